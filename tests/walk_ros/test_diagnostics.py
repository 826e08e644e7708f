# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from diagnostic_msgs.msg import DiagnosticStatus

from walk_building.errors import BuildingError
from walk_ros.conversions import stamp_from_msg
from walk_ros.diagnostics import Diagnostics, diagnostic_values, error_code


def status(diagnostics):
    msg = diagnostics.to_msg(5_000_000_007)
    assert stamp_from_msg(msg.header.stamp) == 5_000_000_007
    return msg.status[0]


def test_state_level_sentence_and_code_are_told():
    d = Diagnostics("walk/trajopt")
    d.building("house.ifc", "abc")
    d.state("failed", "house.ifc: no floor", level="error", code="building_error")
    got = status(d)
    values = diagnostic_values(got)
    assert got.level == DiagnosticStatus.ERROR
    assert (got.name, got.message, got.hardware_id) == ("walk/trajopt", "house.ifc: no floor", "abc")
    assert (values["state"], values["error_code"], values["building_hash"]) == ("failed", "building_error", "abc")


def test_a_good_state_takes_the_error_code_away():
    d = Diagnostics("n")
    d.state("failed", "x", level="error", code="y")
    d.state("ready")
    assert status(d).level == DiagnosticStatus.OK
    assert diagnostic_values(status(d))["error_code"] == ""


def test_percentiles_are_those_of_the_latencies():
    d = Diagnostics("n")
    assert "latency_p50_ms" not in diagnostic_values(status(d))
    seconds = np.random.default_rng(1).random(400)
    for s in seconds:
        d.latency(float(s))
    values = diagnostic_values(status(d))
    assert float(values["latency_p50_ms"]) == pytest.approx(1e3 * np.median(seconds), abs=0.01)
    assert float(values["latency_p99_ms"]) == pytest.approx(1e3 * np.percentile(seconds, 99), abs=0.01)


def test_dropped_edits_are_counted():
    d = Diagnostics("n")
    d.dropped()
    d.dropped(4)
    assert diagnostic_values(status(d))["dropped_edits"] == "5"


def test_codes_are_class_names():
    assert error_code(BuildingError("a", "b")) == "building_error"
    assert error_code(ValueError()) == "value_error"
