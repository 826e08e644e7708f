# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The rules of the house that no tool knows, read from the syntax trees of the sources."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from walk_bringup.bootstrap.layout import Layout

ENGINES = ("ompl", "scipy.optimize", "fcl", "trimesh", "ifcopenshell", "collada", "rosbags", "mcap", "aiohttp")
"""Libraries that stand behind names of the project: each is imported in one file."""

ENGINE_EXCEPTIONS = (r"\w+/bench(_\w+)?(\.py|/.*)", r"walk_bringup/sample/.*")
"""Patterns of paths: measurements use a library plainly to compare; the sample script writes what the loader reads."""

ROS_FOLDERS = ("walk_ros/", "walk_bag/", "walk_vr_bridge/")
"""Packages that are about ROS; elsewhere only files named node.py import it."""

_ROS_MODULES = ("rclpy", "rosidl_runtime_py", "rcl_interfaces", "builtin_interfaces", "launch", "launch_ros")
_SPDX = (
    "# SPDX-FileCopyrightText: The walkthrough planner's authors",
    "# SPDX-License-Identifier: Apache-2.0",
)


def broken_rules(layout: Layout) -> list[str]:
    """Returns a sentence for every place that breaks a rule."""
    imports = {path: list(_imports(file)) for path, file in _sources(layout)}
    return [*_headers(layout), *_ros_at_the_rim(imports), *_one_engine_one_file(imports), *_not_annotated(layout)]


def _sources(layout: Layout) -> Iterator[tuple[str, Path]]:
    """Yields the path inside of src/PACKAGE, such as `walk_plan/report.py`, and the file."""
    for package in layout.packages():
        for file in sorted((package / package.name).rglob("*.py")):
            yield file.relative_to(package).as_posix(), file


def _imports(file: Path) -> Iterator[tuple[int, str]]:
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            # `from scipy import optimize` is an import of scipy.optimize.
            yield from ((node.lineno, f"{node.module}.{alias.name}") for alias in node.names)


def _is_of(module: str, name: str) -> bool:
    return module == name or module.startswith(name + ".")


def _is_ros(module: str) -> bool:
    first = module.split(".")[0]
    return first.endswith(("_msgs", "_srvs")) or first in _ROS_MODULES


def _ros_at_the_rim(imports: dict[str, list[tuple[int, str]]]) -> Iterator[str]:
    for path, found in imports.items():
        # Beside a node lie the door to it, which imports nothing but the handling of signals, and parts of it.
        if re.search(r"/(node(_\w+)?|__main__)\.py$", path) or path.startswith(ROS_FOLDERS):
            continue
        for line, module in found:
            if _is_ros(module) or _is_of(module, "walk_ros"):
                yield f"{path}:{line}: imports {module}; only node.py files and walk_ros import ROS"


def _one_engine_one_file(imports: dict[str, list[tuple[int, str]]]) -> Iterator[str]:
    for engine in ENGINES:
        users = [
            path
            for path, found in imports.items()
            if any(_is_of(module, engine) for _, module in found) and not _is_exception(path)
        ]
        if len(users) > 1:
            yield f"{engine} is imported in {', '.join(users)}; one engine, one file"


def _is_exception(path: str) -> bool:
    return any(re.fullmatch(pattern, path) for pattern in ENGINE_EXCEPTIONS)


def _not_annotated(layout: Layout) -> Iterator[str]:
    for path, file in _sources(layout):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.FunctionDef) and not _is_kernel(node) and not _is_annotated(node):
                yield f"{path}:{node.lineno}: {node.name} lacks annotations; only numba's kernels may"


def _is_kernel(function: ast.FunctionDef) -> bool:
    return any("jit" in ast.unparse(decorator) for decorator in function.decorator_list)


def _is_annotated(function: ast.FunctionDef) -> bool:
    every = [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs]
    every += [extra for extra in (function.args.vararg, function.args.kwarg) if extra is not None]
    return function.returns is not None and all(arg.annotation or arg.arg in ("self", "cls") for arg in every)


def _headers(layout: Layout) -> Iterator[str]:
    files = [*layout.root.glob("src/**/*.py"), *layout.root.glob("tests/**/*.py")]
    for file in sorted(files):
        lines = file.read_text(encoding="utf-8").splitlines()
        lines = lines[1:] if lines and lines[0].startswith("#!") else lines
        if tuple(lines[:2]) != _SPDX:
            yield f"{file.relative_to(layout.root)}:1: the SPDX header is missing"
