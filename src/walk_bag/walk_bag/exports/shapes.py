# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Simple bodies as triangles, for what has no body of its own: a path, a point."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Triangles = tuple[NDArray[np.float64], NDArray[np.int64]]
"""Vertices (V, 3) [m] and faces (F, 3)."""


def sphere(radius_m: float, rings: int = 8, sides: int = 12) -> Triangles:
    """Returns a sphere around the origin: rings of corners between two poles, faces turned outwards."""
    polar = np.linspace(0.0, np.pi, rings + 1)[1:-1, None]
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)[None, :]
    ring = np.stack(
        [np.sin(polar) * np.cos(angle), np.sin(polar) * np.sin(angle), np.cos(polar) * np.ones_like(angle)], axis=2
    )
    vertices = np.vstack([ring.reshape(-1, 3), [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]]])
    k, n = np.arange(sides), (np.arange(sides) + 1) % sides
    first = (np.arange(rings - 2) * sides)[:, None]
    upper = np.stack([first + k, first + sides + k, first + n], axis=2).reshape(-1, 3)
    lower = np.stack([first + n, first + sides + k, first + sides + n], axis=2).reshape(-1, 3)
    north, south, last = len(vertices) - 2, len(vertices) - 1, (rings - 2) * sides
    top = np.column_stack([np.full(sides, north), k, n])
    bottom = np.column_stack([np.full(sides, south), last + n, last + k])
    return radius_m * vertices, np.vstack([upper, lower, top, bottom])


def tube(points: NDArray[np.float64], radius_m: float, sides: int = 6) -> Triangles:
    """Returns a tube around a polyline (n, 3), closed at both ends.

    The ring at each point is square to the mean of its two segments; it is turned so that one corner stays as
    level as it can, which is stable on any path that does not go straight up.
    """
    along = np.gradient(points, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    side = np.cross(along, [0.0, 0.0, 1.0])
    length = np.linalg.norm(side, axis=1, keepdims=True)
    side = np.where(length > 1e-6, side / np.maximum(length, 1e-12), [1.0, 0.0, 0.0])
    up = np.cross(side, along)
    angle = np.linspace(0.0, 2.0 * np.pi, sides, endpoint=False)
    rings = side[:, None, :] * np.cos(angle)[None, :, None] + up[:, None, :] * np.sin(angle)[None, :, None]
    vertices = (points[:, None, :] + radius_m * rings).reshape(-1, 3)
    first = (np.arange(len(points) - 1) * sides)[:, None]
    k, n = np.arange(sides), (np.arange(sides) + 1) % sides
    near = np.stack([first + k, first + n, first + sides + k], axis=2).reshape(-1, 3)
    far = np.stack([first + n, first + sides + n, first + sides + k], axis=2).reshape(-1, 3)
    fan = np.column_stack([np.zeros(sides - 2, int), np.arange(1, sides - 1), np.arange(2, sides)])
    last = fan[:, ::-1] + (len(points) - 1) * sides
    return vertices, np.vstack([near[:, ::-1], far[:, ::-1], fan, last])
