# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Changes of the keypoints as the journal stores them, and what each does. Every change makes a new value."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from walk_sequencer.keypoints import Keypoints, nothing, rows
from walk_sequencer.whole import plain, whole

Entry = Mapping[str, Any]
"""A change: `kind` and its data, all of it plain JSON."""


def suggested_entry(positions: ArrayLike, quat_xyzw: ArrayLike) -> Entry:
    """Returns the change to newly suggested keypoints."""
    return {"kind": "suggested", "positions": _plain(positions), "quat_xyzw": _plain(quat_xyzw)}


def opened_entry(keypoints: Keypoints) -> Entry:
    """Returns the change to the keypoints of a saved tour; nothing before it can be taken back."""
    return {"kind": "opened", **plain(keypoints)}


def order_entry(ids: Iterable[int]) -> Entry:
    """Returns the change to the order that the planner has found; nothing that a user takes back."""
    return {"kind": "order", "ids": [int(i) for i in ids]}


def move_entry(identity: int, position: ArrayLike, quat_xyzw: ArrayLike, client_id: str) -> Entry:
    """Returns the change of a keypoint's place."""
    place = {"position": _plain(position), "quat_xyzw": _plain(quat_xyzw)}
    return {"kind": "move", "id": identity, **place, "client_id": client_id}


def insert_entry(identity: int, at: int, position: ArrayLike, quat_xyzw: ArrayLike, client_id: str) -> Entry:
    """Returns the change by a new keypoint, of the next identity, that comes at the given index of the order."""
    place = {"position": _plain(position), "quat_xyzw": _plain(quat_xyzw)}
    return {"kind": "insert", "id": identity, "at": at, **place, "client_id": client_id}


def delete_entry(identity: int, client_id: str) -> Entry:
    """Returns the change that takes a keypoint away."""
    return {"kind": "delete", "id": identity, "client_id": client_id}


def reorder_entry(ids: Iterable[int], client_id: str) -> Entry:
    """Returns the change to an order that a user wants."""
    return {"kind": "reorder", "ids": [int(i) for i in ids], "client_id": client_id}


def lock_entry(identity: int, locked: bool, client_id: str) -> Entry:
    """Returns the change that locks a keypoint, or frees it."""
    return {"kind": "lock", "id": identity, "locked": locked, "client_id": client_id}


def ends_entry(start: int, end: int, ids: Iterable[int], client_id: str) -> Entry:
    """Returns the change of where the tour starts and ends (-1: free), and to the order that follows."""
    return {"kind": "ends", "start": start, "end": end, "ids": [int(i) for i in ids], "client_id": client_id}


def dwell_entry(identity: int, dwell_s: float | None, client_id: str) -> Entry:
    """Returns the change of how long to stand at a keypoint; None: as everywhere."""
    return {"kind": "dwell", "id": identity, "dwell_s": dwell_s, "client_id": client_id}


def look_at_entry(identity: int, point: ArrayLike | None, client_id: str) -> Entry:
    """Returns the change of what to look at from a keypoint; None: ahead."""
    return {
        "kind": "look_at",
        "id": identity,
        "point": None if point is None else _plain(point),
        "client_id": client_id,
    }


def changed(keypoints: Keypoints, entry: Entry) -> Keypoints:
    """Returns the keypoints after a change.

    Raises:
        KeyError, ValueError, TypeError: The entry is none, or does not fit these keypoints.
    """
    if entry["kind"] in EDITS:
        return dataclasses.replace(EDITS[entry["kind"]](keypoints, entry), edited=True)
    return _PLANNED[entry["kind"]](keypoints, entry)


def _suggested(keypoints: Keypoints, entry: Entry) -> Keypoints:
    positions, quat_xyzw = rows(entry["positions"], 3), rows(entry["quat_xyzw"], 4)
    if len(positions) != len(quat_xyzw):
        raise ValueError(f"{len(positions)} positions and {len(quat_xyzw)} orientations")
    after = keypoints.next_id + len(positions)
    return Keypoints(
        ids=tuple(range(keypoints.next_id, after)),
        positions=positions,
        quat_xyzw=quat_xyzw,
        dwell_s=nothing(len(positions)),
        look_at=nothing(len(positions), 3),
        suggested=positions,
        next_id=after,
    )


def _opened(_keypoints: Keypoints, entry: Entry) -> Keypoints:
    return whole(entry)


def _order(keypoints: Keypoints, entry: Entry) -> Keypoints:
    order = tuple(int(i) for i in entry["ids"])
    if len(set(order)) != len(order) or not set(order) <= set(keypoints.ids):
        raise ValueError(f"{order} is no order of {keypoints.ids}")
    return dataclasses.replace(keypoints, order=order)


def _move(keypoints: Keypoints, entry: Entry) -> Keypoints:
    position, quat_xyzw = _row(entry["position"], 3), _row(entry["quat_xyzw"], 4)
    return keypoints.with_row(int(entry["id"]), positions=position, quat_xyzw=quat_xyzw)


def _insert(keypoints: Keypoints, entry: Entry) -> Keypoints:
    identity, at = int(entry["id"]), int(entry["at"])
    if identity != keypoints.next_id or not 0 <= at <= len(keypoints.order):
        raise ValueError(f"keypoint {identity} cannot be the new one at {at}")
    more = keypoints.with_keypoint(_row(entry["position"], 3), _row(entry["quat_xyzw"], 4))
    return dataclasses.replace(more, order=(*keypoints.order[:at], identity, *keypoints.order[at:]))


def _delete(keypoints: Keypoints, entry: Entry) -> Keypoints:
    return keypoints.without(int(entry["id"]))


def _lock(keypoints: Keypoints, entry: Entry) -> Keypoints:
    one = {keypoints.ids[keypoints.ids.index(int(entry["id"]))]}
    return dataclasses.replace(keypoints, locked=keypoints.locked | one if entry["locked"] else keypoints.locked - one)


def _ends(keypoints: Keypoints, entry: Entry) -> Keypoints:
    start, end = int(entry["start"]), int(entry["end"])
    if not {start, end} <= {-1, *keypoints.ids} or start == end >= 0:
        raise ValueError(f"{start} and {end} are no ends of {keypoints.ids}")
    return dataclasses.replace(_order(keypoints, entry), start=start, end=end)


def _dwell(keypoints: Keypoints, entry: Entry) -> Keypoints:
    dwell = entry["dwell_s"]
    return keypoints.with_row(int(entry["id"]), dwell_s=nothing() if dwell is None else rows([dwell], 1)[0, 0])


def _look_at(keypoints: Keypoints, entry: Entry) -> Keypoints:
    point = entry["point"]
    return keypoints.with_row(int(entry["id"]), look_at=nothing(3) if point is None else _row(point, 3))


def _row(values: Any, width: int) -> NDArray[np.float64]:
    return rows([values], width)[0]


def _plain(values: ArrayLike) -> Any:
    return np.asarray(values, float).tolist()


_Change = Callable[[Keypoints, Entry], Keypoints]

_PLANNED: dict[str, _Change] = {"suggested": _suggested, "opened": _opened, "order": _order}

EDITS: dict[str, _Change] = {
    "move": _move,
    "insert": _insert,
    "delete": _delete,
    "reorder": _order,
    "lock": _lock,
    "ends": _ends,
    "dwell": _dwell,
    "look_at": _look_at,
}
"""What a user does, and can take back."""
