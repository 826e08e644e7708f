# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Railings in a plan: thin barriers that go on from a drop. Our own."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

RAILING_M = 0.9
"""Height at which every railing is met: guards are at least so high nearly everywhere."""

# Furniture and walls are thicker; a sheet between two columns of the grid is met in both.
_THICKEST_M = 0.3
_SQUARE = np.ones((3, 3))


def railings(barrier: NDArray[np.bool_], ledge: NDArray[np.bool_], cell_m: float) -> NDArray[np.bool_]:
    """Returns the railings of a plan (nx, ny): thin runs of barrier that are connected to a ledge.

    Where a ramp begins, its railing stands before there is a drop to guard; it parts rooms as the drop does, whereas
    a counter or a shelf as high does not.

    Args:
        barrier: (nx, ny) whether anything is met at the height of railings.
        ledge: (nx, ny) where the floor ends at a higher or lower one.
        cell_m: Distance between columns [m].
    """
    size = round(_THICKEST_M / cell_m)
    thick = ndimage.binary_opening(barrier, np.ones((size, size)))
    label, _ = ndimage.label((barrier & ~thick) | ledge, _SQUARE)
    guarded = np.unique(label[ledge])
    return np.asarray(barrier & ~thick & np.isin(label, guarded[guarded > 0]))
