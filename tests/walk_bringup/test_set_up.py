# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import dataclasses
import io
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from walk_bringup.bootstrap import build, doctor, environment, installation, venv
from walk_bringup.bootstrap import setup as bootstrap_setup
from walk_bringup.bootstrap.checks import Check, machine_checks
from walk_bringup.bootstrap.command import run_logged
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.bootstrap.layout import Layout
from walk_bringup.bootstrap.machine import Machine, look
from walk_bringup.bootstrap.progress import StageLine
from walk_bringup.bootstrap.stamps import read_json, write_json

ROOT = Path(__file__).resolve().parents[2]

FIT = Machine(
    python=sys.executable,
    python_version=(3, 12, 3),
    system="Linux",
    architecture="x86_64",
    libc=(2, 39),
    has_venv=True,
    free_bytes=20_000_000_000,
    writable=True,
    ros_distro="",
    has_rclpy=False,
)

UNFIT = {
    "Python": {"python_version": (3, 10, 12)},
    "venv module": {"has_venv": False},
    "architecture": {"architecture": "aarch64"},
    "ROS 2": {"ros_distro": "humble", "has_rclpy": True},
    "disk": {"free_bytes": 1_000_000_000},
    "folder": {"writable": False},
}


def failing(machine: Machine, *, installed: bool = False) -> list[Check]:
    return [check for check in machine_checks(machine, installed=installed) if check.required and not check.ok]


def test_fit_machine_passes() -> None:
    assert failing(FIT) == []


@pytest.mark.parametrize("name", UNFIT)
def test_each_lack_is_found_and_advised_on(name: str) -> None:
    found = failing(dataclasses.replace(FIT, **UNFIT[name]))
    assert [check.name for check in found] == [name]
    assert len(found[0].advice) > 20


@pytest.mark.parametrize("name", UNFIT)
def test_set_up_refuses_unfit_machine_in_one_sentence(name: str, tmp_path: Path) -> None:
    (tmp_path / "requirements.lock").write_text("click==8\n")
    (tmp_path / "colcon.meta").write_text("{}")
    with pytest.raises(SetupError, match=name) as caught:
        bootstrap_setup.set_up(Layout(tmp_path), dataclasses.replace(FIT, **UNFIT[name]))
    assert "\n" not in str(caught.value)
    assert not (tmp_path / ".venv").exists()


def test_other_architecture_is_fit_with_a_ros_installation() -> None:
    machine = dataclasses.replace(FIT, architecture="aarch64", ros_distro="jazzy", has_rclpy=True)
    assert failing(machine) == []


def test_musl_and_old_glibc_have_no_wheels() -> None:
    assert not dataclasses.replace(FIT, libc=(0, 0)).has_wheels
    assert not dataclasses.replace(FIT, libc=(2, 27)).has_wheels


def test_full_disk_does_not_stop_what_is_installed() -> None:
    assert failing(dataclasses.replace(FIT, free_bytes=1), installed=True) == []


def test_report_names_what_is_lacking() -> None:
    text = doctor.report(machine_checks(dataclasses.replace(FIT, has_venv=False), installed=False))
    assert "NO  venv module" in text
    assert "python3.12-venv" in text
    assert text.endswith("This machine lacks: venv module.")


def test_ros_installation_replaces_exactly_the_ros_wheels() -> None:
    layout = Layout(ROOT)
    wheels = installation.requirements(layout, FIT)
    ros = installation.requirements(layout, dataclasses.replace(FIT, ros_distro="jazzy", has_rclpy=True))
    assert {pin.split("-")[0] for pin in set(wheels) - set(ros)} == {"ros"}
    assert "ros-jazzy-rclpy==7.1.6" in wheels
    assert not any(pin.startswith("ros-") for pin in ros)


