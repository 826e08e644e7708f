# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The step of a banded problem with kinks, in compiled code.

The model around x is ½ δᵀ H δ + gᵀ δ + Σ c (max_j (v_j + J_j · δ + ½ κ_j |δ across J_j|²))², H banded and constant, j over a point's pieces. It
is convex. The largest is softened to s = ε log Σ exp(v_j / ε), and Newton's method follows the minimum while ε falls
from decimetres to a millimetre, without asking the geometry anything: so the step ends on the kinks, not beyond them.
"""

from __future__ import annotations

import numba
import numpy as np

_SOFTNESS = (0.03, 0.01, 0.003, 0.001)  # ε [m]
_NEWTON_STEPS = 8  # at most, for each ε
_HALVINGS = 6
_ENOUGH = 1e-5  # an inner step that lowers the model by less than this share is the last for its ε
_BAND = 6  # bands beside the diagonal: a point's coordinates meet those of two neighbours on each side


@numba.njit(cache=True, nogil=True)
def newton_step(base, gradient, values, slopes, bends, first, scale, damping, fixed):
    """Returns the step (n, 3) to the minimum of the model, none at fixed points, and by how much it lowers the model.

    Args:
        base: (7, 3 n) lower bands of H, fixed points cut loose.
        gradient: (n, 3) g.
        values: (n, P) v, −inf where there is no piece.
        slopes: (n, P, 3) J.
        bends: (n, P) κ, at least zero.
        first: (G + 1,) the pieces of objective k are first[k] : first[k + 1].
        scale: (G,) c.
        damping: (n,) added to the diagonal of H.
        fixed: (n,) bool.
    """
    n = len(gradient)
    step, trial = np.zeros((n, 3)), np.zeros((n, 3))
    move = np.zeros(3 * n)
    bands, rhs = np.empty_like(base), np.empty(3 * n)
    some = np.empty((n, len(scale)), np.bool_)
    for i in range(n):
        for g in range(len(scale)):
            some[i, g] = values[i, first[g] : first[g + 1]].max() > -np.inf
    for level in range(len(_SOFTNESS)):
        soft = _SOFTNESS[level]
        value = _assemble(bands, rhs, base, gradient, values, slopes, bends, first, scale, damping, fixed, some, step, soft)
        for _ in range(_NEWTON_STEPS):
            move[:] = rhs
            _solve_banded(bands, move)
            share = 1.0
            for _ in range(_HALVINGS):
                for u in range(3 * n):
                    trial[u // 3, u % 3] = step[u // 3, u % 3] + share * move[u]
                there = _assemble(
                    bands, rhs, base, gradient, values, slopes, bends, first, scale, damping, fixed, some, trial, soft
                )
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
    begin = _true_value(base, gradient, values, slopes, bends, first, scale, damping, 0.0 * step)
    return step, begin - _true_value(base, gradient, values, slopes, bends, first, scale, damping, step)


@numba.njit(cache=True, nogil=True)
def _true_value(base, gradient, values, slopes, bends, first, scale, damping, step):
    """Returns the model's value at a step, its kinks as they are."""
    total = _residual(np.empty(gradient.size), base, gradient, step, 0.0 * damping)
    for i in range(len(gradient)):
        for g in range(len(scale)):
            top = -np.inf
            for j in range(first[g], first[g + 1]):
                if values[i, j] > -np.inf:
                    top = max(top, _piece(values, slopes, bends, i, j, step)[0])
            if top > -np.inf:
                total += scale[g] * top * top
    return total


