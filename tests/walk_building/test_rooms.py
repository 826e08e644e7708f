# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms found where no file declares them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh
from room_scores import SAMPLE, described, room_score
from scenes import box, building_of, shell, stair, two_rooms

from walk_building import Building, Walker, load_building
from walk_building.loaders import load_model


def room_at(building: Building, x: float, y: float, z: float = 0.0) -> int:
    return int(building.surface.room[building.surface.nearest([(x, y, z)])[0]])


def wall_with_gap(gap_m: float, top_m: float = 3.0, lintel_m: float | None = None) -> list:
    """Two rooms of 4 x 4 m and the wall between them, which a gap in its middle divides."""
    low, high = 2.0 - gap_m / 2, 2.0 + gap_m / 2
    wall = [box((4.0, 0, 0), (4.2, low, top_m)), box((4.0, high, 0), (4.2, 4, top_m))]
    if lintel_m is not None:
        wall.append(box((4.0, low, lintel_m), (4.2, high, 3)))
    return shell(8.2, 4.0) + wall


@pytest.mark.parametrize(("gap_m", "lintel_m"), [(0.9, 2.1), (0.9, None), (1.8, 2.5), (2.6, None), (3.4, 2.2)])
def test_rooms_are_parted_by_doorways_and_by_what_hangs_over_openings(gap_m: float, lintel_m: float | None) -> None:
    building = building_of(wall_with_gap(gap_m, lintel_m=lintel_m))
    assert [round(r.area_m2) for r in building.rooms] == pytest.approx([12, 12], abs=2)
    assert room_at(building, 1, 1) != room_at(building, 7, 3)


def test_rooms_too_narrow_for_the_walker_are_there_with_that_reason() -> None:
    # A room of 4 x 4 m behind a door of 0.9 m, and behind the next one a closet 1 m deep.
    closet = [*wall_with_gap(0.9, lintel_m=2.1), box((7.0, 0, 0), (7.2, 1.5, 3)), box((7.0, 2.4, 0), (7.2, 4, 3))]
    usual = building_of(closet)
    assert [room.reachable for room in usual.rooms] == [True] * 3 and not len(usual.narrow_floor)
    wide = building_of(closet, walker=Walker(radius_m=0.6))
    assert sorted(room.reason for room in wide.rooms) == [
        "", "the way there is too narrow for a walker 1.2 m wide", "too narrow for a walker 1.2 m wide",
    ]  # fmt: skip
    assert len({room.name for room in wide.rooms}) == 3
    assert len(wide.narrow_floor) == np.count_nonzero(usual.reachable)
    assert sum(len(room.places) for room in wide.rooms) == np.count_nonzero(wide.surface.room >= 0)


def test_a_room_that_only_its_door_keeps_a_wide_walker_from_says_so() -> None:
    large = [*shell(16.2, 8.0), box((8.0, 0, 0), (8.2, 3.5, 3)), box((8.0, 4.4, 0), (8.2, 8, 3))]
    (reason,) = {room.reason for room in building_of(large, walker=Walker(radius_m=0.6)).rooms} - {""}
    assert reason == "the way there is too narrow for a walker 1.2 m wide"


def test_a_beam_parts_nothing() -> None:
    assert len(building_of([*shell(8.2, 4.0), box((4.0, 0, 2.5), (4.2, 4, 3))]).rooms) == 1


def test_a_wide_opening_without_a_lintel_parts_nothing() -> None:
    assert len(building_of(wall_with_gap(3.4)).rooms) == 1


def test_furniture_parts_nothing_but_a_wall_of_its_place_does() -> None:
    """A counter that leaves a doorway's width to pass: 1.1 m high it is furniture, 2.6 m high a wall."""
    for top_m, rooms in ((1.1, 1), (2.0, 1), (3.0, 2)):
        assert len(building_of(wall_with_gap(0.9, top_m)).rooms) == rooms


def test_a_room_is_one_however_much_furniture_stands_in_it() -> None:
    rng = np.random.default_rng(5)
    corners = rng.uniform((0.3, 0.3), (6.5, 4.5), (14, 2))
    tables = [box((x, y, 0), (x + 0.8, y + 0.5, 0.75)) for x, y in corners]
    assert len(building_of(shell(8.0, 6.0) + tables).rooms) == 1


