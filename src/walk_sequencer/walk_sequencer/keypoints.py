# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The keypoints as they are now: identity, place, order, and what a user has laid down about each."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

ROWS = ("positions", "quat_xyzw", "dwell_s", "look_at")
"""The arrays that have a row for each keypoint."""


def rows(values: Any, width: int) -> NDArray[np.float64]:
    """Returns finite numbers as a read-only (n, width) array.

    Raises:
        ValueError, TypeError: They are none.
    """
    array = np.array(values, dtype=np.float64).reshape(-1, width)
    if not np.isfinite(array).all():
        raise ValueError("numbers that are not finite")
    return _read_only(array)


def nothing(*shape: int) -> NDArray[np.float64]:
    """Returns a read-only array of nan: what nobody has laid down."""
    return _read_only(np.full(shape, np.nan))


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Keypoints:
    """The keypoints and the order they are visited in. Arrays are read-only."""

    ids: tuple[int, ...] = ()  # stable identities
    positions: NDArray[np.float64] = dataclasses.field(default_factory=lambda: nothing(0, 3))  # (K, 3) as wished [m]
    quat_xyzw: NDArray[np.float64] = dataclasses.field(default_factory=lambda: nothing(0, 4))  # (K, 4)
    dwell_s: NDArray[np.float64] = dataclasses.field(default_factory=lambda: nothing(0))  # (K,) nan: as everywhere [s]
    look_at: NDArray[np.float64] = dataclasses.field(default_factory=lambda: nothing(0, 3))  # (K, 3) nan: ahead [m]
    locked: frozenset[int] = frozenset()  # identities that neither a hand nor a search for an order moves
    start: int = -1  # identity of the first keypoint of the tour, -1 where the user leaves it free
    end: int = -1  # identity of the last one, likewise
    order: tuple[int, ...] = ()  # identities in the order of the tour; empty until it is planned
    suggested: NDArray[np.float64] = dataclasses.field(default_factory=lambda: nothing(0, 3))  # what they began as
    edited: bool = False  # whether a user has changed them since
    next_id: int = 0  # never used before

    def index(self, identity: int) -> int:
        """Returns where a keypoint stands in the arrays, -1 if there is none of that identity."""
        return self.ids.index(identity) if identity in self.ids else -1

    def in_order(self) -> Keypoints:
        """Returns the same keypoints with the arrays in the order of the tour; those outside of it come last."""
        if not self.order:
            return self
        ids = self.order + tuple(i for i in self.ids if i not in self.order)
        return self._taken(ids, [self.ids.index(i) for i in ids])

    def begins_as(self, positions: NDArray[np.float64]) -> bool:
        """Returns whether these keypoints began as the suggested positions (K, 3)."""
        return bool(self.suggested.shape == positions.shape and np.array_equal(self.suggested, positions))

    def with_row(self, identity: int, **values: NDArray[np.float64]) -> Keypoints:
        """Returns the keypoints with other values in one keypoint's row; raises ValueError where there is no such."""
        arrays: dict[str, Any] = {}
        row = self.ids.index(identity)
        for name, value in values.items():
            arrays[name] = getattr(self, name).copy()
            arrays[name][row] = value
            _read_only(arrays[name])
        return dataclasses.replace(self, **arrays)

    def with_keypoint(self, position: NDArray[np.float64], quat_xyzw: NDArray[np.float64]) -> Keypoints:
        """Returns the keypoints and one more, outside of the order, of the next identity."""
        new = {"positions": position, "quat_xyzw": quat_xyzw, "dwell_s": nothing(), "look_at": nothing(3)}
        arrays: dict[str, Any] = {
            name: _read_only(np.concatenate([getattr(self, name), value[None]])) for name, value in new.items()
        }
        ids, after = (*self.ids, self.next_id), self.next_id + 1
        return dataclasses.replace(self, ids=ids, next_id=after, **arrays)

    def without(self, identity: int) -> Keypoints:
        """Returns the keypoints but one; raises ValueError where there is no such."""
        gone = self.ids.index(identity)
        left = [row for row in range(len(self.ids)) if row != gone]
        return dataclasses.replace(
            self._taken(tuple(self.ids[row] for row in left), left),
            order=tuple(i for i in self.order if i != identity),
            locked=self.locked - {identity},
            start=-1 if self.start == identity else self.start,
            end=-1 if self.end == identity else self.end,
        )

    def _taken(self, ids: tuple[int, ...], taken: list[int]) -> Keypoints:
        arrays: dict[str, Any] = {name: _read_only(getattr(self, name)[taken]) for name in ROWS}
        return dataclasses.replace(self, ids=ids, **arrays)


def _read_only(array: NDArray[np.float64]) -> NDArray[np.float64]:
    array.setflags(write=False)
    return array
