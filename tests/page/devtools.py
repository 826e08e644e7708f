# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A Chromium that is measured: spoken to through a pipe, and only when asked.

Playwright, which the tests use, listens to every frame of every socket of the page. On two cores that is a part of what
is measured.
"""

import fcntl
import itertools
import json
import os
import signal
import tempfile

from page.browser import FLAGS, HEADSET, HEIGHT, IWER, WIDTH


class DevTools:
    """One tab with an emulated headset, driven by the Chrome DevTools Protocol."""

    def __init__(self, chromium, url):
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self._process, self._to, self._from = _start(chromium, f"--user-data-dir={self._profile.name}")
        self._serial = itertools.count(1)
        self._rest = b""
        self._session = {}
        window = self.ask("Target.createTarget", url="about:blank", newWindow=True, width=WIDTH, height=HEIGHT)
        session = self.ask("Target.attachToTarget", targetId=window["targetId"], flatten=True)
        self._session = {"sessionId": session["sessionId"]}
        self.ask("Page.enable")
        for script in (IWER, HEADSET):
            self.ask("Page.addScriptToEvaluateOnNewDocument", source=script.read_text(encoding="utf-8"))
        self.ask("Page.navigate", url=f"{url}/?plain")

    def ask(self, method, **params):
        """Sends a command and returns its result; events are passed over."""
        serial = next(self._serial)
        message = {"id": serial, "method": method, "params": params, **self._session}
        self._to.write(json.dumps(message).encode() + b"\0")
        while True:
            answer = json.loads(self._line())
            if answer.get("id") == serial:
                assert "error" not in answer, answer["error"]
                return answer["result"]

    def js(self, code):
        """Runs the body of an async function in the page; returns what it returns."""
        expression = f"(async () => {{ {code} }})()"
        answer = self.ask("Runtime.evaluate", expression=expression, awaitPromise=True, returnByValue=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def close(self):
        os.kill(self._process, signal.SIGTERM)
        os.waitpid(self._process, 0)
        self._to.close()
        self._from.close()
        self._profile.cleanup()

    def _line(self):
        while b"\0" not in self._rest:
            part = self._from.read1(1 << 20)
            assert part, "the browser has ended"
            self._rest += part
        line, _, self._rest = self._rest.partition(b"\0")
        return line


def _start(chromium, *arguments):
    """Returns the process's number and the two ends to write commands to and read answers from."""
    (theirs_in, ours_out), (ours_in, theirs_out) = os.pipe(), os.pipe()
    quiet = os.open(os.devnull, os.O_WRONLY)
    # Chromium reads from 3 and answers on 4, which may be in use here: out of their way first.
    moved = [fcntl.fcntl(end, fcntl.F_DUPFD_CLOEXEC, 10) for end in (theirs_in, theirs_out, quiet, quiet)]
    actions = [(os.POSIX_SPAWN_DUP2, old, new) for old, new in zip(moved, (3, 4, 1, 2), strict=True)]
    command = [chromium, *FLAGS, "--headless", "--remote-debugging-pipe", *arguments]
    process = os.posix_spawn(chromium, command, os.environ, file_actions=actions)
    for end in (theirs_in, theirs_out, quiet, *moved):
        os.close(end)
    return process, os.fdopen(ours_out, "wb", buffering=0), os.fdopen(ours_in, "rb")
