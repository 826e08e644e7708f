# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits of a keypoint as visualization_msgs/InteractiveMarkerFeedback, and their answers as DiagnosticStatus."""

from __future__ import annotations

import dataclasses
import enum

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from numpy.typing import NDArray
from visualization_msgs.msg import InteractiveMarkerFeedback

from walk_ros.conversions.checks import require
from walk_ros.conversions.poses import pose_arrays, pose_msgs
from walk_ros.conversions.stamps import header_from_msg, header_to_msg

KIND = "visualization_msgs/InteractiveMarkerFeedback"
RESULT_KIND = "diagnostic_msgs/DiagnosticStatus"


class EditKind(enum.Enum):
    """What the editor's hand does; the value is the event type of the message."""

    GRAB = InteractiveMarkerFeedback.MOUSE_DOWN
    DRAG = InteractiveMarkerFeedback.POSE_UPDATE
    RELEASE = InteractiveMarkerFeedback.MOUSE_UP
    HOLD = InteractiveMarkerFeedback.KEEP_ALIVE


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class KeypointEdit:
    """One event of moving a keypoint: where its eye position is now wished to be."""

    kind: EditKind
    keypoint: int  # stable identity
    client_id: str  # who edits
    stamp_ns: int
    position: NDArray[np.float64]  # (3,) eye position [m], read-only
    quat_xyzw: NDArray[np.float64]  # (4,), read-only


class Outcome(enum.Enum):
    """What became of an edit."""

    ACCEPTED = "accepted"  # done, and in the journal on disk
    FOLLOWED = "followed"  # grabbed or dragged: valid and shown, confirmed by the release
    REFUSED = "refused"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class EditResult:
    """The sequencer's answer to one edit."""

    outcome: Outcome
    keypoint: str  # the marker name of the edit, also where it names no keypoint
    client_id: str
    reason: str  # why it was refused, "" otherwise
    revision_ns: int  # the keypoints' revision that the answer is about
    edit_stamp_ns: int  # of the edit answered


def edit_to_msg(edit: KeypointEdit) -> InteractiveMarkerFeedback:
    """Returns the edit as the feedback an interactive marker gives; `marker_name` is the identity."""
    (pose,) = pose_msgs([edit.position], [edit.quat_xyzw])
    return InteractiveMarkerFeedback(
        header=header_to_msg(edit.stamp_ns),
        client_id=edit.client_id,
        marker_name=str(edit.keypoint),
        event_type=edit.kind.value,
        pose=pose,
    )


def edit_from_msg(msg: InteractiveMarkerFeedback) -> KeypointEdit:
    """Returns the edit of a feedback; raises MessageError if it is not sound or no edit that is known."""
    stamp_ns = header_from_msg(msg.header, KIND)
    known = {kind.value: kind for kind in EditKind}
    require(msg.event_type in known, KIND, f"event type {msg.event_type} is no edit; expected 0, 1, 4 or 5")
    name = msg.marker_name
    require(name.isascii() and name.isdigit() and len(name) < 10, KIND, f"{name!r} is no keypoint; expected its number")
    positions, quats = pose_arrays(KIND, [msg.pose])
    return KeypointEdit(
        kind=known[msg.event_type],
        keypoint=int(name),
        client_id=msg.client_id,
        stamp_ns=stamp_ns,
        position=positions[0],
        quat_xyzw=quats[0],
    )


def edit_result_to_msg(result: EditResult) -> DiagnosticStatus:
    """Returns the answer: OK or WARN, the reason as message, who and what as key and value."""
    refused = result.outcome is Outcome.REFUSED
    return DiagnosticStatus(
        level=DiagnosticStatus.WARN if refused else DiagnosticStatus.OK,
        name=f"keypoint {result.keypoint}",
        message=result.reason if refused else result.outcome.value,
        hardware_id=result.client_id,
        values=[
            KeyValue(key="outcome", value=result.outcome.value),
            KeyValue(key="keypoint", value=result.keypoint),
            KeyValue(key="revision_ns", value=str(result.revision_ns)),
            KeyValue(key="edit_stamp_ns", value=str(result.edit_stamp_ns)),
        ],
    )


def edit_result_from_msg(msg: DiagnosticStatus) -> EditResult:
    """Returns the answer to an edit; raises MessageError if it is none."""
    values = {pair.key: pair.value for pair in msg.values}
    wanted = ("outcome", "keypoint", "revision_ns", "edit_stamp_ns")
    missing = [key for key in wanted if key not in values]
    require(not missing, RESULT_KIND, f"values lack {', '.join(missing)}")
    outcomes = {outcome.value: outcome for outcome in Outcome}
    require(values["outcome"] in outcomes, RESULT_KIND, f"outcome is {values['outcome']!r}")
    numbers = values["revision_ns"], values["edit_stamp_ns"]
    require(all(n.isascii() and n.isdigit() for n in numbers), RESULT_KIND, f"stamps are {numbers}; expected numbers")
    outcome = outcomes[values["outcome"]]
    return EditResult(
        outcome=outcome,
        keypoint=values["keypoint"],
        client_id=msg.hardware_id,
        reason=msg.message if outcome is Outcome.REFUSED else "",
        revision_ns=int(numbers[0]),
        edit_stamp_ns=int(numbers[1]),
    )
