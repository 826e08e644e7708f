# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Orders of an open tour. A method is one file here and one line in `ORDERS`.

A method takes the costs (n, n) from row to column, finite and not negative, which need not be symmetric; the index
to start at and the index to end at, -1 where free; the config, for its own settings; and `before` (n, n), true where
the row must come somewhere before the column, with all that follows from it. It returns a permutation (n,) of the
indices. That an order exists is checked before; stretches that stay together have become one index.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import ParameterError
from walk_sequencer.config import SequencerConfig
from walk_sequencer.order.exact import MAX_EXACT, order_exact
from walk_sequencer.order.given import order_given
from walk_sequencer.order.local_search import order_local_search
from walk_sequencer.order.mst_dfs import order_mst_dfs
from walk_sequencer.rules import FREE, Rules, conflict

Order = Callable[[NDArray[np.float64], int, int, SequencerConfig, NDArray[np.bool_]], NDArray[np.int64]]

ORDERS: dict[str, Order] = {
    "exact": order_exact,
    "local_search": order_local_search,
    "mst_dfs": order_mst_dfs,
    "given": order_given,
}


def find_order(
    costs: NDArray[np.float64], start: int, end: int, config: SequencerConfig, rules: Rules = FREE
) -> NDArray[np.int64]:
    """Returns an order (n,) by the config's method that keeps the ends and the rules.

    Each stretch is searched as one index that is entered at its first keypoint and left at its last.

    Args:
        costs: (n, n) from row to column, finite, not negative; need not be symmetric.
        start: Row to start at, -1 where free.
        end: Row to end at, -1 where free.
        config: The method and its settings.
        rules: By rows of the costs.

    Raises:
        ParameterError: No order keeps the ends and the rules, or there are too many keypoints for the method.
    """
    problem = conflict(rules, start, end)
    if problem:
        before, together = rules.texts()
        raise ParameterError(
            "before and together", f"{before}; {together}", f"rules that an order can keep, not {problem}"
        )
    head, follower = np.arange(len(costs)), dict(rules.links)
    for stretch in rules.stretches:
        head[list(stretch)] = stretch[0]
    firsts = np.unique(head)
    blocks = [_stretch(k, follower) for k in firsts.tolist()]
    block = np.searchsorted(firsts, head)
    pairs = Rules(before=tuple((int(block[a]), int(block[b])) for a, b in rules.before if block[a] != block[b]))
    before_matrix = np.zeros((len(blocks), len(blocks)), bool)
    for a, b in pairs.implied():
        before_matrix[a, b] = True
    lasts = np.array([members[-1] for members in blocks], dtype=np.int64)
    first, last = (int(block[k]) if k >= 0 else -1 for k in (start, end))
    method = ORDERS[resolve_method(config.method, len(blocks))]
    order = method(costs[np.ix_(lasts, firsts)], first, last, config, before_matrix)
    return np.array([k for at in order.tolist() for k in blocks[at]], dtype=np.int64)


def resolve_method(method: str, n: int) -> str:
    """Returns the method that "auto" stands for with n keypoints; any other name as it is."""
    if method != "auto":
        return method
    return "exact" if n <= MAX_EXACT else "local_search"


def order_cost(costs: NDArray[np.float64], order: NDArray[np.int64]) -> float:
    """Returns the cost of walking through `order` once."""
    return float(costs[order[:-1], order[1:]].sum())


def _stretch(first: int, follower: dict[int, int]) -> list[int]:
    members = [first]
    while members[-1] in follower:
        members.append(follower[members[-1]])
    return members
