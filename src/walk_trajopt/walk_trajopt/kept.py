# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The last path on disk: a node that starts again shows the very path it showed before."""

from __future__ import annotations

import dataclasses
import hashlib
import io
import json
import logging
import os
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

from walk_trajopt.config import TrajoptConfig
from walk_trajopt.polyline import Polyline
from walk_trajopt.repair import Mended, Way
from walk_trajopt.state import State

_log = logging.getLogger(__name__)
_FORMAT = 2  # raised when a state gets another content or meaning
_ARRAYS = ("keypoints", "radius_m", "pinned", "keypoint_m", "keypoint_index", "start", "arc_m", "x", "firmness")


def default_state_dir() -> Path:
    """Returns the folder for what a program keeps between runs, by the XDG base directory specification."""
    home = os.environ.get("XDG_STATE_HOME", "")
    return (Path(home) if Path(home).is_absolute() else Path.home() / ".local" / "state") / "walk"


class Kept:
    """One file for a building and a config: what was solved last, and which revision it belongs to.

    Attributes:
        file: The file.
    """

    def __init__(self, folder: Path, building_hash: str, config: TrajoptConfig) -> None:
        text = repr((_FORMAT, building_hash, dataclasses.asdict(config)))
        self.file = folder / f"path-{hashlib.sha256(text.encode()).hexdigest()[:32]}.npz"

    def save(self, key: str, state: State, spacing_m: float) -> None:
        """Writes a state; the file appears whole or not at all. Where it cannot be written, that is logged."""
        arrays: dict[str, Any] = {name: getattr(state, name) for name in _ARRAYS}
        arrays |= {f"term_{name}": values for name, values in state.terms.items()}
        arrays |= {"tour_points": state.tour.points, "tour_m": state.tour.arc_m}
        arrays |= {"way_points": state.way.points, "way_m": state.way.tour_m}
        mended = json.dumps([dataclasses.asdict(m) for m in state.mended])
        out = io.BytesIO()
        np.savez(out, key=np.array(key), spacing_m=np.array(spacing_m), mended=np.array(mended), **arrays)
        try:
            self.file.parent.mkdir(parents=True, exist_ok=True)
            part = self.file.with_suffix(".part")
            part.write_bytes(out.getvalue())
            part.replace(self.file)
        except OSError as error:
            _log.warning("the path cannot be kept in %s (%s); set state_dir to another folder", self.file, error)

    def load(self, key: str) -> tuple[State, float] | None:
        """Returns the state of a revision and its spacing, if it is the one that was written last."""
        try:
            with np.load(io.BytesIO(self.file.read_bytes()), allow_pickle=False) as found:
                if str(found["key"]) != key:
                    return None
                state = State(
                    tour=Polyline(found["tour_points"], found["tour_m"]),
                    way=Way(points=found["way_points"], tour_m=found["way_m"]),
                    mended=tuple(Mended(**m) for m in json.loads(str(found["mended"]))),
                    terms={name[5:]: found[name] for name in found.files if name.startswith("term_")},
                    **{name: found[name] for name in _ARRAYS},
                )
                return state, float(found["spacing_m"])
        except (OSError, ValueError, KeyError, TypeError, zipfile.BadZipFile):
            # Nothing kept yet, or a file that is none of ours: the path is solved.
            return None
