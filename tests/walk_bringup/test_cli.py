# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.cli import executables as lookup
from walk_bringup.cli.bench import _OF_THE_PAGE, _OTHERS, MEASUREMENTS
from walk_bringup.cli.main import group, main
from walk_bringup.cli.up import refuse_taken_port, ros_arguments
from walk_plan.bench import BENCHES
from walk_plan.options import plan_options

SOURCES = [str(path) for path in sorted((Path(__file__).resolve().parents[2] / "src").iterdir())]


@pytest.mark.parametrize("name", sorted(set(COMMANDS) - {"record", "recover", "replay", "bench", "doctor"}))
def test_every_command_explains_itself_with_examples(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([name, "--help"]) == 0
    out = capsys.readouterr().out
    assert "Examples:" in out
    assert f"./walk {name}" in out


def test_the_help_of_bench_lists_every_measurement(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bench", "--help"]) == 0
    out = capsys.readouterr().out
    assert set(MEASUREMENTS) == {*BENCHES, *_OTHERS, *_OF_THE_PAGE}
    assert all(f"  {word} " in out for word in MEASUREMENTS)
    assert main(["bench", "lode"]) == 2
    assert "there is no measurement 'lode'; did you mean load?" in capsys.readouterr().err


@pytest.mark.parametrize("name", ["record", "recover", "replay"])
def test_what_is_handed_over_is_called_as_it_was_typed(name: str) -> None:
    script = f"import walk_bag.{name} as it; it.main(['{name}', '--help'])"
    env = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "WALK_COMMAND": f"./walk {name}"}
    told = subprocess.run([sys.executable, "-c", script], env=env, capture_output=True, text=True, timeout=60)
    assert f"usage: ./walk {name} " in told.stdout, told.stderr


@pytest.mark.parametrize("word", ["live", "bridge", "release"])
def test_every_measurement_explains_itself(word: str) -> None:
    script = "import sys; from walk_bringup.cli.main import main; sys.exit(main(['bench', *sys.argv[1:]]))"
    env = {**os.environ, "WALK_ROOT": str(Path(SOURCES[0]).parents[1]), "PYTHONPATH": os.pathsep.join(sys.path)}
    command = [sys.executable, "-c", script, word, "--help"]
    told = subprocess.run(command, env=env, capture_output=True, text=True, timeout=60, check=True).stdout
    assert f"./walk bench {word}" in told


def test_every_command_in_the_overview_exists() -> None:
    for name in COMMANDS:
        assert group.get_command(None, name) is not None  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["nothing"], "there is no command"),
        (["plan"], "Missing argument"),
        (["plan", "x.ifc"], "--out"),
        (["plan", "x.ifc", "--out", "o", "--speed", "fast"], "not a valid float"),
        (["plan", "x.ifc", "--out", "o", "--speed", "-1"], "--speed is -1.0"),
        (["plan", "/missing/x.ifc", "--out", "o"], "/missing/x.ifc"),
        (["up", "/missing/x.ifc"], "/missing/x.ifc"),
        (["up", "--frobnicate"], "--frobnicate"),
        (["up", "--keypoints-file", "missing.csv"], "missing.csv: cannot be read: No such file"),
        (["run", "walk_nothing", "x"], "there is no package 'walk_nothing'"),
        (["run", "walk_trajopt", "trajopt", "-p", "a:=1"], "./walk run walk_trajopt trajopt --ros-args -p a:=1"),
    ],
)
def test_user_errors_are_one_sentence_and_code_2(
    arguments: list[str],
    expected: str,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith("walk: ")
    assert captured.err.count("\n") == 1
    assert expected in captured.err


def test_errors_of_the_program_are_not_hidden(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*args: object, **kwargs: object) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(group, "main", broken)
    with pytest.raises(ZeroDivisionError):
        main(["plan"])


def test_plan_offers_an_option_for_every_field_of_the_configs(capsys: pytest.CaptureFixture[str]) -> None:
    main(["plan", "--help"])
    out = capsys.readouterr().out
    missing = [option.name for option in plan_options() if f"--{option.name}" not in out]
    assert missing == []


def test_building_is_handed_on_as_an_absolute_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "house.obj").touch()
    monkeypatch.chdir(tmp_path)
    arguments = ros_arguments(Path("house.obj"), None, "/walk/", "info")
    assert f"building:={tmp_path}/house.obj" in arguments
    assert "__ns:=/walk" in arguments


