# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The browser in which the page is tested: installed where that is allowed."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

NAMES = ("chromium", "chromium-browser", "google-chrome")


def find_browser() -> str | None:
    """Returns the path of a Chromium, None where there is none."""
    return next((path for path in map(shutil.which, NAMES) if path), None)


def ensure_browser() -> None:
    """Installs Debian's chromium where there is no browser and we are root; says what is skipped otherwise."""
    if find_browser() is not None:
        return
    if os.geteuid() != 0 or shutil.which("apt-get") is None:
        _say("there is no Chromium: the tests of the page are skipped (sudo apt install chromium)")
        return
    _say("installing chromium for the tests of the page ...")
    env = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    for command in (["update"], ["install", "-y", "--no-install-recommends", "chromium"]):
        done = subprocess.run(["apt-get", "-qq", *command], env=env, capture_output=True, text=True)
        if done.returncode != 0:
            reason = (done.stderr.strip().splitlines() or ["no reason given"])[-1]
            _say(f"chromium could not be installed, the tests of the page are skipped: {reason}")
            return


def _say(text: str) -> None:
    print(f"walk: {text}", file=sys.stderr, flush=True)
