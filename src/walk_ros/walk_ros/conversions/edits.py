# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits of a keypoint as visualization_msgs/InteractiveMarkerFeedback, and their answers as DiagnosticStatus."""

from __future__ import annotations

import dataclasses
import enum

import numpy as np
from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from geometry_msgs.msg import Point, Pose
from numpy.typing import NDArray
from visualization_msgs.msg import InteractiveMarkerFeedback

from walk_ros.conversions.checks import finite_array, require
from walk_ros.conversions.markers import point_msgs, point_rows
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
    CHANGE = InteractiveMarkerFeedback.MENU_SELECT


class Change(enum.IntEnum):
    """What an edit of kind CHANGE does; the value is the menu entry of the message."""

    INSERT = 1
    DELETE = 2
    REORDER = 3
    LOCK = 4
    UNLOCK = 5
    START = 6
    END = 7
    FREE_END = 8
    DWELL = 9
    LOOK_AT = 10
    EARLIER = 11
    LATER = 12
    UNDO = 13
    REDO = 14
    INSERT_NEAR = 15  # the importance node turns it into an INSERT at the best place around


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class KeypointEdit:
    """One event: where a keypoint's eye position is now wished to be, or what else is to be done."""

    kind: EditKind
    keypoint: int  # stable identity; -1 where a change names none
    client_id: str  # who edits
    stamp_ns: int
    position: NDArray[np.float64]  # (3,) eye position [m], read-only
    quat_xyzw: NDArray[np.float64]  # (4,), read-only
    change: Change | None = None  # of kind CHANGE only
    argument: str = ""  # what the change takes
    target: NDArray[np.float64] | None = None  # (3,) what to look at [m]


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
    better_order_saves_m: float = 0.0  # by how much another order would shorten the tour, 0: none found [m]


def edit_to_msg(edit: KeypointEdit) -> InteractiveMarkerFeedback:
    """Returns the edit as the feedback an interactive marker gives; `marker_name` is the identity."""
    (pose,) = pose_msgs([edit.position], [edit.quat_xyzw])
    return InteractiveMarkerFeedback(
        header=header_to_msg(edit.stamp_ns),
        client_id=edit.client_id,
        marker_name=str(edit.keypoint) if edit.keypoint >= 0 else "",
        event_type=edit.kind.value,
        menu_entry_id=int(edit.change or 0),
        control_name=edit.argument,
        pose=pose,
        mouse_point=Point() if edit.target is None else point_msgs(edit.target[None])[0],
        mouse_point_valid=edit.target is not None,
    )


def edit_from_msg(msg: InteractiveMarkerFeedback) -> KeypointEdit:
    """Returns the edit of a feedback; raises MessageError if it is not sound or no edit that is known."""
    stamp_ns = header_from_msg(msg.header, KIND)
    known = {kind.value: kind for kind in EditKind}
    require(msg.event_type in known, KIND, f"event type {msg.event_type} is no edit; expected 0, 1, 2, 4 or 5")
    kind = known[msg.event_type]
    change = _change(msg) if kind is EditKind.CHANGE else None
    name = msg.marker_name
    nameless = change in _NAMELESS and not name
    require(
        nameless or (name.isascii() and name.isdigit() and len(name) < 10),
        KIND,
        f"{name!r} is no keypoint; expected its number",
    )
    # What is not about a place needs none: menus and scripts may leave the pose as it is made, all zero.
    positions, quats = pose_arrays(KIND, [msg.pose if change in _WITH_POSE else _no_pose()])
    target = None
    if change is Change.LOOK_AT and msg.mouse_point_valid:
        target = finite_array(KIND, "mouse point", point_rows([msg.mouse_point]), 3)[0]
    return KeypointEdit(
        kind=kind,
        keypoint=int(name) if name else -1,
        client_id=msg.client_id,
        stamp_ns=stamp_ns,
        position=positions[0],
        quat_xyzw=quats[0],
        change=change,
        argument=msg.control_name if change in _WITH_ARGUMENT else "",
        target=target,
    )


_NAMELESS = (Change.INSERT, Change.INSERT_NEAR, Change.UNDO, Change.REDO)
_WITH_POSE = (None, Change.INSERT, Change.INSERT_NEAR)
_WITH_ARGUMENT = (Change.INSERT, Change.REORDER, Change.DWELL)


def _change(msg: InteractiveMarkerFeedback) -> Change:
    known = {int(change): change for change in Change}
    number = msg.menu_entry_id
    require(number in known, KIND, f"menu entry {number} is no edit; expected 1 to {max(known)}")
    return known[number]


def _no_pose() -> Pose:
    (pose,) = pose_msgs([[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.0, 1.0]])
    return pose


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
            KeyValue(key="better_order_saves_m", value=f"{result.better_order_saves_m:.3f}"),
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
        better_order_saves_m=_metres(values.get("better_order_saves_m", "0")),
    )


def _metres(text: str) -> float:
    try:
        metres = float(text)
    except ValueError:
        metres = float("nan")
    require(bool(np.isfinite(metres)) and metres >= 0.0, RESULT_KIND, f"better_order_saves_m is {text!r}")
    return metres
