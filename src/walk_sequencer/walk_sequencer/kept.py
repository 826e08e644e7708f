# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""An earlier value of the keypoints, kept as what it has that a neighbouring value lacks."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_sequencer.keypoints import ROWS, Keypoints, nothing

_NONE = Keypoints()


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Kept:
    """One value beside another: half a kilobyte for a move among 100 keypoints, where the value itself has six.

    Attributes:
        rest: The value without its arrays.
        rows: By name of the array, the rows that differ: which they are, and what is in them.
    """

    rest: Keypoints
    rows: dict[str, tuple[NDArray[np.int64], NDArray[np.float64]]]

    @classmethod
    def of(cls, value: Keypoints, beside: Keypoints) -> Kept:
        """Returns what `restored` needs, beside the other value, to make the value again bit for bit."""
        source = _sources(value, beside)
        rows = {}
        for name in ROWS:
            own, other = getattr(value, name), getattr(beside, name)
            if own is not other:
                differs = source < 0
                differs[~differs] = _differ(own[~differs], other[source[~differs]])
                rows[name] = np.flatnonzero(differs), own[differs]
        empty: dict[str, Any] = {name: getattr(_NONE, name) for name in ROWS}
        return cls(rest=dataclasses.replace(value, **empty), rows=rows)

    def restored(self, beside: Keypoints) -> Keypoints:
        """Returns the value; the other one must have the arrays it had when this was kept."""
        source = _sources(self.rest, beside)
        arrays: dict[str, Any] = {}
        for name in ROWS:
            other = getattr(beside, name)
            if name not in self.rows:
                arrays[name] = other
                continue
            array = nothing(len(source), *other.shape[1:]).copy()
            array[source >= 0] = other[source[source >= 0]]
            at, own = self.rows[name]
            array[at] = own
            array.setflags(write=False)
            arrays[name] = array
        return dataclasses.replace(self.rest, **arrays)


def _sources(value: Keypoints, beside: Keypoints) -> NDArray[np.int64]:
    """Returns the row that each keypoint of a value has in the other one, -1 where it has none."""
    if value.ids is beside.ids:
        return np.arange(len(value.ids))
    row_of = {identity: row for row, identity in enumerate(beside.ids)}
    return np.array([row_of.get(identity, -1) for identity in value.ids], dtype=np.int64)


def _differ(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Returns which rows differ in any bit: nan is what nobody has laid down, and equals itself."""
    bits = np.ascontiguousarray(a).view(np.uint64) != np.ascontiguousarray(b).view(np.uint64)
    return np.asarray(bits.reshape(len(a), -1).any(axis=1))
