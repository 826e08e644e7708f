# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The keypoints as CSV and JSON, the same files that can be read back; see walk_bag.imports."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_bag.errors import ExportError
from walk_bag.exports.ride import ExportConfig, Ride
from walk_building.progress import Progress, no_progress

COLUMNS = ("x", "y", "z", "qx", "qy", "qz", "qw")


def write_keypoints_csv(
    path: Path,
    ride: Ride,
    config: ExportConfig | None = None,  # noqa: ARG001  (all exporters are called alike)
    progress: Progress = no_progress,
) -> None:
    """Writes `x,y,z,qx,qy,qz,qw` rows in the order of the tour: metres, z up, the building file's coordinates."""
    np.savetxt(path, _table(path, ride), fmt="%.7f", delimiter=",", header=",".join(COLUMNS), comments="")
    progress("write", 1.0)


def write_keypoints_json(
    path: Path,
    ride: Ride,
    config: ExportConfig | None = None,  # noqa: ARG001  (all exporters are called alike)
    progress: Progress = no_progress,
) -> None:
    """Writes `{"keypoints": [{"position": [x, y, z], "quat_xyzw": [x, y, z, w]}, …]}`, as the CSV counts."""
    table = np.round(_table(path, ride), 7).tolist()
    rows = [{"position": row[:3], "quat_xyzw": row[3:]} for row in table]
    path.write_text(json.dumps({"building": ride.building_name, "keypoints": rows}, indent=1) + "\n", encoding="utf-8")
    progress("write", 1.0)


def _table(path: Path, ride: Ride) -> NDArray[np.float64]:
    if len(ride.keypoints) == 0:
        raise ExportError(path, "there are no keypoints to write: the bag holds none")
    quat = ride.keypoint_quat_xyzw
    turns = np.tile([0.0, 0.0, 0.0, 1.0], (len(ride.keypoints), 1)) if quat is None else quat
    return np.column_stack([ride.to_file(ride.keypoints), turns])
