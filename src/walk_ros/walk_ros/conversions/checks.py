# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Checks that every incoming message passes before anything of it is used."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_ros.errors import MessageError

FRAME = "map"
"""The one fixed frame of the project (REP-105)."""

QUAT_TOLERANCE = 1e-3
"""How far a quaternion's norm may be from 1: what float32 and a headset's rounding leave, with room."""


def require(condition: bool, kind: str, reason: str) -> None:
    """Raises MessageError with the reason unless the condition holds."""
    if not condition:
        raise MessageError(kind, reason)


def check_frame(kind: str, frame_id: str) -> None:
    """Raises MessageError unless the frame is the fixed frame of the project."""
    require(frame_id == FRAME, kind, f"frame is {frame_id!r}; expected {FRAME!r}")


def finite_array(kind: str, name: str, values: Any, width: int) -> NDArray[np.float64]:
    """Returns the values as a read-only (N, width) float64 array; raises MessageError if one is not finite."""
    array = np.asarray(values, dtype=np.float64).reshape(-1, width)
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    require(bad.size == 0, kind, f"{name} {bad[0] if bad.size else 0} is not finite; expected numbers")
    array.flags.writeable = False
    return array


def unit_quaternions(kind: str, values: Any) -> NDArray[np.float64]:
    """Returns (N, 4) read-only xyzw quaternions of norm exactly 1; raises MessageError if one is far from it."""
    quat = np.array(values, dtype=np.float64).reshape(-1, 4)
    # Norms of huge or non-finite components are reported below, not as floating-point warnings.
    with np.errstate(over="ignore", invalid="ignore"):
        norm = np.linalg.norm(quat, axis=1)
        off = np.flatnonzero(~(np.abs(norm - 1.0) <= QUAT_TOLERANCE))
    if off.size:
        raise MessageError(kind, f"orientation {off[0]} has norm {norm[off[0]]:g}; expected 1")
    # A quaternion this close is left alone, so that what was sent is what arrives.
    rough = np.abs(norm - 1.0) > 1e-12
    quat[rough] /= norm[rough, None]
    quat.flags.writeable = False
    return quat


def same_length(kind: str, **lengths: int) -> None:
    """Raises MessageError unless all the named lengths agree."""
    if len(set(lengths.values())) > 1:
        text = ", ".join(f"{n} {name}" for name, n in lengths.items())
        raise MessageError(kind, f"sizes do not agree: {text}")


def read_only(values: Any, dtype: Any, shape: Sequence[int]) -> NDArray[Any]:
    """Returns a read-only copy of the values in the shape."""
    array = np.array(values, dtype=dtype).reshape(shape)
    array.flags.writeable = False
    return array
