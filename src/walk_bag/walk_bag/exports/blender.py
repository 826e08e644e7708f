# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walk as JSON that a few lines of Blender's Python turn into an animated camera."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from walk_bag.exports.axes import z_up_camera_quat_xyzw
from walk_bag.exports.resample import sample_at
from walk_bag.exports.ride import ExportConfig, Ride
from walk_bag.exports.times import frame_times
from walk_building.progress import Progress, no_progress

FORMAT = "walk camera 1"


def write_blender(path: Path, ride: Ride, config: ExportConfig | None = None, progress: Progress = no_progress) -> None:
    """Writes one entry per frame, from frame 1 on, as Blender counts: location, rotation_quaternion (w x y z).

    Metres, z up, in the building file's own coordinates; the camera looks along its -z, as Blender's do.
    """
    config = config or ExportConfig()
    samples = sample_at(ride, frame_times(ride, config.fps))
    locations = np.round(ride.to_file(samples.positions), 5).tolist()
    quats_wxyz = np.round(z_up_camera_quat_xyzw(samples.quat_xyzw)[:, [3, 0, 1, 2]], 7).tolist()
    frames = [
        {"frame": number, "location": location, "rotation_quaternion": quat}
        for number, (location, quat) in enumerate(zip(locations, quats_wxyz, strict=True), start=1)
    ]
    document = {
        "format": FORMAT,
        "fps": config.fps,
        "field_of_view_rad": config.field_of_view_rad,
        "sensor_fit": "VERTICAL",
        "building": ride.building_name,
        "keypoints": np.round(ride.to_file(ride.keypoints), 5).tolist(),
        "frames": frames,
    }
    path.write_text(json.dumps(document, separators=(",", ":")) + "\n", encoding="utf-8")
    progress("write", 1.0)
