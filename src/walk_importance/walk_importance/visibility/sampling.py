# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The order in which displacements are sampled: without replacement, every prefix spread evenly.

Displacements are parted into shells by their largest component. Within a shell they come in the order of an octree
whose digits are reversed, so the first eight fall into eight octants, the first 64 into 64 sub-octants and so on,
and shuffled at every node (`owen1995`), so that each displacement is equally likely to be among the first k.
"""

from __future__ import annotations

import itertools

import numba
import numpy as np
from numpy.typing import NDArray

_SHELLS = 4  # each half as wide as the next: the near ones, which rooms are made of, get their share of samples
_SMALLEST = 4  # voxels; below it a shell is complete after a few hundred displacements anyway


class Shell:
    """The displacements whose largest component is in (inner, outer], half of them, in their sampling order."""

    def __init__(self, shape: tuple[int, int, int], inner: int, outer: int, seed: int) -> None:
        limit = np.array(shape) - 1
        self._reach = np.minimum(limit, outer).astype(np.int64)
        self._inner = inner
        self._seed = seed
        self._bits = np.array([int(2 * r).bit_length() for r in self._reach], dtype=np.int64)
        self._cursor = 0
        inside = np.minimum(limit, inner)
        self.total = int(np.prod(2 * self._reach + 1) - np.prod(2 * inside + 1)) // 2
        self.drawn = 0

    def draw(self, wanted: int) -> NDArray[np.int64]:
        """Returns the next displacements (D, 3), D = `wanted` or what is left."""
        wanted = min(wanted, self.total - self.drawn)
        found, self._cursor = _draw(self._cursor, wanted, self._reach, self._inner, self._bits, self._seed)
        self.drawn += wanted
        return found


def shells(shape: tuple[int, int, int], seed: int) -> list[Shell]:
    """Returns the shells that hold every displacement within a grid of `shape`, nearest first."""
    outer = max(shape) - 1
    edges = [outer]
    while len(edges) < _SHELLS and edges[-1] // 2 >= _SMALLEST:
        edges.append(edges[-1] // 2)
    edges = [0, *edges[::-1]]
    found = [Shell(shape, a, b, seed + 7919 * i) for i, (a, b) in enumerate(itertools.pairwise(edges))]
    return [shell for shell in found if shell.total > 0]


@numba.njit(cache=True, nogil=True)
def _draw(cursor, wanted, reach, inner, bits, seed):
    found = np.empty((wanted, 3), np.int64)
    levels = max(bits[0], bits[1], bits[2])
    n = 0
    while n < wanted:
        rest = cursor
        cursor += 1
        node = np.uint64(seed) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(1)
        x, y, z = 0, 0, 0
        for level in range(levels):
            shuffle = _mix(node)
            digits = 0
            for axis in range(3):
                # A shorter axis joins at the level where its cells are as long as the others'.
                if levels - level > bits[axis]:
                    continue
                digit = (rest & 1) ^ (np.int64(shuffle >> np.uint64(axis)) & 1)
                rest >>= 1
                digits |= digit << axis
                if axis == 0:
                    x = 2 * x + digit
                elif axis == 1:
                    y = 2 * y + digit
                else:
                    z = 2 * z + digit
            node = node * np.uint64(8) + np.uint64(digits) + shuffle
        x, y, z = x - reach[0], y - reach[1], z - reach[2]
        if x > reach[0] or y > reach[1] or z > reach[2] or max(abs(x), abs(y), abs(z)) <= inner:
            continue
        if z < 0 or (z == 0 and (y < 0 or (y == 0 and x < 0))):
            continue
        found[n, 0], found[n, 1], found[n, 2] = x, y, z
        n += 1
    return found, cursor


@numba.njit(cache=True, nogil=True)
def _mix(x):
    """Spreads a number's bits over all 64 (`steele2014`)."""
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))
