# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Doors that stand closed in a model that does not say what is a door: thin leaves in door-sized gaps. Our own."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from walk_building.geometry import Geometry

_THICKEST_M = 0.12
_WIDTH_M = (0.6, 1.3)
# Higher panes are windows down to the floor.
_HEIGHT_M = (1.8, 2.4)
# Where the leaf is looked at: off handles, and above what is stepped over.
_EYE_M = 1.3
# How far beyond the thickest leaf's face the other side is looked for, and how near to that a place has to be.
_BEYOND_M = 0.39
_NEAR_M = 0.2
# A leaf is even to this, and what holds it differs from it by more.
_EVEN_M = 0.02
_SAMPLE_M = 0.02
# It reaches down to this above the floor.
_SILL_M = 0.3
# The warning names so many places and counts the others.
_NAMED = 6
# Findings nearer to each other than this are one door.
_SAME_M = 0.5


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ClosedDoor:
    """What looks like a closed door."""

    position: NDArray[np.float64]  # (3,) the middle of the leaf's foot [m]
    normal: NDArray[np.float64]  # (2,) a horizontal unit vector across the leaf
    width_m: float
    height_m: float
    thickness_m: float


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class _Barriers:
    """What stands between pairs of places that face each other; N pairs."""

    foot: NDArray[np.float64]  # (N, 3) floor point under its middle
    across: NDArray[np.float64]  # (N, 3) unit vectors to the other side
    near_m: NDArray[np.float64]  # (N,) from the place to the middle of the barrier
    apart_m: NDArray[np.float64]  # (N,) between the two places
    thickness_m: NDArray[np.float64]  # (N,)


def find_closed_doors(
    geometry: Geometry, places: NDArray[np.float64], indoor: NDArray[np.bool_], radius_m: float
) -> tuple[ClosedDoor, ...]:
    """Returns where the walkable surface ends at a thin leaf in a door-sized gap and goes on behind it.

    From each place at the edge a ray goes to the nearest face, and another comes back from the place behind it: the
    thickness between them. Rays beside these show how wide and how high it is the same. A leaf as thick as its wall,
    and one that leads to where nobody can stand, is not found.

    Args:
        geometry: What stands on the floor.
        places: (P, 3) where standing ends: the edge of the walkable surface.
        indoor: (P,) the places from which to look.
        radius_m: The body's radius.
    """
    thin = _thin_barriers(geometry, places, indoor, radius_m)
    found: list[ClosedDoor] = []
    for k in range(len(thin.foot)):
        if any(np.linalg.norm(door.position - thin.foot[k]) < _SAME_M for door in found):
            continue
        door = _leaf(geometry, thin, k)
        if door is not None and all(np.linalg.norm(d.position - door.position) >= _SAME_M for d in found):
            found.append(door)
    return tuple(found)


def closed_door_warnings(doors: tuple[ClosedDoor, ...], offset_m: NDArray[np.float64]) -> tuple[str, ...]:
    """Returns a sentence for the user that says, in the file's own coordinates, where doors look closed."""
    if not doors:
        return ()
    named = [", ".join(f"{x:.1f}" for x in door.position + offset_m) for door in doors[:_NAMED]]
    others = f" and {len(doors) - _NAMED} more" if len(doors) > _NAMED else ""
    return (
        f"Closed doors here? ({'), ('.join(named)}){others}: nobody gets through; "
        "leave them out by the names of their parts with --doors or --ignore, or take them out of the file.",
    )


