# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What only glTF has: several primitives in a mesh, buffers beside the file, extensions, encodings."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from mesh_files import HIGH, LOW, Y_UP_TO_Z_UP, bounds, hall, write

from walk_building.errors import BuildingError
from walk_building.loaders import load_model


def test_primitives_of_one_gltf_mesh_keep_the_nodes_name(tmp_path: Path) -> None:
    path = write(hall(), tmp_path / "hall.gltf", y_up=True)
    tree = json.loads(path.read_text())
    tree["meshes"][0]["primitives"] += tree["meshes"][1]["primitives"]
    path.write_text(json.dumps(tree))
    first, second = load_model(path), load_model(path)
    assert len(first.parts) == 4
    assert {part.name for part in first.parts} == {"floor", "wall", "column"}
    assert first.parts == second.parts


def test_draco_geometry_is_read(tmp_path: Path) -> None:
    pytest.importorskip("DracoPy", reason="compressed glTF is read where DracoPy is installed")
    scene = hall()
    scene.apply_transform(np.linalg.inv(Y_UP_TO_Z_UP))
    path = tmp_path / "hall.glb"
    path.write_bytes(trimesh.exchange.gltf.export_glb(scene, extension_draco=True))
    assert b"KHR_draco_mesh_compression" in path.read_bytes()
    np.testing.assert_allclose(bounds(load_model(path)), [LOW, HIGH], atol=1e-3)


def _gltf(tmp_path: Path, **changes: object) -> Path:
    path = write(hall(), tmp_path / "hall.gltf", y_up=True)
    path.write_text(json.dumps(json.loads(path.read_text()) | changes))
    return path


@pytest.mark.parametrize("extension", ["EXT_meshopt_compression", "VENDOR_new_geometry"])
def test_gltf_that_needs_an_unread_extension_is_refused_by_its_name(tmp_path: Path, extension: str) -> None:
    path = _gltf(tmp_path, extensionsUsed=[extension], extensionsRequired=[extension])
    with pytest.raises(BuildingError, match=f"needs {extension}, which is not read; export it again"):
        load_model(path)


def test_draco_without_its_decoder_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    path = _gltf(tmp_path, extensionsUsed=["KHR_draco_mesh_compression"])
    with pytest.raises(BuildingError, match="pip install DracoPy"):
        load_model(path)


def test_gltf_that_needs_only_looks_is_read(tmp_path: Path) -> None:
    path = _gltf(tmp_path, extensionsRequired=["KHR_materials_unlit", "KHR_texture_basisu"])
    assert len(load_model(path).faces) == 36


@pytest.mark.parametrize(
    ("key", "value", "said"), [("sparse", {"count": 1}, "sparse"), ("normalized", True, "normalized")]
)
def test_encodings_that_the_engine_would_misread_are_refused(
    tmp_path: Path, key: str, value: object, said: str
) -> None:
    path = write(hall(), tmp_path / "hall.gltf", y_up=True)
    tree = json.loads(path.read_text())
    tree["accessors"][tree["meshes"][0]["primitives"][0]["attributes"]["POSITION"]][key] = value
    path.write_text(json.dumps(tree))
    with pytest.raises(BuildingError, match=said):
        load_model(path)


def test_missing_buffer_of_a_gltf_is_named(tmp_path: Path) -> None:
    path = write(hall(), tmp_path / "hall.gltf", y_up=True)
    buffer = next(tmp_path.glob("*.bin"))
    buffer.unlink()
    with pytest.raises(BuildingError, match=f"'{buffer.name}', which is not there"):
        load_model(path)


def test_gltf_version_1_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BuildingError, match=r"glTF 1\.0"):
        load_model(_gltf(tmp_path, asset={"version": "1.0"}))


def test_cut_short_glb_is_refused(tmp_path: Path) -> None:
    path = write(hall(), tmp_path / "hall.glb", y_up=True)
    path.write_bytes(path.read_bytes()[:-100])
    with pytest.raises(BuildingError, match="cut short"):
        load_model(path)
