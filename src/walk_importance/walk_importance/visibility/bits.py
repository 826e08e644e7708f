# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A grid of booleans as one string of bits, in which a step from voxel to voxel is a shift by a constant.

The grid gets one row, column and layer of obstacles behind it. A line that leaves the grid steps by one voxel at a
time, so its first voxel outside is one of these (a step below 0 lands in the padding of the row before), and what
the line meets after that no longer matters.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class BitLayout:
    """Where each voxel of a grid lies in the string of bits.

    Attributes:
        order: The grid's axes from the fastest to the slowest: the shortest is the slowest, so that a layer of the
            two others is a long stretch of the string, of which a displacement along the second leaves one piece.
        shape: (3,) voxels along those axes.
        strides: (3,) bits from voxel to voxel along those axes.
        front: Bits before voxel 0, a multiple of 64, more than any line steps back.
        words: 64-bit words that hold all voxels.
    """

    order: tuple[int, int, int]
    shape: tuple[int, int, int]
    strides: tuple[int, int, int]
    front: int
    words: int

    @staticmethod
    def of(shape: tuple[int, int, int]) -> BitLayout:
        """Returns the layout of a grid of `shape` (nx, ny, nz)."""
        k, i, j = sorted(range(3), key=lambda axis: shape[axis])
        nx, ny, nz = shape[i], shape[j], shape[k]
        strides = (1, nx + 1, (nx + 1) * (ny + 1))
        slab = -(-(strides[2] + nx + 2) // 64) * 64
        return BitLayout(
            order=(i, j, k), shape=(nx, ny, nz), strides=strides, front=slab, words=-(-(strides[2] * nz) // 64)
        )

    def pack(self, grid: NDArray[np.bool_]) -> NDArray[np.uint8]:
        """Returns (8, B) uint8: copy s is the string shifted down by s bits, so that any bit can start a byte."""
        nx, ny, nz = self.shape
        padded = np.zeros((nz, ny + 1, nx + 1), bool)
        padded[:, :ny, :nx] = np.transpose(grid, self.order[::-1])
        # As much behind as in front, plus a word for the reads that run over the end.
        size = self.front + 64 * self.words + self.front + 128
        copies = np.zeros((8, size // 8), np.uint8)
        bits = np.packbits(padded.reshape(-1), bitorder="little")
        copies[0, self.front // 8 : self.front // 8 + len(bits)] = bits
        for s in range(1, 8):
            copies[s] = copies[0] >> s
            copies[s, :-1] |= copies[0, 1:] << (8 - s)
        return copies

    def pack_chains(self, grid: NDArray[np.bool_]) -> NDArray[np.uint8]:
        """Returns (4, 8, B) uint8: the grid, and the grid ANDed with its neighbours along each axis, as by `pack`.

        A line of sight steps from voxel to neighbour: asking for two at once halves the work.
        """
        chains = [self.pack(grid)]
        for axis in self.order:
            both = np.zeros_like(grid)
            here, there = np.moveaxis(grid, axis, 0)[:-1], np.moveaxis(grid, axis, 0)[1:]
            np.moveaxis(both, axis, 0)[:-1] = here & there
            chains.append(self.pack(both))
        return np.stack(chains)

    def unpack(self, counts: NDArray[Any]) -> NDArray[Any]:
        """Returns the numbers of (64 words,) bits as a grid (nx, ny, nz)."""
        nx, ny, nz = self.shape
        padded = counts[: nz * self.strides[2]].reshape(nz, ny + 1, nx + 1)
        values = padded[:, :ny, :nx]
        return np.ascontiguousarray(np.transpose(values, np.argsort(self.order[::-1])))
