# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Fewer triangles, part by part, so that names are kept."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import fast_simplification
import numpy as np

from walk_vr_bridge.model.pieces import Piece, compact

_SMALL = 16
"""A part with so few triangles is a box or little more: it is left as it is."""

_ROUNDS = 6


def simplify(pieces: Sequence[Piece], triangles: int) -> list[Piece]:
    """Returns the pieces with at most so many triangles altogether.

    Collapses edges (quadric error) in the pieces that have many triangles; where that is not enough, the smallest
    pieces are left out. All stay as they are if they are few enough.
    """
    kept, goal = list(pieces), triangles
    for _ in range(_ROUNDS):
        count = sum(len(p.faces) for p in kept)
        if count <= triangles:
            return kept
        # Collapsing stops short of its target where a mesh is open or branches: the next round aims lower.
        small = sum(len(p.faces) for p in kept if len(p.faces) <= _SMALL)
        share = max((goal - small) / max(count - small, 1), 0.02)
        kept = [_fewer(p, share) for p in kept]
        goal = int(0.9 * goal)
    return _largest(kept, triangles)


def _fewer(piece: Piece, share: float) -> Piece:
    if len(piece.faces) <= _SMALL:
        return piece
    keep = max(_SMALL, int(share * len(piece.faces)))
    if keep >= len(piece.faces):
        return piece
    vertices, faces = fast_simplification.simplify(
        np.ascontiguousarray(piece.vertices), np.ascontiguousarray(piece.faces), target_count=keep
    )
    vertices, faces = compact(np.asarray(vertices, np.float64), np.asarray(faces, np.int64))
    # A part never vanishes by being simplified.
    return dataclasses.replace(piece, vertices=vertices, faces=faces) if len(faces) else piece


def _largest(pieces: Sequence[Piece], triangles: int) -> list[Piece]:
    size = np.array([np.ptp(p.vertices, axis=0).max() for p in pieces])
    kept, left = set(), triangles
    for at in np.argsort(-size, kind="stable"):
        if len(pieces[at].faces) <= left:
            kept.add(int(at))
            left -= len(pieces[at].faces)
    return [piece for at, piece in enumerate(pieces) if at in kept]
