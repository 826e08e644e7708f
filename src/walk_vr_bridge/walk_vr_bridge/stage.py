# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Playback on the graph: what steers it, and the viewpoint that it publishes."""

from __future__ import annotations

import json
import math
import time
from typing import Any

import numpy as np
from std_msgs.msg import Float64, String
from std_srvs.srv import SetBool

from walk_ros.conversions import trajectory_from_msg, viewpoint_to_msg
from walk_ros.conversions.stamps import NS
from walk_ros.errors import MessageError
from walk_ros.node import WalkNode
from walk_ros.raw import from_bytes
from walk_vr_bridge.playback import Player, Timeline
from walk_vr_bridge.wire.rows import header_stamp_ns, trajectory_rows

_STATE_S = 0.5
_TRAJECTORY = "trajectory_msgs/msg/MultiDOFJointTrajectory"


class Stage:
    """Plays the trajectory; all of it happens in the thread of the executor."""

    def __init__(self, node: WalkNode, rate_hz: float) -> None:
        """Offers service and topics.

        Args:
            node: On whose behalf.
            rate_hz: Of the viewpoint, while it plays.
        """
        self._node = node
        self._player = Player()
        self._told_s = float("-inf")
        node.offer("playback", "viewpoint")
        node.take_in("playback/seek", self._seek)
        node.take_in("playback/speed", self._speed)
        node.create_service(SetBool, "play", self._play)
        self._timer = node.create_timer(1.0 / rate_hz, self._tick, autostart=False)
        self._tell()

    def set_rate(self, rate_hz: float) -> None:
        """Publishes the viewpoint this often from now on."""
        self._timer.timer_period_ns = int(NS / rate_hz)

    def take(self, data: bytes) -> None:
        """Goes on on a new trajectory, given as CDR bytes; raises MessageError where it is not sound."""
        self._player.take(_timeline(data), time.monotonic())
        self._tell()
        if self._player.playing:
            # Otherwise nobody looks: a recording of edits would hold a camera path that jumps about.
            self._view()

    def _play(self, request: SetBool.Request, response: SetBool.Response) -> SetBool.Response:
        now_s = time.monotonic()
        if request.data:
            response.success = self._player.play(now_s)
            response.message = "playing" if response.success else "there is no trajectory to play yet"
        else:
            self._player.pause(now_s)
            response.success, response.message = True, "paused"
        self._show()
        return response

    def _seek(self, msg: Float64) -> None:
        self._player.seek(_finite(msg), time.monotonic())
        self._show()

    def _speed(self, msg: Float64) -> None:
        self._player.set_speed(_finite(msg), time.monotonic())
        self._show()

    def _tick(self) -> None:
        if time.monotonic() - self._told_s > _STATE_S or not self._player.playing:
            self._tell()
        self._view()

    def _show(self) -> None:
        self._tell()
        self._view()

    def _tell(self) -> None:
        now_s = self._told_s = time.monotonic()
        state = self._player.state(now_s)
        self._node.publish("playback", String(data=json.dumps(state)))
        if state["playing"]:
            self._timer.reset()
        else:
            self._timer.cancel()

    def _view(self) -> None:
        timeline = self._player.timeline
        if timeline is not None:
            position, quat = timeline.sample(self._player.time(time.monotonic()))
            stamp_ns = self._node.get_clock().now().nanoseconds
            self._node.publish("viewpoint", viewpoint_to_msg(position, quat, stamp_ns))


def _finite(msg: Float64) -> float:
    if not math.isfinite(msg.data):
        raise MessageError("std_msgs/Float64", f"{msg.data} is not finite; expected a number")
    return float(msg.data)


def _timeline(data: bytes) -> Timeline:
    rows: Any = trajectory_rows(data)
    if rows is None:
        sound = trajectory_from_msg(from_bytes(data, _TRAJECTORY))
        return Timeline(stamp_ns=sound.stamp_ns, t_s=sound.t_s, positions=sound.positions, quat_xyzw=sound.quat_xyzw)
    t_s = rows["sec"] + rows["nanosec"] / NS
    pose = rows["transform"]
    if not np.isfinite(pose).all() or (np.diff(t_s) < 0).any():
        raise MessageError(_TRAJECTORY, "positions are not finite or times do not rise")
    return Timeline(stamp_ns=header_stamp_ns(data), t_s=t_s, positions=pose[:, :3].copy(), quat_xyzw=pose[:, 3:].copy())
