# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Counts, for every voxel at once, who sees whom along a list of displacements (our own method).

For a displacement d, bit v of the AND of the free space shifted by every cell of the line 0 -> d says whether v sees
v + d: one AND of a 64-byte vector answers 512 pairs for one cell. Results are added up in vertical counters: plane k
holds bit k of every voxel's count, and four displacements, each counted at both of its ends, go through one tree of
carry-save adders. Nothing is shared between displacements.
"""

from __future__ import annotations

import numba
import numpy as np

from walk_importance.visibility.lines import supercover

PLANES = 12
CAPACITY = (2**PLANES - 1) // 2 // 4 * 4  # displacements the counters can hold; each counts at both ends
_BLOCK = 512  # bytes of the string worked on at a time: small enough to die out early, long enough to run fast


@numba.njit(cache=True, nogil=True)
def sweep(displacements, chains, targets, sources, strides, front, words, reach, results, planes):
    """Adds the pairs seen along `displacements` to the counters.

    Args:
        displacements: (D, 3) int64 along the layout's axes, first non-zero from the slowest axis on positive,
            D <= CAPACITY since the counters were cleared.
        chains: (4, 8, B) uint8 free voxels, see `BitLayout.pack_chains`.
        targets: (8, B) uint8 voxels that both ends of a pair must be among, or (8, 0): all.
        sources: (8, B) uint8 voxels that one end of a pair must be among, or (8, 0): all.
        strides: (3,) int64 of the layout.
        front: Of the layout.
        words: Of the layout.
        reach: (3,) int64 shape of the grid along the layout's axes.
        results: (5, 2 words) uint64, scratch, the first half zero.
        planes: (PLANES, words) uint64 counters.
    """
    flat = chains.reshape(-1)
    size = chains.shape[2]
    cells = np.empty(3 * (reach[0] + reach[1] + reach[2]) + 8, np.int64)
    pieces = np.empty(len(cells), np.int64)
    source = np.empty(len(cells) + 8, np.int64)
    shift = np.zeros(4, np.int64)
    held = 0
    for i in range(len(displacements)):
        dx, dy, dz = displacements[i, 0], displacements[i, 1], displacements[i, 2]
        step = dx * strides[0] + dy * strides[1] + dz * strides[2]
        n_cells = supercover(dx, dy, dz, strides[0], strides[1], strides[2], cells)
        n_pieces = _pair_up(cells, n_cells, strides, front, size, pieces)
        n_source = _spread(pieces, n_pieces, source)
        row = results[held].view(np.uint8)[8 * words :]
        anything = False
        done = 0
        # Layer by layer of the slowest axis, the stretch of it whose rows stay in the grid.
        for layer in range(reach[2] - dz):
            first = (layer * strides[2] + max(0, -dy) * strides[1]) >> 3
            end = ((layer * strides[2] + (reach[1] - max(0, dy)) * strides[1]) >> 3) + 1
            first = max(first, done)
            row[done:first] = 0
            anything |= _see(row[first:end], flat, source[:n_source], targets, sources, front, step, first)
            done = end
        if not anything:
            continue
        row[done:] = 0
        shift[held] = step
        held += 1
        if held == 4:
            _add(results, shift, words, planes)
            held = 0
    if held > 0:
        for j in range(held, 4):
            results[j, words:] = 0
            shift[j] = 0
        _add(results, shift, words, planes)


@numba.njit(cache=True, nogil=True)
def _pair_up(cells, n, strides, front, size, pieces):
    """Turns the cells of a line into places in the flat chains, neighbours two at a time; returns their number."""
    i, m = 0, 0
    while i < n:
        at, chain = cells[i], 0
        if i + 1 < n:
            for axis in range(3):
                if abs(cells[i + 1] - at) == strides[axis]:
                    chain = axis + 1
        if chain > 0:
            at = min(at, cells[i + 1])
            i += 1
        i += 1
        bit = front + at
        pieces[m] = (8 * chain + (bit & 7)) * size + (bit >> 3)
        m += 1
    return m


@numba.njit(cache=True, nogil=True)
def _spread(pieces, n, source):
    """Puts pieces that follow each other far apart; returns their number, filled up to a multiple of 8.

    Neighbours on a line are blocked together; in the order of the golden section the first few pieces already meet
    most walls.
    """
    stride = max(int(n * 0.6180339887), 1)
    while _gcd(stride, n) != 1:
        stride += 1
    k = 0
    for i in range(n):
        source[i] = pieces[k]
        k += stride
        if k >= n:
            k -= n
    full = (n + 7) // 8 * 8
    for i in range(n, full):
        source[i] = source[0]
    return full


@numba.njit(cache=True, nogil=True)
def _gcd(a, b):
    while b:
        a, b = b, a % b
    return a


@numba.njit(cache=True, nogil=True)
def _see(stretch, flat, source, targets, sources, front, step, first):
    """Writes which voxels of a stretch that starts at byte `first` see along one line; returns whether any does."""
    anything = False
    for begin in range(0, len(stretch), _BLOCK):
        block = stretch[begin : begin + _BLOCK]
        block[:] = 255
        alive = True
        if targets.shape[1] > 0:
            alive = _keep(block, targets, front, step, first + begin, True)
        if alive and sources.shape[1] > 0:
            alive = _keep(block, sources, front, step, first + begin, False)
        k = 0
        while alive and k < len(source):
            alive = _and8(block, flat, source[k : k + 8], first + begin) != 0
            k += 8
        if alive:
            anything = True
        else:
            block[:] = 0
    return anything


@numba.njit(cache=True, nogil=True)
def _keep(block, chosen, front, step, begin, both):
    """Leaves only pairs of which both ends, or one at least, are among the chosen; returns whether any is left."""
    at = front + step
    here = chosen[0, (front >> 3) + begin : (front >> 3) + begin + len(block)]
    there = chosen[at & 7, (at >> 3) + begin : (at >> 3) + begin + len(block)]
    alive = np.uint8(0)
    for i in range(len(block)):
        block[i] &= (here[i] & there[i]) if both else (here[i] | there[i])
        alive |= block[i]
    return alive != 0


@numba.njit(cache=True, nogil=True)
def _and8(block, flat, source, begin):
    # Slices with one length let LLVM see contiguous, non-negative indices: 16 to 64 bytes per instruction.
    n = len(block)
    b0 = flat[source[0] + begin : source[0] + begin + n]
    b1 = flat[source[1] + begin : source[1] + begin + n]
    b2 = flat[source[2] + begin : source[2] + begin + n]
    b3 = flat[source[3] + begin : source[3] + begin + n]
    b4 = flat[source[4] + begin : source[4] + begin + n]
    b5 = flat[source[5] + begin : source[5] + begin + n]
    b6 = flat[source[6] + begin : source[6] + begin + n]
    b7 = flat[source[7] + begin : source[7] + begin + n]
    alive = np.uint8(0)
    for i in range(n):
        x = block[i] & b0[i] & b1[i] & b2[i] & b3[i] & b4[i] & b5[i] & b6[i] & b7[i]
        block[i] = x
        alive |= x
    return alive


@numba.njit(cache=True, nogil=True)
def _half(results, j, step, words):
    """Returns the row of one displacement, the same row moved to the other ends of its pairs, and the shift left."""
    here = results[j, words:]
    whole = step >> 6
    return here, results[j, words - whole :], results[j, words - whole - 1 :], np.uint64(step & 63)


@numba.njit(cache=True, nogil=True)
def _full_add(a, b, c):
    u = a ^ b
    return u ^ c, (a & b) | (u & c)


@numba.njit(cache=True, nogil=True)
def _add(results, shift, words, planes):
    """Adds four rows, each at both ends of its pairs, to the counters: eight inputs through carry-save adders."""
    one, top = np.uint64(1), np.uint64(63)
    a0, a1, a2, s0 = _half(results, 0, shift[0], words)
    b0, b1, b2, s1 = _half(results, 1, shift[1], words)
    c0, c1, c2, s2 = _half(results, 2, shift[2], words)
    d0, d1, d2, s3 = _half(results, 3, shift[3], words)
    p0, p1, p2 = planes[0], planes[1], planes[2]
    carry = results[4]
    for i in range(words):
        # (x >> 1) >> (63 - s) is x >> (64 - s) without the shift by 64 that s = 0 would ask for.
        a = (a1[i] << s0) | ((a2[i] >> one) >> (top - s0))
        b = (b1[i] << s1) | ((b2[i] >> one) >> (top - s1))
        c = (c1[i] << s2) | ((c2[i] >> one) >> (top - s2))
        d = (d1[i] << s3) | ((d2[i] >> one) >> (top - s3))
        x, t0 = _full_add(p0[i], a0[i], a)
        x, t1 = _full_add(x, b0[i], b)
        x, t2 = _full_add(x, c0[i], c)
        p0[i], t3 = _full_add(x, d0[i], d)
        y, f0 = _full_add(p1[i], t0, t1)
        p1[i], f1 = _full_add(y, t2, t3)
        p2[i], e = _full_add(p2[i], f0, f1)
        carry[i] = e
    for k in range(3, PLANES):
        p = planes[k]
        more = np.uint64(0)
        for i in range(words):
            u = p[i] & carry[i]
            p[i] ^= carry[i]
            carry[i] = u
            more |= u
        if more == 0:
            break


@numba.njit(cache=True, nogil=True)
def flush(planes, counts):
    """Adds the counters to `counts` (64 words,) int32 and clears them."""
    for w in range(planes.shape[1]):
        part = counts[64 * w : 64 * w + 64]
        for k in range(PLANES):
            p = planes[k, w]
            if p != 0:
                for b in range(64):
                    part[b] += np.int32((p >> np.uint64(b)) & np.uint64(1)) << k
                planes[k, w] = 0
