# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The best order, by dynamic programming over subsets."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from walk_building.errors import ParameterError
from walk_sequencer.config import SequencerConfig

MAX_EXACT = 16  # the table has 2^n n entries, and the time grows likewise: 11 to 20 ms here, seconds at 22


def order_exact(
    costs: NDArray[np.float64],
    start: int,
    end: int,
    config: SequencerConfig,  # noqa: ARG001  the signature of all orders
    before: NDArray[np.bool_],
) -> NDArray[np.int64]:
    """Returns an order of least cost (`held1962`), in O(2^n n^2); what must come later is added later.

    Raises:
        ParameterError: For more than `MAX_EXACT` indices.
    """
    if len(costs) > MAX_EXACT:
        raise ParameterError("method", "exact", f"local_search for {len(costs)} keypoints; exact takes {MAX_EXACT}")
    if len(costs) < 2:
        return np.arange(len(costs))
    waits_for = before.T @ (1 << np.arange(len(costs)))
    order: NDArray[np.int64] = _held_karp(np.ascontiguousarray(costs, dtype=np.float64), start, end, waits_for)
    return order


@numba.njit(cache=True, nogil=True)
def _held_karp(costs, start, end, waits_for):
    n = len(costs)
    best = np.full((1 << n, n), np.inf)
    before = np.full((1 << n, n), -1, dtype=np.int8)
    inside, next_ones = np.empty(n, np.int64), np.empty(n, np.int64)
    for k in range(n):
        if (start < 0 or k == start) and waits_for[k] == 0:
            best[1 << k, k] = 0.0
    for seen in range(1, 1 << n):
        size, count = 0, 0
        for k in range(n):
            if seen & (1 << k):
                inside[size] = k
                size += 1
            elif waits_for[k] & ~seen == 0:
                next_ones[count] = k
                count += 1
        for last in inside[:size]:
            here = best[seen, last]
            if here == np.inf:
                continue
            for k in next_ones[:count]:
                cost = here + costs[last, k]
                if cost < best[seen | (1 << k), k]:
                    best[seen | (1 << k), k] = cost
                    before[seen | (1 << k), k] = last
    seen = (1 << n) - 1
    last = end if end >= 0 else int(np.argmin(best[seen]))
    order = np.empty(n, dtype=np.int64)
    for at in range(n - 1, -1, -1):
        order[at] = last
        previous = before[seen, last]
        seen ^= 1 << last
        last = previous
    return order
