# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The outline of the floor that one can walk on, as rings around the cells of a grid. Our own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def outline(inside: NDArray[np.bool_]) -> list[NDArray[np.int64]]:
    """Returns closed rings (n, 2) of corners around the cells of a mask (nx, ny), the inside to the left.

    Only corners at which the direction changes are kept. Cells that meet at a corner only are apart.
    """
    after = _edges(np.pad(inside, 1))
    rings = []
    while after:
        start = next(iter(after))
        ring, at, heading = [], start, (0, 0)
        while at in after:
            ways = after[at]
            # Where two rings touch, the sharpest turn to the left stays on this one.
            step = ways[0] if len(ways) == 1 else max(ways, key=lambda way: _turn(heading, way))
            ways.remove(step)
            if not ways:
                del after[at]
            if step != heading:
                ring.append(at)
            at, heading = (at[0] + step[0], at[1] + step[1]), step
        first = ring[1] if len(ring) > 1 else ring[0]
        if _direction(ring[0], first) == heading:
            ring = ring[1:]
        rings.append(np.array(ring, dtype=np.int64) - 1)
    return rings


def _edges(inside: NDArray[np.bool_]) -> dict[tuple[int, int], list[tuple[int, int]]]:
    """Returns the steps along the boundary that leave each corner."""
    after: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for shift, corner, step in (
        ((0, 1), (0, 0), (1, 0)),
        ((-1, 0), (1, 0), (0, 1)),
        ((0, -1), (1, 1), (-1, 0)),
        ((1, 0), (0, 1), (0, -1)),
    ):
        beside = np.roll(inside, shift, axis=(0, 1))
        for x, y in np.argwhere(inside & ~beside).tolist():
            after.setdefault((x + corner[0], y + corner[1]), []).append(step)
    return after


def _turn(heading: tuple[int, int], way: tuple[int, int]) -> int:
    return heading[0] * way[1] - heading[1] * way[0]


def _direction(start: tuple[int, int], end: tuple[int, int]) -> tuple[int, int]:
    return int(np.sign(end[0] - start[0])), int(np.sign(end[1] - start[1]))
