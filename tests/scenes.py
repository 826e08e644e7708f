# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Small buildings with known answers, made of boxes; shared by the tests of all packages."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh

from walk_building import Building, LoadOptions, Model, Space, Storey, Walker, prepare_building

Box = tuple[tuple[float, float, float], tuple[float, float, float]]
WALL_M = 0.2


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> trimesh.Trimesh:
    """A box between two corners."""
    return trimesh.creation.box(bounds=[low, high])


def model_of(meshes: list[trimesh.Trimesh], spaces: tuple[Space, ...] = (), storeys: tuple[Storey, ...] = ()) -> Model:
    """A model of the given meshes, in metres, z up."""
    mesh = trimesh.util.concatenate(meshes)
    return Model(
        source=Path("scene"),
        content_hash="scene",
        vertices=np.asarray(mesh.vertices, dtype=np.float64),
        faces=np.asarray(mesh.faces, dtype=np.int32),
        parts=(),
        spaces=spaces,
        doors=(),
        storeys=storeys,
        offset_m=np.zeros(3),
        units_m=1.0,
        warnings=(),
    )


def building_of(meshes: list[trimesh.Trimesh], *, walker: Walker | None = None, outdoors: bool = False) -> Building:
    """A prepared building of the given meshes."""
    return prepare_building(model_of(meshes), LoadOptions(outdoors=outdoors), walker or Walker())


def shell(length: float, width: float, height: float = 3.0, z: float = 0.0) -> list[trimesh.Trimesh]:
    """Floor, ceiling and four walls around the inside 0..length, 0..width, z..z + height."""
    t = WALL_M
    return [
        box((-t, -t, z - t), (length + t, width + t, z)),
        box((-t, -t, z + height), (length + t, width + t, z + height + t)),
        box((-t, -t, z), (0, width + t, z + height)),
        box((length, -t, z), (length + t, width + t, z + height)),
        box((0, -t, z), (length, 0, z + height)),
        box((0, width, z), (length, width + t, z + height)),
    ]


def two_rooms(door_m: float = 0.9) -> list[trimesh.Trimesh]:
    """Rooms of 4 x 4 m at x 0..4 and 4.2..8.2, joined by a door in the middle of the wall; door_m 0 for none."""
    low, high = 2.0 - door_m / 2, 2.0 + door_m / 2
    wall = [box((4.0, 0, 0), (4.2, low, 3)), box((4.0, high, 0), (4.2, 4, 3))]
    if door_m > 0:
        wall.append(box((4.0, low, 2.1), (4.2, high, 3)))
    return shell(8.2, 4.0) + wall


def stair(steps: int = 10, rise: float = 0.17, tread: float = 0.28, width: float = 1.4) -> list[trimesh.Trimesh]:
    """A hall with a flight along x from (3, 0) up to a platform that ends the hall; nothing leads past it."""
    top = steps * rise
    flight = [box((3 + k * tread, 0, 0), (3 + (k + 1) * tread, width, (k + 1) * rise)) for k in range(steps)]
    end = 3 + steps * tread
    return shell(end + 3, width, height=top + 2.6) + flight + [box((end, 0, 0), (end + 3, width, top))]


def ramp(slope: float = 0.125, length: float = 8.0, width: float = 2.0) -> list[trimesh.Trimesh]:
    """A hall whose floor rises along x between 2 and 2 + length, then goes on level."""
    top = slope * length
    end = 2 + length
    wedge = trimesh.Trimesh(
        vertices=[(2, 0, 0), (2, width, 0), (end, 0, 0), (end, width, 0), (end, 0, top), (end, width, top)],
        faces=[(0, 4, 5), (0, 5, 1), (0, 2, 4), (1, 5, 3), (2, 3, 5), (2, 5, 4), (0, 1, 3), (0, 3, 2)],
    )
    return shell(end + 2, width, height=top + 2.6) + [wedge, box((end, 0, 0), (end + 2, width, top))]
