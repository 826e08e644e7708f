# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits on their way to the sequencer, and its answers on their way back to the client that asked."""

from __future__ import annotations

import asyncio
import dataclasses
from collections import OrderedDict, deque
from collections.abc import Callable
from typing import Any

from visualization_msgs.msg import InteractiveMarkerFeedback

from walk_ros.conversions.checks import FRAME
from walk_ros.conversions.edits import Change, EditKind, edit_from_msg
from walk_ros.conversions.stamps import stamp_to_msg
from walk_ros.errors import MessageError
from walk_vr_bridge.client import Client
from walk_vr_bridge.errors import ProtocolError
from walk_vr_bridge.limits import EDIT_TIMEOUT_S

DRAG_S = 1 / 90
"""Least time between two drags of a keypoint that go on: a frame of the headset."""

LOOK_AGAIN_S = 0.02
"""How often the desk looks whether the planner hears edits, while some wait for it."""

REMEMBERED = 4096
"""Edits whose client and stamp are remembered, so that their answers find back: a minute of 40 hands that drag."""

_NS = 10**9


@dataclasses.dataclass(slots=True, kw_only=True)
class Asked:
    """An edit that went on."""

    client: str
    label_ns: int  # the stamp that the client gave it
    keypoint: str
    due_s: float  # when the client is told that nobody answers; inf once it is answered


class EditDesk:
    """Puts the bridge's own stamp and the client's identity into edits; used in the thread of the web server only."""

    def __init__(self, send: Callable[[Any], None], now_ns: Callable[[], int], is_heard: Callable[[], bool]) -> None:
        """Takes what it needs of the graph.

        Args:
            send: Publishes an edit.
            now_ns: The graph's time [ns].
            is_heard: Whether anybody subscribes to edits. They are not latched: before the sequencer has been
                discovered, as just after a start, they would be lost.
        """
        self._publish = send
        self._is_heard = is_heard
        self._unheard: deque[tuple[float, Any]] = deque(maxlen=REMEMBERED)
        self._now_ns = now_ns
        self._last_ns = 0
        self._asked: OrderedDict[int, Asked] = OrderedDict()
        self._dragged_s: dict[tuple[str, str], float] = {}
        self._held: dict[tuple[str, str], tuple[Client, Any]] = {}

    def take(self, client: Client, msg: InteractiveMarkerFeedback) -> str:
        """Sends an edit of a client on; returns why it is refused, "" if it is not."""
        key = (client.identity, msg.marker_name)
        if msg.event_type == EditKind.DRAG.value:
            return self._drag(key, client, msg)
        held = self._held.pop(key, None)
        if held is not None and msg.event_type != EditKind.RELEASE.value:
            self._pass_on(*held)
        return self._pass_on(client, msg)

    def answer(self, values: dict[str, Any], *, final: bool) -> str:
        """Puts the client's own stamp back into an answer of the graph; returns whose it is.

        Args:
            values: The answer.
            final: Whether it is the sequencer's; trajopt's is about the path alone.
        """
        for pair in values["values"]:
            if pair["key"] == "edit_stamp_ns" and pair["value"].isdigit():
                asked = self._asked.get(int(pair["value"]))
                if asked is not None and asked.client == values["hardware_id"]:
                    asked.due_s = float("inf") if final else asked.due_s
                    pair["value"] = str(asked.label_ns)
        return str(values["hardware_id"])

    def overdue(self) -> list[tuple[str, dict[str, Any]]]:
        """Returns client and answer for the edits to which the graph has said nothing for too long."""
        now_s = asyncio.get_running_loop().time()
        late = [asked for asked in self._asked.values() if asked.due_s < now_s]
        for asked in late:
            asked.due_s = float("inf")
        reason = f"the planner has not answered for {EDIT_TIMEOUT_S:g} s; /diagnostics says what it does"
        return [(a.client, refusal(a.client, a.keypoint, a.label_ns, reason)) for a in late]

    def forget(self, client: Client) -> None:
        """Drops the drags that wait of a client that has gone."""
        for key in [key for key in self._held if key[0] == client.identity]:
            del self._held[key]
        for key in [key for key in self._dragged_s if key[0] == client.identity]:
            del self._dragged_s[key]

    def _drag(self, key: tuple[str, str], client: Client, msg: Any) -> str:
        loop = asyncio.get_running_loop()
        wait_s = self._dragged_s.get(key, 0.0) + DRAG_S - loop.time()
        if wait_s <= 0:
            self._dragged_s[key] = loop.time()
            return self._pass_on(client, msg)
        if key not in self._held:
            loop.call_later(wait_s, self._release, key)
        self._held[key] = (client, msg)
        return ""

    def _release(self, key: tuple[str, str]) -> None:
        held = self._held.pop(key, None)
        if held is not None:
            self._dragged_s[key] = asyncio.get_running_loop().time()
            self._pass_on(*held)

    def _pass_on(self, client: Client, msg: Any) -> str:
        label_ns = msg.header.stamp.sec * _NS + msg.header.stamp.nanosec
        self._last_ns = max(self._now_ns(), self._last_ns + 1)
        msg.header.stamp = stamp_to_msg(self._last_ns)
        msg.header.frame_id = msg.header.frame_id or FRAME
        msg.client_id = client.identity
        try:
            kind = edit_from_msg(msg).kind
        except MessageError as error:
            return error.reason
        waits = kind not in (EditKind.HOLD, EditKind.DRAG)
        due_s = asyncio.get_running_loop().time() + EDIT_TIMEOUT_S if waits else float("inf")
        self._asked[self._last_ns] = Asked(
            client=client.identity, label_ns=label_ns, keypoint=msg.marker_name, due_s=due_s
        )
        while len(self._asked) > REMEMBERED:
            self._asked.popitem(last=False)
        self._send(msg)
        return ""

    def _send(self, msg: Any) -> None:
        """Publishes an edit, behind those that wait until the planner hears them."""
        if not self._unheard and self._is_heard():
            self._publish(msg)
            return
        loop = asyncio.get_running_loop()
        if not self._unheard:
            loop.call_later(LOOK_AGAIN_S, self._send_unheard)
        self._unheard.append((loop.time() + EDIT_TIMEOUT_S, msg))

    def _send_unheard(self) -> None:
        """Publishes what has waited, in its order; drops what its client has meanwhile been told is lost."""
        loop = asyncio.get_running_loop()
        while self._unheard and self._unheard[0][0] <= loop.time():
            self._unheard.popleft()
        while self._unheard and self._is_heard():
            self._publish(self._unheard.popleft()[1])
        if self._unheard:
            loop.call_later(LOOK_AGAIN_S, self._send_unheard)


