# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A trajectory at times of one's own choice."""

from __future__ import annotations

import dataclasses
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp


class Timed(Protocol):
    """What can be resampled: a trajectory, or a ride."""

    @property
    def t_s(self) -> NDArray[np.float64]:
        """(m,) strictly rising [s]."""

    @property
    def positions(self) -> NDArray[np.float64]:
        """(m, 3) [m]."""

    @property
    def quat_xyzw(self) -> NDArray[np.float64]:
        """(m, 4)."""

    @property
    def stop(self) -> NDArray[np.bool_]:
        """(m,) whether the walker stands still."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class PoseSamples:
    """Where the eye is and looks at given times."""

    t_s: NDArray[np.float64]  # (m,) [s]
    positions: NDArray[np.float64]  # (m, 3) [m]
    quat_xyzw: NDArray[np.float64]  # (m, 4), neighbours on the same side of the double cover
    stop: NDArray[np.bool_]  # (m,) the walker stands


def resample(trajectory: Timed, max_step_s: float) -> PoseSamples:
    """Returns the trajectory's own samples with as many between as keep the steps within `max_step_s`.

    Positions between two samples lie on the straight line between them, because that line is what was swept
    against the building; look directions turn about one axis at constant rate.
    """
    return sample_at(trajectory, _refined(trajectory.t_s, max_step_s))


def sample_at(trajectory: Timed, times: NDArray[np.float64]) -> PoseSamples:
    """Returns the trajectory at the given times (m,) [s], which lie within it."""
    positions = np.column_stack([np.interp(times, trajectory.t_s, trajectory.positions[:, i]) for i in range(3)])
    before = np.clip(np.searchsorted(trajectory.t_s, times, side="right") - 1, 0, len(trajectory.t_s) - 1)
    after = np.minimum(before + 1, len(trajectory.t_s) - 1)
    exact = times == trajectory.t_s[before]
    stop = trajectory.stop[before] & (trajectory.stop[after] | exact)
    return PoseSamples(t_s=times, positions=positions, quat_xyzw=_turned(trajectory, times), stop=stop)


def _refined(t_s: NDArray[np.float64], max_step_s: float) -> NDArray[np.float64]:
    # A hair is taken off so that 0.3 s is cut in three and not in four.
    pieces = np.maximum(np.ceil(np.diff(t_s) / max_step_s - 1e-9).astype(int), 1)
    start = np.repeat(t_s[:-1], pieces)
    step = np.repeat(np.diff(t_s) / pieces, pieces)
    index = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    return np.append(start + step * index, t_s[-1])


def _turned(trajectory: Timed, times: NDArray[np.float64]) -> NDArray[np.float64]:
    if len(trajectory.t_s) < 2:
        return np.repeat(trajectory.quat_xyzw[:1], len(times), axis=0)
    quat = Slerp(trajectory.t_s, Rotation.from_quat(trajectory.quat_xyzw))(times).as_quat()
    flips = np.sign(np.einsum("ij,ij->i", quat[1:], quat[:-1]))
    signs = np.concatenate([[1.0], np.cumprod(np.where(flips == 0.0, 1.0, flips))])
    return np.asarray(quat * signs[:, None])
