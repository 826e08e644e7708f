# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The step of a banded problem with kinks, in compiled code. Our own.

The model around x is ½ δᵀ H δ + gᵀ δ + Σ_i c_i (max_j p_j(δ))², H banded and constant, j over the pieces of a point,
and p_j(δ) = v_j + J_j · δ + ½ κ_j |δ across J_j|². The largest is softened to ε log Σ exp(p_j / ε), and Newton's method
follows the minimum while ε falls from centimetres to a millimetre, without asking the geometry anything: so the step
ends on the kinks, not beyond them.
"""

from __future__ import annotations

from typing import NamedTuple

import numba
import numpy as np
from numpy.typing import NDArray

from walk_trajopt.solvers.banded import add_product, solve_banded

_SOFTNESS = (0.01, 0.001)  # ε, in the unit of the residuals
_NEWTON_STEPS = 8  # at most, for each ε
_HALVINGS = 6
_NEGLIGIBLE = 30.0  # pieces that are so many ε below the largest have a weight below 1e-13
_ENOUGH = 1e-4  # an inner step that lowers the model by less than this share is the last for its ε


class Model(NamedTuple):
    """The problem around x; n points, P pieces of G objectives."""

    base: NDArray[np.float64]  # (7, 3 n) lower bands of H, fixed points cut loose
    gradient: NDArray[np.float64]  # (n, 3) g
    values: NDArray[np.float64]  # (n, P) v, −inf where there is no piece
    slopes: NDArray[np.float64]  # (n, P, 3) J
    bends: NDArray[np.float64]  # (n, P) κ, at least zero
    first: NDArray[np.int64]  # (G + 1,) the pieces of objective k are first[k] : first[k + 1]
    scale: NDArray[np.float64]  # (n, G) c
    damping: float  # added to the diagonal of H
    fixed: NDArray[np.bool_]  # (n,)


@numba.njit(cache=True, nogil=True)
def newton_step(model):
    """Returns the step (n, 3) to the minimum of the model, none at fixed points, and by how much it lowers it."""
    n = len(model.gradient)
    step, trial, still = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, 3))
    bands, rhs, move = np.empty_like(model.base), np.empty(3 * n), np.empty(3 * n)
    for softness in _SOFTNESS:
        value = _assemble(model, step, softness, bands, rhs)
        for _ in range(_NEWTON_STEPS):
            move[:] = rhs
            solve_banded(bands, move)
            share, there = 1.0, np.inf
            for _ in range(_HALVINGS):
                for u in range(3 * n):
                    trial[u // 3, u % 3] = step[u // 3, u % 3] + share * move[u]
                there = _assemble(model, trial, softness, bands, rhs)
                if there < value:
                    break
                share *= 0.5
            if there >= value:
                break
            step, trial = trial, step
            done = value - there <= _ENOUGH * abs(there)
            value = there
            if done:
                break
    return step, _value(model, still) - _value(model, step)


@numba.njit(cache=True, nogil=True)
def _value(model, step):
    """Returns the model at a step, with its kinks as they are and without the damping."""
    found = np.empty(model.values.shape[1])
    total = add_product(model.base, model.gradient, 0.0, step, np.empty(step.size))
    for i in range(len(step)):
        for g in range(model.scale.shape[1]):
            top = _look(model, i, model.first[g], model.first[g + 1], step, found)
            if top > -np.inf:
                total += model.scale[i, g] * top * top
    return total


@numba.njit(cache=True, nogil=True)
def _assemble(model, step, softness, bands, rhs):
    """Writes the softened model's Hessian and minus its gradient at a step; returns its value."""
    first, scale = model.first, model.scale
    bands[:] = model.base
    bands[0] += model.damping
    value = add_product(model.base, model.gradient, model.damping, step, rhs)
    slope, curvature, found = np.empty(3), np.empty((3, 3)), np.empty(model.values.shape[1])
    for i in range(len(step)):
        if model.fixed[i]:
            rhs[3 * i : 3 * i + 3] = 0.0
            continue
        for g in range(scale.shape[1]):
            begin, end = first[g], first[g + 1]
            top = _look(model, i, begin, end, step, found)
            if top == -np.inf:
                continue
            soft = _soften(model, i, begin, end, step, softness, top, found, slope, curvature)
            c = 2.0 * scale[i, g]
            value += 0.5 * c * soft * soft
            for a in range(3):
                rhs[3 * i + a] -= c * soft * slope[a]
                for b in range(a + 1):
                    bands[a - b, 3 * i + b] += c * (slope[a] * slope[b] + max(soft, 0.0) * curvature[a, b])
    return value


