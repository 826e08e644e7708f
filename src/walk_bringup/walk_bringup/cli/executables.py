# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Finding the executables of the built packages, as `ros2 run` does."""

from __future__ import annotations

import os
from pathlib import Path

from walk_bringup.bootstrap.errors import SetupError


class ExecutableError(SetupError):
    """An executable that no package has.

    Attributes:
        package: Where it was looked for.
        name: What was looked for.
    """

    def __init__(self, package: str, name: str) -> None:
        self.package = package
        self.name = name
        there = sorted(executables(package))
        found = f"it has {', '.join(there)}" if there else "it has none"
        packages = ", ".join(packages_with_executables())
        where = f"package {package!r} has no executable {name!r}; {found}"
        super().__init__(where if _exists(package) else f"there is no package {package!r}; packages: {packages}")


def executables(package: str) -> dict[str, Path]:
    """Returns the executables of a package by name."""
    found: dict[str, Path] = {}
    for prefix in reversed(_prefixes()):
        folder = prefix / "lib" / package
        if folder.is_dir():
            files = (file for file in folder.iterdir() if file.is_file() and os.access(file, os.X_OK))
            found.update({file.name: file for file in files})
    return found


def find_executable(package: str, name: str) -> Path:
    """Returns the path of an executable.

    Raises:
        ExecutableError: There is none of that name.
    """
    found = executables(package).get(name)
    if found is None:
        raise ExecutableError(package, name)
    return found


def packages_with_executables() -> list[str]:
    """Returns the packages of this workspace that have executables."""
    index = "share/ament_index/resource_index/packages"
    names = {file.name for prefix in _prefixes() for file in (prefix / index).glob("walk_*")}
    return sorted(name for name in names if executables(name))


def _exists(package: str) -> bool:
    return any((prefix / "share" / package / "package.xml").exists() for prefix in _prefixes())


def _prefixes() -> list[Path]:
    return [Path(prefix) for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if prefix]
