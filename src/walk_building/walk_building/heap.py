# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A binary heap on two arrays, keys and items: numba's own lists are slower."""

from __future__ import annotations

import numba


@numba.njit(cache=True, nogil=True)
def push(keys, items, size, key, item):
    """Adds an entry to a heap of `size` entries."""
    k = size
    while k > 0 and keys[(k - 1) >> 1] > key:
        keys[k], items[k] = keys[(k - 1) >> 1], items[(k - 1) >> 1]
        k = (k - 1) >> 1
    keys[k], items[k] = key, item


@numba.njit(cache=True, nogil=True)
def pop(keys, items, size):
    """Takes the first of `size` entries off the heap; the caller has read it."""
    key, item = keys[size - 1], items[size - 1]
    k, last = 0, size - 1
    while 2 * k + 1 < last:
        child = 2 * k + 1
        if child + 1 < last and keys[child + 1] < keys[child]:
            child += 1
        if keys[child] >= key:
            break
        keys[k], items[k] = keys[child], items[child]
        k = child
    keys[k], items[k] = key, item
