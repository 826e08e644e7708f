# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What clients may subscribe to, publish and call, and in which role."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

from walk_ros.topics import TOPICS, absolute_name
from walk_vr_bridge.errors import NotAllowedError, ProtocolError
from walk_vr_bridge.wire.schema import short_name

ROLES = ("viewer", "editor")
PARAMETER_GROUPS = ("walker", "importance", "keypoints", "sequencer", "editing", "trajopt", "timing")
"""Parameter groups that an editor may set; none of them names a file or a folder."""

NODES = ("importance", "sequencer", "trajopt", "vr_bridge")
LATCHED = (
    "suggested_keypoints", "keypoints", "keypoint_markers", "pairwise_paths", "tour", "path", "trajectory",
    "importance_map", "importance_map/storeys", "playback", "bridge/files",
)  # fmt: skip
EVENTS = {"edit_results": 64, "path_results": 64, "study_events": 64, "importance_map/storeys": 64}
"""Topics of which every message counts, and how many are kept for a slow client."""

OWN = ("edit_results", "path_results")
"""Topics of which a client hears only what is about itself."""

FILES, SESSION = "bridge/files", "bridge/session"
LOCAL = {FILES: "std_msgs/String", SESSION: "std_msgs/String"}
"""Topics between the bridge and its clients only."""

PUBLISHED = ("keypoint_edits", "playback/seek", "playback/speed", "study_events")
_HEARD_ELSEWHERE = ("keypoint_edits", "keypoint_editor/update", "keypoint_editor/feedback", "playback/seek",
                    "playback/speed")  # fmt: skip
"""Topics of the table that clients do not subscribe to."""

_TRIGGERS = ("undo", "redo", "replan")
_READING = {"describe_parameters": "DescribeParameters", "get_parameters": "GetParameters",
            "list_parameters": "ListParameters"}  # fmt: skip
_SETTING = {"set_parameters": "SetParameters", "set_parameters_atomically": "SetParametersAtomically"}


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Service:
    """A service that clients may call."""

    type_name: str  # as pkg/Type
    role: str  # the least role that may
    sets_parameters: bool = False


class Allowed:
    """The allow-list for one namespace; names are full names."""

    def __init__(self, namespace: str) -> None:
        self.namespace = "/" + namespace.strip("/")
        self.heard: dict[str, str] = {
            self.full(name): _type(topic.type) for name, topic in TOPICS.items() if name not in _HEARD_ELSEWHERE
        } | {self.full(name): type_name for name, type_name in LOCAL.items()}
        self.said: dict[str, str] = {self.full(name): _type(TOPICS[name].type) for name in PUBLISHED}
        self.services: dict[str, Service] = {self.full(name): service for name, service in _services().items()}

    def full(self, name: str) -> str:
        """Returns the full name of a topic or service."""
        return absolute_name(name, self.namespace)

    def short(self, full: str) -> str:
        """Returns the name without the namespace."""
        return full.removeprefix(self.namespace + "/")

    def topic(self, name: object, type_name: object, table: Mapping[str, str]) -> str:
        """Returns the full name of a topic of `table` after checking the type, if one is given.

        Raises:
            ProtocolError: There is no such topic, or it has another type.
        """
        if not isinstance(name, str):
            raise ProtocolError(f"topic is {name!r:.60}; expected a name")
        known = self.full(name)
        if known not in table:
            raise ProtocolError(f"there is no topic {name[:80]!r} here; there are {', '.join(sorted(table))}")
        if type_name and (not isinstance(type_name, str) or short_name(type_name) != table[known]):
            raise ProtocolError(f"{known} is of type {table[known]}, not {type_name!r:.80}")
        return known

    def publishing(self, name: object, type_name: object, role: str) -> str:
        """Returns the full name of a topic that a client wants to publish; raises if it may not."""
        known = self.topic(name, type_name, self.said)
        require_editor(role, f"publish on {known}")
        return known

    def calling(self, name: object, type_name: object, role: str) -> tuple[str, Service]:
        """Returns the full name of a service that a client wants to call; raises if it may not."""
        known = self.full(name) if isinstance(name, str) else ""
        service = self.services.get(known)
        if service is None:
            raise ProtocolError(f"there is no service {name!r:.80} here")
        if type_name and (not isinstance(type_name, str) or short_name(type_name) != service.type_name):
            raise ProtocolError(f"{known} is of type {service.type_name}, not {type_name!r:.80}")
        if service.role == "editor":
            require_editor(role, f"call {known}")
        return known, service


def require_editor(role: str, what: str) -> None:
    """Raises NotAllowedError unless the role is that of an editor."""
    if role != "editor":
        raise NotAllowedError(what, "viewers look on; only editors may")


def require_settable(parameters: Any) -> None:
    """Raises NotAllowedError where a request sets a parameter that clients may not set, or sets one to no number."""
    for parameter in parameters:
        group, dot, _ = parameter.name.partition(".")
        if not dot or group not in PARAMETER_GROUPS:
            raise NotAllowedError(
                f"set {parameter.name[:80]}", f"clients set parameters of {', '.join(PARAMETER_GROUPS)} only"
            )
        value = parameter.value
        if not all(map(math.isfinite, (value.double_value, *value.double_array_value))):
            raise NotAllowedError(f"set {parameter.name[:80]}", "the value is NaN or infinite; expected a finite one")


def name_unknown(service: str, parameters: Any, response: Any) -> None:
    """Says in the answer to a request to set parameters which of them its node has not; rclpy names no way out."""
    node = service.rsplit("/", 2)[-2]
    names = [parameter.name for parameter in parameters]
    # Set together there is one answer to all.
    results = response.results if hasattr(response, "results") else [response.result]
    told = names if hasattr(response, "results") else [" or ".join(names)]
    for name, result in zip(told, results, strict=False):
        if not result.successful and result.reason.startswith(_UNDECLARED):
            result.reason = f"{node} has no parameter {name}; list_parameters and ./walk params say which there are"


_UNDECLARED = "Invalid access to undeclared parameter"


def _services() -> dict[str, Service]:
    services = {name: Service(type_name="std_srvs/Trigger", role="editor") for name in _TRIGGERS}
    services["play"] = Service(type_name="std_srvs/SetBool", role="editor")
    for node in NODES:
        for name, kind in _READING.items():
            services[f"{node}/{name}"] = Service(type_name=f"rcl_interfaces/{kind}", role="viewer")
        for name, kind in _SETTING.items():
            services[f"{node}/{name}"] = Service(
                type_name=f"rcl_interfaces/{kind}", role="editor", sets_parameters=True
            )
    return services


def _type(cls: Any) -> str:
    return f"{cls.__module__.split('.')[0]}/{cls.__name__}"
