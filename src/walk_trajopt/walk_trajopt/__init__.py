# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a planned tour to a smooth, collision-free, timed walkthrough."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from walk_trajopt.config import TimingConfig, TrajoptConfig
    from walk_trajopt.optimiser import EditOutcome, Optimiser
    from walk_trajopt.path import OptimisedPath, Stretch
    from walk_trajopt.pipeline import optimise_path
    from walk_trajopt.spline import spline_path
    from walk_trajopt.timing import time_path
    from walk_trajopt.trajectory import Trajectory

__all__ = [
    "EditOutcome",
    "OptimisedPath",
    "Optimiser",
    "Stretch",
    "TimingConfig",
    "Trajectory",
    "TrajoptConfig",
    "optimise_path",
    "spline_path",
    "time_path",
]

_HOMES = {
    "walk_trajopt.config": ("TimingConfig", "TrajoptConfig"),
    "walk_trajopt.optimiser": ("EditOutcome", "Optimiser"),
    "walk_trajopt.path": ("OptimisedPath", "Stretch"),
    "walk_trajopt.pipeline": ("optimise_path",),
    "walk_trajopt.spline": ("spline_path",),
    "walk_trajopt.timing": ("time_path",),
    "walk_trajopt.trajectory": ("Trajectory",),
}


def __getattr__(name: str) -> object:
    """Imports what is asked for: all of it at once would keep every executable from starting at once."""
    for module, names in _HOMES.items():
        if name in names:
            return getattr(importlib.import_module(module), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
