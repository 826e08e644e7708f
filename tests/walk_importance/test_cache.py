# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import dataclasses
import os
from pathlib import Path

import numpy as np
import pytest
from scenes import building_of, two_rooms

from walk_building.building import Building
from walk_importance.cache import cache_file, load_map, save_map, trim
from walk_importance.config import ImportanceConfig
from walk_importance.importance_map import ImportanceMap
from walk_importance.pipeline import compute_importance

CONFIG = ImportanceConfig(voxel_size_m=0.4)


@pytest.fixture(scope="module")
def building() -> Building:
    return building_of(two_rooms())


@pytest.fixture(scope="module")
def maps(building: Building) -> ImportanceMap:
    return compute_importance(building, CONFIG)


def test_what_is_read_is_what_was_written(tmp_path: Path, building: Building, maps: ImportanceMap) -> None:
    file = cache_file(tmp_path / "new", building.hash, CONFIG)
    save_map(file, maps)
    back = load_map(file, CONFIG)
    assert back is not None
    for name in ("obstacle", "distance", "visibility", "importance"):
        np.testing.assert_array_equal(getattr(back, name), getattr(maps, name))
        assert not getattr(back, name).flags.writeable
    assert back.grid.shape == maps.grid.shape
    np.testing.assert_array_equal(back.grid.origin, maps.grid.origin)
    assert (back.grid.voxel_size_m, back.visibility_stderr) == (maps.grid.voxel_size_m, maps.visibility_stderr)
    assert [p.name for p in file.parent.iterdir()] == [file.name]


def test_other_weights_use_the_same_file(tmp_path: Path, building: Building, maps: ImportanceMap) -> None:
    heavy = dataclasses.replace(CONFIG, weight_visibility=9.0)
    assert cache_file(tmp_path, building.hash, heavy) == cache_file(tmp_path, building.hash, CONFIG)
    file = cache_file(tmp_path, building.hash, CONFIG)
    save_map(file, maps)
    back = load_map(file, heavy)
    assert back is not None
    np.testing.assert_allclose(back.importance, maps.importance + 8 * maps.visibility, atol=1e-5)


def test_another_building_or_voxel_size_has_another_file(tmp_path: Path, building: Building) -> None:
    other = dataclasses.replace(building, hash="another")
    finer = dataclasses.replace(CONFIG, voxel_size_m=0.3)
    names = {cache_file(tmp_path, b.hash, c) for b, c in ((building, CONFIG), (other, CONFIG), (building, finer))}
    assert len(names) == 3


@pytest.mark.parametrize("damage", ["cut", "flipped", "empty", "no head", "missing"])
def test_a_damaged_file_counts_as_none(tmp_path: Path, building: Building, maps: ImportanceMap, damage: str) -> None:
    file = cache_file(tmp_path, building.hash, CONFIG)
    save_map(file, maps)
    raw = file.read_bytes()
    flipped = bytearray(raw)
    flipped[len(raw) // 2] ^= 1
    head_only = b"{}\n" + raw.split(b"\n", 1)[1]
    content = {"cut": raw[:-100], "flipped": bytes(flipped), "empty": b"", "no head": head_only, "missing": b""}[damage]
    file.write_bytes(content)
    if damage == "missing":
        file.unlink()
    assert load_map(file, CONFIG) is None


def test_a_full_folder_loses_what_was_used_longest_ago(tmp_path: Path) -> None:
    for age in range(6):
        file = tmp_path / f"importance-{age}.bin"
        file.write_bytes(b"x" * 100)
        os.utime(file, (1e9 - age, 1e9 - age))
    (tmp_path / "mine.txt").write_text("not the cache's")
    old = tmp_path / "killed.part"
    old.write_bytes(b"")
    os.utime(old, (1e9, 1e9))
    trim(tmp_path, max_files=4)
    assert sorted(f.name for f in tmp_path.glob("importance-*")) == [f"importance-{age}.bin" for age in range(4)]
    trim(tmp_path, max_bytes=250)
    assert sorted(f.name for f in tmp_path.iterdir()) == ["importance-0.bin", "importance-1.bin", "mine.txt"]
