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
import time
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_importance.config import ImportanceConfig
from walk_importance.grid import VoxelGrid
from walk_importance.importance_map import ImportanceMap, weigh

_log = logging.getLogger(__name__)
_FORMAT = 1  # raise when the method or the file changes, so that older files are left alone
_WEIGHTS = ("weight_obstacle", "weight_distance", "weight_visibility")
_MAPS = ("obstacle", "distance", "visibility")

MAX_FILES = 20
MAX_BYTES = 2_000_000_000
"""What a cache folder holds at most: 20 maps of the default size are 360 MB, two of the largest size 1.5 GB."""
_STALE_S = 3600.0  # an unfinished file this old was left by a process that was killed


def default_cache_dir() -> Path:
    """Returns the folder that XDG gives the maps: `$XDG_CACHE_HOME/walk`, `~/.cache/walk` by default."""
    home = Path(os.environ.get("XDG_CACHE_HOME", ""))
    return (home if home.is_absolute() else Path.home() / ".cache") / "walk"


def same_maps(a: ImportanceConfig, b: ImportanceConfig) -> bool:
    """Returns whether two configs differ in their weights at most, so that the three maps are the same."""
    return _but_weights(a) == _but_weights(b)


def _but_weights(config: ImportanceConfig) -> dict[str, object]:
    return {k: v for k, v in dataclasses.asdict(config).items() if k not in _WEIGHTS}


def cache_file(folder: Path, building_hash: str, config: ImportanceConfig) -> Path:
    """Returns where the maps of a building are kept; the weights do not matter, they are applied anew."""
    text = json.dumps([_FORMAT, building_hash, _but_weights(config)], sort_keys=True)
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
    write_whole(file, json.dumps(head).encode() + b"\n", body)


def write_whole(file: Path, *pieces: bytes) -> None:
    """Writes a file that appears whole or not at all; raises OSError where it cannot."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=file.parent, suffix=".part", delete=False) as out:
        part = Path(out.name)
        try:
            for piece in pieces:
                out.write(piece)
            out.flush()
            part.replace(file)
        except OSError:
            part.unlink(missing_ok=True)
            raise


def trim(folder: Path, max_files: int = MAX_FILES, max_bytes: int = MAX_BYTES) -> None:
    """Deletes what was used longest ago, until no more than this many files and bytes of each kind are left."""
    for pattern in ("importance-*.bin", "start-*.json"):
        # Another node may delete the same files at the same time.
        found = sorted(((f.stat(), f) for f in folder.glob(pattern)), key=lambda s: -s[0].st_mtime_ns)
        held = 0
        for count, (status, file) in enumerate(found, start=1):
            held += status.st_size
            if count > max_files or held > max_bytes:
                file.unlink(missing_ok=True)
    for part in folder.glob("*.part"):
        if time.time() - part.stat().st_mtime > _STALE_S:
            part.unlink(missing_ok=True)


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
