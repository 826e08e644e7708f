# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The tour that viewers of building models make from rooms and doors alone, without knowing where one can walk."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

from walk_building.building import Building
from walk_trajopt.trajectory import Trajectory

EYE_M, LEG_S, DWELL_S = 1.7, 1.5, 2.0
"""Height of the eye, time for a leg whatever its length, time at each stop: those viewers' rules."""

SAMPLE_S = 0.05
_BESIDE_M = 0.6  # from the middle of a door to where its rooms are asked for


def rooms_and_doors(building: Building) -> Trajectory | None:
    """Returns the tour by those rules: a stop in each reachable room, straight legs through the doors between.

    The order is by nearest neighbour and 2-opt on straight distances. None with fewer than two rooms.
    """
    rooms = [index for index, room in enumerate(building.rooms) if room.reachable and len(room.places)]
    if len(rooms) < 2:
        return None
    stops = np.array([building.rooms[room].centre for room in rooms])
    order = short_order(np.linalg.norm(stops[:, None] - stops[None], axis=2))
    doors = np.array([door.centre for door in building.model.doors]).reshape(-1, 3)
    routes = _Routes(stops, doors, _room_pairs(building, rooms))
    legs = [routes.between(a, b) + [0.0, 0.0, EYE_M] for a, b in itertools.pairwise(order)]
    return _timed([leg for leg in legs if np.any(leg[0] != leg[-1])])


def short_order(distance: NDArray[np.float64]) -> NDArray[np.int64]:
    """Returns an open order of all stops: nearest neighbour from the first, then 2-opt until nothing gets shorter."""
    left = set(range(1, len(distance)))
    order = [0]
    while left:
        order.append(min(left, key=lambda stop: (distance[order[-1], stop], stop)))
        left.remove(order[-1])
    better = True
    while better:
        better = False
        for i in range(len(order) - 1):
            for j in range(i + 1, len(order)):
                ahead = distance[order[i], order[j]] - distance[order[i], order[i + 1]]
                if j + 1 < len(order):
                    ahead += distance[order[i + 1], order[j + 1]] - distance[order[j], order[j + 1]]
                if ahead < -1e-9:
                    order[i + 1 : j + 1] = order[i + 1 : j + 1][::-1]
                    better = True
    return np.array(order)


class _Routes:
    """Shortest chains of straight lines from room to room through the middles of doors."""

    def __init__(
        self, stops: NDArray[np.float64], doors: NDArray[np.float64], pairs: list[tuple[int, int, int]]
    ) -> None:
        floor = np.array([min((stops[a, 2], stops[b, 2])) for a, b, _ in pairs])
        self._points = np.vstack([stops, np.column_stack([doors[[d for *_, d in pairs], :2], floor])])
        edges = [(room, len(stops) + k) for k, (a, b, _) in enumerate(pairs) for room in (a, b)]
        start, end = np.array(edges, dtype=int).reshape(-1, 2).T
        length = np.linalg.norm(self._points[start] - self._points[end], axis=1)
        graph = csr_array((length, (start, end)), shape=(len(self._points),) * 2)
        self._before = dijkstra(graph, directed=False, indices=np.arange(len(stops)), return_predecessors=True)[1]

    def between(self, a: int, b: int) -> NDArray[np.float64]:
        """Returns the points from stop a to stop b (k, 3) [m]; a straight line where no doors lead there."""
        chain = [b]
        while chain[-1] != a and self._before[a, chain[-1]] >= 0:
            chain.append(int(self._before[a, chain[-1]]))
        return self._points[chain[::-1]] if chain[-1] == a else self._points[[a, b]]


def _room_pairs(building: Building, rooms: list[int]) -> list[tuple[int, int, int]]:
    """Returns the doors with a room of the list on each side: (index in the list, index in the list, door)."""
    index = {room: at for at, room in enumerate(rooms)}
    pairs = []
    for d, door in enumerate(building.model.doors):
        across = np.array([1.0, 0.0, 0.0]) if door.size[0] <= door.size[1] else np.array([0.0, 1.0, 0.0])
        foot = door.centre - [0.0, 0.0, door.size[2] / 2]
        places = building.surface.nearest(np.stack([foot - _BESIDE_M * across, foot + _BESIDE_M * across]))
        a, b = (index.get(int(building.surface.room[place]), -1) for place in places)
        if a >= 0 and b >= 0 and a != b:
            pairs.append((a, b, d))
    return pairs


def _timed(legs: list[NDArray[np.float64]]) -> Trajectory:
    """Returns the legs at constant speed each, with a stand between in which the view turns to the next leg."""
    moves = [leg[-1] - leg[0] for leg in legs]
    yaw = np.unwrap([np.arctan2(move[1], move[0]) for move in moves])
    positions, angles, stop = [legs[0][0]], [yaw[0]], [False]
    steps = round(LEG_S / SAMPLE_S)
    pause = round(DWELL_S / SAMPLE_S)
    for k, leg in enumerate(legs):
        at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(leg, axis=0), axis=1))])
        where = np.linspace(0.0, at[-1], steps + 1)[1:]
        positions += list(np.column_stack([np.interp(where, at, leg[:, i]) for i in range(3)]))
        angles += [yaw[k]] * steps
        stop += [False] * steps
        if k + 1 < len(legs):
            positions += [leg[-1]] * pause
            angles += list(np.linspace(yaw[k], yaw[k + 1], pause + 1)[1:])
            stop += [True] * pause
    t = np.arange(len(positions), dtype=np.float64) * SAMPLE_S
    eyes = np.array(positions)
    velocities = np.gradient(eyes, t, axis=0)
    half = np.array(angles) / 2
    quat = np.column_stack([np.zeros((len(half), 2)), np.sin(half), np.cos(half)])
    return Trajectory(
        t_s=t, positions=eyes, velocities=velocities, accelerations=np.gradient(velocities, t, axis=0),
        quat_xyzw=quat, stop=np.array(stop),
    )  # fmt: skip
