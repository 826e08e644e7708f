# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Legs between stands: all pairs on the roadmap's graph, each made short and laid on the floor."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from walk_building.progress import Progress, no_progress
from walk_sequencer.ground import walk_line
from walk_sequencer.regions import way_home
from walk_sequencer.roadmap import Roadmap
from walk_sequencer.tighten import follow_floor, tighten
from walk_sequencer.tour import Leg, Stand, polyline_length_m

_NEAREST_MILESTONES = 16
_THREADS = 2


def stand_at(roadmap: Roadmap, place: int, point: NDArray[np.float64]) -> Stand:
    """Returns where to stand for a floor point (3,) next to a place of the ground.

    That is the point itself if all around it is ground, else the centre of the place.
    """
    centre = _centre(roadmap, place)
    stand = Stand(place, float(point[0]), float(point[1]))
    return stand if _straight(roadmap, centre, stand) < np.inf else centre


def plan_pairs(
    roadmap: Roadmap,
    stands: Sequence[Stand],
    pairs: Sequence[tuple[int, int]],
    progress: Progress = no_progress,
) -> list[Leg]:
    """Returns a leg for each pair of indices into `stands`.

    The stands are joined to the roadmap, the cheapest ways are searched on its graph from every first stand of a
    pair, then each way is tightened by itself. All stands of a roadmap can reach one another, so no leg is missing.
    No way leads over a third stand, so a leg depends on its own two ends only: planned alone it is the same.
    """
    if not pairs:
        return []
    joined = _Joined.of(roadmap, stands, pairs)
    sources = sorted({i for i, _ in pairs})
    first = len(roadmap.milestones)
    before = dijkstra(joined.graph, indices=[first + i for i in sources], return_predecessors=True)[1]
    row = {i: r for r, i in enumerate(sources)}
    progress("legs", 0.3)

    def lay(pair: tuple[int, int]) -> NDArray[np.float64]:
        way = tighten(roadmap.ground, joined.unfold(before[row[pair[0]]], *pair))
        return follow_floor(roadmap.ground, way, roadmap.config.slope_break_m)

    with ThreadPoolExecutor(_THREADS) as pool:
        floors = list(pool.map(lay, pairs, chunksize=8))
    progress("legs", 0.8)
    eyes = _raise_to_eyes(roadmap, floors)
    progress("legs", 1.0)
    return [
        Leg(start=i, goal=j, points=points, length_m=polyline_length_m(points))
        for (i, j), points in zip(pairs, eyes, strict=True)
    ]


def _raise_to_eyes(roadmap: Roadmap, floors: list[NDArray[np.float64]]) -> list[NDArray[np.float64]]:
    """Returns the eye positions above floor points, for all legs in one query of the floor."""
    eye = roadmap.walker.eye_height_m
    points = np.vstack(floors)
    points[:, 2] += eye
    floor = roadmap.surface.floor_z(points, eye)
    points[:, 2] = np.where(np.isfinite(floor), floor + eye, points[:, 2])
    points.setflags(write=False)
    return np.split(points, np.cumsum([len(f) for f in floors])[:-1])


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class _Joined:
    """The roadmap's graph with the stands behind the milestones: nodes to leave from, then nodes to arrive at."""

    roadmap: Roadmap
    stands: Sequence[Stand]
    graph: csr_array
    by_floor: frozenset[int]  # stands that reach their region's milestone along places, not straight

    @classmethod
    def of(cls, roadmap: Roadmap, stands: Sequence[Stand], pairs: Sequence[tuple[int, int]]) -> _Joined:
        ground, first = roadmap.ground, len(roadmap.milestones)
        links: list[tuple[int, int, float]] = []
        by_floor = set()
        near = roadmap.tree.query(ground.xyz[[s.place for s in stands]], k=min(_NEAREST_MILESTONES, first))[1]
        for k, (stand, candidates) in enumerate(zip(stands, np.reshape(near, (len(stands), -1)), strict=True)):
            home = int(roadmap.regions.owner[stand.place])
            straight = False
            for m in candidates.tolist():
                cost = _straight(roadmap, stand, _centre(roadmap, int(roadmap.milestones[m])))
                if cost < np.inf:
                    links += [(first + k, m, cost), (m, first + len(stands) + k, cost)]
                    straight |= m == home
            if not straight:
                by_floor.add(k)
                cost = float(roadmap.regions.cost[stand.place])
                links += [(first + k, home, cost), (home, first + len(stands) + k, cost)]
        for i, j in set(pairs):
            cost = _straight(roadmap, stands[i], stands[j])
            if cost < np.inf:
                links.append((first + i, first + len(stands) + j, cost))
        return cls(
            roadmap=roadmap,
            stands=stands,
            graph=_extend(roadmap.graph, links, 2 * len(stands)),
            by_floor=frozenset(by_floor),
        )

    def unfold(self, before: NDArray[np.int32], i: int, j: int) -> NDArray[np.float64]:
        """Returns the way (n, 3) of place, x, y from stand i to stand j, given what precedes each node."""
        first = len(self.roadmap.milestones)
        nodes = [first + len(self.stands) + j]
        while nodes[-1] != first + i:
            nodes.append(int(before[nodes[-1]]))
        nodes.reverse()
        way = [vertex for a, b in itertools.pairwise(nodes) for vertex in self._between(a, b)[:-1]]
        return np.array([*way, self._vertex(nodes[-1])])

    def _between(self, a: int, b: int) -> list[Stand]:
        roadmap, first = self.roadmap, len(self.roadmap.milestones)
        if a < first and b < first:
            return [_centre(roadmap, place) for place in roadmap.way(a, b)]
        stand, m = max(a, b), min(a, b)
        place = self._vertex(stand).place
        way = [self._vertex(stand), self._vertex(m)]
        by_floor = (stand - first) % len(self.stands) in self.by_floor
        if m < first and by_floor and m == roadmap.regions.owner[place]:
            way = [way[0], *(_centre(roadmap, p) for p in way_home(roadmap.regions, place))]
        return way if a == stand else way[::-1]

    def _vertex(self, node: int) -> Stand:
        first = len(self.roadmap.milestones)
        if node >= first:
            return self.stands[(node - first) % len(self.stands)]
        return _centre(self.roadmap, int(self.roadmap.milestones[node]))


def _centre(roadmap: Roadmap, place: int) -> Stand:
    return Stand(place, float(roadmap.ground.xyz[place, 0]), float(roadmap.ground.xyz[place, 1]))


def _straight(roadmap: Roadmap, a: Stand, b: Stand) -> float:
    return float(walk_line(roadmap.ground, a.place, a.x, a.y, b.place, b.x, b.y, None)[0])


def _extend(graph: csr_array, links: list[tuple[int, int, float]], more: int) -> csr_array:
    n = graph.shape[0] + more
    old = graph.tocoo()
    tails, heads, costs = np.array(links, dtype=np.float64).reshape(-1, 3).T
    # Two stands at one spot are joined too: a cost of exactly 0 would be no edge.
    rows = np.concatenate([old.coords[0], tails]).astype(np.int32)
    columns = np.concatenate([old.coords[1], heads]).astype(np.int32)
    data = np.concatenate([old.data, np.maximum(costs, 1e-9)])
    return coo_array((data, (rows, columns)), shape=(n, n)).tocsr()
