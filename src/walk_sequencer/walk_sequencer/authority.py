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
from walk_sequencer.config import SequencerConfig
from walk_sequencer.editing import EditingConfig
from walk_sequencer.journal import Journal
from walk_sequencer.keypoints import Keypoints, changed, move_entry, order_entry, suggested_entry
from walk_sequencer.pipeline import plan_tour
from walk_sequencer.tour import Tour

_log = logging.getLogger(__name__)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Planned:
    """The keypoints of one revision with the tour through them; row k of every array is keypoint k of the tour."""

    keypoints: Keypoints
    tour: Tour
    labels: tuple[str, ...]  # (K,)


class Authority:
    """The keypoints of one building. Every change that a method confirms is on disk when it returns."""

    def __init__(self, building: Building, journal: Journal) -> None:
        self._building = building
        self._journal = journal
        self.keypoints = journal.replay()
        self.planned: Planned | None = None

    def adopt(self, positions: NDArray[np.float64], quat_xyzw: NDArray[np.float64]) -> bool:
        """Takes over suggested keypoints (K, 3), (K, 4); returns whether anything has changed.

        Keypoints that a user has edited stay: a suggestion never undoes somebody's work.
        """
        if self.keypoints.begins_as(positions) or self.keypoints.edited:
            return False
        entry = suggested_entry(positions, quat_xyzw)
        after = changed(self.keypoints, entry)
        self._journal.append(entry)
        self.keypoints = after
        self.planned = None
        return True

    def plan(self, config: SequencerConfig, progress: Progress = no_progress, *, anew: bool = False) -> Planned:
        """Plans the tour; the order stays as it is unless there is none yet or `anew` asks for another."""
        if anew or not self.keypoints.order:
            self._confirm(self._planned(self.keypoints, config, progress, anew=True))
        # Legs are planned in the direction of the rows, so the legs of a new order are planned once more along it:
        # what is shown is then, bit for bit, what a sequencer started again plans from the journal.
        planned = self._planned(self.keypoints, config, progress)
        self._confirm(planned)
        return planned

    def move(
        self,
        identity: int,
        position: NDArray[np.float64],
        quat_xyzw: NDArray[np.float64],
        client_id: str,
        config: SequencerConfig,
        editing: EditingConfig,
    ) -> str:
        """Moves a keypoint to the floor below a position and plans again; returns why not, "" if it is done."""
        if self.keypoints.index(identity) < 0:
            return f"there is no keypoint {identity}"
        entry = move_entry(identity, eye_over_floor(self._building, position), quat_xyzw, client_id)
        planned = self._planned(changed(self.keypoints, entry), config, no_progress)
        row = planned.keypoints.index(identity)
        reasons = [left.reason for left in planned.tour.unreachable if left.index == row]
        if reasons:
            return reasons[0]
        pulled = float(np.linalg.norm(planned.tour.stands[row, :2] - planned.keypoints.positions[row, :2]))
        if pulled > editing.pull_m:
            return f"no room for the walker's body there: the nearest place to stand on is {pulled:.2f} m away"
        self._journal.append(entry)
        self._confirm(planned)
        return ""

    def _planned(
        self, keypoints: Keypoints, config: SequencerConfig, progress: Progress, *, anew: bool = False
    ) -> Planned:
        keep = bool(keypoints.order) and not anew
        ordered = keypoints.in_order()
        # The ends are identities to the user: rows change with every order.
        start, end = (ordered.index(identity) if identity >= 0 else -1 for identity in (config.start, config.end))
        for name, identity, row in (("start", config.start, start), ("end", config.end, end)):
            if identity >= 0 and row < 0:
                _log.warning("the %s is keypoint %d, which there is not; it is left free", name, identity)
        here = dataclasses.replace(config, method="given" if keep else config.method, start=start, end=end)
        previous = self.planned.tour if self.planned is not None else None
        tour = plan_tour(self._building, ordered.positions, here, progress, previous)
        stands = np.isfinite(tour.stands).all(axis=1)
        eyes = np.where(np.asarray(stands)[:, None], tour.stands, ordered.positions)
        labels = tuple(room_name(self._building, eye) for eye in eyes)
        return Planned(keypoints=ordered, tour=tour, labels=labels)

    def _confirm(self, planned: Planned) -> None:
        """Makes a plan the current one and keeps its order."""
        keypoints = planned.keypoints
        order = tuple(keypoints.ids[i] for i in planned.tour.order)
        if order != keypoints.order:
            entry = order_entry(order)
            keypoints = changed(keypoints, entry)
            self._journal.append(entry)
        self.keypoints = keypoints
        self.planned = dataclasses.replace(planned, keypoints=keypoints)
