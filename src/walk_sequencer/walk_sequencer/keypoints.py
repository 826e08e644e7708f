# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The keypoints as they are now: identity, place, order. Every change is a new value made by a journal entry."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Entry = Mapping[str, Any]
"""A change as the journal stores it: `kind` and its data, all of it plain JSON."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Keypoints:
    """The keypoints and the order they are visited in. Arrays are read-only."""

    ids: tuple[int, ...] = ()  # stable identities
    positions: NDArray[np.float64] = dataclasses.field(default_factory=lambda: _rows((), 3))  # (K, 3) as wished [m]
    quat_xyzw: NDArray[np.float64] = dataclasses.field(default_factory=lambda: _rows((), 4))  # (K, 4)
    order: tuple[int, ...] = ()  # identities in the order of the tour; empty until it is planned
    suggested: NDArray[np.float64] = dataclasses.field(default_factory=lambda: _rows((), 3))  # what they began as
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
        rows = [self.ids.index(i) for i in ids]
        return dataclasses.replace(self, ids=ids, positions=self.positions[rows], quat_xyzw=self.quat_xyzw[rows])

    def begins_as(self, positions: NDArray[np.float64]) -> bool:
        """Returns whether these keypoints began as the suggested positions (K, 3)."""
        return bool(self.suggested.shape == positions.shape and np.array_equal(self.suggested, positions))


def suggested_entry(positions: ArrayLike, quat_xyzw: ArrayLike) -> Entry:
    """Returns the change to newly suggested keypoints."""
    return {
        "kind": "suggested",
        "positions": np.asarray(positions, float).tolist(),
        "quat_xyzw": np.asarray(quat_xyzw, float).tolist(),
    }


def order_entry(ids: Iterable[int]) -> Entry:
    """Returns the change to another order of the tour."""
    return {"kind": "order", "ids": [int(i) for i in ids]}


def move_entry(identity: int, position: ArrayLike, quat_xyzw: ArrayLike, client_id: str) -> Entry:
    """Returns the change of a keypoint's place."""
    return {
        "kind": "move",
        "id": identity,
        "position": np.asarray(position, float).tolist(),
        "quat_xyzw": np.asarray(quat_xyzw, float).tolist(),
        "client_id": client_id,
    }


def changed(keypoints: Keypoints, entry: Entry) -> Keypoints:
    """Returns the keypoints after a change.

    Raises:
        KeyError, ValueError, TypeError: The entry is none, or does not fit these keypoints.
    """
    return _CHANGES[entry["kind"]](keypoints, entry)


def _suggested(keypoints: Keypoints, entry: Entry) -> Keypoints:
    positions, quat_xyzw = _rows(entry["positions"], 3), _rows(entry["quat_xyzw"], 4)
    if len(positions) != len(quat_xyzw):
        raise ValueError(f"{len(positions)} positions and {len(quat_xyzw)} orientations")
    after = keypoints.next_id + len(positions)
    return Keypoints(
        ids=tuple(range(keypoints.next_id, after)),
        positions=positions,
        quat_xyzw=quat_xyzw,
        suggested=positions,
        next_id=after,
    )


def _order(keypoints: Keypoints, entry: Entry) -> Keypoints:
    order = tuple(int(i) for i in entry["ids"])
    if len(set(order)) != len(order) or not set(order) <= set(keypoints.ids):
        raise ValueError(f"{order} is no order of {keypoints.ids}")
    return dataclasses.replace(keypoints, order=order)


def _move(keypoints: Keypoints, entry: Entry) -> Keypoints:
    row = keypoints.ids.index(int(entry["id"]))
    positions, quat_xyzw = keypoints.positions.copy(), keypoints.quat_xyzw.copy()
    positions[row], quat_xyzw[row] = _rows([entry["position"]], 3)[0], _rows([entry["quat_xyzw"]], 4)[0]
    for array in (positions, quat_xyzw):
        array.setflags(write=False)
    return dataclasses.replace(keypoints, positions=positions, quat_xyzw=quat_xyzw, edited=True)


_CHANGES = {"suggested": _suggested, "order": _order, "move": _move}


def _rows(values: Any, width: int) -> NDArray[np.float64]:
    rows = np.array(values, dtype=np.float64).reshape(-1, width)
    if not np.isfinite(rows).all():
        raise ValueError("numbers that are not finite")
    rows.setflags(write=False)
    return rows
