# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A node that answers every edit with a path under the edit's stamp: what is left is the way there and back."""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from rclpy.node import Node

from walk_ros.conversions.cdr import path_to_bytes
from walk_ros.runner import run_node
from walk_ros.topics import NAMESPACE, TOPICS

POSES = 100
_STAMP = slice(4, 12)  # of the header, in an edit and in a path alike


class Copier(Node):
    """Stands where the sequencer and trajopt stand."""

    def __init__(self) -> None:
        super().__init__("copier", namespace=NAMESPACE)
        line = np.linspace([0.0, 0.0, 1.6], [20.0, 0.0, 1.6], POSES)
        turns = np.tile([0.0, 0.0, 0.0, 1.0], (POSES, 1))
        self._path = bytearray(path_to_bytes(np.linspace(0.0, 20.0, POSES), line, turns, 0))
        edits, path = TOPICS["keypoint_edits"], TOPICS["path"]
        self._publisher = self.create_publisher(path.type, "path", path.qos)
        self.create_subscription(edits.type, "keypoint_edits", self._answer, edits.qos, raw=True)

    def _answer(self, data: Any) -> None:
        self._path[_STAMP] = bytes(data)[_STAMP]
        self._publisher.publish(bytes(self._path))


def main() -> int:
    """Runs the node; returns the exit code."""
    return run_node(Copier)


if __name__ == "__main__":
    sys.exit(main())
