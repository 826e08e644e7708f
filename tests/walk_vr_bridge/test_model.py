# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a page loads of a building: names kept, limits kept, positions where they were."""

import gzip
import json
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scenes import building_of, two_rooms
from scipy.spatial import cKDTree

from walk_building.pipeline import load_building
from walk_vr_bridge.config import BridgeConfig
from walk_vr_bridge.content import content
from walk_vr_bridge.files import Files
from walk_vr_bridge.model.floor import floor_of, rectangles
from walk_vr_bridge.model.glb import batches, write_glb
from walk_vr_bridge.model.pieces import Piece, compact, group_of, pieces_of
from walk_vr_bridge.model.scene import FULL_MESHES, MINIATURE_MESHES, describe, make_scene
from walk_vr_bridge.model.simplify import simplify
from walk_vr_bridge.model.volume import volume

SAMPLE = Path(__file__).resolve().parents[2] / "src" / "walk_bringup" / "buildings" / "sample.ifc"


def read_glb(data):
    """The document, and for each node its triangles in the map (F, 3, 3)."""
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20 : 20 + length])
    binary = data[28 + length :]
    found = {}
    for node in document["nodes"]:
        primitive = document["meshes"][node["mesh"]]["primitives"][0]
        arrays = []
        for at in (primitive["attributes"]["POSITION"], primitive["indices"]):
            accessor = document["accessors"][at]
            view = document["bufferViews"][accessor["bufferView"]]
            assert view["byteOffset"] % 4 == 0
            kind = {5122: "<i2", 5123: "<u2", 5125: "<u4"}[accessor["componentType"]]
            raw = np.frombuffer(binary[view["byteOffset"] :][: view["byteLength"]], kind)
            arrays.append(raw.reshape(-1, 4)[:, :3] if "byteStride" in view else raw)
        assert len(arrays[0]) == document["accessors"][primitive["attributes"]["POSITION"]]["count"]
        points = arrays[0] * np.array(node["scale"]) + node["translation"]
        found[node["name"]] = (node["extras"], points[arrays[1].reshape(-1, 3)])
    return document, found


def ball(name, kind, storey=0, subdivisions=3, at=0.0):
    mesh = trimesh.creation.icosphere(subdivisions=subdivisions)
    vertices = np.asarray(mesh.vertices) + [at, 0.0, 3.0 * storey]
    return Piece(
        name=name, kind=kind, group=group_of(kind), storey=storey, vertices=vertices, faces=np.asarray(mesh.faces)
    )


def test_names_and_positions_survive_the_file():
    pieces = [
        ball("a", "IfcWall"),
        ball("b", "IfcWall", at=5.0),
        ball("ü", "IfcWindow"),
        ball("c", "IfcDoor", storey=1),
    ]
    document, found = read_glb(write_glb(batches(pieces, 16), {"hash": "x"}))
    assert set(found) == {"structure/0", "glass/0", "door/1"}
    assert document["extensionsRequired"] == ["KHR_mesh_quantization"]
    extras, triangles = found["structure/0"]
    assert extras["parts"] == [["a", "IfcWall", 1280], ["b", "IfcWall", 1280]]
    # Part b begins where a ends.
    want = pieces[1].vertices[pieces[1].faces]
    np.testing.assert_allclose(triangles[1280:], want, atol=7.0 / 65534)


def test_too_many_storeys_are_drawn_by_group():
    pieces = [ball(str(k), "IfcWall", storey=k, subdivisions=0) for k in range(20)]
    assert len(batches(pieces, 20)) == 20
    ((group, storey, all_of_them),) = batches(pieces, 19)
    assert (group, storey, len(all_of_them)) == ("structure", -1, 20)


@pytest.mark.parametrize("limit", [100_000, 3000, 700, 90])
def test_simplified_pieces_keep_the_limit_and_the_shape(limit):
    pieces = [ball(str(k), "IfcWall", at=3.0 * k) for k in range(3)]
    kept = simplify(pieces, limit)
    assert sum(len(p.faces) for p in kept) <= limit
    if limit >= 3840:
        assert kept == pieces
    for piece in kept:
        away = np.linalg.norm(piece.vertices - [3.0 * int(piece.name), 0, 0], axis=1)
        assert np.abs(away - 1.0).max() < 0.35


