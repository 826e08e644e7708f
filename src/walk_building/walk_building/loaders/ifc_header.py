# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The text of an IFC file and the schema its header names, checked before the engine parses it."""

from __future__ import annotations

import re
import zipfile
import zlib
from collections.abc import Collection
from pathlib import Path

from walk_building.errors import BuildingError

_SCHEMA = re.compile(rb"FILE_SCHEMA\s*\(\s*\(\s*'([^']*)'", re.IGNORECASE)

# Names that exporters write for what is, in all that shapes a building, a schema the engine knows.
_SAME_AS = {
    **dict.fromkeys(("IFC2X_FINAL", "IFC2X3_FINAL", "IFC2X3_TC1"), "IFC2X3"),
    **dict.fromkeys(("IFC4_ADD1", "IFC4_ADD2", "IFC4_ADD2_TC1"), "IFC4"),
    **dict.fromkeys(("IFC4X3", "IFC4X3_ADD1", "IFC4X3_TC1"), "IFC4X3_ADD2"),
}
_NOT_ASCII = re.compile(r"[^\x00-\x7f]+")

# A header longer than this is none.
_HEADER_BYTES = 65536


def read_step(path: Path, known: Collection[str]) -> str:
    """Returns the STEP text of an `.ifc` or `.ifczip` file, its schema under a name the engine knows.

    Args:
        path: The file.
        known: The schemas the engine reads.

    Raises:
        BuildingError: It is no STEP file, is of another schema, or ends before its end.
    """
    data = _unzipped(path) if path.suffix.lower() == ".ifczip" else path.read_bytes()
    head = data[:_HEADER_BYTES]
    if b"ISO-10303-21" not in head[:1024]:
        raise BuildingError(path, "is not an IFC file (it does not start with ISO-10303-21)")
    match = _SCHEMA.search(head)
    if match is None:
        raise BuildingError(path, "is not an IFC file (its header names no schema)")
    given = match.group(1).decode("ascii", "replace").upper()
    name = _SAME_AS.get(given, given)
    if name not in known:
        expected = ", ".join(sorted(known))
        raise BuildingError(path, f"its schema {given!r} cannot be read; export it as one of {expected}")
    if b"END-ISO-10303-21" not in data[-1024:]:
        raise BuildingError(path, "is cut short (END-ISO-10303-21 is missing); copy or export it again")
    return _text(data[: match.start(1)] + name.encode() + data[match.end(1) :])


def _text(data: bytes) -> str:
    """Returns the file as ASCII: exporters write names as they come, and the engine drops what is not escaped."""
    if data.isascii():
        return data.decode("ascii")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        text = data.decode("latin-1")
    return _NOT_ASCII.sub(lambda found: "\\X4\\" + found.group().encode("utf-32-be").hex().upper() + "\\X0\\", text)


def _unzipped(path: Path) -> bytes:
    try:
        with zipfile.ZipFile(path) as archive:
            names = [name for name in archive.namelist() if name.lower().endswith(".ifc")]
            if not names:
                raise BuildingError(path, "holds no .ifc file")
            return archive.read(names[0])
    except (zipfile.BadZipFile, zlib.error, NotImplementedError, RuntimeError, EOFError) as error:
        raise BuildingError(path, f"cannot be unpacked ({error})") from error
