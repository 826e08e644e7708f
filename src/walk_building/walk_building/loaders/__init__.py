# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Building files of every format as one `Model`. A new format is one new file and one line in `LOADERS`."""

from __future__ import annotations

import stat
from pathlib import Path

from walk_building.errors import BuildingError
from walk_building.fingerprint import content_hash
from walk_building.loaders.assemble import assemble
from walk_building.loaders.ifc import load_ifc
from walk_building.loaders.mesh import load_mesh
from walk_building.loaders.raw import Loader, PartFilter, RawMesh, RawModel
from walk_building.model import LoadOptions, Model
from walk_building.progress import Progress, no_progress

__all__ = ["LOADERS", "Loader", "PartFilter", "RawMesh", "RawModel", "check_file", "load_model"]

LOADERS: dict[str, Loader] = {
    ".ifc": load_ifc,
    ".ifczip": load_ifc,
    ".glb": load_mesh,
    ".gltf": load_mesh,
    ".obj": load_mesh,
    ".ply": load_mesh,
    ".stl": load_mesh,
    ".dae": load_mesh,
}


def load_model(path: Path | str, options: LoadOptions | None = None, progress: Progress = no_progress) -> Model:
    """Returns the building of a file as triangles in metres, z up, near the origin.

    Args:
        path: The file; its suffix, in any case, chooses the loader from `LOADERS`.
        options: How to read it; by default everything is asked from the file.
        progress: Told the share done of the stage "load".

    Raises:
        BuildingError: The file is missing, cannot be read as what its suffix says, or holds no usable building.
        ParameterError: `options.ignore` is no regular expression.
    """
    path = Path(path)
    options = LoadOptions() if options is None else options
    part_filter = PartFilter(options.ignore)
    loader = check_file(path)
    progress("load", 0.0)
    try:
        raw = loader(path, options, part_filter, progress)
        name = content_hash(path, raw.references, options)
    except OSError as error:
        raise BuildingError(path, f"cannot be read ({error.strerror or error})") from error
    model = assemble(raw, path, options, part_filter, name)
    progress("load", 1.0)
    return model


def check_file(path: Path) -> Loader:
    """Returns the loader of a building file that is there, not empty and of a known suffix; raises BuildingError."""
    _check_readable(path)
    return _loader_for(path)


def _check_readable(path: Path) -> None:
    try:
        mode = path.stat().st_mode
        if stat.S_ISDIR(mode):
            raise BuildingError(path, "is a folder; give the building file inside it")
        if not stat.S_ISREG(mode):
            raise BuildingError(path, "is no ordinary file")
        with path.open("rb") as file:
            empty = not file.read(1)
    except (FileNotFoundError, NotADirectoryError) as error:
        raise BuildingError(path, "there is no such file") from error
    except (OSError, ValueError) as error:
        raise BuildingError(path, f"cannot be read ({getattr(error, 'strerror', None) or error})") from error
    if empty:
        raise BuildingError(path, "the file is empty")


def _loader_for(path: Path) -> Loader:
    loader = LOADERS.get(path.suffix.lower())
    if loader is None:
        given = f"the suffix {path.suffix} is not known" if path.suffix else "the file name has no suffix"
        raise BuildingError(path, f"{given}; expected one of {', '.join(LOADERS)}")
    return loader
