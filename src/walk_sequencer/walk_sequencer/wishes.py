# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a user asks for, and the change of the keypoints that this is; or why it cannot be."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import WalkError
from walk_sequencer.changes import (
    Entry,
    delete_entry,
    dwell_entry,
    ends_entry,
    insert_entry,
    lock_entry,
    look_at_entry,
    move_entry,
    reorder_entry,
)
from walk_sequencer.history import REDO, UNDO, History
from walk_sequencer.keypoints import Keypoints

LONGEST_DWELL_S = 3600.0


class EditRefused(WalkError):  # noqa: N818  a result on its way out, no failure
    """An edit that cannot be done.

    Attributes:
        reason: Why, for the user.
    """

    def __init__(self, reason: str) -> None:
        self.reason = reason
        super().__init__(reason)


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Wish:
    """One edit as asked for."""

    kind: str  # one of WISHES
    keypoint: int = -1  # identity; for an insertion the one to come behind, -1: where the way round is least
    client_id: str = ""
    position: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.zeros(3))  # (3,) eye position [m]
    quat_xyzw: NDArray[np.float64] = dataclasses.field(default_factory=lambda: np.array([0.0, 0.0, 0.0, 1.0]))  # (4,)
    argument: str = ""  # what the kind takes
    target: NDArray[np.float64] | None = None  # (3,) what to look at [m]


def entry_of(history: History, wish: Wish) -> Entry:
    """Returns the change that a wish means for the present keypoints.

    Raises:
        EditRefused: It cannot be done, with the reason.
    """
    keypoints = history.present
    free = wish.kind in ("undo", "redo") or (wish.kind == "insert" and wish.keypoint < 0)
    if not free and keypoints.index(wish.keypoint) < 0:
        raise EditRefused(f"there is no keypoint {wish.keypoint}")
    if wish.kind == "undo" and not history.can_undo:
        raise EditRefused("there is nothing to undo")
    if wish.kind == "redo" and not history.can_redo:
        raise EditRefused("there is nothing to redo")
    return WISHES[wish.kind](keypoints, wish)


def _move(keypoints: Keypoints, wish: Wish) -> Entry:
    _check_free(keypoints, wish.keypoint)
    return move_entry(wish.keypoint, wish.position, wish.quat_xyzw, wish.client_id)


def _insert(keypoints: Keypoints, wish: Wish) -> Entry:
    at = _place(keypoints, wish.keypoint) + 1 if wish.keypoint >= 0 else len(keypoints.order)
    if wish.keypoint >= 0 and wish.keypoint == keypoints.end:
        raise EditRefused(f"the tour ends at keypoint {wish.keypoint}: nothing can come behind it")
    if wish.keypoint < 0 and keypoints.end in keypoints.order:
        at -= 1
    return insert_entry(keypoints.next_id, at, wish.position, wish.quat_xyzw, wish.client_id)


def _delete(keypoints: Keypoints, wish: Wish) -> Entry:
    _check_free(keypoints, wish.keypoint)
    if wish.keypoint in keypoints.order and len(keypoints.order) <= 2:
        raise EditRefused("a walk needs two keypoints: insert another one first")
    return delete_entry(wish.keypoint, wish.client_id)


def _reorder(keypoints: Keypoints, wish: Wish) -> Entry:
    _check_free(keypoints, wish.keypoint)
    at = _place(keypoints, wish.keypoint)
    rest = [i for i in keypoints.order if i != wish.keypoint]
    fixed = {"first": 0, "last": len(rest), "earlier": max(at - 1, 0), "later": min(at + 1, len(rest))}
    where = wish.argument.strip() if wish.kind == "reorder" else wish.kind
    if where in fixed:
        to = fixed[where]
    elif where.isascii() and where.isdigit() and int(where) in rest:
        to = rest.index(int(where)) + 1
    elif where.isascii() and where.isdigit():
        raise EditRefused(f"there is no other keypoint {where} on the tour to come behind")
    else:
        raise EditRefused(f"{where!r} is no place in the order; expected {', '.join(fixed)} or a keypoint's number")
    order = [*rest[:to], wish.keypoint, *rest[to:]]
    for end, name, place in ((keypoints.start, "starts", 0), (keypoints.end, "ends", -1)):
        if end in order and order[place] != end:
            raise EditRefused(f"the tour {name} at keypoint {end}: free its ends first")
    return reorder_entry(order, wish.client_id)


def _lock(_keypoints: Keypoints, wish: Wish) -> Entry:
    return lock_entry(wish.keypoint, wish.kind == "lock", wish.client_id)


def _ends(keypoints: Keypoints, wish: Wish) -> Entry:
    at, start, end = wish.keypoint, keypoints.start, keypoints.end
    if wish.kind == "free_end":
        if at not in (start, end):
            raise EditRefused(f"keypoint {at} is neither the start nor the end")
        return ends_entry(-1 if start == at else start, -1 if end == at else end, keypoints.order, wish.client_id)
    before = _place(keypoints, at)
    rest = [i for i in keypoints.order if i != at]
    to = 0 if wish.kind == "start" else len(rest)
    if before != to:
        _check_free(keypoints, at)
    if wish.kind == "start":
        start, end = at, -1 if end == at else end
    else:
        start, end = -1 if start == at else start, at
    return ends_entry(start, end, [*rest[:to], at, *rest[to:]], wish.client_id)


def _dwell(_keypoints: Keypoints, wish: Wish) -> Entry:
    text = wish.argument.strip()
    if not text:
        return dwell_entry(wish.keypoint, None, wish.client_id)
    try:
        dwell = float(text)
    except ValueError:
        dwell = float("nan")
    if not 0.0 <= dwell <= LONGEST_DWELL_S:
        raise EditRefused(f"{text!r} is no time to stand; expected 0 to {LONGEST_DWELL_S:g} s or nothing")
    return dwell_entry(wish.keypoint, dwell, wish.client_id)


def _look_at(_keypoints: Keypoints, wish: Wish) -> Entry:
    return look_at_entry(wish.keypoint, wish.target, wish.client_id)


def _check_free(keypoints: Keypoints, identity: int) -> None:
    if identity in keypoints.locked:
        raise EditRefused(f"keypoint {identity} is locked: unlock it first")


def _place(keypoints: Keypoints, identity: int) -> int:
    if identity not in keypoints.order:
        raise EditRefused(f"keypoint {identity} is not on the tour, for it cannot be reached")
    return keypoints.order.index(identity)


WISHES: dict[str, Callable[[Keypoints, Wish], Entry]] = {
    "move": _move,
    "insert": _insert,
    "delete": _delete,
    "reorder": _reorder,
    "earlier": _reorder,
    "later": _reorder,
    "lock": _lock,
    "unlock": _lock,
    "start": _ends,
    "end": _ends,
    "free_end": _ends,
    "dwell": _dwell,
    "look_at": _look_at,
    "undo": lambda _keypoints, _wish: UNDO,
    "redo": lambda _keypoints, _wish: REDO,
}
