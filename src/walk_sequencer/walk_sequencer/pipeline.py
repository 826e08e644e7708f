# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From keypoints to a tour."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_building.building import Building
from walk_building.errors import ParameterError
from walk_building.progress import Progress, no_progress
from walk_sequencer.beginning import first_from_entrance
from walk_sequencer.config import SequencerConfig
from walk_sequencer.order import find_order, resolve_method
from walk_sequencer.pairs import plan_pairs
from walk_sequencer.placing import floor_points, part_of_tour, place_keypoints
from walk_sequencer.roadmap import Roadmap, build_roadmap
from walk_sequencer.rules import Rules, conflict
from walk_sequencer.tour import Leg, Stand, Tour, Unreachable, polyline_length_m


def plan_tour(
    building: Building,
    keypoints: ArrayLike,
    config: SequencerConfig | None = None,
    progress: Progress = no_progress,
    previous: Tour | None = None,
) -> Tour:
    """Plans the walks between all keypoints and a short order to visit them in.

    Args:
        building: Where to walk.
        keypoints: (K, 3) eye positions [m]; none is fine.
        config: How.
        progress: Told of the stages roadmap, legs and order.
        previous: An earlier tour of this building. Its roadmap, and its legs between keypoints that stayed where
            they were, are used again where they fit; the result is the same without, bit for bit.

    Returns:
        The tour. Keypoints that cannot be reached are in `unreachable`, with the reason, and not in the order.

    Raises:
        ParameterError: Keypoints that are no finite (K, 3) array, a start or end that is no keypoint.
    """
    config = config or SequencerConfig()
    floor = floor_points(building, keypoints)
    _check_ends(config, len(floor))
    mask = part_of_tour(building, floor, config)
    if not mask.any():
        reason = "the building has no floor indoors to start on"
        return _assemble(
            building, len(floor), {}, tuple(Unreachable(index=k, reason=reason) for k in range(len(floor))), config
        )
    roadmap = _usable(previous, building, mask, config)
    if roadmap is None:
        roadmap = build_roadmap(building.surface, building.walker, mask, config, progress)
    stands, unreachable = place_keypoints(building, roadmap, floor, config)
    pairs = _plan_legs(roadmap, stands, previous, progress)
    return _assemble(building, len(floor), stands, unreachable, config, roadmap, pairs, progress)


def _check_ends(config: SequencerConfig, count: int) -> None:
    for name, value in (("start", config.start), ("end", config.end)):
        if value >= count:
            raise ParameterError(name, value, f"the index of one of {count} keypoints, or -1")
    for k in sorted(config.rules.keypoints):
        if k >= count:
            texts = "; ".join(filter(None, (config.before, config.together)))
            raise ParameterError(
                "before and together", texts, f"numbers below {count}, that of keypoints, which {k} is not"
            )
    if config.start == config.end >= 0:
        raise ParameterError("end", config.end, "another keypoint than the start, or -1")


def _usable(
    previous: Tour | None, building: Building, mask: NDArray[np.bool_], config: SequencerConfig
) -> Roadmap | None:
    roadmap = previous.roadmap if previous is not None else None
    if roadmap is None or roadmap.surface is not building.surface or roadmap.walker != building.walker:
        return None
    decisive = ("milestones", "seed", "comfort_m", "comfort_weight", "slope_break_m")
    same = all(getattr(roadmap.config, name) == getattr(config, name) for name in decisive)
    return roadmap if same and np.array_equal(roadmap.mask, mask) else None


def _plan_legs(
    roadmap: Roadmap, stands: dict[int, Stand], previous: Tour | None, progress: Progress
) -> tuple[Leg, ...]:
    """Returns a leg for every pair of stands, those of the previous tour where neither end has moved."""
    known: dict[tuple[Stand, Stand], Leg] = {}
    if previous is not None and previous.roadmap is roadmap:
        for leg in previous.pairs:
            a, b = previous.stand_of[leg.start], previous.stand_of[leg.goal]
            known[a, b] = leg
    names = sorted(stands)
    pairs = [(i, j) for at, i in enumerate(names) for j in names[at + 1 :]]
    legs: dict[tuple[int, int], Leg] = {}
    for i, j in pairs:
        if (stands[i], stands[j]) in known:
            leg = known[stands[i], stands[j]]
            legs[i, j] = Leg(start=i, goal=j, points=leg.points, length_m=leg.length_m)
    missing = [pair for pair in pairs if pair not in legs]
    index = {name: at for at, name in enumerate(names)}
    planned = plan_pairs(roadmap, [stands[k] for k in names], [(index[i], index[j]) for i, j in missing], progress)
    for (i, j), leg in zip(missing, planned, strict=True):
        legs[i, j] = Leg(start=i, goal=j, points=leg.points, length_m=leg.length_m)
    return tuple(legs[pair] for pair in pairs)


