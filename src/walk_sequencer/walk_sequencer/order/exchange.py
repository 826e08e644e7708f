# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Two neighbouring stretches exchanged, neither turned: the change that rules, and costs one way, allow most often.

It is the 3-exchange of `or1976` and `gambardella2000`: with costs[a, b] from row to column, three steps change whatever
the stretches' lengths. Compiled, on closed tours that begin with vertex 0; `costs`, `early` and `tour` are those of the
descent.
"""

from __future__ import annotations

import numba
import numpy as np


@numba.njit(cache=True, nogil=True)
def best_exchange(costs, tour, place, u, v):
    """Returns (more, a, b, c): exchanging tour[a..b) and tour[b..c) puts v right behind u for the least more cost.

    Args:
        costs: (n, n).
        tour: (n,).
        place: (n,) where each vertex is in it.
        u: A vertex.
        v: Another, not 0 and not the one behind u.
    """
    n, i, j = len(tour), place[u], place[v]
    least, cut = np.inf, -1
    if j > i:
        first, last = tour[i + 1], tour[j - 1]
        gap = costs[u, v] - costs[u, first] - costs[last, v]
        for c in range(j + 1, n + 1):
            ahead = tour[c] if c < n else 0
            more = gap + costs[tour[c - 1], first] + costs[last, ahead] - costs[tour[c - 1], ahead]
            if more < least:
                least, cut = more, c
        return least, i + 1, j, cut
    ahead, behind = tour[i + 1] if i + 1 < n else 0, tour[j - 1]
    gap = costs[u, v] - costs[behind, v] - costs[u, ahead]
    for b in range(j + 1, i + 1):
        more = gap + costs[behind, tour[b]] + costs[tour[b - 1], ahead] - costs[tour[b - 1], tour[b]]
        if more < least:
            least, cut = more, b
    return least, j, cut, i + 1


@numba.njit(cache=True, nogil=True)
def keeps_rules(early, tour, a, b, c):
    """Returns whether nothing in tour[a..b) must come before anything in tour[b..c)."""
    for x in range(a, b):
        for y in range(b, c):
            if early[tour[x], tour[y]]:
                return False
    return True


@numba.njit(cache=True, nogil=True)
def exchange(tour, place, a, b, c, room):
    """Exchanges tour[a..b) and tour[b..c); `room` (n,) is written over."""
    room[: c - b] = tour[b:c]
    for x in range(b - 1, a - 1, -1):
        tour[x + c - b] = tour[x]
    tour[a : a + c - b] = room[: c - b]
    for x in range(a, c):
        place[tour[x]] = x
