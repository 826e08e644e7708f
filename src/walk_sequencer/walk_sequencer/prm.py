# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A probabilistic roadmap (PRM*) over places, grown by OMPL; the only file that imports it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from ompl import base, geometric, util

from walk_building.floor_grid import FloorGrid, walk_between

util.setLogLevel(util.LogLevel.LOG_WARN)
# Before any other object of OMPL. Nothing below depends on its random numbers: the places come from outside.
util.RNG.setSeed(1)


def grow_roadmap(ground: FloorGrid, places: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Returns the edges (E, 2), i < j, of the PRM* roadmap with the given places as milestones, and their costs (E,).

    Each milestone is joined to its nearest ones (`karaman2011`) where a straight walk leads there. Edges and
    milestones are indices into `places`.
    """
    # OMPL asks about states, not about places. Its states are told apart by their coordinates, so those get an
    # offset far below a cell, which no two share; it also decides between neighbours that are equally near.
    offset = np.arange(len(places))[:, None] * np.array([3.1e-9, 4.3e-9, 0.0])
    coordinates = ground.xyz[places] + offset
    index = {x: i for i, x in enumerate(coordinates[:, 0].tolist())}
    if len(index) != len(places):
        raise AssertionError("milestones must be different places")
    problem = base.SpaceInformation(_space(coordinates))
    problem.setStateValidityChecker(lambda _: True)
    problem.setValidStateSamplerAllocator(lambda info: _Milestones(info, coordinates))
    walks = _Walks(problem, ground, places, index)
    problem.setMotionValidator(walks)
    problem.setup()
    planner = geometric.PRMstar(problem)
    planner.setProblemDefinition(base.ProblemDefinition(problem))
    planner.setup()
    # By count, not by time: the same result on every machine.
    enough = base.PlannerTerminationCondition(lambda: planner.milestoneCount() >= len(places))
    planner.growRoadmapPtc(enough)
    data = base.PlannerData(problem)
    planner.getPlannerData(data)
    edges = _edges(data, index)
    return edges, np.array([walks.costs[i, j] for i, j in edges.tolist()])


def _space(coordinates: NDArray[np.float64]) -> base.RealVectorStateSpace:
    space = base.RealVectorStateSpace(3)
    bounds = base.RealVectorBounds(3)
    for axis in range(3):
        bounds.setLow(axis, float(coordinates[:, axis].min()) - 1.0)
        bounds.setHigh(axis, float(coordinates[:, axis].max()) + 1.0)
    space.setBounds(bounds)
    return space


def _edges(data: base.PlannerData, index: dict[float, int]) -> NDArray[np.int64]:
    names = [index[data.getVertex(v).getState()[0]] for v in range(data.numVertices())]
    pairs = [(names[v], names[w]) for v in range(data.numVertices()) for w in data.getEdges(v)]
    edges = np.array(pairs, dtype=np.int64).reshape(-1, 2)
    edges = edges[edges[:, 0] < edges[:, 1]]
    return np.unique(edges, axis=0)


class _Milestones(base.ValidStateSampler):
    """Hands out the prepared milestones one after the other."""

    def __init__(self, info: base.SpaceInformation, coordinates: NDArray[np.float64]) -> None:
        super().__init__(info)
        self._next = iter(coordinates.tolist())

    def sample(self, state: base.RealVectorStateType) -> bool:
        point = next(self._next, None)
        if point is None:
            return False
        state[0], state[1], state[2] = point
        return True

    def sampleNear(self, *_: object) -> bool:  # noqa: N802  OMPL's name
        return False


class _Walks(base.MotionValidator):
    """A motion is valid if a straight walk over the ground leads from place to place."""

    def __init__(
        self, info: base.SpaceInformation, ground: FloorGrid, places: NDArray[np.int64], index: dict[float, int]
    ) -> None:
        super().__init__(info)
        self._ground, self._places, self._index = ground, places.tolist(), index
        self.costs: dict[tuple[int, int], float] = {}  # of the walks there are, by milestones i < j

    def checkMotion(self, start: base.State, end: base.State) -> bool:  # noqa: N802  OMPL's name
        i, j = self._index[start[0]], self._index[end[0]]
        cost = walk_between(self._ground, self._places[i], self._places[j])
        if cost == np.inf:
            return False
        self.costs[(i, j) if i < j else (j, i)] = cost
        return True