def _assemble(
    building: Building,
    count: int,
    stands: dict[int, Stand],
    unreachable: tuple[Unreachable, ...],
    config: SequencerConfig,
    roadmap: Roadmap | None = None,
    pairs: Sequence[Leg] = (),
    progress: Progress = no_progress,
) -> Tour:
    lengths = np.full((count, count), np.inf)
    np.fill_diagonal(lengths, 0.0)
    for leg in pairs:
        lengths[leg.start, leg.goal] = lengths[leg.goal, leg.start] = leg.length_m
    progress("order", 0.0)
    names = np.array(sorted(stands), dtype=np.int64)
    # An end that cannot be reached is reported as such and is otherwise as good as none.
    start, end = (int(np.flatnonzero(names == k)[0]) if k in stands else -1 for k in (config.start, config.end))
    eyes = _eyes(roadmap, stands, count)
    row = {name: at for at, name in enumerate(names.tolist())}
    rules = config.rules.renamed(lambda k: row.get(k, -1))
    if config.start < 0 and config.begin == "entrance" and config.method != "given":
        start = _begin(building, eyes[names], end, rules)
    order = names[find_order(lengths[np.ix_(names, names)], start, end, config, rules)]
    if config.method != "given" and start < 0 and end < 0 and not rules:
        order = _upwards(order, eyes, building.surface.step_m)
    progress("order", 1.0)
    by_pair = {(leg.start, leg.goal): leg for leg in pairs}
    legs = tuple(by_pair[a, b] if a < b else by_pair[b, a].reversed() for a, b in itertools.pairwise(order.tolist()))
    polyline = _polyline(legs, eyes[order])
    for array in (lengths, order, eyes, polyline):
        array.setflags(write=False)
    return Tour(
        order=order,
        unreachable=unreachable,
        legs=legs,
        pairs=tuple(pairs),
        lengths_m=lengths,
        stands=eyes,
        polyline=polyline,
        length_m=polyline_length_m(polyline),
        method=resolve_method(config.method, len(names) - len(rules.links)),
        stand_of=stands,
        roadmap=roadmap,
    )


def _begin(building: Building, eyes: NDArray[np.float64], end: int, rules: Rules) -> int:
    """Returns the row nearest to the entrance, or to it among those the rules let come first; -1: none, or the end."""
    first = first_from_entrance(building, eyes)
    if first == end:
        # A tour that is wished to end at the entrance begins wherever it is shortest.
        return -1
    if first < 0 or not conflict(rules, first, end):
        return first
    may = np.array([k for k in range(len(eyes)) if k != end and not conflict(rules, k, end)], dtype=np.int64)
    first = first_from_entrance(building, eyes[may])
    return int(may[first]) if first >= 0 else -1


def _upwards(order: NDArray[np.int64], eyes: NDArray[np.float64], step_m: float) -> NDArray[np.int64]:
    """Returns an order, as good either way round, so that it begins on the lower floor: there people come in."""
    climb = eyes[order[-1], 2] - eyes[order[0], 2] if len(order) else 0.0
    return order[::-1] if climb < -step_m else order


def _eyes(roadmap: Roadmap | None, stands: dict[int, Stand], count: int) -> NDArray[np.float64]:
    eyes = np.full((count, 3), np.nan)
    if roadmap is not None and stands:
        height = roadmap.walker.eye_height_m
        rows = np.array([(s.x, s.y, roadmap.ground.xyz[s.place, 2] + height) for s in stands.values()])
        floor = roadmap.surface.floor_z(rows, height)
        rows[:, 2] = np.where(np.isfinite(floor), floor + height, rows[:, 2])
        eyes[list(stands)] = rows
    return eyes


def _polyline(legs: Sequence[Leg], eyes: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns the legs in a row (L, 3), without repeated points; the one stand where there is no leg."""
    if not legs:
        return eyes.copy()
    points = np.vstack([leg.points for leg in legs])
    moved = np.ones(len(points), dtype=bool)
    moved[1:] = np.any(points[1:] != points[:-1], axis=1)
    return np.asarray(points[moved])
