# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is no building is refused with one sentence, whatever it is."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from walk_building.errors import BuildingError
from walk_building.loaders import LOADERS, load_model
from walk_building.model import LoadOptions

_SUFFIXES = sorted(LOADERS)
_MESHES = [".glb", ".obj", ".ply", ".stl", ".dae"]

_STARTS = [
    b"",
    b"ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n",
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n",
    b"solid a\nfacet normal 0 0 1\nouter loop\nvertex ",
    b"v 0 0 0\nv 1 0 0\nf 1 2 ",
    b'{"asset": {"version": "2.0"}, "meshes": ',
    b"glTF\x02\x00\x00\x00\x20\x00\x00\x00\x0c\x00\x00\x00JSON",
    b"PK\x03\x04",
    b'<?xml version="1.0"?><COLLADA><asset/><scene>',
]
_ENDS = [b"", b"\nENDSEC;\nEND-ISO-10303-21;\n", b"</scene></COLLADA>", b"}"]


def refusal(path: Path, options: LoadOptions | None = None) -> str:
    with pytest.raises(BuildingError) as caught:
        load_model(path, options)
    assert caught.value.path == path
    text = str(caught.value)
    assert text == f"{path}: {caught.value.reason}" and "\n" not in text and caught.value.reason
    return caught.value.reason


def box(path: Path, side: float) -> Path:
    trimesh.creation.box(extents=[side, side, side]).export(path)
    return path


def test_missing_file(tmp_path: Path) -> None:
    assert refusal(tmp_path / "gone.ifc") == "there is no such file"


def test_folder(tmp_path: Path) -> None:
    folder = tmp_path / "house.ifc"
    folder.mkdir()
    assert "folder" in refusal(folder)


@pytest.mark.parametrize("name", ["x" * 300 + ".ifc", "nul\0.ifc", "house.stl/inside.ifc"])
def test_names_that_no_file_has(tmp_path: Path, name: str) -> None:
    box(tmp_path / "house.stl", 3.0)
    refusal(tmp_path / name)


def test_pipe_is_refused_at_once(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "house.ifc")
    assert "no ordinary file" in refusal(tmp_path / "house.ifc")


