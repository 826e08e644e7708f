# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Scenes for the conversions."""

from types import SimpleNamespace

import numpy as np
import pytest

STAMP = 1_700_000_000_123_456_789


@pytest.fixture
def rng():
    return np.random.default_rng(7)


@pytest.fixture
def quats(rng):
    def make(n):
        q = rng.normal(size=(n, 4))
        return q / np.linalg.norm(q, axis=1, keepdims=True)

    return make


@pytest.fixture
def importance_map(rng):
    shape = (5, 4, 3)
    fields = {k: rng.random(shape, dtype=np.float32) for k in ("distance", "visibility", "importance")}
    obstacle = (rng.random(shape) < 0.3).astype(np.float32)
    grid = SimpleNamespace(origin=np.array([-1.0, 2.0, 0.5]), voxel_size_m=0.25, shape=shape)
    return SimpleNamespace(grid=grid, obstacle=obstacle, **fields)


@pytest.fixture
def trajectory(rng, quats):
    m = 17
    t = np.round(np.cumsum(rng.random(m)), 9) - 0.0
    rows = {k: rng.normal(size=(m, 3)) for k in ("positions", "velocities", "accelerations")}
    return SimpleNamespace(t_s=t, quat_xyzw=quats(m), **rows)
