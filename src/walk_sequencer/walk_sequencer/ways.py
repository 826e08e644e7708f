# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The cheapest ways from a stand to all milestones: searched once, they serve for every leg that leaves the stand."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import dijkstra

from walk_building.floor_grid import walk_line
from walk_sequencer.regions import way_home
from walk_sequencer.roadmap import Roadmap
from walk_sequencer.tour import Stand

_NEAREST_MILESTONES = 16


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Links:
    """How a stand is joined to the roadmap."""

    milestones: NDArray[np.int64]  # (L,)
    costs: NDArray[np.float64]  # (L,)
    by_floor: bool  # whether it reaches its region's milestone along places, not straight


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Ways:
    """The cheapest ways from one stand over the milestones. No way leads over another stand."""

    stand: Stand
    links: Links
    cost: NDArray[np.float64]  # (M,)
    before: NDArray[np.int32]  # (M,) the milestone on the way to each, -1: straight from the stand


def centre(roadmap: Roadmap, place: int) -> Stand:
    """Returns the stand at the centre of a place."""
    return Stand(place, float(roadmap.ground.xyz[place, 0]), float(roadmap.ground.xyz[place, 1]))


def straight_cost(roadmap: Roadmap, a: Stand, b: Stand) -> float:
    """Returns the cost of the straight walk between two stands, inf where it leaves the ground."""
    return float(walk_line(roadmap.ground, a.place, a.x, a.y, b.place, b.x, b.y, None)[0])


def ways_from(roadmap: Roadmap, stands: Sequence[Stand]) -> list[Ways]:
    """Returns the ways from each stand.

    The roadmap keeps those of the stands asked for last: moving one of many costs one search.
    """
    kept = {stand: roadmap.ways[stand] for stand in stands if stand in roadmap.ways}
    new = [stand for stand in dict.fromkeys(stands) if stand not in kept]
    if new:
        links = [_links(roadmap, stand, near) for stand, near in zip(new, _nearest(roadmap, new), strict=True)]
        kept |= _searched(roadmap, new, links)
        roadmap.ways.clear()
        roadmap.ways.update(kept)
    return [kept[stand] for stand in stands]


def way(roadmap: Roadmap, a: Ways, b: Ways) -> NDArray[np.float64]:
    """Returns the cheapest way (n, 3) of place, x, y from one stand to another."""
    over = a.cost[b.links.milestones] + b.links.costs
    best = int(np.argmin(over))
    if straight_cost(roadmap, a.stand, b.stand) <= over[best]:
        return np.array([a.stand, b.stand])
    chain = [int(b.links.milestones[best])]
    while a.before[chain[-1]] >= 0:
        chain.append(int(a.before[chain[-1]]))
    chain.reverse()
    way = _to_milestone(roadmap, a, chain[0])
    for m, n in itertools.pairwise(chain):
        way += [centre(roadmap, place) for place in roadmap.way(m, n)[1:]]
    return np.array(way + _to_milestone(roadmap, b, chain[-1])[-2::-1])


def _to_milestone(roadmap: Roadmap, ways: Ways, m: int) -> list[Stand]:
    """Returns the way from the stand to a milestone it is joined to."""
    place = ways.stand.place
    if ways.links.by_floor and m == roadmap.regions.owner[place]:
        return [ways.stand, *(centre(roadmap, p) for p in way_home(roadmap.regions, place))]
    return [ways.stand, centre(roadmap, int(roadmap.milestones[m]))]


def _nearest(roadmap: Roadmap, stands: Sequence[Stand]) -> NDArray[np.int64]:
    count = min(_NEAREST_MILESTONES, len(roadmap.milestones))
    near = roadmap.tree.query(roadmap.ground.xyz[[s.place for s in stands]], k=count)[1]
    return np.reshape(near, (len(stands), -1))


def _links(roadmap: Roadmap, stand: Stand, near: NDArray[np.int64]) -> Links:
    home = int(roadmap.regions.owner[stand.place])
    costs = [straight_cost(roadmap, stand, centre(roadmap, int(roadmap.milestones[m]))) for m in near.tolist()]
    joined = [(m, cost) for m, cost in zip(near.tolist(), costs, strict=True) if cost < np.inf]
    by_floor = home not in [m for m, _ in joined]
    if by_floor:
        joined.append((home, float(roadmap.regions.cost[stand.place])))
    return Links(
        milestones=np.array([m for m, _ in joined], dtype=np.int64),
        costs=np.array([cost for _, cost in joined]),
        by_floor=by_floor,
    )


def _searched(roadmap: Roadmap, stands: Sequence[Stand], links: Sequence[Links]) -> dict[Stand, Ways]:
    """Searches the roadmap's graph with the stands behind the milestones, nodes that one only leaves from."""
    count = len(roadmap.milestones)
    graph = _extended(roadmap.graph, links)
    cost, before = dijkstra(graph, indices=count + np.arange(len(stands)), return_predecessors=True)
    cost, before = cost[:, :count].copy(), before[:, :count].copy()
    before[before >= count] = -1
    return {stand: Ways(stand=stand, links=links[k], cost=cost[k], before=before[k]) for k, stand in enumerate(stands)}


def _extended(graph: csr_array, links: Sequence[Links]) -> csr_array:
    old, count = graph.tocoo(), graph.shape[0]
    tails = np.repeat(count + np.arange(len(links)), [len(link.costs) for link in links])
    rows = np.concatenate([old.coords[0], tails]).astype(np.int32)
    columns = np.concatenate([old.coords[1], *(link.milestones for link in links)]).astype(np.int32)
    # A stand on a milestone is joined to it, too: a cost of exactly 0 would be no edge.
    data = np.concatenate([old.data, *(np.maximum(link.costs, 1e-9) for link in links)])
    return coo_array((data, (rows, columns)), shape=(count + len(links), count + len(links))).tocsr()
