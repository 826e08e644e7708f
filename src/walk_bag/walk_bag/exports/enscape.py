# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walk as a camera path in XML, as Enscape keeps its video paths."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

from walk_bag.exports.axes import ahead, to_gltf
from walk_bag.exports.resample import resample
from walk_bag.exports.ride import ExportConfig, Ride
from walk_building.progress import Progress, no_progress

KEYFRAME_STEP_S = 0.2
"""Longest time between two keyframes [s]: what the program puts between them then stays near the path."""


def write_enscape(path: Path, ride: Ride, config: ExportConfig | None = None, progress: Progress = no_progress) -> None:
    """Writes `VideoPath` with a keyframe at least every 0.2 s: position, unit look direction, seconds, angle of view.

    Metres, y up (x east, -z north), in the building file's own coordinates: the model that is open beside it stands
    there. The program publishes no description of the format; what is written is what its own files hold.
    """
    config = config or ExportConfig()
    samples = resample(ride, KEYFRAME_STEP_S)
    root = ET.Element("VideoPath", version="1", easingInOut="0", shakyCam="0")
    frames = ET.SubElement(root, "Keyframes", count=str(len(samples.t_s)))
    looks = to_gltf(ahead(samples.quat_xyzw))
    rows = zip(samples.t_s - samples.t_s[0], to_gltf(ride.to_file(samples.positions)), looks, strict=True)
    for order, (t_s, position, look) in enumerate(rows):
        frame = ET.SubElement(frames, "Keyframe", order=str(order), timestampSeconds=f"{t_s:.4f}")
        frame.set("fieldOfView", f"{config.field_of_view_rad:.6f}")
        for name, vector in (("Position", position), ("LookAt", look)):
            ET.SubElement(frame, name, {axis: f"{value:.6f}" for axis, value in zip("xyz", vector + 0.0, strict=True)})
    ET.indent(root)
    path.write_bytes(b'<?xml version="1.0" ?>\n' + ET.tostring(root) + b"\n")
    progress("write", 1.0)
