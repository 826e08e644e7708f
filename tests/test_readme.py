# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Every command of the pages that a new user reads runs, as it is printed there, one after the other."""

from __future__ import annotations

import os
import re
import select
import shlex
import shutil
import signal
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from graph.domains import own_domain

from walk_bringup.bootstrap.commands import COMMANDS

ROOT = Path(__file__).resolve().parents[1]
LIMIT_S = 240.0

# What to wait for before a command that runs until Ctrl-C is told to end.
UNTIL = {
    "./walk up house.ifc": "a walk past",
    "./walk replay out/house/tour.mcap --start 10": "replaying",
    "./walk up": "a walk past",
    "./walk up building.ifc --keypoints-file keypoints.csv": "a walk past",
    "./walk up src/walk_bringup/buildings/sample.ifc": "a walk past",
    "./walk run walk_importance importance --ros-args -r __ns:=/walk": "loaded",
    "./walk record --out out/session": "recording",
    "./walk replay out/building/tour.mcap": "replaying",
}
# These are what a clean clone is checked with: inside of themselves they are only asked for their help.
OURSELVES = {"./walk test", "./walk check"}


PAGES = ("README.md", "docs/quickstart.md", "docs/tutorial.md", "docs/formats.md")
GOES_ON = {"docs/formats.md": "README.md"}
"""Pages that begin with what the commands of another have written."""


def commands() -> list[tuple[str, str]]:
    found = []
    for page in PAGES:
        blocks = re.findall(r"```sh\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), flags=re.S)
        found += [(page, line) for block in blocks for line in block.splitlines() if line.strip()]
    return found


@pytest.fixture(scope="module")
def domain() -> Iterator[int]:
    """A ROS domain for all commands: on the machine's ordinary one somebody else's graph may run."""
    with own_domain() as number:
        yield number


@pytest.fixture(scope="module")
def folders(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    if not (ROOT / "build" / "walk" / "environment.json").exists():
        pytest.skip("this checkout was not set up by ./walk")
    made = {page: tmp_path_factory.mktemp(Path(page).stem) for page in PAGES if page not in GOES_ON}
    for folder in made.values():
        # The user's own building, and what is in the checkout as seen from its folder.
        for name in ("building.ifc", "house.ifc"):
            shutil.copy(ROOT / "src/walk_bringup/buildings/sample.ifc", folder / name)
        for name in ("walk", "examples", "src"):
            (folder / name).symlink_to(ROOT / name)
    return made | {page: made[before] for page, before in GOES_ON.items()}


@pytest.mark.slow
@pytest.mark.ros
@pytest.mark.parametrize(("page", "command"), commands())
def test_command_of_the_page_runs(page: str, command: str, folders: dict[str, Path], domain: int) -> None:
    folder = folders[page]
    wanted = f"{command} --help" if command in OURSELVES else command
    if command.startswith("./walk up"):
        wanted += " --port 0"  # the page's own port may be somebody's
    # The journal of edits goes to the folder, not to the home of whoever runs the tests.
    environment = os.environ | {"XDG_STATE_HOME": str(folder / "state"), "ROS_DOMAIN_ID": str(domain)}
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
    for name in sorted(set(COMMANDS) - {"setup"}):
        assert f"./walk {name}" in text