def test_a_corridor_is_a_room_beside_its_offices() -> None:
    wall_y, meshes = 1.5, shell(12.2, 5.0)
    for k in range(3):
        x = 4.1 * k
        meshes += [
            box((x, wall_y, 0), (x + 1.5, wall_y + 0.1, 3)),
            box((x + 2.4, wall_y, 0), (x + 4.1, wall_y + 0.1, 3)),
            box((x + 4.0, wall_y, 0), (x + 4.1, 5, 3)),
        ]
    building = building_of(meshes)
    corridor = room_at(building, 1, 0.75)
    assert corridor == room_at(building, 6, 0.75) == room_at(building, 11, 0.75)
    assert len({room_at(building, 2 + 4.1 * k, 3.5) for k in range(3)} | {corridor}) == 4 == len(building.rooms)


def test_no_room_reaches_over_two_storeys() -> None:
    building = building_of(stair(steps=18))
    assert len({r.storey for r in building.rooms}) == 2
    for room in building.rooms:
        assert len(set(building.surface.storey[room.places])) == 1


def test_every_reachable_place_is_in_one_room() -> None:
    building = building_of(two_rooms())
    placed = np.concatenate([r.places for r in building.rooms])
    assert len(placed) == len(set(placed.tolist()))
    assert set(np.flatnonzero(building.reachable).tolist()) <= set(placed.tolist())
    for index, room in enumerate(building.rooms):
        assert (building.surface.room[room.places] == index).all()


def test_rooms_are_the_same_each_time() -> None:
    a, b = building_of(two_rooms()), building_of(two_rooms())
    np.testing.assert_array_equal(a.surface.room, b.surface.room)


def gallery_beside_hall(columns: int) -> list:
    """A hall of 8 x 8 m and, along x, an arm 2 m wide and 10 m long; or the same with an aisle behind columns."""
    meshes = [box((-0.2, -0.2, -0.2), (18.2, 8.2, 0)), box((-0.2, -0.2, 3), (18.2, 8.2, 3.2))]
    meshes += [box((-0.2, 0, 0), (0, 8, 3)), box((-0.2, 8, 0), (18.2, 8.2, 3)), box((-0.2, -0.2, 0), (18.2, 0, 3))]
    meshes.append(box((18, 0, 0), (18.2, 8, 3)))
    if columns:
        return meshes + [box((x, 2, 0), (x + 0.4, 2.4, 3)) for x in np.linspace(2, 16, columns)]
    return [*meshes, box((8, 2, 0), (18, 8, 3))]


def test_an_arm_that_is_long_and_narrow_is_a_room_beside_its_hall() -> None:
    building = building_of(gallery_beside_hall(columns=0))
    assert len(building.rooms) == 2
    assert room_at(building, 4, 4) != room_at(building, 12, 1) == room_at(building, 17, 1)
    assert building.rooms[room_at(building, 4, 4)].area_m2 == pytest.approx(7.5**2, rel=0.1)


def test_an_aisle_between_a_wall_and_columns_belongs_to_the_hall() -> None:
    assert len(building_of(gallery_beside_hall(columns=6)).rooms) == 1


def test_a_bay_belongs_to_the_hall() -> None:
    building = building_of([*gallery_beside_hall(columns=0), box((11, 0, 0), (18, 2, 3))])
    assert room_at(building, 4, 4) == room_at(building, 10, 1)


def ramp_beside_hall(rise_m: float) -> list:
    """A hall of 12 x 4 m, a ramp along its north side behind a railing, and 2 m of floor before both to the west."""
    slope = trimesh.Trimesh(
        vertices=[(x, y, z) for y in (4.0, 6.0) for x, z in ((2, 0), (12, 0), (12, rise_m))],
        faces=[(0, 1, 2), (3, 5, 4), (0, 2, 5), (0, 5, 3), (1, 4, 5), (1, 5, 2)],
    )
    rail = trimesh.creation.box((10, 0.05, 1.0 + rise_m))
    rail.apply_translation((7, 3.975, (1.0 + rise_m) / 2))
    return [*shell(12, 6, height=4.0), rail] + ([slope] if rise_m else [])


def test_a_railing_parts_the_foot_of_a_ramp_from_the_hall_below() -> None:
    building = building_of(ramp_beside_hall(1.0))
    # At x = 4 the ramp is 0.2 m up, which a walker steps over where nothing stands in the way.
    assert room_at(building, 4, 1) != room_at(building, 5, 5, 0.3)
    assert room_at(building, 5, 5, 0.3) == room_at(building, 11, 5, 0.9)


def test_a_railing_on_level_floor_is_furniture() -> None:
    assert len(building_of(ramp_beside_hall(0.0)).rooms) == 1


