# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The script that docs/formats.md gives for Blender sets the keyframes that the walk has."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import MagicMock

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from walk_bag.exports import export_ride
from walk_bag.exports.ride import ExportConfig, Ride

DOCS = Path(__file__).parents[2] / "docs" / "formats.md"


class Camera(SimpleNamespace):
    """An object of Blender's, as far as the script uses one: it keeps the values that were set at a keyframe."""

    def keyframe_insert(self, name: str, *, frame: int) -> None:
        self.keys.setdefault(name, {})[frame] = getattr(self, name)


def test_the_script_of_the_docs_moves_a_camera_as_the_walk_goes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    turned = Rotation.from_euler("zyx", [[0, 0, 0], [90, 20, 0]], degrees=True)
    ride = Ride(
        t_s=np.array([0.0, 1.0]), positions=np.array([[0.0, 0, 1.6], [2.0, 0, 1.6]]), quat_xyzw=turned.as_quat(),
        stop=np.array([False, True]), keypoints=np.empty((0, 3)), offset_m=np.array([10.0, 20.0, 30.0]),
    )  # fmt: skip
    export_ride(ride, "blender", tmp_path / "ride.json", ExportConfig(fps=4.0, field_of_view_rad=1.1))
    eye, lens, bpy = Camera(keys={}), SimpleNamespace(), MagicMock()
    bpy.data.cameras.new.return_value = lens
    bpy.data.objects.new.return_value = eye
    monkeypatch.setitem(sys.modules, "bpy", bpy)
    monkeypatch.chdir(tmp_path)
    (script,) = re.findall(r"```python\n(import bpy.*?)```", DOCS.read_text(encoding="utf-8"), re.DOTALL)
    exec(script, {})

    assert bpy.context.scene.render.fps == 4 and (lens.sensor_fit, lens.angle) == ("VERTICAL", 1.1)
    assert eye.rotation_mode == "QUATERNION" and sorted(eye.keys["location"]) == [1, 2, 3, 4, 5]
    assert eye.keys["location"][3] == pytest.approx([11.0, 20.0, 31.6])
    for frame, k in ((1, 0), (5, 1)):
        w, x, y, z = eye.keys["rotation_quaternion"][frame]
        camera = Rotation.from_quat([x, y, z, w])
        # Blender's cameras look along -z with +y up.
        assert camera.apply([0, 0, -1]) == pytest.approx(turned[k].apply([1, 0, 0]), abs=1e-6)
        assert camera.apply([0, 1, 0]) == pytest.approx(turned[k].apply([0, 0, 1]), abs=1e-6)