@pytest.mark.parametrize("name", ["house.dwg", "house"])
def test_unknown_suffix_lists_the_known_ones(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(b"x")
    reason = refusal(path)
    assert all(suffix in reason for suffix in LOADERS)


def test_suffix_in_capitals_is_known(tmp_path: Path) -> None:
    assert len(load_model(box(tmp_path / "HOUSE.STL", 3.0)).faces) == 12


def test_file_without_permission(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = box(tmp_path / "house.stl", 3.0)
    path.chmod(0)
    if os.access(path, os.R_OK):  # root reads everything: let the system refuse by hand

        def refuse(self: Path, *args: object, **kwargs: object) -> None:
            raise PermissionError(13, "Permission denied")

        monkeypatch.setattr(Path, "open", refuse)
    assert "Permission denied" in refusal(path)


@pytest.mark.parametrize("suffix", _SUFFIXES)
@pytest.mark.parametrize("content", [b"", b"\0" * 200, b"<!DOCTYPE html><html><body>Not found</body></html>", b"{}"])
def test_other_content_under_every_suffix(tmp_path: Path, suffix: str, content: bytes) -> None:
    path = tmp_path / f"house{suffix}"
    path.write_bytes(content)
    refusal(path)


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    suffix=st.sampled_from(_SUFFIXES),
    start=st.sampled_from(_STARTS),
    middle=st.binary(max_size=200),
    end=st.sampled_from(_ENDS),
)
def test_random_bytes_are_refused_or_loaded_but_never_crash(
    suffix: str, start: bytes, middle: bytes, end: bytes
) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"house{suffix}"
        path.write_bytes(start + middle + end)
        try:
            model = load_model(path)
        except BuildingError as error:
            assert error.reason
        else:
            assert len(model.faces)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(suffix=st.sampled_from(_MESHES), place=st.floats(0, 1), byte=st.integers(0, 255))
def test_one_changed_byte_is_refused_or_gives_finite_triangles(suffix: str, place: float, byte: int) -> None:
    with tempfile.TemporaryDirectory() as folder:
        path = box(Path(folder) / f"house{suffix}", 5.0)
        data = bytearray(path.read_bytes())
        data[int(place * (len(data) - 1))] = byte
        path.write_bytes(data)
        try:
            model = load_model(path)
        except BuildingError:
            return
        assert np.isfinite(model.vertices).all()
        assert model.faces.min() >= 0 and model.faces.max() < len(model.vertices)


@pytest.mark.parametrize("suffix", _MESHES)
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_vertices_that_are_no_numbers(tmp_path: Path, suffix: str, value: float) -> None:
    mesh = trimesh.creation.box(extents=[5, 5, 5])
    vertices = np.array(mesh.vertices)
    vertices[3, 1] = value
    path = tmp_path / f"house{suffix}"
    with np.errstate(all="ignore"):
        trimesh.Trimesh(vertices, mesh.faces, process=False, vertex_normals=mesh.vertex_normals).export(path)
    reason = refusal(path)
    assert "finite" in reason or "cannot be read" in reason


@pytest.mark.parametrize("suffix", _MESHES)
def test_triangles_without_area_only(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"flat{suffix}"
    with np.errstate(all="ignore"):
        trimesh.Trimesh([[0, 0, 0], [5, 0, 0], [9, 0, 0]], [[0, 1, 2]], process=False).export(path)
    assert "no triangles" in refusal(path)


def test_points_only(tmp_path: Path) -> None:
    path = tmp_path / "scan.ply"
    trimesh.PointCloud(np.random.default_rng(0).random((50, 3)) * 9).export(path)
    assert "point clouds" in refusal(path)


@pytest.mark.parametrize("side", [0.01, 50_000.0])
@pytest.mark.parametrize("suffix", [".glb", ".obj"])
def test_sizes_of_no_building_ask_for_the_unit(tmp_path: Path, suffix: str, side: float) -> None:
    path = box(tmp_path / f"house{suffix}", side)
    assert "give its unit with --units" in refusal(path)
    assert len(load_model(path, LoadOptions(units_m=10.0 / side)).faces) == 12


def test_a_stray_part_is_named(tmp_path: Path) -> None:
    scene = trimesh.Scene()
    for i, x in enumerate((0.0, 5.0, 9.0)):
        scene.add_geometry(trimesh.creation.box(extents=[3, 3, 3]), node_name=f"room{i}", transform=_shift(x))
    scene.add_geometry(trimesh.creation.box(extents=[1, 1, 1]), node_name="north arrow", transform=_shift(90_000.0))
    path = tmp_path / "site.glb"
    scene.export(path)
    assert "'north arrow'" in refusal(path)
    assert len(load_model(path, LoadOptions(ignore="north")).parts) == 3


def _shift(x: float) -> np.ndarray:
    transform = np.eye(4)
    transform[0, 3] = x
    return transform


def test_collada_unit_that_is_no_length(tmp_path: Path) -> None:
    path = box(tmp_path / "house.dae", 5.0)
    path.write_text(path.read_text().replace("<up_axis>", '<unit name="x" meter="nope"/><up_axis>'))
    assert "'nope'" in refusal(path)


_DAMAGE = """
import random, sys
from pathlib import Path
from walk_building.errors import BuildingError
from walk_building.loaders import load_model
source, target = Path(sys.argv[1]).read_bytes(), Path(sys.argv[2])
random.seed(7)
for _ in range(40):
    data = bytearray(source)
    for _ in range(random.choice((1, 3, 20))):
        data[random.randrange(200, len(data) - 40)] = random.choice(b"0123456789#$,();'.*AZ ")
    target.write_bytes(data)
    try:
        load_model(target)
    except BuildingError:
        pass
print("survived")
"""


def test_damaged_ifc_never_ends_the_process(tmp_path: Path) -> None:
    import ifcopenshell.api.aggregate
    import ifcopenshell.api.context
    import ifcopenshell.api.geometry
    import ifcopenshell.api.project
    import ifcopenshell.api.root
    import ifcopenshell.api.unit

    api = ifcopenshell.api
    file = api.project.create_file()
    api.root.create_entity(file, ifc_class="IfcProject")
    api.unit.assign_unit(file)
    body = api.context.add_context(file, context_type="Model")
    for i in range(5):
        wall = api.root.create_entity(file, ifc_class="IfcWall", name=f"wall {i}")
        api.geometry.edit_object_placement(file, product=wall)
        shape = api.geometry.add_wall_representation(file, context=body, length=5, height=3, thickness=0.2)
        api.geometry.assign_representation(file, product=wall, representation=shape)
    source = tmp_path / "sound.ifc"
    file.write(str(source))
    assert len(load_model(source).parts) == 5
    # In a process of its own, for an engine that crashes would take the whole suite with it.
    done = subprocess.run(
        [sys.executable, "-c", _DAMAGE, str(source), str(tmp_path / "damaged.ifc")],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.stdout.strip() == "survived", done.stderr[-2000:]
    assert done.returncode == 0


def test_engine_that_crashes_on_a_damaged_file_is_survived(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "damaged.ifc"
    path.write_text(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
        "FILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n#1=IFCWALL('0E8e5g8qb0kg3Ff9f2HM1S',$,'wall',$,$,#7,#8,$,$);\n"
        "ENDSEC;\nEND-ISO-10303-21;\n"
    )
    monkeypatch.setattr("walk_building.loaders.ifc_probe._CHILD", "import os; os.abort()")
    assert "names instances that are not there" in refusal(path)
    monkeypatch.setattr("walk_building.loaders.ifc_probe._CHILD", "pass")
    assert "not in it" in refusal(path)  # survived, and then there is nothing to walk on
