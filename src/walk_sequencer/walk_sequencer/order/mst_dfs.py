# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The order of the source: walk around a minimum spanning tree."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from walk_sequencer.config import SequencerConfig
from walk_sequencer.order.given import waiting


def order_mst_dfs(
    costs: NDArray[np.float64],
    start: int,
    end: int,
    config: SequencerConfig,  # noqa: ARG001  the signature of all orders
    before: NDArray[np.bool_],
) -> NDArray[np.int64]:
    """Returns the tree's vertices depth first (`schmidiger`), for comparison.

    Where the costs are a metric the order costs at most twice the optimum. The nearest child goes first. A chosen
    end goes last, after the subtree it is in; a free start is index 0, or the next that may be one. Costs that are not
    symmetric count with the smaller direction in the tree. What must come later waits (our own).
    """
    n = len(costs)
    if n < 2:
        return np.arange(n)
    # A free start is the first index that may be the first.
    free = (k for k in range(n) if k != end and not before[:, k].any())
    root = start if start >= 0 else next(free)
    parent, joined = _prim(np.minimum(costs, costs.T), root)
    holds_end, k = set(), end
    while k >= 0:
        holds_end.add(k)
        k = int(parent[k])
    order: list[int] = []
    stack = [root]
    while stack:
        at = stack.pop()
        order.append(at)
        children = [k for k in joined if parent[k] == at]
        # Taken from the stack's end: the child towards the tour's end lies deepest, then the farthest.
        stack += sorted(children, key=lambda k: (k not in holds_end, -costs[at, k]))
    if end >= 0:
        order.remove(end)
        order.append(end)
    return waiting(order, before)


def _prim(costs: NDArray[np.float64], root: int) -> tuple[NDArray[np.int64], list[int]]:
    """Returns each vertex's parent in the minimum spanning tree, -1 for the root, and the order they were joined."""
    n = len(costs)
    parent = np.full(n, root)
    parent[root] = -1
    nearest = costs[root].copy()
    nearest[root] = np.inf
    joined = [root]
    for _ in range(n - 1):
        k = int(np.argmin(nearest))
        joined.append(k)
        outside = np.isfinite(nearest)
        outside[k] = False
        closer = outside & (costs[k] < nearest)
        parent[closer] = k
        nearest[closer] = costs[k, closer]
        nearest[k] = np.inf
    return parent, joined
