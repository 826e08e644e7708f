# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""How well rooms and doors that were found agree with those that a file declares."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
import trimesh

from walk_building import Building, LoadOptions, Model, Walker, prepare_building
from walk_building.loaders import ifc, load_model

SAMPLE = Path(__file__).resolve().parents[1] / "src/walk_bringup/buildings/sample.ifc"


@dataclasses.dataclass(frozen=True, kw_only=True)
class Score:
    """Shares of the declared that are found, and of the found that are declared; names of what is missed."""

    recall: float
    precision: float
    mean_iou: float = 1.0
    missed: tuple[str, ...] = ()


def room_score(model: Model) -> Score:
    """Compares the rooms found with the spaces ignored to the spaces: the same from an IoU of 0.5 on.

    Both are sets of the same places, where a walker can stand. A declared space without any is no room to find.
    """
    truth = prepare_building(model, LoadOptions(), Walker())
    found = prepare_building(dataclasses.replace(model, spaces=()), LoadOptions(), Walker())
    np.testing.assert_array_equal(truth.surface.places, found.surface.places)
    declared = [room for room in truth.rooms if len(room.places)]
    iou = np.array([[_iou(a.places, b.places) for b in found.rooms] for a in declared])
    return Score(
        recall=float((iou.max(axis=1) >= 0.5).mean()),
        precision=float((iou.max(axis=0) >= 0.5).mean()),
        mean_iou=float(iou.max(axis=1).mean()),
        missed=tuple(room.name for room, best in zip(declared, iou.max(axis=1), strict=True) if best < 0.5),
    )


def door_score(path: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Score:
    """Compares the closed doors found in one mesh without names, leaves included, to the doors of the IFC file."""
    doors = load_model(path).doors
    with monkeypatch.context() as patch:
        patch.setattr(ifc, "_door_of", lambda product: None)
        closed = load_model(path, LoadOptions(doors=""))
    trimesh.Trimesh(closed.vertices, closed.faces, process=False).export(tmp_path / "closed.ply")
    found = prepare_building(load_model(tmp_path / "closed.ply"), LoadOptions(), Walker()).closed_doors
    same = np.array([[_same_door(door.centre, f.position) for f in found] for door in doors])
    assert same.sum(axis=1).max() == 1, "a door is reported twice"
    return Score(recall=float(same.any(axis=1).mean()), precision=float(same.any(axis=0).mean()))


def _iou(a: np.ndarray, b: np.ndarray) -> float:
    both = len(np.intersect1d(a, b))
    return both / (len(a) + len(b) - both)


def _same_door(centre: np.ndarray, foot: np.ndarray) -> bool:
    return bool(np.linalg.norm(centre[:2] - foot[:2]) < 0.5 and 0.5 < centre[2] - foot[2] < 1.5)


def described(building: Building) -> list[tuple[int, float]]:
    """Storey and area of the reachable rooms, largest first."""
    return sorted(((r.storey, round(r.area_m2, 1)) for r in building.rooms if r.reachable), key=lambda r: -r[1])
