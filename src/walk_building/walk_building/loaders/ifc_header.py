# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The text of an IFC file and the schema its header names, checked before the engine parses it."""

from __future__ import annotations

import re
import zipfile
import zlib
from pathlib import Path

from walk_building.errors import BuildingError

_SCHEMA = re.compile(rb"FILE_SCHEMA\s*\(\s*\(\s*'([^']*)'", re.IGNORECASE)

# Names for what is, entity by entity, a schema the engine knows under another name.
_SAME_AS = {"IFC2X_FINAL": "IFC2X3", "IFC2X3_FINAL": "IFC2X3", "IFC2X3_TC1": "IFC2X3", "IFC4X3": "IFC4X3_ADD2"}

# A header longer than this is none.
_HEADER_BYTES = 65536


def read_step(path: Path) -> bytes:
    """Returns the STEP text of an `.ifc` or `.ifczip` file with a schema name the engine knows.

    Raises:
        BuildingError: It is no STEP file, names no schema, or ends before its end.
    """
    data = _unzipped(path) if path.suffix.lower() == ".ifczip" else path.read_bytes()
    head = data[:_HEADER_BYTES]
    if b"ISO-10303-21" not in head[:1024]:
        raise BuildingError(path, "is not an IFC file (it does not start with ISO-10303-21)")
    match = _SCHEMA.search(head)
    if match is None:
        raise BuildingError(path, "is not an IFC file (its header names no schema)")
    if b"END-ISO-10303-21" not in data[-1024:]:
        raise BuildingError(path, "is cut short (END-ISO-10303-21 is missing); copy or export it again")
    name = match.group(1).decode("ascii", "replace").upper()
    known = _SAME_AS.get(name, name)
    return data[: match.start(1)] + known.encode("ascii", "replace") + data[match.end(1) :]


def _unzipped(path: Path) -> bytes:
    try:
        with zipfile.ZipFile(path) as archive:
            names = [name for name in archive.namelist() if name.lower().endswith(".ifc")]
            if not names:
                raise BuildingError(path, "holds no .ifc file")
            return archive.read(names[0])
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError, EOFError) as error:
        raise BuildingError(path, f"cannot be unpacked ({error})") from error
