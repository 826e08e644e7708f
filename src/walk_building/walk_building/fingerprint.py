# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The hash that names a loaded building, the same on every machine and in every folder."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from collections.abc import Iterable
from pathlib import Path

from walk_building.model import LoadOptions


def content_hash(path: Path, references: Iterable[bytes], options: LoadOptions) -> str:
    """Returns the sha256, in hex, of the file, the files it refers to and the load options.

    Each piece is hashed by itself first, so that bytes cannot wander from one piece to the next unnoticed.
    """
    with path.open("rb") as file:
        pieces = [hashlib.file_digest(file, "sha256").digest()]
    pieces += [hashlib.sha256(reference).digest() for reference in references]
    settings = json.dumps(dataclasses.asdict(options), sort_keys=True)
    pieces.append(hashlib.sha256(settings.encode()).digest())
    return hashlib.sha256(b"".join(pieces)).hexdigest()
