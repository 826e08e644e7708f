# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A bag made from results, without a running graph: the messages are those the nodes would publish."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from walk_bag.bag_writer import BagWriter
from walk_bag.topics import BagTopic
from walk_ros.conversions.importance import ImportanceMapLike
from walk_ros.conversions.trajectories import TrajectoryLike
from walk_ros.diagnostics import Diagnostics
from walk_ros.raw import policies, to_bytes
from walk_ros.results import (
    TopicMessages,
    TourLike,
    map_messages,
    path_messages,
    suggestion_messages,
    tour_messages,
    viewpoint_messages,
)
from walk_ros.topics import TOPICS, absolute_name, type_name

TimedMessages = list[tuple[int, str, Any]]
"""Times [ns], relative topic names and messages, by time."""


def walkthrough_messages(
    *,
    importance_map: ImportanceMapLike,
    floors_z: Sequence[float],
    eye_height_m: float,
    positions: NDArray[np.float64],
    quat_xyzw: NDArray[np.float64],
    labels: Sequence[str],
    tour: TourLike,
    trajectory: TrajectoryLike,
    stamp_ns: int,
    building: Mapping[str, str] | None = None,
) -> TimedMessages:
    """Returns what the graph publishes for a planned walkthrough, and the walk itself on `viewpoint`.

    Args:
        importance_map: As computed.
        floors_z: Height of each storey's floor [m].
        eye_height_m: The walker's.
        positions: (K, 3) eye positions of the keypoints, best first [m].
        quat_xyzw: (K, 4) their view directions.
        labels: (K,) what a viewer writes beside them.
        tour: Through the keypoints; its indices are theirs.
        trajectory: Along the tour.
        stamp_ns: When the walk begins; names the one revision of everything.
        building: What names the building, for a status on /diagnostics: `building`, its path, and `building_hash` as
            the nodes tell them, and what else a reader needs to find and to place it; None tells nothing.
    """
    at_once: TopicMessages = [
        *map_messages(importance_map, floors_z, eye_height_m, stamp_ns),
        *suggestion_messages(positions, quat_xyzw, stamp_ns),
        *tour_messages(tour, positions, quat_xyzw, range(len(positions)), labels, stamp_ns),
        *path_messages(trajectory, stamp_ns),
    ]
    walk = [(at, "viewpoint", msg) for at, msg in viewpoint_messages(trajectory, stamp_ns)]
    told: TopicMessages = [("/diagnostics", _status(building, stamp_ns))] if building is not None else []
    return [(stamp_ns, topic, msg) for topic, msg in [*told, *at_once]] + walk


def _status(building: Mapping[str, str], stamp_ns: int) -> Any:
    status = Diagnostics("/walk/plan")
    status.state("planned")
    status.building(building["building"], building["building_hash"])
    status.note(**building)
    return status.to_msg(stamp_ns)


def write_walkthrough_bag(path: Path | str, messages: TimedMessages) -> None:
    """Writes messages as a bag under the graph's topic names and QoS; see BagWriter for what `path` may be.

    Raises:
        BagError: The bag cannot be written.
    """
    with BagWriter(path) as writer:
        for stamp_ns, topic, msg in messages:
            writer.write(bag_topic(topic), stamp_ns, to_bytes(msg))


def bag_topic(topic: str) -> BagTopic:
    """Returns a topic of the table as a bag holds it."""
    spec = TOPICS[topic]
    return BagTopic(name=absolute_name(topic), type_name=type_name(spec.type), **policies(spec.qos))
