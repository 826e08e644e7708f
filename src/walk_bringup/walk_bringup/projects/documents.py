# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What project.yaml and the files of the tours say."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_bringup.projects.errors import ProjectError
from walk_bringup.projects.files import Layout, read_yaml, to_yaml
from walk_sequencer.keypoints import Keypoints, rows
from walk_sequencer.whole import plain, whole

SAMPLE = "the sample building"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Reference:
    """The building of a project."""

    path: str  # of its file from the project's folder, "" for the sample building
    name: str  # for the reader
    hash: str  # of file, load options and walker, when it was saved

    @classmethod
    def to(cls, building: Path | None, folder: Path, building_hash: str) -> Reference:
        """Returns the reference to a building's file, None for the sample."""
        if building is None:
            return cls(path="", name=SAMPLE, hash=building_hash)
        path = Path(os.path.relpath(building.resolve(), folder.resolve())).as_posix()
        return cls(path=path, name=building.name, hash=building_hash)

    def found(self, folder: Path) -> Path | None:
        """Returns the file, None for the sample; raises ProjectError where it is not."""
        if not self.path:
            return None
        # Not resolved before the check: the folder may be a link, and the way up from it is meant from its target.
        path = (folder.resolve() / self.path).resolve()
        if not path.is_file():
            raise ProjectError(
                folder, f"its building is not at {path}; if it has moved, say where with --building FILE"
            )
        return path


def write_reference(reference: Reference, saved: Mapping[str, str]) -> bytes:
    """Returns project.yaml; `saved` says when and by which version."""
    return to_yaml("walk_project", {"building": dataclasses.asdict(reference), "saved": dict(saved)})


def read_reference(layout: Layout) -> Reference:
    """Returns the building of a project; raises ProjectError where there is no project, or a damaged one."""
    path = layout.project_file
    if not path.exists():
        raise ProjectError(layout.folder, "is no project: there is no project.yaml in it; ./walk save makes one")
    building = read_yaml(path, "walk_project").get("building")
    names = [field.name for field in dataclasses.fields(Reference)]
    if not isinstance(building, dict) or not all(isinstance(building.get(name), str) for name in names):
        raise ProjectError(path, f"is damaged: 'building' lacks one of {', '.join(names)}")
    return Reference(**{name: building[name] for name in names})


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class SavedTour:
    """A named tour."""

    building_hash: str  # of the building it was saved in
    offset_m: NDArray[np.float64]  # (3,) of that building's coordinates in those of its file
    keypoints: Keypoints
    rooms: Mapping[int, str]  # names by identity, for the reader

    def name_of(self, identity: int) -> str:
        """Returns what a user knows a keypoint by."""
        room = self.rooms.get(identity, "")
        return f"keypoint {identity} ({room})" if room else f"keypoint {identity}"


def write_tour(tour: SavedTour, left_out: Mapping[int, str]) -> bytes:
    """Returns the file of a tour; `left_out` says by identity why the walk does not come to a keypoint."""
    data = plain(tour.keypoints)
    for keypoint in data["keypoints"]:
        identity = keypoint["id"]
        keypoint["room"] = tour.rooms.get(identity, "")
        if identity in left_out:
            keypoint["left_out"] = left_out[identity]
    building = {"hash": tour.building_hash, "offset_m": tour.offset_m.tolist()}
    return to_yaml("walk_tour", {"building": building, **data})


def read_tour(layout: Layout) -> SavedTour:
    """Returns a tour; raises ProjectError where there is none of that name, or a damaged one."""
    path = layout.tour_file
    if not path.exists():
        there = ", ".join(layout.tours()) or "none"
        raise ProjectError(layout.folder, f"has no tour {layout.tour!r}; its tours: {there}")
    data = read_yaml(path, "walk_tour")
    try:
        return SavedTour(
            building_hash=str(data["building"]["hash"]),
            offset_m=rows([data["building"]["offset_m"]], 3)[0],
            keypoints=whole(data),
            rooms={int(k["id"]): str(k.get("room", "")) for k in data["keypoints"]},
        )
    except KeyError as error:
        raise ProjectError(path, f"is damaged: it lacks {error.args[0]!r}") from error
    except (ValueError, TypeError, AttributeError) as error:
        raise ProjectError(path, f"is damaged: {error}") from error