def test_lock_pins_every_requirement_and_names_no_index() -> None:
    pins = installation.requirements(Layout(ROOT), FIT)
    names = [pin.partition("==")[0] for pin in pins]
    assert all("==" in pin for pin in pins)
    assert not any("://" in line or line.startswith("-") for line in pins)
    assert len(names) == len(set(names))
    asked = [
        line.split("#")[0].split("[")[0].split("<")[0].strip().lower() for line in _lines(ROOT / "requirements.in")
    ]
    assert set(asked) - {""} <= set(names)


def _lines(path: Path) -> list[str]:
    return path.read_text().splitlines()


@pytest.mark.parametrize(
    ("output", "expected"),
    [
        ("WARNING: Retrying ... NewConnectionError('...')\nERROR: No matching distribution found for x", "network"),
        ("OSError: [Errno 28] No space left on device", "disk is full"),
        ("Collecting x\nERROR: No matching distribution found for x==1", "No matching distribution found for x==1"),
        ("", "no output"),
    ],
)
def test_failure_of_pip_is_explained(output: str, expected: str) -> None:
    assert expected in installation.explain(output)


def test_half_installed_packages_are_dropped_and_whole_ones_stay(tmp_path: Path) -> None:
    site = tmp_path / ".venv" / "lib" / "python3.12" / "site-packages"
    records = {"whole": "whole/x.py,,\nwhole-1.dist-info/INSTALLER,,\n", "cut": "cut/x.py,,\n", "cut_early": None}
    for name, record in records.items():
        info = site / f"{name}-1.dist-info"
        info.mkdir(parents=True)
        if record is not None:
            (info / "RECORD").write_text(record)
    installation._drop_half_installed(Layout(tmp_path))
    assert [path.name for path in site.iterdir()] == ["whole-1.dist-info"]


def test_environment_made_with_ros_is_refused_without(tmp_path: Path) -> None:
    (tmp_path / ".venv").mkdir()
    (tmp_path / ".venv" / "pyvenv.cfg").write_text("include-system-site-packages = true\n")
    with pytest.raises(SetupError, match="not sourced"):
        venv.make(Layout(tmp_path), FIT)


def test_environment_of_another_place_is_not_usable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    binaries = tmp_path / ".venv" / "bin"
    binaries.mkdir(parents=True)
    (binaries / "python").symlink_to(sys.executable)
    (tmp_path / ".venv" / "pyvenv.cfg").write_text("include-system-site-packages = false\n")
    monkeypatch.setattr(subprocess, "run", lambda *args, **kwargs: subprocess.CompletedProcess([], 0))
    (binaries / "pip").write_text(f"#!{tmp_path}/.venv/bin/python\n")
    assert venv._usable(Layout(tmp_path), FIT)
    (binaries / "pip").write_text("#!/elsewhere/.venv/bin/python\n")
    assert not venv._usable(Layout(tmp_path), FIT)


def test_build_of_another_place_is_removed(tmp_path: Path) -> None:
    layout = Layout(tmp_path)
    (tmp_path / "src" / "walk_x").mkdir(parents=True)
    (tmp_path / "src" / "walk_x" / "package.xml").touch()
    stale = [layout.install / "walk_x", tmp_path / "build" / "walk_x"]
    for folder in stale:
        folder.mkdir(parents=True)
    write_json(layout.state / "made_for.json", "/elsewhere")
    build._drop_foreign_build(layout)
    assert not any(folder.exists() for folder in stale)
    assert read_json(layout.state / "made_for.json") == str(tmp_path)


