# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A recorder as a process of its own, as `./walk record` starts it."""

from __future__ import annotations

import dataclasses
import os
import signal
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

from walk_bag.bag_reader import read_bag
from walk_bag.parameter_watch import TOPIC as PARAMETERS
from walk_ros.live_bench.hand import BenchError, Hand
from walk_ros.topics import absolute_name

_READY_S = 30.0
_END_S = 20.0


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Recorded:
    """What a recorder has left."""

    bag: Path
    size_bytes: int
    cpu_s: float  # since it was ready

    def counts(self) -> Counter[str]:
        """Returns how many messages of each topic are in the bag."""
        return Counter(message.topic.name for message in read_bag(self.bag))

    def payload_bytes(self) -> dict[str, int]:
        """Returns the bytes of each topic's messages before compression, largest first."""
        sizes: Counter[str] = Counter()
        for message in read_bag(self.bag):
            sizes[message.topic.name] += len(message.data)
        return dict(sizes.most_common())


class RecorderProcess:
    """Starts a recorder and waits until it hears the graph."""

    def __init__(self, bag: Path, hand: Hand, previews_hz: float) -> None:
        """Starts; raises BenchError where the recorder does not come up."""
        self._bag = bag
        self._log = bag.with_suffix(".log")
        with self._log.open("ab") as log:
            self._process = subprocess.Popen(
                [sys.executable, "-m", "walk_bag.record", "--out", str(bag), "--previews", f"{previews_hz:g}"],
                stdout=log,
                stderr=log,
            )
        hand.wait(self._hears, "the recorder to hear the graph", _READY_S, self._check)
        self._cpu_s = self._used_s()

    def end(self) -> Recorded:
        """Ends the recording as Ctrl-C does."""
        cpu_s = self._used_s() - self._cpu_s
        self._process.send_signal(signal.SIGINT)
        if self._process.wait(_END_S) != 0:
            raise BenchError(f"the recorder failed: {self._text().strip()}")
        return Recorded(bag=self._bag, size_bytes=sum(f.stat().st_size for f in self._bag.iterdir()), cpu_s=cpu_s)

    def close(self) -> None:
        """Ends the process, whatever it does."""
        self._process.kill()
        self._process.wait()

    def _hears(self) -> bool:
        text = self._text()
        return all(f"first of {topic}\n" in text for topic in (absolute_name("path"), PARAMETERS))

    def _check(self) -> None:
        if self._process.poll() is not None:
            raise BenchError(f"the recorder has ended: {self._text().strip()}")

    def _text(self) -> str:
        return self._log.read_text(errors="replace")

    def _used_s(self) -> float:
        fields: list[Any] = Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
