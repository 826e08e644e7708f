# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Running the tools of the set-up: output into a log, every line to a callback, errors as one sentence."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from walk_bringup.bootstrap.errors import SetupError


def run_logged(
    command: Sequence[str | Path],
    log: Path,
    *,
    cwd: Path,
    env: Mapping[str, str],
    on_line: Callable[[str], None],
    explain: Callable[[str], str],
) -> None:
    """Runs a command to its end.

    Args:
        command: What to run.
        log: File that takes all the output.
        cwd: Folder to run it in.
        env: The whole environment.
        on_line: Called with each line of the output as it comes.
        explain: Turns the output of a failed command into the reason that the user reads.

    Raises:
        SetupError: The command could not be started or failed.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    lines = []
    process = subprocess.Popen(
        list(map(str, command)),
        cwd=cwd,
        env=dict(env),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
    )
    with log.open("w", encoding="utf-8") as file, process:
        assert process.stdout is not None
        try:
            for line in process.stdout:
                file.write(line)
                lines.append(line)
                on_line(line.rstrip())
            code = process.wait()
        except BaseException:
            process.terminate()
            raise
    if code != 0:
        raise SetupError(f"{explain(''.join(lines))} The whole output is in {log}.")


def last_line(output: str) -> str:
    """Returns the last line of an output that is not empty."""
    lines = [line.strip() for line in output.splitlines() if line.strip()]
    return lines[-1] if lines else "no output"
