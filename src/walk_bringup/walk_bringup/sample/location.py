# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where the stored sample building is."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from pathlib import Path


def sample_path() -> Path:
    """Returns the stored sample building: in the source tree, else in an installed share folder.

    Raises:
        FileNotFoundError: The package was installed without its data.
    """
    places = [folder / "buildings" / "sample.ifc" for folder in _data_folders()]
    for place in places:
        if place.is_file():
            return place
    raise FileNotFoundError(f"{places[0]} is missing; make it with python -m walk_bringup.sample {places[0]}")


def _data_folders() -> Iterator[Path]:
    package = Path(__file__).resolve().parents[1]
    yield package.parent
    # Installed as PREFIX/lib/python3.x/site-packages/walk_bringup, the data is in PREFIX/share/walk_bringup.
    yield from (parent / "share" / "walk_bringup" for parent in package.parents)
    try:
        index = importlib.import_module("ament_index_python.packages")
        yield Path(index.get_package_share_directory("walk_bringup"))
    except (ImportError, LookupError, OSError):
        return  # no ROS 2, a workspace that does not hold the package, or no AMENT_PREFIX_PATH
