# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
import os
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from walk_ros.runner import use_profiles

NAMES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE")


def test_fast_dds_gets_a_file_that_there_is(monkeypatch):
    for name in NAMES:
        monkeypatch.setenv(name, "")
    use_profiles()
    root = ET.parse(Path(os.environ[NAMES[0]])).getroot()
    assert {child.tag.rpartition("}")[2] for child in root} == {"participant", "data_writer"}
    assert all(child.get("is_default_profile") == "true" for child in root)


@pytest.mark.parametrize("name", NAMES)
def test_the_profiles_of_the_user_stay(monkeypatch, name):
    for other in NAMES:
        monkeypatch.setenv(other, "")
    monkeypatch.setenv(name, "mine.xml")
    use_profiles()
    assert [os.environ[n] for n in NAMES if os.environ[n]] == ["mine.xml"]
