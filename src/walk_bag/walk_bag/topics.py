# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Topics and messages as bags hold them."""

from __future__ import annotations

import dataclasses
from typing import Any

import yaml

_KEEP_LAST, _RELIABLE, _BEST_EFFORT, _TRANSIENT_LOCAL, _VOLATILE, _AUTOMATIC = 1, 1, 2, 1, 2, 1
"""The numbers of the middleware's policies, as version 8 of a bag's metadata holds them."""

_ANY_TIME = {"sec": 2147483647, "nsec": 4294967295}  # how rosbag2 writes "infinite"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class BagTopic:
    """A topic of a bag and the QoS its publisher offered."""

    name: str  # full, such as /walk/path
    type_name: str  # such as nav_msgs/msg/Path
    latched: bool
    reliable: bool
    depth: int


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class BagMessage:
    """A message of a bag."""

    topic: BagTopic
    stamp_ns: int  # when it was recorded
    data: bytes  # CDR


def qos_to_yaml(topic: BagTopic) -> str:
    """Returns the QoS profile as bags hold it: YAML, a list of the profiles of all publishers."""
    profile = {
        "history": _KEEP_LAST,
        "depth": topic.depth,
        "reliability": _RELIABLE if topic.reliable else _BEST_EFFORT,
        "durability": _TRANSIENT_LOCAL if topic.latched else _VOLATILE,
        "deadline": dict(_ANY_TIME),
        "lifespan": dict(_ANY_TIME),
        "liveliness": _AUTOMATIC,
        "liveliness_lease_duration": dict(_ANY_TIME),
        "avoid_ros_namespace_conventions": False,
    }
    return str(yaml.safe_dump([profile], sort_keys=False)).strip()


def qos_from_yaml(text: str) -> dict[str, Any]:
    """Returns `latched`, `reliable` and `depth` of the first profile; volatile, reliable, 10 where none is told."""
    try:
        profiles = yaml.safe_load(text)
    except yaml.YAMLError:
        profiles = None
    profile = profiles[0] if isinstance(profiles, list) and profiles and isinstance(profiles[0], dict) else {}
    return {
        "latched": profile.get("durability") in (_TRANSIENT_LOCAL, "transient_local"),
        "reliable": profile.get("reliability") not in (_BEST_EFFORT, "best_effort"),
        "depth": max(int(profile.get("depth", 10)), 1),
    }
