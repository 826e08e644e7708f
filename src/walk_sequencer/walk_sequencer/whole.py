# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""All keypoints of a moment as plain data and back: what a saved tour holds, and how a journal begins with one."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import numpy as np

from walk_sequencer.keypoints import Keypoints, nothing, rows


def plain(keypoints: Keypoints) -> dict[str, Any]:
    """Returns the keypoints as plain JSON, in the order of the tour, without what they were suggested as."""
    ordered = keypoints.in_order()
    return {
        "start": ordered.start,
        "end": ordered.end,
        "next_id": ordered.next_id,
        "order": list(ordered.order),
        "keypoints": [_row(ordered, row) for row in range(len(ordered.ids))],
    }


def whole(data: Mapping[str, Any]) -> Keypoints:
    """Returns the keypoints of plain data, as a user's own: no suggestion replaces them.

    Raises:
        KeyError, ValueError, TypeError, AttributeError: The data are none, or contradict each other.
    """
    every = list(data["keypoints"])
    ids = tuple(int(k["id"]) for k in every)
    order, start, end = tuple(int(i) for i in data["order"]), int(data["start"]), int(data["end"])
    if len(set(ids)) != len(ids) or min(ids, default=0) < 0:
        raise ValueError(f"{ids} are no identities: each is a number of its own, from 0 on")
    if len(set(order)) != len(order) or not set(order) <= set(ids):
        raise ValueError(f"{order} is no order of the keypoints {ids}")
    if not {start, end} <= {-1, *ids} or start == end >= 0:
        raise ValueError(f"{start} and {end} are no start and end of {ids}; -1 leaves one free")
    turned = rows([k["quat_xyzw"] for k in every], 4)
    if not np.allclose(np.linalg.norm(turned, axis=1), 1.0, atol=1e-3):
        raise ValueError("a quat_xyzw is not of length 1")
    looked = [nothing(3) if k["look_at"] is None else rows([k["look_at"]], 3)[0] for k in every]
    dwells = [nothing() if k["dwell_s"] is None else rows([k["dwell_s"]], 1)[0, 0] for k in every]
    look_at, dwell_s = np.array(looked, float).reshape(-1, 3), np.array(dwells, float).reshape(-1)
    look_at.setflags(write=False)
    dwell_s.setflags(write=False)
    return Keypoints(
        ids=ids,
        positions=rows([k["position"] for k in every], 3),
        quat_xyzw=turned,
        dwell_s=dwell_s,
        look_at=look_at,
        locked=frozenset(i for i, k in zip(ids, every, strict=True) if bool(k["locked"])),
        start=start,
        end=end,
        order=order,
        edited=True,
        next_id=max(int(data["next_id"]), max(ids, default=-1) + 1),
    )


def without(keypoints: Keypoints, gone: frozenset[int]) -> Keypoints:
    """Returns the keypoints but some, by identity."""
    for identity in sorted(gone):
        keypoints = keypoints.without(identity)
    return dataclasses.replace(keypoints, edited=True)


def _row(keypoints: Keypoints, row: int) -> dict[str, Any]:
    dwell_s, look_at = float(keypoints.dwell_s[row]), keypoints.look_at[row]
    return {
        "id": keypoints.ids[row],
        "position": keypoints.positions[row].tolist(),
        "quat_xyzw": keypoints.quat_xyzw[row].tolist(),
        "locked": keypoints.ids[row] in keypoints.locked,
        "dwell_s": dwell_s if np.isfinite(dwell_s) else None,
        "look_at": look_at.tolist() if np.isfinite(look_at).all() else None,
    }
