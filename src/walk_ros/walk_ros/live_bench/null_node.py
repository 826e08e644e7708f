# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The node that only copies: an edit in, the bytes of a path out. What it takes is the price of the way alone."""

from __future__ import annotations

import sys
from typing import Any

from rclpy.node import Node

from walk_ros.runner import run_node
from walk_ros.topics import NAMESPACE, TOPICS

EDITS, SAMPLE, PATH = "null/edits", "null/sample", "null/path"

_STAMP = slice(4, 12)
"""Where the header's stamp is in the bytes of an edit and of a path alike: both begin with the header."""


class NullNode(Node):
    """Answers every edit with the sample path it was given, under the edit's stamp."""

    def __init__(self) -> None:
        super().__init__("null", namespace=NAMESPACE)
        self._sample = bytearray()
        edit, path = TOPICS["keypoint_edits"], TOPICS["path"]
        self._path = self.create_publisher(path.type, PATH, path.qos)
        self.create_subscription(path.type, SAMPLE, self._store, path.qos, raw=True)
        self.create_subscription(edit.type, EDITS, self._answer, edit.qos, raw=True)

    def _store(self, data: Any) -> None:
        self._sample = bytearray(data)

    def _answer(self, data: Any) -> None:
        if self._sample:
            self._sample[_STAMP] = bytes(data)[_STAMP]
            self._path.publish(bytes(self._sample))


def main() -> int:
    """Runs the node; returns the exit code."""
    return run_node(NullNode)


if __name__ == "__main__":
    sys.exit(main())