def test_of_too_many_small_things_the_largest_stay():
    small = [ball(f"s{k}", "IfcWall", subdivisions=0, at=k) for k in range(50)]
    large = ball("large", "IfcWall", subdivisions=0)
    large = Piece(
        **{f: getattr(large, f) for f in ("name", "kind", "group", "storey", "faces")}, vertices=9 * large.vertices
    )
    kept = simplify([*small, large], 100)
    assert "large" in {p.name for p in kept}
    assert sum(len(p.faces) for p in kept) <= 100


def test_equal_vertices_are_merged_and_empty_triangles_left_out():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1e-6], [1, 1, 0]], float)
    points, faces = compact(vertices, np.array([[0, 1, 2], [3, 4, 2], [0, 3, 1]]))
    assert len(points) == 4
    assert faces.tolist() == [[0, 1, 2], [0, 3, 2]]


def test_rectangles_cover_each_cell_once_at_its_level():
    rng = np.random.default_rng(3)
    for _ in range(50):
        levels = rng.integers(-1, 3, (9, 7))
        covered = np.full(levels.shape, -1)
        for i0, j0, i1, j1, level in rectangles(levels, none=-1):
            assert (covered[i0:i1, j0:j1] == -1).all()
            covered[i0:i1, j0:j1] = level
        assert (covered == levels).all()
    assert rectangles(np.zeros((40, 30), int)).tolist() == [[0, 0, 40, 30, 0]]


def off(tiles, points):
    """How far each of (N, 3) points is from the nearest tile over or under it, and whether tiles lie in one place."""
    x0, y0, x1, y1, z = tiles.T
    inside = (points[:, :1] >= x0) & (points[:, :1] < x1) & (points[:, 1:2] >= y0) & (points[:, 1:2] < y1)
    gaps = np.where(inside, np.abs(z - points[:, 2:3]), np.inf)
    return gaps.min(1), ((gaps < 0.3).sum(1) > 1).any()


def test_the_floor_lies_under_whoever_walks_there_also_on_a_stair():
    building = load_building(SAMPLE)
    surface = building.surface
    for index in range(len(building.storeys)):
        tiles = floor_of(building, index)
        here = (surface.storey == index) & building.reachable
        places = surface.places[here]
        gap, doubled = off(tiles, places)
        assert gap.max() <= 0.026
        assert not doubled
        # Nowhere farther from where somebody stands than a body reaches.
        middles = (tiles[:, :2] + tiles[:, 2:4]) / 2
        gap, _ = cKDTree(surface.places[surface.storey == index, :2]).query(middles)
        assert gap.max() <= building.walker.radius_m + surface.cell_m
    assert len(np.unique(floor_of(building, 0)[:, 4])) > 5, "the stair of the sample"


class Map:
    """An importance map of n³ voxels."""

    class grid:  # noqa: N801  stands for an object
        origin, voxel_size_m = np.array([1.0, 2.0, 3.0]), 0.5

    def __init__(self, n):
        rng = np.random.default_rng(n)
        self.stamp_ns = 10**18 + 1
        self.grid.shape = (n, n + 1, n + 2)
        shape = self.grid.shape
        self.obstacle = (rng.random(shape) < 0.3).astype(np.float32)
        self.distance, self.visibility, self.importance = rng.normal(size=(3, *shape)).astype(np.float32)


def test_a_volume_gives_the_map_back_to_a_255th():
    wanted = Map(5)
    made = volume(wanted, "hash")
    nx, ny, nz = made.description["shape"]
    table = np.frombuffer(made.data, np.uint8).reshape(nz, ny, nx, 4).transpose(2, 1, 0, 3)
    for at, channel in enumerate(made.description["channels"]):
        low, high = channel["low"], channel["high"]
        got = low + (high - low) * table[..., at] / 255
        np.testing.assert_allclose(got, getattr(wanted, channel["name"]), atol=(high - low) / 500)
    assert made.description["revision_ns"] == "1000000000000000001"


