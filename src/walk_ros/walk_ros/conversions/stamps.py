# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Times as nanoseconds since the epoch: exact, where a float of seconds is not."""

from __future__ import annotations

from builtin_interfaces.msg import Duration, Time
from std_msgs.msg import Header

from walk_ros.conversions.checks import FRAME, check_frame, require

NS = 1_000_000_000
MAX_STAMP_NS = (2**31 - 1) * NS + NS - 1


def stamp_to_msg(stamp_ns: int) -> Time:
    """Returns the time of a stamp in nanoseconds, 0 to `MAX_STAMP_NS`."""
    return Time(sec=stamp_ns // NS, nanosec=stamp_ns % NS)


def stamp_from_msg(msg: Time, kind: str = "builtin_interfaces/Time") -> int:
    """Returns the nanoseconds of a time; raises MessageError if it is before 1970 or not normal."""
    require(msg.sec >= 0 and msg.nanosec < NS, kind, f"stamp is {msg.sec} s and {msg.nanosec} ns; expected 0 or later")
    return int(msg.sec) * NS + int(msg.nanosec)


def duration_to_msg(seconds: float) -> Duration:
    """Returns a duration of whole nanoseconds."""
    nanoseconds = round(seconds * NS)
    return Duration(sec=nanoseconds // NS, nanosec=nanoseconds % NS)


def duration_from_msg(msg: Duration) -> float:
    """Returns the seconds of a duration."""
    return int(msg.sec) + int(msg.nanosec) / NS


def header_to_msg(stamp_ns: int) -> Header:
    """Returns a header in the fixed frame; its stamp names the revision."""
    return Header(stamp=stamp_to_msg(stamp_ns), frame_id=FRAME)


def header_from_msg(msg: Header, kind: str) -> int:
    """Returns the header's stamp [ns]; raises MessageError if its frame is another."""
    check_frame(kind, msg.frame_id)
    return stamp_from_msg(msg.stamp, kind)
