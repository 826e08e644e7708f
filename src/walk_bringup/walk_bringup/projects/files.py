# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The files of a project: where they are, written whole or not at all, read with their version checked."""

from __future__ import annotations

import contextlib
import dataclasses
import fcntl
import os
import re
import time
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import yaml

from walk_bringup.projects.errors import ProjectError

VERSION = 1
"""Of the files; raised when one gets another meaning."""

_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_-]{0,63}")


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Where the files of one tour of a project are."""

    folder: Path
    tour: str  # its name

    def __post_init__(self) -> None:
        if not _NAME.fullmatch(self.tour):
            raise ProjectError(self.folder, f"{self.tour!r} is no name of a tour: letters, digits, - and _ make one")

    @property
    def project_file(self) -> Path:
        """The building, and who saved when."""
        return self.folder / "project.yaml"

    @property
    def parameters_file(self) -> Path:
        """The parameters of the nodes, as ROS reads them."""
        return self.folder / "parameters.yaml"

    @property
    def tour_file(self) -> Path:
        """The keypoints of the tour and their order."""
        return self.folder / "tours" / f"{self.tour}.yaml"

    @property
    def journal_file(self) -> Path:
        """How the tour came to be: what undo takes back."""
        return self.folder / "tours" / f"{self.tour}.jsonl"

    @property
    def path_file(self) -> Path:
        """The path through the tour as it was shown last; without it, it is solved anew."""
        return self.folder / "tours" / f"{self.tour}.path.npz"

    @property
    def state_dir(self) -> Path:
        """Where an opened tour is edited."""
        return self.folder / "state" / self.tour

    def tours(self) -> list[str]:
        """Returns the names of the tours there are."""
        return sorted(file.stem for file in (self.folder / "tours").glob("*.yaml"))


def write(folder: Path, path: Path, data: bytes) -> None:
    """Writes a file of a project, whole or not at all; another content that was there is kept in `backup`.

    Raises:
        ProjectError: It cannot be written.
    """
    try:
        if path.exists() and path.read_bytes() != data:
            put_aside(folder, path)
        path.parent.mkdir(parents=True, exist_ok=True)
        _replace(path, data)
    except OSError as error:
        raise ProjectError(path, f"cannot be written: {error.strerror or error}") from error


def put_aside(folder: Path, path: Path) -> Path:
    """Copies a file into the project's `backup`, under a name with the time; returns where."""
    backup = folder / "backup"
    backup.mkdir(parents=True, exist_ok=True)
    moment = time.strftime("%Y%m%dT%H%M%SZ", time.gmtime())
    stem, suffix = path.name.split(".", 1)
    numbers = ("", *(f"-{n}" for n in range(1, 10000)))
    aside = next(a for n in numbers if not (a := backup / f"{stem}-{moment}{n}.{suffix}").exists())
    _replace(aside, path.read_bytes())
    return aside


def _replace(path: Path, data: bytes) -> None:
    part = path.with_name(f".{path.name}.part")
    with part.open("wb") as file:
        file.write(data)
        file.flush()
        os.fsync(file.fileno())
    part.replace(path)


def to_yaml(what: str, document: Mapping[str, Any]) -> bytes:
    """Returns a document of this version as YAML; `what` it is comes first, with the version."""
    text: str = yaml.safe_dump(
        {what: VERSION, **document}, sort_keys=False, allow_unicode=True, default_flow_style=None, width=120
    )
    return text.encode()


def read_yaml(path: Path, what: str) -> dict[str, Any]:
    """Returns a document that `to_yaml` wrote.

    Raises:
        ProjectError: It cannot be read, is another one, or of a newer version.
    """
    document = load_yaml(path)
    version = document.get(what)
    if isinstance(version, bool) or not isinstance(version, int) or version < 1:
        raise ProjectError(path, f"does not begin with '{what}: {VERSION}'; it is damaged, or no file of a project")
    if version > VERSION:
        raise ProjectError(path, f"is of version {version}, and this program reads {VERSION}: open it with a newer one")
    return document


def load_yaml(path: Path) -> dict[str, Any]:
    """Returns the mapping that a YAML file holds; raises ProjectError if it cannot be read or holds another thing."""
    try:
        document = yaml.safe_load(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ProjectError(path, f"cannot be read: {error.strerror or error}") from error
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        where = getattr(error, "problem_mark", None)
        line = f" in line {where.line + 1}" if where is not None else ""
        raise ProjectError(path, f"is damaged{line}: no YAML; an earlier one may be in 'backup'") from error
    if not isinstance(document, dict):
        raise ProjectError(path, "is damaged: it holds no names and values; an earlier one may be in 'backup'")
    return document


@contextlib.contextmanager
def only_one(layout: Layout) -> Iterator[None]:
    """Keeps others from opening the tour meanwhile; raises ProjectError where another has it open."""
    try:
        layout.state_dir.mkdir(parents=True, exist_ok=True)
        lock = (layout.state_dir / "lock").open("ab")
    except OSError as error:
        raise ProjectError(layout.state_dir, f"cannot be written: {error.strerror or error}") from error
    with lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            raise ProjectError(layout.folder, f"the tour {layout.tour!r} is open in another graph already") from error
        yield
