# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The one writer of the keypoints and their order: takes suggestions and edits, keeps the journal, plans the tour."""

from __future__ import annotations

import dataclasses
import logging

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.footing import eye_over_floor, room_name
from walk_building.progress import Progress, no_progress
from walk_sequencer.changes import Entry, insert_entry, order_entry, suggested_entry
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.journal import Journal
from walk_sequencer.keypoints import Keypoints
from walk_sequencer.order import order_cost, resolve_method
from walk_sequencer.pipeline import plan_tour
from walk_sequencer.reorder import reorder, saved_m
from walk_sequencer.rules import FREE, conflict
from walk_sequencer.tour import Tour
from walk_sequencer.wishes import EditRefused, Wish, entry_of

_log = logging.getLogger(__name__)

HALF_WAY = "half-way"
"""The argument of an insertion in the middle of the leg behind a keypoint."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Planned:
    """The keypoints of one revision with the tour through them; row k of every array is keypoint k of the tour."""

    keypoints: Keypoints
    tour: Tour
    labels: tuple[str, ...]  # (K,)

    def eyes(self) -> NDArray[np.float64]:
        """Returns where each keypoint is (K, 3): where the walker stands, or where it is wished if it cannot be."""
        stands = np.asarray(self.tour.stands)
        there = np.isfinite(stands).all(axis=1, keepdims=True)
        return np.where(there, stands, self.keypoints.positions)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """What became of a wish."""

    reason: str  # why it was refused, "" if it is done
    keypoint: int  # identity, of an insertion the new one; -1 for none


class Authority:
    """The keypoints of one building. Every change that a method confirms is on disk when it returns.

    Attributes:
        planned: What is shown; None before the first plan.
        order_by: The method that has found the order; "given" where a user or the journal has.
    """

    def __init__(self, building: Building, journal: Journal) -> None:
        self._building = building
        self._journal = journal
        self._history = journal.replay()
        self.planned: Planned | None = None
        self.order_by = "given"

    @property
    def keypoints(self) -> Keypoints:
        """The keypoints now; their rows are in the order in which they came to be."""
        return self._history.present

    def adopt(self, positions: NDArray[np.float64], quat_xyzw: NDArray[np.float64]) -> bool:
        """Takes over suggested keypoints (K, 3), (K, 4); returns whether anything has changed.

        Keypoints that a user has edited stay, and so does what was taken back and can be done again: a suggestion
        never undoes somebody's work.
        """
        if self.keypoints.begins_as(positions) or self.keypoints.edited or self._history.can_redo:
            return False
        self._record(suggested_entry(positions, quat_xyzw))
        self.planned = None
        return True

    def plan(
        self,
        config: SequencerConfig,
        progress: Progress = no_progress,
        *,
        anew: bool = False,
        offered: bool = False,
    ) -> Planned:
        """Plans the tour; the order stays as it is unless there is none yet or `anew` asks for another.

        Another order leaves locked keypoints, and the ends a user has chosen, where they are in the order. With
        `offered` it is never longer than the one that `better_order_saves_m` means, which begins where the tour does.
        """
        offer = self._offer(config) if anew and offered else ()
        pinned = self.keypoints.locked | ({self.keypoints.start, self.keypoints.end} - {-1})
        if not self.keypoints.order or (anew and not pinned):
            found = self._settle(self._planned(self.keypoints, config, progress, anew=True))
            self.order_by = found.tour.method
            self._take_shorter(offer, found)
        elif anew:
            planned = self._planned(self.keypoints, config, progress)
            self._settle(planned)
            by_row = _by_row(config, planned.keypoints)
            rows = reorder(planned.tour.lengths_m, planned.tour.order, self._pinned_rows(planned), by_row)
            self._record(order_entry(planned.keypoints.ids[k] for k in rows.tolist()))
            self.order_by = resolve_method(config.method, len(rows))
        # Legs are planned in the direction of the rows, so the legs of a new order are planned once more along it:
        # what is shown is then, bit for bit, what a sequencer started again plans from the journal.
        return self._settle(self._planned(self.keypoints, config, progress))

    def edit(self, wish: Wish, config: SequencerConfig, editing: EditingConfig) -> Answer:
        """Does what a user asks for, or says why not; what is done is in the journal and planned."""
        try:
            if wish.kind in ("move", "insert"):
                place = self._half_way(wish) if wish.argument == HALF_WAY else wish.position
                wish = dataclasses.replace(wish, position=eye_over_floor(self._building, place))
            entry = entry_of(self._history, wish)
            if wish.kind == "insert" and wish.keypoint < 0:
                entry = self._least_way_round(entry, config)
            planned = self._planned(self._history.after(entry), config, no_progress)
            if wish.kind in ("move", "insert"):
                _check_stand(planned, int(entry["id"]), editing)
        except EditRefused as refused:
            return Answer(reason=refused.reason, keypoint=wish.keypoint)
        self._record(entry)
        self._settle(planned)
        self.order_by = "given"
        return Answer(reason="", keypoint=int(entry["id"]) if wish.kind == "insert" else wish.keypoint)

    def better_order_saves_m(self, config: SequencerConfig) -> float:
        """Returns by how much a quick search would shorten the tour [m], around what is pinned and from its start."""
        planned = self.planned
        if planned is None or len(planned.tour.order) < 3:
            return 0.0
        pinned = self._pinned_rows(planned) | {int(planned.tour.order[0])}
        return saved_m(planned.tour.lengths_m, planned.tour.order, pinned, _by_row(config, planned.keypoints))

    def _offer(self, config: SequencerConfig) -> tuple[int, ...]:
        """Returns the order that is offered, by identities: around what is pinned, from the same start; or ()."""
        planned = self.planned
        if planned is None or len(planned.tour.order) < 3:
            return ()
        pinned = self._pinned_rows(planned) | {int(planned.tour.order[0])}
        rows = reorder(planned.tour.lengths_m, planned.tour.order, pinned, _by_row(config, planned.keypoints))
        return tuple(planned.keypoints.ids[k] for k in rows.tolist())

    def _take_shorter(self, offer: tuple[int, ...], found: Planned) -> None:
        """Keeps the order offered where the one found, which may have to begin elsewhere, is longer."""
        rows = [found.keypoints.index(i) for i in offer]
        if sorted(rows) == sorted(found.tour.order.tolist()):
            length_m = order_cost(found.tour.lengths_m, np.array(rows, dtype=np.int64))
            if length_m < order_cost(found.tour.lengths_m, found.tour.order):
                self._record(order_entry(offer))

    def _pinned_rows(self, planned: Planned) -> set[int]:
        keypoints = planned.keypoints
        return {keypoints.index(i) for i in (*keypoints.locked, keypoints.start, keypoints.end)} - {-1}

    def _half_way(self, wish: Wish) -> NDArray[np.float64]:
        """Returns the middle of the leg behind a keypoint (3,)."""
        planned = self.planned
        row = planned.keypoints.index(wish.keypoint) if planned is not None else -1
        if planned is not None:
            for leg in planned.tour.legs:
                if leg.start == row:
                    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(leg.points, axis=0), axis=1))])
                    return np.array([np.interp(0.5 * way[-1], way, axis) for axis in leg.points.T])
        raise EditRefused(f"no leg of the tour begins at keypoint {wish.keypoint}: give a place")

    def _least_way_round(self, entry: Entry, config: SequencerConfig) -> Entry:
        """Returns the insertion where the tour grows least by it, behind a chosen start and before a chosen end."""
        identity = int(entry["id"])
        planned = self._planned(self._history.after(entry), config, no_progress)
        ids, lengths = planned.keypoints.ids, planned.tour.lengths_m
        row = planned.keypoints.index(identity)
        rows = [planned.keypoints.index(i) for i in self.keypoints.order]
        if not rows or not np.isfinite(lengths[row, rows]).all():
            return entry
        way = lengths[row, rows]
        grows = np.empty(len(rows) + 1)
        grows[0], grows[-1] = way[0], way[-1]
        grows[1:-1] = way[:-1] + way[1:] - lengths[rows[:-1], rows[1:]]
        grows[0] = np.inf if ids[rows[0]] == self.keypoints.start else grows[0]
        grows[-1] = np.inf if ids[rows[-1]] == self.keypoints.end else grows[-1]
        at = int(np.argmin(grows))
        return insert_entry(identity, at, entry["position"], entry["quat_xyzw"], entry["client_id"])

    def _planned(
        self, keypoints: Keypoints, config: SequencerConfig, progress: Progress, *, anew: bool = False
    ) -> Planned:
        keep = bool(keypoints.order) and not anew
        ordered = keypoints.in_order()
        # The ends are identities to the user: rows change with every order. Those of an edit go before parameters.
        first, last = keypoints.start, keypoints.end
        first = config.start if first < 0 and config.start != last else first
        last = config.end if last < 0 and config.end != first else last
        start, end = ordered.index(first), ordered.index(last)
        for name, identity, row in (("start", first, start), ("end", last, end)):
            if identity >= 0 and row < 0:
                _log.warning("the %s is keypoint %d, which there is not; it is left free", name, identity)
        # Rules bind the search for an order; one that is kept may be a user's, who went before them.
        here = dataclasses.replace(
            _by_row(config, ordered, start, end, bound=not keep), method="given" if keep else config.method
        )
        previous = self.planned.tour if self.planned is not None else None
        tour = plan_tour(self._building, ordered.positions, here, progress, previous)
        stands = np.isfinite(tour.stands).all(axis=1)
        eyes = np.where(np.asarray(stands)[:, None], tour.stands, ordered.positions)
        labels = tuple(room_name(self._building, eye) for eye in eyes)
        return Planned(keypoints=ordered, tour=tour, labels=labels)

    def _settle(self, planned: Planned) -> Planned:
        """Makes a plan the current one and keeps its order."""
        order = tuple(planned.keypoints.ids[i] for i in planned.tour.order)
        if order != self.keypoints.order:
            self._record(order_entry(order))
        self.planned = dataclasses.replace(
            planned, keypoints=dataclasses.replace(planned.keypoints, order=order, next_id=self.keypoints.next_id)
        )
        return self.planned

    def _record(self, entry: Entry) -> None:
        """Writes a change to the journal, then makes it; what does not fit is not written."""
        self._history.after(entry)
        self._journal.append(entry)
        self._history.apply(entry)


def _by_row(
    config: SequencerConfig, keypoints: Keypoints, start: int = -1, end: int = -1, *, bound: bool = True
) -> SequencerConfig:
    """Returns the config with rules that name rows instead of identities; without any where it is not bound."""
    rules = config.rules.renamed(keypoints.index) if bound else FREE
    problem = conflict(rules, start, end)
    if problem:
        _log.warning("the rules about the order are left out, which the tour's chosen ends contradict")
    before, together = (FREE if problem else rules).texts()
    return dataclasses.replace(config, start=start, end=end, before=before, together=together)


def _check_stand(planned: Planned, identity: int, editing: EditingConfig) -> None:
    """Raises EditRefused where a keypoint cannot be reached, or only by being pulled far away."""
    row = planned.keypoints.index(identity)
    reasons = [left.reason for left in planned.tour.unreachable if left.index == row]
    if reasons:
        raise EditRefused(reasons[0])
    pulled = float(np.linalg.norm(planned.tour.stands[row, :2] - planned.keypoints.positions[row, :2]))
    if pulled > editing.pull_m:
        raise EditRefused(
            f"no room for the walker's body there, as in a wall: the nearest place to stand on is {pulled:.2f} m away"
        )