def test_stored_environment_comes_before_the_users_and_drops_what_breaks_the_wheels(tmp_path: Path) -> None:
    layout = Layout(tmp_path)
    added = {"AMENT_PREFIX_PATH": ["/i/a"], "PYTHONPATH": ["/b/a", "/b/c"]}
    write_json(layout.environment, {"wheels": True, "added": added})
    base = {"PATH": "/usr/bin", "PYTHONPATH": "/mine:/b/c", "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1"}
    env = environment.built_environment(layout, base)
    assert env["PYTHONPATH"] == "/b/a:/b/c:/mine"
    assert env["AMENT_PREFIX_PATH"] == f"/i/a:{tmp_path}/.venv"
    assert env["PATH"] == f"{tmp_path}/.venv/bin:/usr/bin"
    assert env["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    assert "_ROS_WHEELS_BOOTSTRAP_COMPLETE" not in env
    kept = environment.built_environment(layout, {"ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET", "ROS_DOMAIN_ID": "7"})
    assert (kept["ROS_AUTOMATIC_DISCOVERY_RANGE"], kept["ROS_DOMAIN_ID"]) == ("SUBNET", "7")


def test_missing_environment_says_what_to_run(tmp_path: Path) -> None:
    with pytest.raises(SetupError, match="walk setup"):
        environment.built_environment(Layout(tmp_path), {})


def test_failed_tool_leaves_its_output_in_a_log(tmp_path: Path) -> None:
    seen: list[str] = []
    command = [sys.executable, "-c", "print('one'); print('two'); raise SystemExit(3)"]
    log = tmp_path / "logs" / "tool.log"
    with pytest.raises(SetupError, match=r"because.*tool\.log"):
        run_logged(command, log, cwd=tmp_path, env=os.environ, on_line=seen.append, explain=lambda text: "because.")
    assert seen == ["one", "two"]
    assert log.read_text() == "one\ntwo\n"


def test_a_long_stage_goes_on_saying_so_where_there_is_no_terminal() -> None:
    out = io.StringIO()
    with StageLine("Python packages", 8, out, beat_s=0.02) as line:
        line.update(3, "numpy")
        until = time.monotonic() + 10.0
        while "goes on" not in out.getvalue() and time.monotonic() < until:
            time.sleep(0.01)
    lines = out.getvalue().splitlines()
    assert lines[0] == "Python packages ..."
    assert "goes on" in lines[1] and lines[1].endswith(", 3 of 8")
    assert "done in" in lines[-1]
    assert "\r" not in out.getvalue()


def test_second_set_up_has_nothing_to_do_quickly() -> None:
    layout = Layout.here()
    if not layout.environment.exists():
        pytest.skip("this checkout was not set up by ./walk")
    stages = [stage for stage in bootstrap_setup.STAGES[:2] if not stage.is_done(layout, look(layout.root))]
    assert stages == []


def _walk(*arguments: str, path: str | None = None, root: Path = ROOT) -> subprocess.CompletedProcess[str]:
    env = {"PATH": path or os.environ["PATH"], "HOME": os.environ.get("HOME", "/")}
    return subprocess.run([str(root / "walk"), *arguments], env=env, capture_output=True, text=True, timeout=60)


def test_root_script_says_that_python_is_missing(tmp_path: Path) -> None:
    tools = tmp_path / "bin"
    tools.mkdir()
    for name in ("sh", "dirname", "readlink"):
        (tools / name).symlink_to(Path("/usr/bin") / name)
    old = tools / "python3"
    old.write_text("#!/bin/sh\nexit 1\n")
    old.chmod(0o755)
    done = _walk("doctor", path=str(tools))
    assert done.returncode == 2
    assert "no Python 3.11, 3.12 or 3.13 found" in done.stderr
    assert "Traceback" not in done.stderr


def test_root_script_works_through_a_link_and_before_set_up(tmp_path: Path) -> None:
    (tmp_path / "walk").symlink_to(ROOT / "walk")
    done = _walk("--help", root=tmp_path)
    assert done.returncode == 0
    assert "Commands:" in done.stdout


def test_doctor_reports_as_json_what_it_reports_as_text() -> None:
    report = json.loads(_walk("doctor", "--json").stdout)
    names = [check["name"] for check in report["checks"]]
    text = _walk("doctor").stdout
    assert set(UNFIT) | {"set-up", "buildings"} == set(names)
    assert all(name in text for name in names)


def test_unknown_command_is_one_sentence_with_the_one_meant() -> None:
    done = _walk("plna")
    assert done.returncode == 2
    assert done.stderr == "walk: there is no command 'plna'; is 'plan' meant? ./walk --help lists them.\n"
