# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the tutorial does with two terminals: a session that is edited and recorded while it runs, saved, opened again.

`test_readme.py` runs every command of the pages one after the other; here those run beside each other that belong
beside each other.
"""

from __future__ import annotations

import contextlib
import os
import queue
import re
import shutil
import signal
import subprocess
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from graph.domains import own_domain

ROOT = Path(__file__).resolve().parents[1]
LIMIT_S = 240.0
PAGE = re.compile(r"http://localhost:(\d+)")

pytestmark = [pytest.mark.slow, pytest.mark.ros]


class Terminal:
    """A command that runs in a terminal, of which every line is kept."""

    def __init__(self, command: list[str], folder: Path, environment: dict[str, str]) -> None:
        self.process = subprocess.Popen(
            command, cwd=folder, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self.said = ""
        self._lines: queue.SimpleQueue[str] = queue.SimpleQueue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        for line in self.process.stdout:
            self._lines.put(line)

    def until(self, pattern: str) -> re.Match[str]:
        """Waits for a line in which the pattern is found."""
        stop_at = time.monotonic() + LIMIT_S
        while time.monotonic() < stop_at:
            with contextlib.suppress(queue.Empty):
                line = self._lines.get(timeout=0.2)
                self.said += line
                if found := re.search(pattern, line):
                    return found
        raise AssertionError(f"waited {LIMIT_S:g} s for {pattern!r}; it said: {self.said}")

    def control_c(self) -> int:
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(LIMIT_S)

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        self._reader.join()
        assert self.process.stdout is not None
        self.process.stdout.close()


class User:
    """Somebody who sits in a checkout with a building of their own."""

    def __init__(self, folder: Path, domain: int) -> None:
        self.folder = folder
        self.environment = os.environ | {"XDG_STATE_HOME": str(folder / "state"), "ROS_DOMAIN_ID": str(domain)}

    @contextlib.contextmanager
    def terminal(self, *arguments: str) -> Iterator[Terminal]:
        terminal = Terminal(["./walk", *arguments], self.folder, self.environment)
        try:
            yield terminal
        finally:
            terminal.close()

    def walk(self, *arguments: str) -> str:
        done = subprocess.run(
            ["./walk", *arguments],
            cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=LIMIT_S,
        )  # fmt: skip
        assert done.returncode == 0, f"{arguments}: {done.stdout}{done.stderr}"
        return done.stdout


@pytest.fixture
def user(tmp_path: Path) -> Iterator[User]:
    if not (ROOT / "build" / "walk" / "environment.json").exists():
        pytest.skip("this checkout was not set up by ./walk")
    shutil.copy(ROOT / "src/walk_bringup/buildings/sample.ifc", tmp_path / "house.ifc")
    for name in ("walk", "examples", "src"):
        (tmp_path / name).symlink_to(ROOT / name)
    with own_domain() as domain:
        yield User(tmp_path, domain)


def test_a_session_is_edited_recorded_saved_exported_and_opened_again(user: User) -> None:
    with user.terminal("up", "house.ifc", "--port", "0") as first:
        port = first.until(PAGE.pattern)[1]
        first.until("a walk past")
        with user.terminal("record", "--out", "out/session") as second:
            second.until(r"first of /walk/keypoint_markers")
            moved = user.walk("python", "examples/edit_live.py", f"localhost:{port}")
            assert "the move was accepted" in moved
            saved = user.walk("save", "house")
            assert second.control_c() == 0
        assert first.control_c() == 0

    (keypoints,) = re.findall(r"^(\d+) keypoints: ", moved, re.MULTILINE)
    assert keypoints in saved
    assert "is whole" in user.walk("recover", "out/session")
    for to, suffix in (("csv", "csv"), ("glb", "glb"), ("keypoints-csv", "csv")):
        user.walk("export", "out/session", "--to", to, "--out", f"out/{to}.{suffix}")
        assert (user.folder / "out" / f"{to}.{suffix}").stat().st_size > 500
    assert len((user.folder / "out/keypoints-csv.csv").read_text().splitlines()) == int(keypoints) + 1

    with user.terminal("open", "house", "--port", "0") as again:
        assert again.until(r"the tour 'main': (\d+) keypoints in house\.ifc")[1] == keypoints
        again.until("a walk past")
        assert again.control_c() == 0

    with user.terminal("replay", "out/session", "--rate", "20") as replay:
        replay.until(r"published (?:all|\d\d+ of) \d\d+ messages")
        assert replay.process.wait(LIMIT_S) == 0
