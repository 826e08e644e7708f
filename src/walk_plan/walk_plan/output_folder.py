# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A folder of results that is there completely or not at all."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Collection
from pathlib import Path
from types import TracebackType

from walk_plan.errors import OutputError


class OutputFolder:
    """Collects files beside the folder wanted, and moves them there when the `with` ends without an error.

    Whatever ends the `with` early, Ctrl-C too, leaves nothing behind and the folder as it was. An existing folder
    may be empty or hold an earlier result, whose files are replaced; any other is refused.

    Args:
        path: The folder wanted.
        marker: A file whose presence tells an earlier result from a folder of somebody's own.
        optional: Files that not every result has; those of an earlier one go.
    """

    def __init__(self, path: Path | str, marker: str, optional: Collection[str] = ()) -> None:
        self.path = Path(path).absolute()
        self._marker = marker
        self._optional = optional
        self._collected: Path | None = None

    def __enter__(self) -> Path:
        """Returns the temporary folder to write to.

        Raises:
            OutputError: The results could not be put where they are wanted.
        """
        self._check()
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._collected = Path(tempfile.mkdtemp(prefix=f".{self.path.name}-", dir=self.path.parent))
        except OSError as error:
            raise OutputError(self.path, f"cannot be written ({error.strerror}); choose another folder") from error
        return self._collected

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Moves the results into place, or removes them after an error."""
        assert self._collected is not None
        try:
            if kind is None:
                self._move()
        finally:
            shutil.rmtree(self._collected, ignore_errors=True)

    def _check(self) -> None:
        if self.path.exists() and not self.path.is_dir():
            raise OutputError(self.path, "is a file; --out names a folder")
        if self.path.is_dir() and any(self.path.iterdir()) and not (self.path / self._marker).exists():
            raise OutputError(self.path, "holds files that are no earlier plan; choose a new or an empty folder")
        if self.path.is_dir() and not os.access(self.path, os.W_OK | os.X_OK):
            raise OutputError(self.path, "cannot be written (no permission); choose another folder")

    def _move(self) -> None:
        assert self._collected is not None
        try:
            self.path.mkdir(exist_ok=True)
            # The marker first out and last in: a folder that is cut off half-way never looks complete.
            for name in (self._marker, *self._optional):
                (self.path / name).unlink(missing_ok=True)
            for made in sorted(self._collected.iterdir(), key=lambda made: made.name == self._marker):
                target = self.path / made.name
                if target.is_dir() and not target.is_symlink():
                    shutil.rmtree(target)
                made.replace(target)
        except OSError as error:
            raise OutputError(self.path, f"cannot be written ({error.strerror}); choose another folder") from error
