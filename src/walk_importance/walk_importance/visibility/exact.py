# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Exact visibility: every pair of voxels, by every displacement there is."""

from __future__ import annotations

from collections.abc import Iterator

import numba
import numpy as np
from numpy.typing import NDArray

from walk_importance.visibility.counter import PairCounter
from walk_importance.visibility.estimate import Scene, VisibilityEstimate, estimate
from walk_importance.visibility.sweep import CAPACITY

_STEPS = 64  # how often progress is told


def exact_visibility(scene: Scene) -> Iterator[VisibilityEstimate]:
    """Yields the visibility map once; see `VisibilityEstimate`.

    Two voxels see each other when all voxels that the segment between their centres touches are free.
    """
    counter = PairCounter(scene)
    counts = counter.new_counts()
    total = half_space(counter.layout.shape)
    step = max(total // _STEPS, 2 * CAPACITY * counter.threads)
    for first in range(0, total, step):
        displacements = nth_displacements(first, min(first + step, total), np.array(counter.layout.shape))
        counter.add(displacements, counts)
    n = float(scene.targets.sum())
    yield estimate(scene, counter.layout.unpack(counts).astype(np.float32), 0.0, 1.0, n * (n - 1) / 2)


def half_space(shape: tuple[int, int, int]) -> int:
    """Returns the number of displacements within a grid of `shape`, each and its reverse counted once."""
    nx, ny, nz = shape
    return ((2 * nx - 1) * (2 * ny - 1) * (2 * nz - 1) - 1) // 2


@numba.njit(cache=True, nogil=True)
def nth_displacements(begin: int, end: int, shape: NDArray[np.int64]) -> NDArray[np.int64]:
    """Returns displacements number begin .. end - 1 of the half space, (end - begin, 3) int64."""
    wide, deep = 2 * shape[0] - 1, 2 * shape[1] - 1
    middle = (wide * deep * (2 * shape[2] - 1) - 1) // 2
    found = np.empty((end - begin, 3), np.int64)
    for i in range(begin, end):
        k = middle + 1 + i
        found[i - begin, 0] = k % wide - (shape[0] - 1)
        found[i - begin, 1] = k // wide % deep - (shape[1] - 1)
        found[i - begin, 2] = k // (wide * deep) - (shape[2] - 1)
    return found
