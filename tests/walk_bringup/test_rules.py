# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

from pathlib import Path

import pytest

from walk_bringup.bootstrap.layout import Layout
from walk_bringup.check.rules import broken_rules

SPDX = "# SPDX-FileCopyrightText: The walkthrough planner's authors\n# SPDX-License-Identifier: Apache-2.0\n"


def _source(root: Path, path: str, text: str, header: str = SPDX) -> None:
    package = root / "src" / path.split("/")[0]
    file = package / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(header + text)
    (package / "package.xml").touch()


@pytest.mark.parametrize(
    "line",
    [
        "import rclpy",
        "from rclpy.node import Node",
        "from nav_msgs.msg import Path",
        "from walk_ros.qos import latched",
    ],
)
def test_ros_is_found_in_a_core_and_allowed_in_a_node(line: str, tmp_path: Path) -> None:
    _source(tmp_path, "walk_plan/core.py", f"def f() -> None:\n    {line}\n")
    _source(tmp_path, "walk_plan/node.py", f"{line}\n")
    _source(tmp_path, "walk_ros/any.py", f"{line}\n")
    broken = broken_rules(Layout(tmp_path))
    assert len(broken) == 1
    assert broken[0].startswith("walk_plan/core.py:4: imports ")


@pytest.mark.parametrize(
    "lines", [("import fcl", "from fcl import X"), ("import scipy.optimize", "from scipy import optimize")]
)
def test_second_file_with_an_engine_is_found(lines: tuple[str, str], tmp_path: Path) -> None:
    _source(tmp_path, "walk_building/one.py", lines[0] + "\n")
    assert broken_rules(Layout(tmp_path)) == []
    _source(tmp_path, "walk_plan/bench/two.py", lines[1] + "\n")
    assert broken_rules(Layout(tmp_path)) == []
    _source(tmp_path, "walk_trajopt/two.py", lines[1] + "\n")
    (sentence,) = broken_rules(Layout(tmp_path))
    assert "walk_building/one.py, walk_trajopt/two.py" in sentence


def test_missing_header_is_found(tmp_path: Path) -> None:
    _source(tmp_path, "walk_plan/core.py", "x = 1\n", header="")
    assert broken_rules(Layout(tmp_path)) == ["src/walk_plan/walk_plan/core.py:1: the SPDX header is missing"]


def test_function_without_annotations_is_found_unless_numba_compiles_it(tmp_path: Path) -> None:
    _source(
        tmp_path,
        "walk_plan/core.py",
        "@numba.njit(cache=True)\ndef kernel(a):\n    return a\n\ndef plain(a):\n    return a\n",
    )
    assert broken_rules(Layout(tmp_path)) == ["walk_plan/core.py:7: plain lacks annotations; only numba's kernels may"]
