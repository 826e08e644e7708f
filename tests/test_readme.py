# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Every command of the README runs, as it is printed there."""

from __future__ import annotations

import os
import re
import select
import shlex
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
LIMIT_S = 240.0

# What to wait for before a command that runs until Ctrl-C is told to end.
UNTIL = {
    "./walk up": "a walk past",
    "./walk run walk_importance importance --ros-args -r __ns:=/walk": "loaded",
    "./walk record --out out/session": "recording",
    "./walk replay out/building/tour.mcap": "replaying",
}
# These are what a clean clone is checked with: inside of themselves they are only asked for their help.
OURSELVES = {"./walk test", "./walk check"}


def commands() -> list[str]:
    blocks = re.findall(r"```sh\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), flags=re.S)
    return [line for block in blocks for line in block.splitlines() if line.strip()]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    if not (ROOT / "build" / "walk" / "environment.json").exists():
        pytest.skip("this checkout was not set up by ./walk")
    made = tmp_path_factory.mktemp("readme")
    # The user's own building, and the command as seen from the checkout's folder.
    shutil.copy(ROOT / "src/walk_bringup/buildings/sample.ifc", made / "building.ifc")
    (made / "walk").symlink_to(ROOT / "walk")
    return made


@pytest.mark.slow
@pytest.mark.ros
@pytest.mark.parametrize("command", commands())
def test_command_of_the_readme_runs(command: str, folder: Path) -> None:
    wanted = f"{command} --help" if command in OURSELVES else command
    # The journal of edits goes to the folder, not to the home of whoever runs the tests.
    environment = os.environ | {"XDG_STATE_HOME": str(folder / "state")}
    process = subprocess.Popen(
        shlex.split(wanted), cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment
    )
    try:
        output = _output(process, UNTIL.get(command))
    finally:
        process.kill()
        process.wait()
        assert process.stdout is not None
        process.stdout.close()
    assert process.returncode == 0, output


def _output(process: subprocess.Popen[bytes], until: str | None) -> str:
    """Reads all that the process says; once it says `until`, tells it to end as Ctrl-C does."""
    assert process.stdout is not None
    stop_at, text, told = time.monotonic() + LIMIT_S, b"", False
    while time.monotonic() < stop_at:
        if select.select([process.stdout], [], [], 0.5)[0]:
            piece = os.read(process.stdout.fileno(), 65536)
            if not piece:
                process.wait(timeout=LIMIT_S)
                return text.decode()
            text += piece
        if until and not told and until.encode() in text:
            process.send_signal(signal.SIGINT)
            told = True
    raise AssertionError(f"did not end within {LIMIT_S:g} s; it said: {text.decode()}")


def test_the_readme_names_every_command() -> None:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    for name in ("up", "plan", "run", "record", "replay", "test", "check", "bench", "params", "doctor"):
        assert f"./walk {name}" in text