def test_a_large_volume_is_thinned_out_in_place():
    made = volume(Map(10), "hash", max_voxels=300)
    assert made.description["voxel_size_m"] == 1.0
    # The middle of the first voxel stays where it was.
    assert made.description["origin"][0] + 0.5 == 1.0 + 0.25
    assert np.prod(made.description["shape"]) <= 300


def test_a_volume_can_be_read_after_the_next_one_has_come():
    files, made, revisions = Files(), {}, []
    assert (files.get("/importance.json").status, files.get("/importance.bin").status) == (503, 503)
    for n in (4, 5, 6):
        source = Map(n)
        source.stamp_ns += n
        one = volume(source, "hash")
        files.set_volume(one)
        revisions.append(one.description["revision_ns"])
        made[revisions[-1]] = one.data
    oldest, before, newest = revisions
    assert files.get("/importance.bin").data == files.get("/importance.bin", newest).data == made[newest]
    assert files.get("/importance.bin", before).data == made[before]
    assert files.get("/importance.bin", oldest).status == files.get("/importance.bin", "x").status == 409
    files.no_volume()
    assert files.get("/importance.bin", before).status == 503


def test_a_building_is_described_as_it_is():
    building = building_of(two_rooms())
    told = json.loads(json.dumps(describe(building)))
    assert told["hash"] == building.hash
    assert (told["up"], told["units"], told["frame"]) == ("z", "m", "map")
    assert [room["reachable"] for room in told["rooms"]] == [room.reachable for room in building.rooms]
    x0, y0, x1, y1, z = np.array(told["storeys"][0]["floor"]).T
    floor = building.reachable | (building.surface.indoor & (building.surface.room >= 0))
    assert ((x1 - x0) * (y1 - y0)).sum() >= floor.sum() * building.surface.place_area_m2
    assert np.abs(z).max() < 0.03
    low, high = np.array(told["bounds"]["min"]), np.array(told["bounds"]["max"])
    assert ((low <= told["start"]) & (told["start"] <= high)).all()
    assert len(pieces_of(building)) == len([part for part in building.model.parts if part.n_faces])


def test_content_is_compressed_and_named_by_what_it_is():
    made = content(b"a" * 5000, "model/gltf-binary")
    assert gzip.decompress(made.gzipped) == b"a" * 5000
    assert made.etag == content(b"a" * 5000, "model/gltf-binary").etag
    assert made.etag != content(b"b" * 5000, "model/gltf-binary").etag
    assert not content(bytes(range(256)), "image/png").gzipped


@pytest.mark.parametrize(
    "name", ["duplex.ifc", "large_building.ifc", "small_house.ply", "willowgarage.dae", "parking_garage.dae"]
)
@pytest.mark.slow
def test_every_real_building_stays_in_the_budget(buildings_dir, name):
    building = load_building(buildings_dir / name)
    scene = make_scene(building, BridgeConfig())
    calls = triangles = 0
    for key, file, limit, meshes in (
        ("building", scene.building, 200_000, FULL_MESHES),
        ("miniature", scene.miniature, 40_000, MINIATURE_MESHES),
    ):
        document, found = read_glb(file.data)
        count = sum(len(t) for _, t in found.values())
        told = scene.description["glb"][key]
        assert count == told["triangles"] <= limit
        assert len(found) == told["meshes"] <= meshes
        assert sum(n for extras, _ in found.values() for _, _, n in extras["parts"]) == count
        low, high = building.geometry.bounds
        points = np.concatenate([t.reshape(-1, 3) for _, t in found.values()])
        assert (points.min(axis=0) > low - 0.05).all()
        assert (points.max(axis=0) < high + 0.05).all()
        # Both eyes; the cut faces of the miniature are drawn once more.
        calls += 2 * len(found) * (2 if key == "miniature" else 1)
        triangles += 2 * count * (2 if key == "miniature" else 1)
        assert document["asset"]["version"] == "2.0"
    assert calls <= 60
    assert triangles <= 560_000