def test_executables_are_found_on_the_ament_path_first_prefix_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for prefix in ("one", "two"):
        folder = tmp_path / prefix / "lib" / "walk_x"
        folder.mkdir(parents=True)
        (tmp_path / prefix / "share" / "walk_x").mkdir(parents=True)
        (tmp_path / prefix / "share" / "walk_x" / "package.xml").touch()
        (folder / "node").write_text("")
        (folder / "node").chmod(0o755)
        (folder / "notes.txt").write_text("")
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{tmp_path}/one:{tmp_path}/two")
    assert lookup.find_executable("walk_x", "node") == tmp_path / "one" / "lib" / "walk_x" / "node"
    with pytest.raises(lookup.ExecutableError, match="it has node"):
        lookup.find_executable("walk_x", "other")


SUPERVISED = """
import sys
from walk_bringup.cli.processes import Child, Supervisor
children = [Child(name=f"child{{i}}", command=(sys.executable, "-uc", code)) for i, code in enumerate({codes!r})]
supervisor = Supervisor(children)
supervisor.start()
supervisor.wait()
print("failed:", *supervisor.failed, flush=True)
"""
WAITS = "import time\ntry:\n  print('up'); time.sleep(60)\nexcept KeyboardInterrupt: print('asked to end')"


def _supervise(*codes: str) -> subprocess.Popen[str]:
    env = os.environ | {"PYTHONPATH": os.pathsep.join(SOURCES)}
    command = [sys.executable, "-c", SUPERVISED.format(codes=codes)]
    return subprocess.Popen(command, env=env, stdout=subprocess.PIPE, text=True)


def _read_until(process: subprocess.Popen[str], text: str) -> str:
    assert process.stdout is not None
    read = ""
    while text not in read:
        line = process.stdout.readline()
        assert line, f"ended without {text!r}: {read}"
        read += line
    return read


def _read_all(process: subprocess.Popen[str], *texts: str) -> None:
    assert process.stdout is not None
    missing = set(texts)
    while missing:
        line = process.stdout.readline()
        assert line, f"ended without {missing}"
        missing -= {line.strip()}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signal_ends_all_children_once_and_cleanly(number: signal.Signals) -> None:
    with _supervise(WAITS, WAITS) as process:
        _read_all(process, "child0 │ up", "child1 │ up")
        process.send_signal(number)
        out, _ = process.communicate(timeout=20)
    assert process.returncode == 0
    assert out.count("asked to end") == 2
    assert "failed:\n" in out


AT_ONCE = """
import os, signal, sys
from walk_bringup.cli.processes import Child, Supervisor
late = ("import signal, sys, time; time.sleep(0.5); both = (signal.SIGINT, signal.SIGTERM); "
        "[signal.signal(n, lambda *_: sys.exit(0)) for n in both]; "
        "signal.pthread_sigmask(signal.SIG_UNBLOCK, both); time.sleep(60)")
supervisor = Supervisor([Child(name=n, command=(sys.executable, "-c", late), unblocks=True) for n in "ab"])
supervisor.start()
os.kill(os.getpid(), signal.SIGINT)
children = list(supervisor._running.values())
supervisor.wait()
print("codes:", *(child.returncode for child in children), flush=True)
"""


def test_a_signal_at_once_ends_children_that_were_not_ready_for_it_cleanly() -> None:
    env = os.environ | {"PYTHONPATH": os.pathsep.join(SOURCES)}
    done = subprocess.run([sys.executable, "-c", AT_ONCE], env=env, capture_output=True, text=True, timeout=30)
    assert done.stdout.endswith("codes: 0 0\n"), done


def test_child_that_ends_is_named_and_the_others_go_on() -> None:
    with _supervise("raise SystemExit(3)", WAITS) as process:
        said = _read_until(process, "ended with code 3")
        assert "child1 go on" in said
        process.send_signal(signal.SIGINT)
        out, _ = process.communicate(timeout=20)
    assert "failed: child0" in out


def test_children_do_not_outlive_a_killed_parent() -> None:
    with _supervise("import os, time\nprint('pid', os.getpid())\ntime.sleep(60)") as process:
        pid = int(_read_until(process, "pid").split()[-1])
        process.kill()
        until = time.monotonic() + 10
        while time.monotonic() < until and _alive(pid):
            time.sleep(0.05)
        assert not _alive(pid)


def _alive(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().split()[2] != "Z"
    except FileNotFoundError:
        return False


def test_a_second_graph_is_not_started_over_the_first() -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = other.getsockname()[1]
        with pytest.raises(SetupError, match=rf"port {port} is taken.*ROS_DOMAIN_ID=7 ./walk up --port"):
            refuse_taken_port(port)
    refuse_taken_port(port)
    refuse_taken_port(0)
