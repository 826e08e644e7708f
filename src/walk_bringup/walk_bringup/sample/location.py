# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where the stored sample building is."""

from __future__ import annotations

import importlib
from pathlib import Path

_FILE = Path("buildings") / "sample.ifc"


def sample_path() -> Path:
    """Returns the stored sample building: in the source tree, else in the installed share folder.

    Raises:
        FileNotFoundError: The package was installed without its data.
    """
    here = Path(__file__).resolve().parents[2]
    places = [here / _FILE]
    try:
        index = importlib.import_module("ament_index_python.packages")
        places.append(Path(index.get_package_share_directory("walk_bringup")) / _FILE)
    except (ImportError, LookupError):
        pass  # no ROS 2 around, or a workspace that was not built: the source tree is all there is
    # An install prefix without the index: .../lib/python3.x/site-packages/walk_bringup/sample
    places += [parent / "share" / "walk_bringup" / _FILE for parent in here.parents]
    for place in places:
        if place.is_file():
            return place
    raise FileNotFoundError(
        f"the sample building is not in {places[0].parent}; make it with python -m walk_bringup.sample"
    )
