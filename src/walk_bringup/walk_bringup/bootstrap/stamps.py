# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps: what a stage of the set-up was done for, so that it is done again only when that changes."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable
from pathlib import Path


def fingerprint(texts: Iterable[str], files: Iterable[Path] = ()) -> str:
    """Returns a hash of texts and of the names and contents of files."""
    digest = hashlib.sha256()
    for text in texts:
        digest.update(text.encode() + b"\0")
    for file in files:
        digest.update(str(file).encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()


def fingerprint_of_times(files: Iterable[Path]) -> str:
    """Returns a hash of the names, sizes and times of files, the same facts that numba's cache goes by."""
    facts = ((file, file.stat()) for file in files)
    return fingerprint(f"{file} {stat.st_size} {stat.st_mtime_ns}" for file, stat in facts)


def write_json(path: Path, content: object) -> None:
    """Writes a file whole or not at all, so that an interrupted set-up leaves no half stamp."""
    path.parent.mkdir(parents=True, exist_ok=True)
    draft = path.with_suffix(f".{os.getpid()}.tmp")
    draft.write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")
    draft.replace(path)


def read_json(path: Path) -> object:
    """Returns what a file holds, None where it is missing or damaged."""
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return None
