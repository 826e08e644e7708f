# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Keypoints as RViz lets one edit them: interactive markers with a menu."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import Pose, Quaternion, Vector3
from numpy.typing import ArrayLike
from visualization_msgs.msg import InteractiveMarker, InteractiveMarkerControl, InteractiveMarkerPose, Marker, MenuEntry

from walk_ros.conversions.edits import Change
from walk_ros.conversions.markers import marker
from walk_ros.conversions.poses import pose_msgs
from walk_ros.conversions.stamps import header_to_msg

MENU = {
    Change.INSERT: "Insert half-way to the next",
    Change.DELETE: "Delete",
    Change.EARLIER: "Visit earlier",
    Change.LATER: "Visit later",
    Change.START: "Start here",
    Change.END: "End here",
    Change.FREE_END: "Neither start nor end",
    Change.LOCK: "Lock",
    Change.UNLOCK: "Unlock",
    Change.UNDO: "Undo",
    Change.REDO: "Redo",
}
"""What can be done without further words; dwell, look-at and other places in the order take an argument."""

_SCALE = 0.6
_GREY, _BLUE = (0.45, 0.45, 0.45), (0.10, 0.45, 0.85)


def interactive_marker_to_msg(
    identity: int, position: ArrayLike, quat_xyzw: ArrayLike, description: str, locked: bool, stamp_ns: int
) -> InteractiveMarker:
    """Returns a keypoint as a ball that is dragged over its floor and turned about its height.

    Its name is its identity. A locked one has the menu alone.
    """
    (pose,) = pose_msgs(np.asarray(position)[None], np.asarray(quat_xyzw)[None])
    modes = [InteractiveMarkerControl.MENU] if locked else []
    modes += [] if locked else [InteractiveMarkerControl.MOVE_PLANE, InteractiveMarkerControl.ROTATE_AXIS]
    return InteractiveMarker(
        header=header_to_msg(0),
        name=str(identity),
        description=description,
        scale=_SCALE,
        pose=pose,
        menu_entries=[MenuEntry(id=int(c), title=t, command_type=MenuEntry.FEEDBACK) for c, t in MENU.items()],
        controls=[_control(mode, stamp_ns, _GREY if locked else _BLUE) for mode in modes],
    )


def interactive_pose_to_msg(identity: int, position: ArrayLike, quat_xyzw: ArrayLike) -> InteractiveMarkerPose:
    """Returns where a keypoint's marker is to be put."""
    (pose,) = pose_msgs(np.asarray(position)[None], np.asarray(quat_xyzw)[None])
    return InteractiveMarkerPose(header=header_to_msg(0), name=str(identity), pose=pose)


def _control(mode: int, stamp_ns: int, colour: tuple[float, float, float]) -> InteractiveMarkerControl:
    # A control acts about its own x axis: turned up here, so that the plane is the floor.
    up = Quaternion(x=0.0, y=-float(np.sqrt(0.5)), z=0.0, w=float(np.sqrt(0.5)))
    ring = mode == InteractiveMarkerControl.ROTATE_AXIS
    ball = marker(stamp_ns, "keypoint_editor", 0, Marker.SPHERE, colour)
    ball.header = header_to_msg(0)
    ball.header.frame_id = ""
    ball.pose, ball.scale = Pose(), Vector3(x=0.2, y=0.2, z=0.2)
    ball.pose.orientation.w = 1.0
    return InteractiveMarkerControl(
        name="turn" if ring else "place",
        orientation=up,
        interaction_mode=mode,
        always_visible=not ring,
        markers=[] if ring else [ball],
    )
