# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Progressive visibility: sampled displacements, each serving all voxels, published at every doubling (our own)."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from walk_importance.visibility.counter import PairCounter
from walk_importance.visibility.estimate import Scene, VisibilityEstimate, estimate
from walk_importance.visibility.sampling import Shell, shells

_FIRST = 512  # displacements of the first map, fewer on a grid so large that it would take over a second
_FIRST_VOXELS = 1_000_000_000  # displacements times voxels of the first map at most
_PIECE = 1 << 18


def progressive_visibility(scene: Scene) -> Iterator[VisibilityEstimate]:
    """Yields maps of doubling effort, the last of them exact.

    With C seen among the k displacements drawn from the D of a shell, a voxel sees about C D / k voxels in that
    shell. Draws go to the shells in proportion to D sqrt(p (1 - p)), p the share seen there so far (Neyman's
    allocation). The standard error takes the draws for independent; they are spread more evenly than that, so
    it errs on the safe side.
    """
    counter = PairCounter(scene)
    parts = shells(counter.layout.shape, scene.seed)
    counts = [counter.new_counts() for _ in parts]
    total = sum(shell.total for shell in parts)
    inside = _flat_mask(scene, counter)
    pull = np.array([float(shell.total) ** 0.5 for shell in parts])
    budget = int(np.clip(_FIRST_VOXELS / scene.grid.size, 64, _FIRST))
    pairs = float(scene.targets.sum()) * (float(scene.targets.sum()) - 1) / 2
    while True:
        for shell, count, wanted in zip(parts, counts, _shares(parts, pull, budget), strict=True):
            counter.add(shell.draw(wanted - shell.drawn), count)
        seen, variance, pull = _combine(parts, counts, inside)
        drawn = sum(shell.drawn for shell in parts)
        done = drawn / total if total else 1.0
        seen = counter.layout.unpack(seen)
        yield estimate(scene, seen, variance, done, pairs * done)
        if drawn >= total:
            return
        budget = 2 * drawn


def _shares(parts: list[Shell], pull: NDArray[np.float64], budget: int) -> list[int]:
    """Parts `budget` draws among the shells by their pull; what a shell cannot take goes to the others."""
    have = np.array([shell.drawn for shell in parts])
    room = np.array([shell.total for shell in parts])
    wanted = have.copy()
    for _ in range(len(parts) + 1):
        open_ = wanted < room
        left = budget - wanted.sum()
        if left <= 0 or not open_.any():
            break
        # A shell that was ahead of its share keeps what it has; the rest is parted among those behind.
        aim = pull * open_ / max((pull * open_).sum(), 1e-300) * (left + wanted[open_].sum())
        step = np.maximum(np.ceil(aim).astype(np.int64) - wanted, 0) * open_
        scale = min(1.0, left / max(step.sum(), 1))
        wanted = np.minimum(wanted + np.ceil(step * scale).astype(np.int64), room)
    return [int(w) for w in wanted]


def _combine(
    parts: list[Shell], counts: list[NDArray[np.int32]], inside: NDArray[np.bool_]
) -> tuple[NDArray[np.float32], float, NDArray[np.float64]]:
    """Returns the numbers seen, their mean variance over the sources, and each shell's pull on further draws."""
    seen = np.zeros(len(inside), np.float32)
    scatter = np.zeros(len(parts))
    # Piece by piece, because the float64 in between would be the largest thing in memory.
    for first in range(0, len(inside), _PIECE):
        piece = slice(first, first + _PIECE)
        for i, (shell, count) in enumerate(zip(parts, counts, strict=True)):
            k = max(shell.drawn, 1)
            seen[piece] += count[piece] * (shell.total / k)
            p = count[piece][inside[piece]] * (0.5 / k)
            scatter[i] += (p * (1 - p)).sum()
    drawn = np.maximum([shell.drawn for shell in parts], 1)
    total = np.array([shell.total for shell in parts], dtype=float)
    # One more success and failure each keep a shell in which nothing was seen yet from being given up.
    scatter = scatter / max(inside.sum(), 1) + 1.0 / (2 * drawn + 2) ** 2
    variance = float(np.sum(2.0 * total**2 / drawn * (1 - drawn / total) * scatter))
    return seen, variance, total * np.sqrt(scatter)


def _flat_mask(scene: Scene, counter: PairCounter) -> NDArray[np.bool_]:
    """The sources in the order of the counts."""
    bits = counter.layout.pack(scene.sources)[0]
    first = counter.layout.front // 8
    flat = np.unpackbits(bits[first : first + 8 * counter.layout.words], bitorder="little")
    return flat.astype(bool)
