# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The user's own order."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_sequencer.config import SequencerConfig


def order_given(
    costs: NDArray[np.float64],
    start: int,
    end: int,
    config: SequencerConfig,  # noqa: ARG001  the signature of all orders
    before: NDArray[np.bool_],
) -> NDArray[np.int64]:
    """Returns the indices as they come, but for a chosen start, a chosen end, and those that wait for another."""
    inner = [k for k in range(len(costs)) if k not in (start, end)]
    first = [start] if start >= 0 else []
    last = [end] if end >= 0 else []
    return waiting(first + inner + last, before)


def waiting(wished: list[int], before: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Returns the indices as wished, but that each waits until all that must come before it are there."""
    left, order = list(wished), []
    while left:
        at = next(at for at, k in enumerate(left) if not before[left, k].any())
        order.append(left.pop(at))
    return np.array(order, dtype=np.int64)
