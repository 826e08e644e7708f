# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Ways found afresh: as short as they can be, free, and none where there is none."""

import numpy as np
import pytest
from scenes import box, building_of, ramp, shell, two_rooms
from scipy.sparse.csgraph import dijkstra

from walk_building import BodySweep
from walk_building.route import Router

EYE = 1.6


@pytest.fixture(scope="module")
def rooms():
    return building_of(two_rooms())


def length(points):
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())


def test_ways_are_free_and_hardly_longer_than_the_shortest(rooms):
    router, surface = Router(rooms), rooms.surface
    sweep = BodySweep(rooms.geometry, rooms.walker)
    places = np.flatnonzero(rooms.reachable)
    dice = np.random.default_rng(0)
    for a, b in dice.choice(places, (25, 2)):
        start, end = rooms.eyes(np.array([a, b]))
        way = router.way(start, end)
        if np.linalg.norm(start - end) < 0.5:
            continue
        assert way is not None
        np.testing.assert_array_equal(way[[0, -1]], [start, end])
        assert sweep.segments_free(way).all()
        # Steps in eight directions are up to 8.2 % longer than lines; the price of a wall is paid for by more.
        shortest = dijkstra(surface.graph, indices=int(a))[int(b)]
        assert length(way) <= 1.15 * shortest + 0.2
        assert length(way) >= np.linalg.norm(start - end) - 1e-9


def test_a_way_follows_the_floor():
    building = building_of(ramp(slope=0.125))
    way = Router(building).way(np.array([3.0, 1.0, EYE + 0.125]), np.array([9.0, 1.0, EYE + 0.875]))
    assert way is not None
    np.testing.assert_allclose(way[:, 2] - EYE, 0.125 * (way[:, 0] - 2.0), atol=0.03)


def test_an_end_off_the_floor_or_behind_a_wall_has_no_way():
    building = building_of([*shell(8, 6), box((3.9, 0, 0), (4.1, 6, 3))])
    router = Router(building)
    here = building.eyes(np.flatnonzero(building.reachable)[:1])[0]
    assert router.way(here, np.array([30.0, 3.0, EYE])) is None
    beyond = np.array([8.0 - here[0], 3.0, EYE])
    assert router.way(here, beyond) is None


def test_the_same_question_has_the_same_answer(rooms):
    router = Router(rooms)
    a, b = np.array([1.0, 1.0, EYE]), np.array([7.0, 1.0, EYE])
    first = router.way(a, b)
    router.way(b, a)
    np.testing.assert_array_equal(router.way(a, b), first)
