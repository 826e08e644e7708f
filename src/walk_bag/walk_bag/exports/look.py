# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""How a building looks in a video: a colour for each kind of part, and light that does not depend on the eye."""

from __future__ import annotations

import dataclasses

import numpy as np
from numpy.typing import NDArray

from walk_bag.exports.glb import kinds
from walk_building.model import Model

SKY_LOW, SKY_HIGH = (0.93, 0.95, 0.97), (0.60, 0.74, 0.88)
GLASS_OPACITY = 0.35

# By what the name of a kind begins with; the first that fits.
_COLOURS = (
    ("Wall", (0.95, 0.94, 0.91)),
    ("Slab", (0.76, 0.71, 0.64)),
    ("Covering", (0.93, 0.92, 0.89)),
    ("Roof", (0.72, 0.58, 0.50)),
    ("Stair", (0.66, 0.64, 0.62)),
    ("Ramp", (0.66, 0.64, 0.62)),
    ("Railing", (0.48, 0.50, 0.53)),
    ("Column", (0.86, 0.85, 0.83)),
    ("Beam", (0.62, 0.50, 0.38)),
    ("Door", (0.64, 0.47, 0.32)),
    ("Window", (0.62, 0.76, 0.84)),
    ("CurtainWall", (0.62, 0.76, 0.84)),
    ("Plate", (0.62, 0.76, 0.84)),
    ("Furni", (0.70, 0.53, 0.38)),
    ("Sanitary", (0.96, 0.97, 0.98)),
)
_OTHER = (0.85, 0.84, 0.81)
_GLASS = ("Window", "CurtainWall", "Plate")

# Light on faces turned to +x, +y, +z and to -x, -y, -z: walls that meet differ, floors are lighter than ceilings.
_LIGHT = np.array([[0.92, 0.80, 0.98], [0.86, 0.74, 0.84]])


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Coloured:
    """Triangles that share no corner, so that each has its own colour; F of them."""

    corners: NDArray[np.float64]  # (3 F, 3) [m]
    rgb: NDArray[np.uint8]  # (3 F, 3)


def coloured(model: Model) -> tuple[Coloured, Coloured]:
    """Returns all that one cannot see through, and the glass, with light and colour in the corners.

    Colours that are ready when a picture is drawn leave nothing to work out for each of its pixels, which is what
    drawing without a graphics card spends its time on.
    """
    solid: list[tuple[str, NDArray[np.int32]]] = []
    glass: list[tuple[str, NDArray[np.int32]]] = []
    for name, triangles in kinds(model):
        (glass if name.startswith(_GLASS) else solid).append((name, triangles))
    return _joined(model, solid), _joined(model, glass)


def _joined(model: Model, named: list[tuple[str, NDArray[np.int32]]]) -> Coloured:
    corners, rgb = [np.empty((0, 3))], [np.empty((0, 3))]
    for name, triangles in named:
        faces = model.vertices[triangles]
        colour = next((rgb for start, rgb in _COLOURS if name.startswith(start)), _OTHER)
        corners.append(faces.reshape(-1, 3))
        rgb.append(np.repeat(_light(faces)[:, None] * np.array(colour), 3, axis=0))
    return Coloured(corners=np.vstack(corners), rgb=np.round(255.0 * np.vstack(rgb)).astype(np.uint8))


def _light(faces: NDArray[np.float64]) -> NDArray[np.float64]:
    """Returns how bright faces (F, 3, 3) are (F,): between the six lights by the squares of the normal's parts."""
    normal = np.cross(faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0])
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.where(length > 0.0, normal / np.maximum(length, 1e-300), [0.0, 0.0, 1.0])
    away = (normal < 0.0).astype(int)
    return np.asarray((normal**2 * _LIGHT[away, np.arange(3)]).sum(axis=1))
