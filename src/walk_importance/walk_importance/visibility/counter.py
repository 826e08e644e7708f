# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Runs the sweep over displacements on all cores and keeps the counts."""

from __future__ import annotations

import os
import queue
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from numpy.typing import NDArray

from walk_importance.visibility.bits import BitLayout
from walk_importance.visibility.estimate import Scene
from walk_importance.visibility.sweep import CAPACITY, PLANES, flush, sweep

_SMALL = 4_000_000  # voxels; up to here every core takes part, above as many as keep the memory in bounds
_SCRATCH_BYTES = 6  # per voxel that all threads together may then use for their counters
_THREAD_BYTES = (5 * 2 + PLANES) / 8


class PairCounter:
    """Counts who sees whom along displacements.

    Attributes:
        layout: Of the string of bits; displacements are along its axes.
    """

    def __init__(self, scene: Scene) -> None:
        self.layout = BitLayout.of(scene.grid.shape)
        self._chains = self.layout.pack_chains(scene.free)
        none = np.zeros((8, 0), np.uint8)
        whole = scene.targets is scene.free
        self._targets = none if whole else self.layout.pack(scene.targets)
        self._sources = none if scene.sources is scene.targets else self.layout.pack(scene.sources)
        cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        small = scene.grid.size <= _SMALL
        self.threads = cores if small else max(1, min(cores, int(_SCRATCH_BYTES / _THREAD_BYTES)))
        self._scratch: queue.SimpleQueue[tuple[NDArray[np.uint64], NDArray[np.uint64]]] = queue.SimpleQueue()
        for _ in range(self.threads):
            words = self.layout.words
            self._scratch.put((np.zeros((5, 2 * words), np.uint64), np.zeros((PLANES, words), np.uint64)))
        self._lock = threading.Lock()

    def new_counts(self) -> NDArray[np.int32]:
        """Returns an empty count of every bit of the layout."""
        return np.zeros(64 * self.layout.words, np.int32)

    def add(self, displacements: NDArray[np.int64], counts: NDArray[np.int32]) -> None:
        """Adds to `counts`, at both ends, the pairs that see each other along `displacements` (D, 3)."""
        # A few chunks for each thread even out their load; a chunk may not overrun the counters.
        size = int(np.clip(len(displacements) // (3 * self.threads) + 1, 64, CAPACITY))
        chunks = [displacements[i : i + size] for i in range(0, len(displacements), size)]
        if len(chunks) <= 1 or self.threads == 1:
            for chunk in chunks:
                self._sweep(chunk, counts)
            return
        with ThreadPoolExecutor(self.threads) as pool:
            list(pool.map(lambda chunk: self._sweep(chunk, counts), chunks))

    def _sweep(self, chunk: NDArray[np.int64], counts: NDArray[np.int32]) -> None:
        results, planes = self._scratch.get()
        try:
            layout = self.layout
            strides, reach = np.array(layout.strides), np.array(layout.shape)
            args = (strides, layout.front, layout.words, reach, results, planes)
            sweep(chunk, self._chains, self._targets, self._sources, *args)
            with self._lock:
                flush(planes, counts)
        finally:
            self._scratch.put((results, planes))
