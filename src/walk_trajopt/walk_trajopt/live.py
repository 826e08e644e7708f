# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The path while it is edited: solved once, then only where something changed, and known again when it comes back."""

from __future__ import annotations

import abc
import dataclasses
import hashlib
from collections import OrderedDict
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.route import Router
from walk_trajopt.config import TrajoptConfig
from walk_trajopt.kept import Kept
from walk_trajopt.optimiser import EditOutcome, Optimiser
from walk_trajopt.path import OptimisedPath
from walk_trajopt.spline import spline_path
from walk_trajopt.state import State

_REMEMBERED = 256  # revisions whose paths are kept, so that undo shows the very same; some ten megabytes
_LOCKED = "the keypoint is locked"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Revision:
    """What the authority over the keypoints last said. Dwell, look and labels are not the path's business."""

    ids: tuple[int, ...]  # stable identities, in the order of the tour
    keypoints: NDArray[np.float64]  # (M, 3) [m]
    polyline: NDArray[np.float64]  # (L, 3) the planned tour [m]
    locked: frozenset[int] = frozenset()  # identities that the path passes exactly

    @property
    def key(self) -> tuple[object, ...]:
        """Equal for revisions that have the same path."""
        locked = self.locked & set(self.ids)
        return self.ids, locked, self.keypoints.tobytes(), self.polyline.tobytes()

    @property
    def digest(self) -> str:
        """A text that tells revisions apart as `key` does."""
        head = repr((self.ids, sorted(self.locked & set(self.ids)), self.keypoints.shape, self.polyline.shape))
        return hashlib.sha256(head.encode() + self.keypoints.tobytes() + self.polyline.tobytes()).hexdigest()

    @property
    def pinned(self) -> NDArray[np.bool_]:
        """(M,) whether each keypoint is locked."""
        return np.array([identity in self.locked for identity in self.ids], dtype=bool)


class LivePath(abc.ABC):
    """A path that follows revisions, and edits before they are confirmed. Not safe to share between threads."""

    def __init__(self, building: Building, config: TrajoptConfig) -> None:
        self._building = building
        self._config = config
        self._revision: Revision | None = None
        self._shown: dict[int, NDArray[np.float64]] = {}  # edits since the revision, by identity

    @property
    @abc.abstractmethod
    def keypoints(self) -> NDArray[np.float64]:
        """(M, 3) where they are now, in the order of the tour [m]."""

    @abc.abstractmethod
    def path(self) -> OptimisedPath:
        """Returns the path as it is now."""

    @abc.abstractmethod
    def follow(self, revision: Revision) -> OptimisedPath:
        """Returns the path of a revision; of what is shown, all stays that the revision confirms."""

    @abc.abstractmethod
    def _restored(self) -> OptimisedPath:
        """Goes back to the last revision, and returns its path."""

    @abc.abstractmethod
    def _moved(self, keypoint: int, position: NDArray[np.float64], hasty: bool) -> EditOutcome:
        """Moves a keypoint that is not locked."""

    def prepare(self) -> None:  # noqa: B027  the other mode has nothing to prepare
        """Does beforehand what the first edit would wait for."""

    def move(self, identity: int, position: NDArray[np.float64], *, hasty: bool = False) -> EditOutcome:
        """Moves a keypoint of the last revision: the new path, or the last valid one and the reason.

        Args:
            identity: Which one.
            position: (3,) where its eye is wanted [m].
            hasty: One of many moves that follow each other.
        """
        assert self._revision is not None, "follow a revision first"
        if identity not in self._revision.ids:
            return EditOutcome(path=self.path(), accepted=False, reason="the tour has no such keypoint")
        if identity in self._revision.locked:
            return EditOutcome(path=self.path(), accepted=False, reason=_LOCKED)
        outcome = self._moved(self._revision.ids.index(identity), position, hasty)
        if outcome.accepted:
            self._shown[identity] = position
        return outcome

    def shows(self, identity: int) -> bool:
        """Returns whether a keypoint is shown where an edit since the last revision has it."""
        return identity in self._shown

    def take_back(self, identity: int | None = None) -> OptimisedPath:
        """Returns the path of the last revision with the edits shown since, but for one keypoint's; None: for all.

        What other hands drag meanwhile stays as it is shown.
        """
        assert self._revision is not None
        others = {i: place for i, place in self._shown.items() if identity not in (None, i)}
        self._shown = {}
        path = self._restored()
        for other, place in others.items():
            path = self.move(other, place).path
        return path


