# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walk as a USD stage: the building, the path, and a camera with time samples."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from pxr import Gf, Sdf, Usd, UsdGeom, Vt

from walk_bag.errors import ExportError
from walk_bag.exports.axes import z_up_camera_quat_xyzw
from walk_bag.exports.glb import kinds
from walk_bag.exports.resample import sample_at
from walk_bag.exports.ride import ExportConfig, Ride
from walk_bag.exports.times import frame_times
from walk_building.progress import Progress, no_progress

CAMERA = "/Walk/Eye"
# Of 35 mm film, upright; USD counts lenses in tenths of a stage's unit, which cancels out in the angle of view.
_APERTURE_MM = 24.0
_ASPECT = 16 / 9


def write_usd(path: Path, ride: Ride, config: ExportConfig | None = None, progress: Progress = no_progress) -> None:
    """Writes a stage in metres, z up, one sample of the camera per frame; `.usda` is text, `.usdc` and `.usd` binary.

    Raises:
        ExportError: The file cannot be written.
    """
    config = config or ExportConfig()
    # In memory first: a stage that is made in place would stay open, and half-written after an error.
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    root = UsdGeom.Xform.Define(stage, "/Walk").GetPrim()
    stage.SetDefaultPrim(root)
    root.SetCustomDataByKey("building", ride.building_name)
    root.SetCustomDataByKey("hash", ride.building_hash)
    root.SetCustomDataByKey("offset_m", Gf.Vec3d(*ride.offset_m.tolist()))
    if ride.model is not None:
        for number, (name, triangles) in enumerate(kinds(ride.model)):
            _add_mesh(stage, f"/Walk/Building/{_identifier(name, number)}", ride.model.vertices, triangles)
    _add_path(stage, ride)
    _add_camera(stage, ride, config)
    progress("write", 0.5)
    if not stage.GetRootLayer().Export(str(path)):
        raise ExportError(path, "cannot be written")
    progress("write", 1.0)


def _identifier(name: str, number: int) -> str:
    """Returns a name that USD takes: letters, digits and underscores."""
    plain = "".join(c if c.isascii() and c.isalnum() else "_" for c in name)
    return plain if Sdf.Path.IsValidIdentifier(plain) else f"Part_{number}"


def _add_mesh(stage: Usd.Stage, path: str, vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> None:
    used, index = np.unique(faces, return_inverse=True)
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(vertices[used].astype(np.float32)))
    mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(faces), 3, np.int32)))
    mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(index.reshape(-1).astype(np.int32)))
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreateDoubleSidedAttr(True)


def _add_path(stage: Usd.Stage, ride: Ride) -> None:
    curve = UsdGeom.BasisCurves.Define(stage, "/Walk/Path")
    curve.CreateTypeAttr(UsdGeom.Tokens.linear)
    curve.CreatePointsAttr(Vt.Vec3fArray.FromNumpy(ride.positions.astype(np.float32)))
    curve.CreateCurveVertexCountsAttr([len(ride.positions)])
    curve.CreateWidthsAttr([0.05])
    curve.SetWidthsInterpolation(UsdGeom.Tokens.constant)


def _add_camera(stage: Usd.Stage, ride: Ride, config: ExportConfig) -> None:
    times = frame_times(ride, config.fps)
    stage.SetTimeCodesPerSecond(config.fps)
    stage.SetFramesPerSecond(config.fps)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(len(times) - 1)
    camera = UsdGeom.Camera.Define(stage, CAMERA)
    camera.CreateVerticalApertureAttr(_APERTURE_MM)
    camera.CreateHorizontalApertureAttr(_APERTURE_MM * _ASPECT)
    camera.CreateFocalLengthAttr(_APERTURE_MM / 2 / float(np.tan(config.field_of_view_rad / 2)))
    camera.CreateClippingRangeAttr(Gf.Vec2f(0.05, 1000.0))
    samples = sample_at(ride, times)
    translate = camera.AddTranslateOp()
    orient = camera.AddOrientOp(UsdGeom.XformOp.PrecisionDouble)
    turns = z_up_camera_quat_xyzw(samples.quat_xyzw)
    for frame, (position, turn) in enumerate(zip(samples.positions.tolist(), turns.tolist(), strict=True)):
        translate.Set(Gf.Vec3d(*position), frame)
        orient.Set(Gf.Quatd(turn[3], turn[0], turn[1], turn[2]), frame)