@numba.njit(cache=True, nogil=True)
def _assemble(bands, rhs, base, gradient, values, slopes, bends, first, scale, damping, fixed, some, step, softness):
    """Adds the pieces' curvature to `bands` and writes minus the model's gradient at `step` to `rhs`."""
    n = len(gradient)
    bands[:] = base
    for i in range(n):
        bands[0, 3 * i : 3 * i + 3] += damping[i]
    cost = _residual(rhs, base, gradient, step, damping)
    for i in range(n):
        if fixed[i]:
            rhs[3 * i : 3 * i + 3] = 0.0
            continue
        for g in range(len(scale)):
            a, b = first[g], first[g + 1]
            if not some[i, g]:
                continue
            top = -np.inf
            for j in range(a, b):
                if values[i, j] > -np.inf:
                    top = max(top, _piece(values, slopes, bends, i, j, step)[0])
            total = 0.0
            gx, gy, gz = 0.0, 0.0, 0.0
            xx, xy, yy, xz, yz, zz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            bx, by, bz, bxy, bxz, byz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for j in range(a, b):
                if values[i, j] == -np.inf:
                    continue
                v, jx, jy, jz, k, ux, uy, uz = _piece(values, slopes, bends, i, j, step)
                w = np.exp((v - top) / softness)
                total += w
                gx, gy, gz = gx + w * jx, gy + w * jy, gz + w * jz
                xx, xy, yy = xx + w * jx * jx, xy + w * jx * jy, yy + w * jy * jy
                xz, yz, zz = xz + w * jx * jz, yz + w * jy * jz, zz + w * jz * jz
                if k > 0.0:
                    bx, by, bz = bx + w * k * (1.0 - ux * ux), by + w * k * (1.0 - uy * uy), bz + w * k * (1.0 - uz * uz)
                    bxy, bxz, byz = bxy - w * k * ux * uy, bxz - w * k * ux * uz, byz - w * k * uy * uz
            gx, gy, gz = gx / total, gy / total, gz / total
            smooth = top
            spread = 0.0
            if b - a > 1:
                smooth = max(top + softness * np.log(total), 0.0)
                spread = smooth / softness
            c = 2.0 * scale[g]
            cost += scale[g] * smooth * smooth
            rhs[3 * i] -= c * smooth * gx
            rhs[3 * i + 1] -= c * smooth * gy
            rhs[3 * i + 2] -= c * smooth * gz
            keep = c * (1.0 - spread)
            bent = c * max(smooth, 0.0) / total
            bands[0, 3 * i] += keep * gx * gx + c * spread * xx / total + bent * bx
            bands[1, 3 * i] += keep * gx * gy + c * spread * xy / total + bent * bxy
            bands[0, 3 * i + 1] += keep * gy * gy + c * spread * yy / total + bent * by
            bands[2, 3 * i] += keep * gx * gz + c * spread * xz / total + bent * bxz
            bands[1, 3 * i + 1] += keep * gy * gz + c * spread * yz / total + bent * byz
            bands[0, 3 * i + 2] += keep * gz * gz + c * spread * zz / total + bent * bz
    return cost


@numba.njit(cache=True, nogil=True)
def _piece(values, slopes, bends, i, j, step):
    """Returns a piece's value and gradient at a step, its bend and the direction of its slope."""
    dx, dy, dz = step[i, 0], step[i, 1], step[i, 2]
    jx, jy, jz = slopes[i, j, 0], slopes[i, j, 1], slopes[i, j, 2]
    bend = bends[i, j]
    value = values[i, j] + jx * dx + jy * dy + jz * dz
    if bend <= 0.0:
        return value, jx, jy, jz, 0.0, 0.0, 0.0, 0.0
    length = np.sqrt(jx * jx + jy * jy + jz * jz)
    ux, uy, uz = jx / length, jy / length, jz / length
    along = ux * dx + uy * dy + uz * dz
    ax, ay, az = dx - along * ux, dy - along * uy, dz - along * uz
    value += 0.5 * bend * (ax * ax + ay * ay + az * az)
    return value, jx + bend * ax, jy + bend * ay, jz + bend * az, bend, ux, uy, uz


@numba.njit(cache=True, nogil=True)
def _residual(rhs, base, gradient, step, damping):
    """Writes −(g + (H + damping) δ) and returns ½ δᵀ (H + damping) δ + gᵀ δ; H couples equal coordinates only."""
    n = len(gradient)
    value = 0.0
    for i in range(n):
        for k in range(3):
            u = 3 * i + k
            total = gradient[i, k] + (base[0, u] + damping[i]) * step[i, k]
            for m in (1, 2):
                if i + m < n:
                    total += base[3 * m, u] * step[i + m, k]
                if i >= m:
                    total += base[3 * m, u - 3 * m] * step[i - m, k]
            rhs[u] = -total
            value += 0.5 * step[i, k] * (gradient[i, k] + total)
    return value


@numba.njit(cache=True, nogil=True)
def _solve_banded(bands, rhs):
    """Solves in place, by a Cholesky factorisation of the lower bands (7, N), which it destroys."""
    n = bands.shape[1]
    for j in range(n):
        root = np.sqrt(max(bands[0, j], 1e-300))
        bands[0, j] = root
        reach = min(_BAND, n - 1 - j)
        for k in range(1, reach + 1):
            bands[k, j] /= root
        for k in range(1, reach + 1):
            for m in range(k, reach + 1):
                bands[m - k, j + k] -= bands[m, j] * bands[k, j]
    for j in range(n):
        rhs[j] /= bands[0, j]
        for k in range(1, min(_BAND, n - 1 - j) + 1):
            rhs[j + k] -= bands[k, j] * rhs[j]
    for j in range(n - 1, -1, -1):
        for k in range(1, min(_BAND, n - 1 - j) + 1):
            rhs[j] -= bands[k, j] * rhs[j + k]
        rhs[j] /= bands[0, j]
