# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Importance maps on disk, named by the building's hash and the parameters they depend on."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import logging
import os
import tempfile
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_importance.config import ImportanceConfig
from walk_importance.grid import VoxelGrid
from walk_importance.importance_map import ImportanceMap, weigh

_log = logging.getLogger(__name__)
_FORMAT = 1  # raise when the method or the file changes, so that older files are left alone
_WEIGHTS = ("weight_obstacle", "weight_distance", "weight_visibility")
_MAPS = ("obstacle", "distance", "visibility")


def cache_file(folder: Path, building: Building, config: ImportanceConfig) -> Path:
    """Returns where the maps of a building are kept; the weights do not matter, they are applied anew."""
    settings = {k: v for k, v in dataclasses.asdict(config).items() if k not in _WEIGHTS}
    text = json.dumps([_FORMAT, building.hash, settings], sort_keys=True)
    return folder / f"importance-{hashlib.sha256(text.encode()).hexdigest()[:32]}.bin"


def save_map(file: Path, importance_map: ImportanceMap) -> None:
    """Writes the three maps, a line of JSON and then their numbers; the file appears whole or not at all."""
    body = b"".join(np.ascontiguousarray(getattr(importance_map, name)).tobytes() for name in _MAPS)
    grid = importance_map.grid
    head = {
        "origin": grid.origin.tolist(),
        "voxel_size_m": grid.voxel_size_m,
        "shape": grid.shape,
        "visibility_stderr": importance_map.visibility_stderr,
        "notes": importance_map.notes,
        "crc32": zlib.crc32(body),
    }
    file.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=file.parent, delete=False) as out:
        out.write(json.dumps(head).encode() + b"\n")
        out.write(body)
    os.replace(out.name, file)  # noqa: PTH105 - Path.replace would need the name wrapped again


def load_map(file: Path, config: ImportanceConfig) -> ImportanceMap | None:
    """Returns the maps in `file`, weighed by `config`; None where there is none or it is damaged."""
    try:
        head_line, body = file.read_bytes().split(b"\n", 1)
    except (OSError, ValueError):
        return None
    try:
        head = json.loads(head_line)
        if zlib.crc32(body) != head["crc32"]:
            raise ValueError("the checksum differs")
        nx, ny, nz = head["shape"]
        values = np.frombuffer(body, np.float32).reshape(3, nx, ny, nz)  # read-only, as bytes are
        maps: dict[str, NDArray[np.float32]] = dict(zip(_MAPS, values, strict=True))
        return ImportanceMap(
            grid=VoxelGrid(origin=np.array(head["origin"]), voxel_size_m=head["voxel_size_m"], shape=(nx, ny, nz)),
            importance=weigh(maps["obstacle"], maps["distance"], maps["visibility"], config),
            visibility_stderr=head["visibility_stderr"],
            notes=tuple(head["notes"]),
            **maps,
        )
    except (ValueError, KeyError, TypeError) as error:
        _log.warning("%s is damaged (%s) and is computed anew", file, error)
        return None