def _thin_barriers(
    geometry: Geometry, places: NDArray[np.float64], indoor: NDArray[np.bool_], radius_m: float
) -> _Barriers:
    """The barriers in front of the places indoors that are as thin as a leaf, one in a square of 0.1 m."""
    eye = places[indoor] + np.array([0.0, 0.0, _EYE_M])
    # A place is at most a column's diagonal farther off than the body needs.
    nearest = geometry.closest(eye, radius_m + 0.15)
    across = nearest.points - eye
    kept = np.isfinite(nearest.distance_m) & (np.abs(across[:, 2]) < 0.05)
    eye, across = eye[kept], across[kept] * np.array([1.0, 1.0, 0.0])
    across /= np.maximum(np.linalg.norm(across, axis=1), 1e-9)[:, None]
    near_m = nearest.distance_m[kept]
    probe = eye + across * (near_m + _BEYOND_M)[:, None]
    if len(probe) == 0:
        return _Barriers(foot=eye, across=across, near_m=near_m, apart_m=near_m, thickness_m=near_m)
    gap, behind = cKDTree(places + np.array([0.0, 0.0, _EYE_M])).query(probe, distance_upper_bound=_NEAR_M)
    apart_m = np.full(len(eye), -1.0)
    there = np.isfinite(gap)
    apart_m[there] = np.einsum("ij,ij->i", places[behind[there]] - eye[there], across[there])
    there &= apart_m > near_m
    eye, across, near_m, apart_m = eye[there], across[there], near_m[there], apart_m[there]
    back = geometry.raycast(eye + across * apart_m[:, None], -across, 1.0).distance_m if len(eye) else near_m
    thickness_m = np.where(np.isfinite(back), apart_m - near_m - back, np.inf)
    kept = np.flatnonzero((thickness_m >= -1e-6) & (thickness_m <= _THICKEST_M))
    eye, across, near_m, apart_m, thickness_m = (a[kept] for a in (eye, across, near_m, apart_m, thickness_m))
    near_m = near_m + thickness_m / 2
    foot = eye + across * near_m[:, None] - np.array([0.0, 0.0, _EYE_M])
    one = np.unique(np.round(foot / 0.1).astype(int), axis=0, return_index=True)[1] if len(foot) else np.empty(0, int)
    return _Barriers(
        foot=foot[one], across=across[one], near_m=near_m[one], apart_m=apart_m[one], thickness_m=thickness_m[one]
    )


def _leaf(geometry: Geometry, thin: _Barriers, k: int) -> ClosedDoor | None:
    """The k-th barrier as a door, None where it is a wall, a pane or a screen."""
    across = thin.across[k]
    along = np.array([-across[1], across[0], 0.0])
    sideways = np.arange(-_WIDTH_M[1] - 0.1, _WIDTH_M[1] + 0.1, _SAMPLE_M)
    offsets = sideways[:, None] * along + np.array([0.0, 0.0, _EYE_M])
    even, blocked = _profile(geometry, thin, k, offsets)
    low, high = _run(even, int(np.argmin(np.abs(sideways))))
    width_m = (high - low) * _SAMPLE_M
    # What holds a leaf stands in the way on both sides; beside an open leaf or a screen one can look past.
    held = low > 0 and high < len(even) and blocked[low - 1] and blocked[high]
    if not (held and _WIDTH_M[0] <= width_m <= _WIDTH_M[1]):
        return None
    middle = thin.foot[k] + along * (sideways[low] + sideways[high - 1]) / 2
    upwards = np.arange(_SAMPLE_M, _HEIGHT_M[1] + 0.1, _SAMPLE_M)
    offsets = (middle - thin.foot[k]) + upwards[:, None] * np.array([0.0, 0.0, 1.0])
    even, _ = _profile(geometry, thin, k, offsets)
    low, high = _run(even, int(np.argmin(np.abs(upwards - _EYE_M))))
    if low == high or upwards[low] > _SILL_M or not _HEIGHT_M[0] <= upwards[high - 1] <= _HEIGHT_M[1]:
        return None
    return ClosedDoor(
        position=middle, normal=across[:2], width_m=float(width_m), height_m=float(upwards[high - 1]),
        thickness_m=float(max(thin.thickness_m[k], 0.0)),
    )  # fmt: skip


def _profile(
    geometry: Geometry, thin: _Barriers, k: int, offsets: NDArray[np.float64]
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether the barrier is as at its middle, and whether anything is in the way, at offsets (M, 3) from its foot."""
    across, before = thin.across[k], thin.near_m[k]
    after = thin.apart_m[k] - before
    points = thin.foot[k] + offsets
    there = geometry.raycast(points - before * across, np.broadcast_to(across, points.shape), before + after)
    back = geometry.raycast(points + after * across, np.broadcast_to(-across, points.shape), before + after)
    half = thin.thickness_m[k] / 2
    as_near = np.abs(there.distance_m - (before - half)) <= _EVEN_M
    even = as_near & (np.abs(back.distance_m - (after - half)) <= _EVEN_M)
    return even, np.isfinite(there.distance_m)


def _run(even: NDArray[np.bool_], middle: int) -> tuple[int, int]:
    """The first of the even samples around the middle one and the first after them; equal where it is not even."""
    if not even[middle]:
        return middle, middle
    odd = np.flatnonzero(~even)
    below, above = odd[odd < middle], odd[odd > middle]
    return int(below[-1]) + 1 if len(below) else 0, int(above[0]) if len(above) else len(even)
