# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The walkable surface: every place a walker can stand, and which places are a step apart."""

from __future__ import annotations

import dataclasses
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import csr_array
from scipy.spatial import cKDTree

from walk_building.geometry import as_points
from walk_building.raster import Columns
from walk_building.surface_kernels import (
    NEAREST_RADIUS_M,
    Grid,
    edge_lengths,
    floor_planes,
    nearest_places,
    segment_walkable,
)


@dataclasses.dataclass(frozen=True, kw_only=True)
class WalkableSurface:
    """Places on a grid of columns, several in a column where storeys overlap. Arrays are read-only.

    A place is a floor point over which the walker's body fits. Places are neighbours if their columns are
    adjacent (eight neighbours) and their heights differ by at most a step. P places, E directed neighbour pairs.
    """

    columns: Columns
    step_m: float
    places: NDArray[np.float64]  # (P, 3) floor points, ordered by column, then by height [m]
    column_start: NDArray[np.int64]  # (columns + 1,): places of column c are column_start[c] : column_start[c + 1]
    indptr: NDArray[np.int64]  # (P + 1,)
    neighbours: NDArray[np.int32]  # (E,)
    indoor: NDArray[np.bool_]  # (P,)
    component: NDArray[np.int32]  # (P,) parts connected by walking without a change between in and out; 0 is largest
    clearance_m: NDArray[np.float64]  # (P,) horizontal distance along the surface to where standing ends
    room: NDArray[np.int32]  # (P,) index into the building's rooms, -1 for none
    storey: NDArray[np.int32]  # (P,) index into the building's storeys

    @property
    def cell_m(self) -> float:
        """Distance between columns [m]."""
        return self.columns.cell_m

    @property
    def place_area_m2(self) -> float:
        """Floor area that a place stands for, seen from above [m²]."""
        return self.columns.cell_m**2

    @cached_property
    def edge_length_m(self) -> NDArray[np.float64]:
        """(E,): straight distance to each neighbour [m]."""
        return edge_lengths(self.indptr, self.neighbours, self.places)

    @cached_property
    def graph(self) -> csr_array:
        """The neighbour graph as a sparse matrix of step lengths [m], for scipy.sparse.csgraph."""
        shape = (len(self.places), len(self.places))
        return csr_array((self.edge_length_m, self.neighbours, self.indptr), shape=shape)

    @cached_property
    def grid(self) -> Grid:
        """The arrays that compiled kernels need to look places up by column."""
        return grid_of(self.columns, self.column_start, self.places)

    def nearest(self, points: ArrayLike, mask: NDArray[np.bool_] | None = None) -> NDArray[np.int64]:
        """Returns the place nearest to each floor point, -1 where there is no place at all.

        Args:
            points: (N, 3) points on the floor, not at eye height [m].
            mask: (P,) the places that may be returned; None for all.
        """
        query = as_points("points", points)
        if mask is None:
            return self._nearest_of_all(query)
        candidates = np.flatnonzero(mask)
        if not len(candidates):
            return np.full(len(query), -1)
        return candidates[cKDTree(self.places[candidates]).query(query)[1]]

    def _nearest_of_all(self, query: NDArray[np.float64]) -> NDArray[np.int64]:
        # Most points that anybody asks about are on the floor: a look into the columns around is a tenth of the tree's
        # price there. Whoever is far from all places gets the tree.
        found = np.empty(len(query), np.int64)
        nearest_places(self.grid, query, NEAREST_RADIUS_M, found)
        far = found < 0
        if far.any() and self._tree.n:
            gap, place = self._tree.query(query[far])
            # So far that the square of the distance is no number: the tree returns no place.
            found[far] = np.where(np.isfinite(gap), place, -1)
        return found

    def floor_z(self, eyes: ArrayLike, eye_height_m: float) -> NDArray[np.float64]:
        """Returns the height of the floor under each eye (N, 3), smooth over the steps of a stair; nan: no floor."""
        return self.floor_plane(eyes, eye_height_m)[:, 0]

    def floor_plane(self, eyes: ArrayLike, eye_height_m: float) -> NDArray[np.float64]:
        """Returns the plane that fits the floor around each eye best.

        The fit is over the places within 0.3 m, weighted towards the eye, that lie within two steps of
        `eye_height_m` below it; farther off the surface, the height of the nearest place within 1 m. Our own.

        Args:
            eyes: (N, 3) [m].
            eye_height_m: Where to look for the floor: this far below.

        Returns:
            (N, 3): height under the eye [m], slope along x, slope along y; nan where there is no floor.
        """
        query = as_points("eyes", eyes)
        out = np.empty((len(query), 3))
        floor_planes(self.grid, query, eye_height_m, 2 * self.step_m, out)
        return out

    def segment_walkable(self, start: int, end: int, mask: NDArray[np.bool_]) -> bool:
        """Returns whether a straight walk between two places stays on the places of `mask` (P,).

        Every square of the grid that the line crosses must have all four corners standable, which keeps the body
        free at every point between them.
        """
        return bool(segment_walkable(self.grid, mask, start, end, self.step_m))

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.places)


def grid_of(columns: Columns, column_start: NDArray[np.int64], places: NDArray[np.float64]) -> Grid:
    """Returns places and columns in the form that compiled kernels take."""
    x, y = columns.origin
    return Grid(float(x), float(y), columns.cell_m, *columns.shape, column_start, places)
