# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Orders of an open tour. A method is one file here and one line in `ORDERS`.

A method takes the costs (n, n) from row to column, finite and not negative, which need not be symmetric; the index
to start at and the index to end at, -1 where free; and the config, for its own settings. It returns a permutation
(n,) of the indices.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from walk_sequencer.config import SequencerConfig
from walk_sequencer.order.exact import MAX_EXACT, order_exact
from walk_sequencer.order.given import order_given
from walk_sequencer.order.local_search import order_local_search
from walk_sequencer.order.mst_dfs import order_mst_dfs

Order = Callable[[NDArray[np.float64], int, int, SequencerConfig], NDArray[np.int64]]

ORDERS: dict[str, Order] = {
    "exact": order_exact,
    "local_search": order_local_search,
    "mst_dfs": order_mst_dfs,
    "given": order_given,
}


def resolve_method(method: str, n: int) -> str:
    """Returns the method that "auto" stands for with n keypoints; any other name as it is."""
    if method != "auto":
        return method
    return "exact" if n <= MAX_EXACT else "local_search"


def order_cost(costs: NDArray[np.float64], order: NDArray[np.int64]) -> float:
    """Returns the cost of walking through `order` once."""
    return float(costs[order[:-1], order[1:]].sum())
