# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From a building file to a Building."""

from __future__ import annotations

import dataclasses
import hashlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from walk_building.building import Building
from walk_building.closed_doors import closed_door_warnings, find_closed_doors
from walk_building.entrance import find_entrance
from walk_building.errors import BuildingError
from walk_building.geometry import Geometry
from walk_building.ground import Ground
from walk_building.indoors import (
    DOORWAY_DEPTH_M,
    close_gaps,
    covered,
    declared_space,
    enclosed,
    has_ceilings,
    surface_distance,
)
from walk_building.loaders import load_model
from walk_building.model import LoadOptions, Model
from walk_building.narrow import usual_width, with_narrow_rooms
from walk_building.partition import partition
from walk_building.progress import Progress, no_progress
from walk_building.raster import Columns, Hits, cast_columns
from walk_building.solids import inside_solids
from walk_building.standing import neighbour_graph, standing_places
from walk_building.storeys import find_storeys, storey_of
from walk_building.surface import WalkableSurface, grid_of
from walk_building.walker import Walker

# Vertical rays times the faces they meet; the garage of 13,000 m² that this was tried on has 5 million and takes 1 GB.
_MAX_HITS = 3e7
CELL_M = 0.1  # half of a narrow doorway's free play for the body; finer costs memory by its square
_STAGE = "building"


def load_building(
    path: Path | str,
    options: LoadOptions | None = None,
    walker: Walker | None = None,
    progress: Progress = no_progress,
) -> Building:
    """Reads a building file and finds where a walker can be in it.

    Raises:
        BuildingError: The file cannot be used; the message says why and what to do.
    """
    options = options or LoadOptions()
    progress(_STAGE, 0.0)
    model = load_model(path, options)
    progress(_STAGE, 0.4)
    building = prepare_building(model, options, walker or Walker())
    progress(_STAGE, 1.0)
    return building


def prepare_building(model: Model, options: LoadOptions, walker: Walker) -> Building:
    """Finds the walkable surface, the storeys and the rooms of a model.

    Raises:
        BuildingError: There is no floor in it that a walker could stand on.
    """
    _check_size(model)
    geometry = Geometry(model.vertices, model.faces)
    columns = Columns.over(geometry.bounds, CELL_M)
    hits = cast_columns(columns, model.vertices, model.faces)
    building = _prepared(model, options, walker, geometry, columns, hits)
    usual = usual_width(walker)
    if usual == walker:
        return building
    return with_narrow_rooms(building, _prepared(model, options, usual, geometry, columns, hits))


def _prepared(
    model: Model, options: LoadOptions, walker: Walker, geometry: Geometry, columns: Columns, hits: Hits
) -> Building:
    """Returns the building as a walker finds it."""
    places, column_start = standing_places(geometry, walker, columns, hits)
    if len(places) == 0:
        raise BuildingError(model.source, _no_floor(model, walker))
    grid = grid_of(columns, column_start, places)
    indptr, neighbours = neighbour_graph(grid, walker.step_m)

    column = np.repeat(np.arange(columns.count), np.diff(column_start))
    space = declared_space(columns, model.spaces, column, places[:, 2])
    is_covered = _covered(model, walker, hits, column, places[:, 2])
    inside = _indoor(model, walker, columns, hits, column, places, space, is_covered)
    if model.spaces:
        inside = close_gaps(indptr, neighbours, places, inside, DOORWAY_DEPTH_M)
    storeys = model.storeys or find_storeys(places[inside, 2] if inside.any() else places[:, 2])

    edge = np.diff(indptr) < 8
    clearance = surface_distance(indptr, neighbours, places, edge) + columns.cell_m / 2
    ground = Ground(
        model=model, geometry=geometry, columns=columns, hits=hits, storeys=storeys, places=places, column=column,
        indptr=indptr, neighbours=neighbours, clearance_m=clearance, space=space, step_m=walker.step_m,
    )  # fmt: skip
    parts = partition(ground, inside, outdoors=options.outdoors)
    closed = () if model.doors else find_closed_doors(geometry, places[edge], parts.indoor[edge], walker.radius_m)
    surface = WalkableSurface(
        columns=columns,
        step_m=walker.step_m,
        places=places,
        column_start=column_start,
        indptr=indptr,
        neighbours=neighbours,
        indoor=parts.indoor,
        component=parts.component,
        clearance_m=clearance,
        room=parts.room,
        storey=storey_of(storeys, places[:, 2]),
    )
    for array in (places, column_start, indptr, neighbours, clearance):
        array.setflags(write=False)
    for array in (parts.indoor, parts.component, parts.room, parts.reachable):
        array.setflags(write=False)
    return Building(
        model=model,
        walker=walker,
        geometry=geometry,
        surface=surface,
        storeys=storeys,
        rooms=parts.rooms,
        start_component=parts.start,
        reachable=parts.reachable,
        entrance=find_entrance(
            places,
            indptr,
            neighbours,
            parts.component,
            parts.reachable,
            place_area_m2=columns.cell_m**2,
            doors=model.doors,
        ),
        hash=building_hash(model, options, walker),
        warnings=model.warnings + closed_door_warnings(closed, model.offset_m),
        closed_doors=closed,
    )