@numba.njit(cache=True, nogil=True)
def _look(model, i, begin, end, step, found):
    """Writes the pieces' values at a step to `found` (P,), −inf where there is none; returns the largest."""
    values, slopes, bends = model.values, model.slopes, model.bends
    dx, dy, dz = step[i, 0], step[i, 1], step[i, 2]
    top = -np.inf
    for j in range(begin, end):
        found[j] = values[i, j]
        if found[j] == -np.inf:
            continue
        jx, jy, jz = slopes[i, j, 0], slopes[i, j, 1], slopes[i, j, 2]
        along = jx * dx + jy * dy + jz * dz
        found[j] += along
        if bends[i, j] > 0.0:
            along /= jx * jx + jy * jy + jz * jz
            ax, ay, az = dx - along * jx, dy - along * jy, dz - along * jz
            found[j] += 0.5 * bends[i, j] * (ax * ax + ay * ay + az * az)
        top = max(top, found[j])
    return top


@numba.njit(cache=True, nogil=True)
def _soften(model, i, begin, end, step, softness, top, found, slope, curvature):
    """Writes gradient and Hessian (its lower half) of the softened largest piece; returns its value.

    The Hessian is the pieces' own, plus the covariance of their gradients over ε.
    """
    slopes, bends = model.slopes, model.bends
    total, sx, sy, sz = 0.0, 0.0, 0.0, 0.0
    xx, yx, yy, zx, zy, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(begin, end):
        below = (top - found[j]) / softness
        if not below < _NEGLIGIBLE:
            continue
        w = np.exp(-below) if below > 0.0 else 1.0
        ox, oy, oz = slopes[i, j, 0], slopes[i, j, 1], slopes[i, j, 2]
        jx, jy, jz = ox, oy, oz
        if bends[i, j] > 0.0:
            square = ox * ox + oy * oy + oz * oz
            along = (ox * step[i, 0] + oy * step[i, 1] + oz * step[i, 2]) / square
            jx += bends[i, j] * (step[i, 0] - along * ox)
            jy += bends[i, j] * (step[i, 1] - along * oy)
            jz += bends[i, j] * (step[i, 2] - along * oz)
            k = w * bends[i, j] / square
            xx, yx, yy = xx + k * (oy * oy + oz * oz), yx - k * ox * oy, yy + k * (ox * ox + oz * oz)
            zx, zy, zz = zx - k * ox * oz, zy - k * oy * oz, zz + k * (ox * ox + oy * oy)
        total += w
        sx, sy, sz = sx + w * jx, sy + w * jy, sz + w * jz
        k = w / softness
        xx, yx, yy = xx + k * jx * jx, yx + k * jx * jy, yy + k * jy * jy
        zx, zy, zz = zx + k * jx * jz, zy + k * jy * jz, zz + k * jz * jz
    sx, sy, sz = sx / total, sy / total, sz / total
    slope[0], slope[1], slope[2] = sx, sy, sz
    curvature[0, 0] = xx / total - sx * sx / softness
    curvature[1, 0], curvature[1, 1] = yx / total - sx * sy / softness, yy / total - sy * sy / softness
    curvature[2, 0], curvature[2, 1] = zx / total - sx * sz / softness, zy / total - sy * sz / softness
    curvature[2, 2] = zz / total - sz * sz / softness
    return top + softness * np.log(total)