class OptimisedWalk(LivePath):
    """The optimised, checked path. The states of earlier revisions are kept: undo brings them back bit for bit."""

    def __init__(self, building: Building, config: TrajoptConfig, folder: Path | None = None) -> None:
        super().__init__(building, config)
        self._optimiser: Optimiser | None = None
        self._kept = None if folder is None else Kept(folder, building.hash, config)
        self._known: OrderedDict[tuple[object, ...], State] = OrderedDict()
        self._router: Router | None = None

    def prepare(self) -> None:
        """Lays the floor out for finding other ways."""
        if self._router is None:
            self._router = Router(self._building)
            if self._optimiser is not None:
                self._optimiser.mover.router = self._router
                self._optimiser.rehearse()

    @property
    def keypoints(self) -> NDArray[np.float64]:
        """(M, 3) where they are now [m]."""
        assert self._optimiser is not None
        return self._optimiser.state.keypoints

    def path(self) -> OptimisedPath:
        """Returns the path as it is now."""
        assert self._optimiser is not None
        return self._optimiser.path()

    def follow(self, revision: Revision) -> OptimisedPath:
        """Returns the path of a revision: the one shown, the one known from before, or one solved where it is new."""
        before, key = self._revision, revision.key
        if before is None or key != before.key:
            self._shown = {}
        if before is None or self._optimiser is None:
            self._solve(revision)
        elif key in self._known:
            self._known.move_to_end(key)
            if key != before.key:
                self._optimiser.state = self._known[key]
        else:
            came_from = np.array([before.ids.index(i) if i in before.ids else -1 for i in revision.ids])
            known = self._optimiser.revise(revision.polyline, revision.keypoints, came_from, revision.pinned)
            # A leg that was bent by hand may be kept, and its planned way is bent too: where a new leg beside it is to
            # be mended by it in vain, the sequencer's own way is the one that passes.
            if not known or self._optimiser.path().colliding:
                self._solve(revision)
        self._revision = revision
        if key not in self._known:
            self._remember(key)
        if self._kept and (before is None or key != before.key):
            assert self._optimiser is not None
            self._kept.save(revision.digest, self._known[key], self._optimiser.pieces.spacing_m)
        return self.path()

    def _restored(self) -> OptimisedPath:
        assert self._revision is not None and self._optimiser is not None
        self._optimiser.state = self._known[self._revision.key]
        return self.path()

    def _moved(self, keypoint: int, position: NDArray[np.float64], hasty: bool) -> EditOutcome:
        assert self._optimiser is not None
        return self._optimiser.move_keypoint(keypoint, position, hasty=hasty)

    def _solve(self, revision: Revision) -> None:
        self._optimiser = None
        optimiser = Optimiser(
            self._building, revision.polyline, revision.keypoints, self._config, revision.pinned, self._router
        )
        kept = self._kept.load(revision.digest) if self._kept else None
        if kept is None or not optimiser.restore(*kept):
            optimiser.solve()
            optimiser.check()
        self._optimiser = optimiser

    def _remember(self, key: tuple[object, ...]) -> None:
        assert self._optimiser is not None
        self._known[key] = self._optimiser.state
        while len(self._known) > _REMEMBERED:
            self._known.popitem(last=False)


class ManualWalk(LivePath):
    """The source's manual mode: a spline through the keypoints as they are; where it collides it says so."""

    def __init__(self, building: Building, config: TrajoptConfig) -> None:
        super().__init__(building, config)
        self._keypoints = np.empty((0, 3))
        self._path: OptimisedPath | None = None

    @property
    def keypoints(self) -> NDArray[np.float64]:
        """(M, 3) where they are now [m]."""
        return self._keypoints

    def path(self) -> OptimisedPath:
        """Returns the path as it is now."""
        assert self._path is not None
        return self._path

    def follow(self, revision: Revision) -> OptimisedPath:
        """Returns the spline through the revision's keypoints."""
        self._revision, self._keypoints, self._shown = revision, revision.keypoints, {}
        self._path = spline_path(self._building, self._keypoints, self._config, self._config.mode)
        return self._path

    def _restored(self) -> OptimisedPath:
        assert self._revision is not None
        return self.follow(self._revision)

    def _moved(self, keypoint: int, position: NDArray[np.float64], hasty: bool) -> EditOutcome:  # noqa: ARG002  a spline is fast
        moved = self._keypoints.copy()
        moved[keypoint] = position
        self._path = spline_path(self._building, moved, self._config, self._config.mode)
        self._keypoints = moved
        return EditOutcome(path=self._path, accepted=True, reason="")


def live_path(building: Building, config: TrajoptConfig, folder: Path | None = None) -> LivePath:
    """Returns a path in the mode of the config, which follows its first revision next.

    Args:
        building: Where to walk.
        config: The mode, the problem, its solver.
        folder: Where the optimised path of the last revision is kept; None for nowhere.
    """
    if config.mode == "optimised":
        return OptimisedWalk(building, config, folder)
    return ManualWalk(building, config)