def _covered(
    model: Model, walker: Walker, hits: Hits, column: NDArray[np.int64], z: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Which places are under something, other than under the skin of the solid they are in."""
    under = covered(hits, column, z, walker.height_m)
    in_the_open = under & ~inside_solids(model.vertices, model.faces, hits, column, z)
    # A building drawn as one closed sheet is its own solid: then its inside is what is meant.
    return in_the_open if in_the_open.any() else under


def _indoor(
    model: Model,
    walker: Walker,
    columns: Columns,
    hits: Hits,
    column: NDArray[np.int64],
    places: NDArray[np.float64],
    space: NDArray[np.int32],
    is_covered: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """Which places are indoors, by the best evidence there is; see indoors.py."""
    ceilings = has_ceilings(is_covered)
    if model.spaces:
        # Files declare spaces on roofs and terraces, too; what has nothing above it is not indoors.
        in_space = (space >= 0) & (is_covered | (not ceilings))
        with_spaces = {s.storey for s in model.spaces}
        bare = np.array([s.name not in with_spaces for s in model.storeys] or [False])
        on_bare_storey = bare[storey_of(model.storeys, places[:, 2])] if model.storeys else np.zeros_like(in_space)
        return np.asarray(in_space | (on_bare_storey & is_covered))
    if ceilings:
        return is_covered
    floor = float(np.median(places[:, 2]))
    wall_height = (hits.z > floor + walker.step_m) & (hits.z < floor + 2 * walker.height_m)
    walls = np.zeros(columns.count, bool)
    walls[np.repeat(np.arange(columns.count), np.diff(hits.start))[wall_height]] = True
    # Without ceilings there is one storey, and what a walker could stand on above its walls' lower part is furniture
    # and the tops of walls.
    low = places[:, 2] < floor + walker.height_m
    return enclosed(columns, column, walls) & low


def _check_size(model: Model) -> None:
    """Refuses a model whose floors are so large that laying a grid over them would take all memory."""
    corner = model.vertices[model.faces]
    side = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    level_m2 = float(np.abs(side[:, 2]).sum() / 2)
    size = np.ptp(model.vertices, axis=0)
    if max(level_m2, float(size[0] * size[1])) * CELL_M**-2 <= _MAX_HITS:
        return
    raise BuildingError(
        model.source,
        f"too large to plan in at once: {size[0]:.0f} x {size[1]:.0f} x {size[2]:.0f} m with a unit of "
        f"{model.units_m:g} m, {level_m2:.0f} m² of surface seen from above; if the unit is another one, say so with "
        "--units (mm, cm, in, ft, or its length in metres), else leave parts out with --ignore",
    )


def _no_floor(model: Model, walker: Walker) -> str:
    size = np.ptp(model.vertices, axis=0)
    return (
        f"no floor that a person of {walker.height_m:g} m height and {walker.radius_m:g} m radius can stand on; "
        f"the model measures {size[0]:.2f} x {size[1]:.2f} x {size[2]:.2f} m (z up): "
        "check --units and --up, or use a smaller walker"
    )


def building_hash(model: Model, options: LoadOptions, walker: Walker) -> str:
    """Returns the name of a building: of the file, the load options and the walker, hex."""
    settings = repr((model.content_hash, dataclasses.astuple(options), dataclasses.astuple(walker), CELL_M))
    return hashlib.sha256(settings.encode()).hexdigest()
