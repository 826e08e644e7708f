# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The sample building from its plan to its file."""

from __future__ import annotations

from pathlib import Path

from walk_bringup.sample import plan
from walk_bringup.sample.circulation import EASTWARD, add_guards, add_ramp, add_stair
from walk_bringup.sample.ifc_file import IfcFile
from walk_bringup.sample.interior import add_furniture
from walk_bringup.sample.openings import add_wall
from walk_bringup.sample.plan import Block, Room
from walk_bringup.sample.rooms import rooms
from walk_bringup.sample.structure import add_structure
from walk_bringup.sample.walls import walls


def make_sample(path: Path | str) -> Path:
    """Writes the sample building as IFC4, in metres; returns the path. The same plan gives the same bytes."""
    path = Path(path)
    file = IfcFile("House of culture", {"Ground floor": 0.0, "Upper floor": plan.RISE})
    add_structure(file)
    for wall in walls():
        add_wall(file, wall)
    add_stair(file)
    add_ramp(file)
    add_guards(file)
    for room in rooms():
        _add_room(file, room)
    add_furniture(file)
    file.save(path)
    return path


def _add_room(file: IfcFile, room: Room) -> None:
    solids = []
    for piece in room.pieces:
        if isinstance(piece, Block):
            solids.append(file.shapes.prism(piece.outline, piece.foot, piece.top))
        else:
            middle, width = (piece.south + piece.north) / 2, piece.north - piece.south
            solids.append(file.shapes.upright(piece.outline, (0.0, middle), EASTWARD, width))
    file.space(room.number, room.name, file.storeys[room.storey], solids)
