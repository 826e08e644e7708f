# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import ast
import json
import re
import sys
import xml.etree.ElementTree as ET
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

from walk_bringup.bootstrap.layout import PACKAGES, Layout

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = Layout(ROOT).packages()
IDS = [folder.name for folder in FOLDERS]

ROSDEP = {
    "aiohttp": "python3-aiohttp",
    "click": "python3-click",
    "collada": "python3-collada",
    "cryptography": "python3-cryptography",
    "fcl": "python-fcl-pip",
    "jinja2": "python3-jinja2",
    "matplotlib": "python3-matplotlib",
    "networkx": "python3-networkx",
    "numba": "python3-numba",
    "numpy": "python3-numpy",
    "rich": "python3-rich",
    "rosbags": "python3-rosbags-pip",
    "rtree": "python3-rtree",
    "scipy": "python3-scipy",
    "shapely": "python3-shapely",
    "trimesh": "python3-trimesh-pip",
    "yaml": "python3-yaml",
}
"""rosdep keys by module."""

WITHOUT_KEY = {
    "DracoPy": "DracoPy",
    "cbor2": "cbor2",
    "embreex": "embreex",
    "fast_simplification": "fast-simplification",
    "foxglove": "foxglove-sdk",
    "ifcopenshell": "ifcopenshell",
    "imageio_ffmpeg": "imageio-ffmpeg",
    "mcap": "mcap",
    "ompl": "ompl",
    "orjson": "orjson",
    "pxr": "usd-core",
    "pyvista": "pyvista",
    "segno": "segno",
    "vtkmodules": "pyvista",
}
"""Modules that rosdep does not know, with what pip calls them; docs/ros2.md has the line for them."""


def _dependencies(folder: Path) -> set[str]:
    tree = ET.parse(folder / "package.xml").getroot()
    return {element.text or "" for element in tree if element.tag in ("depend", "exec_depend")}


def _modules(folder: Path) -> set[str]:
    found: set[str] = set()
    for file in [*(folder / folder.name).rglob("*.py"), *folder.glob("launch/*.py")]:
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                found |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
                found.add(node.module.split(".")[0])
    return found


def test_all_packages_of_the_project_are_there() -> None:
    assert set(PACKAGES) <= set(IDS)


@pytest.mark.parametrize("folder", FOLDERS, ids=IDS)
def test_package_names_agree(folder: Path) -> None:
    name = folder.name
    tree = ET.parse(folder / "package.xml").getroot()
    assert tree.get("format") == "3"
    assert tree.findtext("name") == name
    assert tree.findtext("export/build_type") == "ament_python"
    assert (folder / "resource" / name).exists()
    assert (folder / name / "py.typed").exists()
    setup_cfg = (folder / "setup.cfg").read_text()
    assert setup_cfg.count(f"$base/lib/{name}\n") == 2
    version = re.search(r'version="([^"]+)"', (folder / "setup.py").read_text())
    assert version is not None
    assert version[1] == tree.findtext("version")


@pytest.mark.parametrize("folder", FOLDERS, ids=IDS)
def test_package_declares_what_it_imports(folder: Path) -> None:
    declared = _dependencies(folder)
    # walk_bringup is built on all others; a measurement takes its sample where it is there.
    ours = {module for module in _modules(folder) if module.startswith("walk_")} - {folder.name, "walk_bringup"}
    ros = {module for module in _modules(folder) if module.endswith(("_msgs", "_srvs")) or module == "rclpy"}
    keys = {ROSDEP[module] for module in _modules(folder) & set(ROSDEP)}
    assert (ours | ros | keys) - declared == set()


def test_packages_depend_on_each_other_without_a_circle() -> None:
    graph = {folder.name: _dependencies(folder) & set(IDS) for folder in FOLDERS}
    assert len(list(TopologicalSorter(graph).static_order())) == len(FOLDERS)


@pytest.mark.parametrize("folder", FOLDERS, ids=IDS)
def test_entry_points_exist(folder: Path) -> None:
    for module, function in re.findall(r'"\w+ = ([\w.]+):(\w+)"', (folder / "setup.py").read_text()):
        file = folder / (module.replace(".", "/") + ".py")
        names = {node.name for node in ast.parse(file.read_text()).body if isinstance(node, ast.FunctionDef)}
        assert function in names


def test_modules_without_a_rosdep_key_stand_in_the_documentation() -> None:
    used = set().union(*(_modules(folder) for folder in FOLDERS)) & set(WITHOUT_KEY)
    documented = (ROOT / "docs" / "ros2.md").read_text(encoding="utf-8")
    installed = set(re.findall(r"pip install --break-system-packages ((?:[^\\\n]|\\\n)*)", documented)[0].split())
    assert {WITHOUT_KEY[module] for module in used} <= installed


def test_every_module_is_of_a_package_that_somebody_installs() -> None:
    # What comes with ROS itself is declared too, and tested above.
    known = {*ROSDEP, *WITHOUT_KEY, "rclpy", "ament_index_python", "launch", "launch_ros", *sys.stdlib_module_names}
    for folder in FOLDERS:
        others = {m for m in _modules(folder) if not m.startswith("walk_") and not m.endswith(("_msgs", "_srvs"))}
        assert others - known <= {"builtin_interfaces", "rcl_interfaces"}, folder.name


def test_colcon_runs_the_tests_of_each_package() -> None:
    names = json.loads((ROOT / "colcon.meta").read_text())["names"]
    assert set(PACKAGES) <= set(names)
    for name, entry in names.items():
        assert entry["pytest-args"][-1] == f"../../tests/{name}"


@pytest.mark.parametrize("folder", FOLDERS, ids=IDS)
def test_package_has_a_changelog_where_ros_looks_for_it(folder: Path) -> None:
    text = (folder / "CHANGELOG.rst").read_text(encoding="utf-8")
    title = f"Changelog for package {folder.name}"
    bar = "^" * len(title)
    assert f"{bar}\n{title}\n{bar}\n" in text
    assert re.search(r"^(Forthcoming|\d+\.\d+\.\d+ \(\d{4}-\d\d-\d\d\))\n-+\n\* ", text, re.MULTILINE)
