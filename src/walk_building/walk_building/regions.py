# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Parts of the walkable surface that are connected on foot."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.csgraph import connected_components


def components(
    indptr: NDArray[np.int64], neighbours: NDArray[np.int32], allowed: NDArray[np.bool_]
) -> NDArray[np.int32]:
    """Returns the part of each place (P,); 0 is the largest. No part reaches from allowed to other places."""
    source = np.repeat(np.arange(len(allowed)), np.diff(indptr))
    keep = allowed[source] == allowed[neighbours]
    shape = (len(allowed), len(allowed))
    graph = csr_array((np.ones(int(keep.sum()), np.int8), (source[keep], neighbours[keep])), shape=shape)
    label = connected_components(graph, directed=False)[1]
    rank = np.empty(label.max() + 1, np.int32)
    rank[np.argsort(-np.bincount(label), kind="stable")] = np.arange(len(rank))
    return rank[label]


def start_component(component: NDArray[np.int32], indoor: NDArray[np.bool_]) -> int:
    """Returns the part with the most indoor places, else the largest: where a tour starts unless told otherwise."""
    inside = component[indoor]
    return int(np.argmax(np.bincount(inside))) if len(inside) else 0
