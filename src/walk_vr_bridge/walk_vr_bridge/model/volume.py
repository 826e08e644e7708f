# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The importance map as a texture: four bytes a voxel, x fastest."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_ros.conversions.importance import MAPS, ReceivedImportanceMap

MAX_VOXELS = 8_000_000
"""More than this are thinned out: 32 MB are what a headset's memory bears beside the building."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Volume:
    """What is sent: `data`, and what is said about it."""

    description: dict[str, Any]
    data: bytes


def volume(importance_map: ReceivedImportanceMap, building_hash: str, max_voxels: int = MAX_VOXELS) -> Volume:
    """Returns the map as bytes; a byte b stands for low + (high - low) b / 255."""
    grid = importance_map.grid
    step = 1
    while np.prod([-(-n // step) for n in grid.shape]) > max_voxels:
        step += 1
    arrays = [np.asarray(getattr(importance_map, name))[::step, ::step, ::step] for name in MAPS]
    shape = arrays[0].shape
    table = np.empty((*shape[::-1], len(MAPS)), np.uint8)
    channels = []
    for at, (name, values) in enumerate(zip(MAPS, arrays, strict=True)):
        low, high = (0.0, 1.0) if name == "obstacle" else _range(values)
        scaled = (values - np.float32(low)) * np.float32(255 / ((high - low) or 1.0))
        table[..., at] = np.rint(np.clip(scaled, 0, 255)).astype(np.uint8).transpose(2, 1, 0)
        channels.append({"name": name, "low": low, "high": high})
    revision = str(importance_map.stamp_ns)
    # With every n-th voxel, the middle of the first one stays where it was.
    origin = grid.origin - (step - 1) * grid.voxel_size_m / 2
    description = {
        "revision_ns": revision,
        "building": building_hash,
        "origin": [float(x) for x in origin],
        "voxel_size_m": step * grid.voxel_size_m,
        "shape": list(shape),
        "channels": channels,
        "url": f"/importance.bin?revision={revision}",
        "bytes": table.nbytes,
    }
    return Volume(description=description, data=table.tobytes())


def _range(values: NDArray[np.float32]) -> tuple[float, float]:
    return (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