def require_place(said: object, msg: Any) -> None:
    """Raises ProtocolError where an edit that is about a place does not say which: fields left out are 0 in a message.

    Args:
        said: What the client wrote.
        msg: The InteractiveMarkerFeedback that it became.
    """
    inserts = msg.event_type == EditKind.CHANGE.value and msg.menu_entry_id in _INSERTIONS and not msg.control_name
    if msg.event_type not in _MOVES and not inserts:
        return
    position: object = said
    for name in ("pose", "position"):
        position = position.get(name) if isinstance(position, dict) else None
    missing = [axis for axis in "xyz" if not isinstance(position, dict) or axis not in position]
    if missing:
        raise ProtocolError(f"msg.pose.position has no {', '.join(missing)}; expected x, y and z of the place [m]")


_MOVES = (EditKind.DRAG.value, EditKind.RELEASE.value)
_INSERTIONS = (Change.INSERT, Change.INSERT_NEAR)


def label_of(msg: InteractiveMarkerFeedback) -> int:
    """Returns the stamp that a client gave its edit [ns]."""
    return int(msg.header.stamp.sec * _NS + msg.header.stamp.nanosec)


def refusal(client: str, keypoint: str, label_ns: int, reason: str) -> dict[str, Any]:
    """Returns the answer to an edit that the bridge refuses itself, in the form of the sequencer's."""
    pairs = {"outcome": "refused", "keypoint": keypoint, "revision_ns": "0", "edit_stamp_ns": str(label_ns),
             "better_order_saves_m": "0.000"}  # fmt: skip
    return {
        "level": 1,
        "name": f"keypoint {keypoint}",
        "message": reason,
        "hardware_id": client,
        "values": [{"key": key, "value": value} for key, value in pairs.items()],
    }
