# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The roadmap: built once for a building and a walker, then asked for the way between any two places."""

from __future__ import annotations

import dataclasses
import logging
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from walk_building.floor_grid import FloorGrid, lay_floor
from walk_building.progress import Progress, no_progress
from walk_building.surface import WalkableSurface
from walk_building.walker import Walker
from walk_sequencer.config import SequencerConfig
from walk_sequencer.prm import grow_roadmap
from walk_sequencer.regions import Regions, neighbouring_regions, split_ground, way_home

_log = logging.getLogger(__name__)

# How many times likelier a milestone is where the walls are near: doors and corners, where ways bend.
_NARROW_ODDS = 4.0


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Roadmap:
    """Milestones on one walkable part and the ways between them. It knows nothing of the keypoints.

    The edges are those of PRM*, and one way along the places between every two milestones whose regions touch and
    that PRM* did not join. With these the roadmap is connected wherever the part is, through every door.
    """

    surface: WalkableSurface
    walker: Walker
    config: SequencerConfig
    mask: NDArray[np.bool_]  # (P,) the places of the part
    kept: NDArray[np.int64]  # (N,) place of the surface behind each place of the ground
    ground: FloorGrid
    milestones: NDArray[np.int64]  # (M,) places of the ground
    tree: cKDTree  # of the milestones
    floor_tree: cKDTree  # of the places of the ground
    regions: Regions
    graph: csr_array  # (M, M) symmetric walking costs
    crossings: dict[tuple[int, int], tuple[int, int]]  # where an edge m < n leads along places: u of m, v of n
    joined: int  # parts that PRM* alone left apart
    # By stand: what `ways_from` keeps of its searches, for the next tour with most of the same stands.
    ways: dict[Any, Any] = dataclasses.field(default_factory=dict, repr=False, compare=False)

    @property
    def area_m2(self) -> float:
        """Floor area of the part [m²]."""
        return len(self.kept) * self.ground.cell_m**2

    def way(self, m: int, n: int) -> list[int]:
        """Returns the places of the ground that the edge between milestones m and n leads through."""
        crossing = self.crossings.get((min(m, n), max(m, n)))
        if crossing is None:
            return [int(self.milestones[m]), int(self.milestones[n])]
        way = way_home(self.regions, crossing[0])[::-1] + way_home(self.regions, crossing[1])
        return way if m < n else way[::-1]


def build_roadmap(
    surface: WalkableSurface,
    walker: Walker,
    mask: NDArray[np.bool_],
    config: SequencerConfig,
    progress: Progress = no_progress,
) -> Roadmap:
    """Returns the roadmap of the places in `mask` (P,), which are connected and at least one.

    The same input and seed give the same roadmap bit for bit.
    """
    progress("roadmap", 0.0)
    ground, kept = lay_floor(surface, mask, walker.eye_height_m, config.comfort_m, config.comfort_weight)
    milestones = _draw_milestones(ground, config)
    edges, costs = grow_roadmap(ground, milestones)
    progress("roadmap", 0.6)
    regions = split_ground(ground, milestones)
    progress("roadmap", 0.8)
    borders, border_costs = neighbouring_regions(ground, regions)
    known = np.isin(borders[:, 0] * len(milestones) + borders[:, 1], edges[:, 0] * len(milestones) + edges[:, 1])
    borders, border_costs = borders[~known], border_costs[~known]
    joined = connected_components(_symmetric(edges, costs, len(milestones)), directed=False)[0] - 1
    _log.debug(
        "roadmap: %d milestones, %d straight edges, %d along the floor, which join %d parts",
        *(len(milestones), len(edges), len(borders), joined),
    )
    progress("roadmap", 1.0)
    return Roadmap(
        surface=surface,
        walker=walker,
        config=config,
        mask=mask,
        kept=kept,
        ground=ground,
        milestones=milestones,
        tree=cKDTree(ground.xyz[milestones]),
        # Neither balanced nor compact: a second less to build for a million places, and asked for few points.
        floor_tree=cKDTree(ground.xyz, balanced_tree=False, compact_nodes=False),
        regions=regions,
        graph=_symmetric(np.vstack([edges, borders[:, :2]]), np.concatenate([costs, border_costs]), len(milestones)),
        crossings={(int(m), int(n)): (int(u), int(v)) for m, n, u, v in borders},
        joined=int(joined),
    )


def milestone_count(area_m2: float) -> int:
    """Returns how many milestones a part of that floor area gets: 800, one more per square metre, 4000 at most.

    A house gets ten a square metre, an office one and a half, a garage of 13,000 square metres one for every three.
    """
    return int(min(800 + area_m2, 4000))


def _draw_milestones(ground: FloorGrid, config: SequencerConfig) -> NDArray[np.int64]:
    """Draws different places, likelier where the walls are near (`efraimidis2006`)."""
    n = len(ground.xyz)
    count = min(n, config.milestones or milestone_count(n * ground.cell_m**2))
    odds = np.where(ground.price > 1.0, _NARROW_ODDS, 1.0)
    keys = np.random.default_rng(config.seed).exponential(size=n) / odds
    return np.argsort(keys, kind="stable")[:count].astype(np.int64)


def _symmetric(edges: NDArray[np.int64], costs: NDArray[np.float64], n: int) -> csr_array:
    tails, heads = np.concatenate([edges, edges[:, ::-1]]).T
    return coo_array((np.concatenate([costs, costs]), (tails, heads)), shape=(n, n)).tocsr()