def house_with_a_canopy(depth_m: float, wider_m: float = 0.0) -> list:
    """A room of 6 x 4 m with a door to the south, ground around it, and a canopy over the ground before the door."""
    floor, ceiling, west, east, _, north = shell(6, 4)
    south = [box((0, -0.2, 0), (2.5, 0, 3)), box((3.5, -0.2, 0), (6, 0, 3)), box((2.5, -0.2, 2.1), (3.5, 0, 3))]
    ground = box((-6, -14, -0.2), (12, -0.2, 0))
    canopy = box((-wider_m, -0.2 - depth_m, 2.6), (6 + wider_m, -0.2, 2.8))
    return [floor, ceiling, west, east, north, *south, ground, canopy]


def test_a_canopy_before_the_door_is_outdoors() -> None:
    building = building_of(house_with_a_canopy(2.5))
    assert [round(room.area_m2) for room in building.rooms] == pytest.approx([20], abs=2)
    outside = building.surface.nearest([(3, -1.5, 0)])[0]
    assert not building.reachable[outside] and not building.surface.indoor[outside]
    assert building.surface.places[building.entrance] == pytest.approx([3, -0.1, 0], abs=0.3)


def test_what_is_deep_under_a_roof_is_a_room_though_it_is_open() -> None:
    building = building_of(house_with_a_canopy(10.0, wider_m=3.0))
    assert building.reachable[building.surface.nearest([(3, -5, 0)])[0]]
    assert len(building.rooms) == 2


def test_a_roof_over_the_way_between_two_houses_stays_a_way() -> None:
    house = house_with_a_canopy(2.5)
    across = [mesh.copy() for mesh in house]
    for mesh in across:
        mesh.apply_transform(np.diag([-1.0, -1.0, 1.0, 1.0]))
        mesh.apply_translation((6, -3, 0))
    building = building_of([*house, *across])
    for y in (2.0, -5.0):
        assert building.reachable[building.surface.nearest([(3, y, 0)])[0]]


def test_the_spaces_of_the_sample_are_found_without_them() -> None:
    score = room_score(load_model(SAMPLE))
    assert score.missed == ()
    # The head of its stairwell, which is one space over two storeys, is a room of its own here.
    assert score.recall == 1.0 and score.precision >= 0.95 and score.mean_iou >= 0.93


def test_the_spaces_of_the_duplex_are_found_without_them(buildings_dir: Path) -> None:
    score = room_score(load_model(buildings_dir / "duplex.ifc"))
    # The kitchens are parted from the living rooms by a counter only.
    assert set(score.missed) == {"Kitchen A103", "Kitchen B103"}
    assert score.recall >= 0.9 and score.precision >= 0.95 and score.mean_iou >= 0.8


def test_the_spaces_of_the_large_building_are_found_without_them(buildings_dir: Path) -> None:
    score = room_score(load_model(buildings_dir / "large_building.ifc"))
    assert score.recall == 1.0 and score.precision == 1.0 and score.mean_iou >= 0.95


def test_the_office_has_its_rooms_and_corridors(buildings_dir: Path) -> None:
    rooms = described(load_building(buildings_dir / "willowgarage.dae"))
    assert 65 <= len(rooms) <= 85
    assert sum(5.0 <= area <= 30.0 for _, area in rooms) >= 50, "the offices"
    assert rooms[0][1] < 300.0, "the largest hall is 214 m²"


def test_each_deck_of_the_garage_is_one_room(buildings_dir: Path) -> None:
    rooms = described(load_building(buildings_dir / "parking_garage.dae"))
    decks = [storey for storey, area in rooms if area > 1500.0]
    assert len(decks) == len(set(decks)) == len(rooms)


def test_the_flat_keeps_its_rooms_in_spite_of_its_furniture(buildings_dir: Path) -> None:
    building = load_building(buildings_dir / "small_house.ply")
    assert len({room_at(building, x, y) for x, y in ((-6, -3), (6, -3), (3, 4.9))}) == 3
    assert len(building.rooms) == 3


def test_a_podium_that_nobody_reaches_says_how_far_it_is_raised() -> None:
    building = building_of([*shell(12.0, 8.0), box((6.5, 1.5, 0.0), (11.0, 6.5, 0.6))])
    (podium,) = [room for room in building.rooms if not room.reachable]
    assert podium.reason.endswith("raised by 0.60 m above the floor beside it; a step is at most 0.25 m")


def test_a_storey_without_a_stair_is_not_called_raised() -> None:
    building = building_of([*shell(8.0, 6.0), *shell(8.0, 6.0, z=3.0)])
    (upper,) = [room for room in building.rooms if not room.reachable]
    assert "heights 3.2 to 3.2 m" in upper.reason
    assert "raised" not in upper.reason
