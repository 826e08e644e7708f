# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Places inside solid matter: a block of ground or a pillar is hollow as triangles, but nobody walks in it. Our own."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components

from walk_building.raster import Hits

# Corners nearer than this are one corner: exporters repeat them for every face.
_WELD_M = 1e-5
# Where in a body's height the matter is looked for: above what lies on the floor, below any ceiling.
_PROBE_HEIGHT_M = 1.0


def inside_solids(
    vertices: NDArray[np.float64],
    faces: NDArray[np.int32],
    hits: Hits,
    column: NDArray[np.int64],
    z: NDArray[np.float64],
) -> NDArray[np.bool_]:
    """Returns whether each place (P,) is inside a closed body of the model.

    A body is a connected set of faces in which every edge is passed once in each direction; a place is inside if,
    of the faces of such bodies above it, more point up than down.
    """
    corner = vertices[faces]
    up = np.sign(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])[:, 2]).astype(np.int8)
    up[~closed_faces(vertices, faces)] = 0
    return _inside(hits.start, hits.z, up[hits.face], column, z + _PROBE_HEIGHT_M)


def closed_faces(vertices: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.bool_]:
    """Returns which faces (F,) belong to a closed, consistently turned body."""
    key = np.rint(vertices / _WELD_M).astype(np.int64)
    corner = np.unique(key, axis=0, return_inverse=True)[1].reshape(-1)[faces].astype(np.int64)
    n = int(corner.max()) + 1
    start, end = corner[:, [0, 1, 2]].ravel(), corner[:, [1, 2, 0]].ravel()
    # +1 for an edge passed upwards in index, -1 downwards: a closed surface sums to zero on every edge.
    edge = np.minimum(start, end) * n + np.maximum(start, end)
    index = np.unique(edge, return_inverse=True)[1]
    balance = np.bincount(index, weights=np.sign(end - start).astype(float))
    body = connected_components(csr_array((np.ones(len(start), np.int8), (start, end)), shape=(n, n)), directed=False)[
        1
    ]
    open_body = np.zeros(int(body.max()) + 1, bool)
    open_body[body[start[balance[index] != 0]]] = True
    return np.asarray(~open_body[body[corner[:, 0]]])


@numba.njit(cache=True, nogil=True)
def _inside(start, hit_z, up, column, z):
    inside = np.zeros(len(z), np.bool_)
    for p in range(len(z)):
        winding = 0
        k = start[column[p] + 1] - 1
        last_z, last_up = np.inf, 0
        while k >= start[column[p]] and hit_z[k] > z[p]:
            # A line through an edge meets both faces beside it at one height; that is one crossing.
            if not (up[k] == last_up and abs(last_z - hit_z[k]) < 1e-6):
                winding += up[k]
            last_z, last_up = hit_z[k], up[k]
            k -= 1
        inside[p] = winding > 0
    return inside
