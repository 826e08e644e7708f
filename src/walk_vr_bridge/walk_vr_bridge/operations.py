# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The operations of rosbridge v2: what a client says, and what is done about it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import orjson

from walk_building.errors import WalkError
from walk_vr_bridge.allowed import SESSION, Allowed, name_unknown, require_settable
from walk_vr_bridge.client import LEVELS, Client
from walk_vr_bridge.edits import EditDesk, label_of, refusal, require_place
from walk_vr_bridge.errors import NotAllowedError, ProtocolError, UnreadableError
from walk_vr_bridge.hub import Hub
from walk_vr_bridge.limits import MAX_CALLS, MAX_FRAGMENTS, MAX_MESSAGE
from walk_vr_bridge.refusing import edit_of, gist
from walk_vr_bridge.rosapi import answer_rosapi
from walk_vr_bridge.subscriptions import Wish
from walk_vr_bridge.wire.decoding import decoder
from walk_vr_bridge.wire.encoding import encoder
from walk_vr_bridge.wire.message import FORMS
from walk_vr_bridge.wire.schema import fields_of, message_class, service_class

EDITS = "keypoint_edits"
OnAnswer = Callable[[Any, str], None]
"""Takes the response of a service, or None and why there is none."""


class GraphLike(Protocol):
    """What the operations need of the graph."""

    def publish(self, topic: str, msg: Any) -> None:
        """Publishes a message."""

    def is_heard(self, topic: str) -> bool:
        """Returns whether somebody subscribes to a topic that clients publish on."""

    def call(self, service: str, cls: Any, request: Any, done: OnAnswer) -> None:
        """Calls a service; `done` is called in the thread of the web server."""

    def now_ns(self) -> int:
        """Returns the graph's time [ns]."""


class Operations:
    """Does what clients say; used in the thread of the web server only."""

    def __init__(self, hub: Hub, graph: GraphLike) -> None:
        self.hub = hub
        self._graph = graph
        self._allowed: Allowed = hub.allowed
        self._edits_topic = self._allowed.full(EDITS)
        self.desk = EditDesk(
            lambda msg: graph.publish(self._edits_topic, msg),
            graph.now_ns,
            lambda: graph.is_heard(self._edits_topic),
        )
        self._handlers: dict[str, Callable[[Client, dict[str, Any]], None]] = {
            "subscribe": self._subscribe,
            "unsubscribe": self._unsubscribe,
            "advertise": self._advertise,
            "unadvertise": self._unadvertise,
            "publish": self._publish,
            "call_service": self._call_service,
            "fragment": self._fragment,
            "set_level": self._set_level,
            "status": self._nothing,
            "auth": self._nothing,  # of one who is in already
        }

    def receive(self, client: Client, data: str | bytes) -> None:
        """Does what a frame of a client says; what is wrong with it is answered as it was asked, else in a `status`."""
        said: dict[str, Any] = {}
        identity: object = None
        try:
            said = _read(data)
            identity = said.get("id")
            if identity is not None and (not isinstance(identity, str | int) or len(str(identity)) > 200):
                raise ProtocolError(f"id is {identity!r:.60}; expected a short text")
            handler = self._handlers.get(str(said.get("op")))
            if handler is None:
                raise ProtocolError(f"op is {said.get('op')!r:.60}; expected one of {', '.join(self._handlers)}")
            handler(client, said)
        except UnreadableError as error:
            self._refuse(client, error.said, str(error))
        except WalkError as error:
            self._refuse(client, said, str(error), identity)

    def _refuse(self, client: Client, said: dict[str, Any], reason: str, identity: object = None) -> None:
        """Answers what was not understood: an edit and a call as such, so that whoever waits for it is told."""
        client.wrong()
        if said.get("op") == "call_service":
            _respond(client, said.get("service"), said.get("id"), reason, done=False)
            return
        topic = said.get("topic")
        if said.get("op") == "publish" and isinstance(topic, str) and self._allowed.full(topic) == self._edits_topic:
            keypoint, label_ns = edit_of(said)
            self._refuse_edit(client, keypoint, label_ns, reason)
            return
        client.status("error", reason, identity)

    def _refuse_edit(self, client: Client, keypoint: str, label_ns: int, reason: str) -> None:
        values = refusal(client.identity, keypoint, label_ns, reason)
        if not client.deliver_values(self._allowed.full("edit_results"), values):
            client.status("error", reason)

    def answered(self, topic: str, values: dict[str, Any]) -> None:
        """Hands an answer of the sequencer or trajopt on to the client whose edit it is about."""
        owner = self.desk.answer(values, final=topic == self._allowed.full("edit_results"))
        for client in self.hub.of(owner):
            client.deliver_values(topic, values)

    def sweep(self) -> None:
        """Tells clients about edits that nobody answers; called once a second."""
        for owner, values in self.desk.overdue():
            for client in self.hub.of(owner):
                client.deliver_values(self._allowed.full("edit_results"), values)

    def _subscribe(self, client: Client, said: dict[str, Any]) -> None:
        topic = self._allowed.topic(said.get("topic"), said.get("type"), self._allowed.heard)
        listening = client.subscribe(topic, self._allowed.short(topic), str(said.get("id")), _wish(said))
        if topic == self._allowed.full(SESSION):
            session = {"client_id": client.identity, "role": client.role}
            client.deliver_values(topic, {"data": orjson.dumps(session).decode()})
        for message in self.hub.snapshot(topic):
            # Not throttled: all storeys come at once.
            client.deliver_snapshot(listening, message)

    def _unsubscribe(self, client: Client, said: dict[str, Any]) -> None:
        topic = self._allowed.topic(said.get("topic"), None, self._allowed.heard)
        identity = said.get("id")
        client.unsubscribe(topic, None if identity is None else str(identity))

    def _advertise(self, client: Client, said: dict[str, Any]) -> None:
        self._allowed.publishing(said.get("topic"), said.get("type"), client.role)

    def _nothing(self, client: Client, said: dict[str, Any]) -> None:
        del client, said

    def _unadvertise(self, client: Client, said: dict[str, Any]) -> None:
        del client
        self._allowed.topic(said.get("topic"), None, self._allowed.said)

    def _publish(self, client: Client, said: dict[str, Any]) -> None:
        topic = self._allowed.topic(said.get("topic"), said.get("type"), self._allowed.said)
        msg = decoder(message_class(self._allowed.said[topic]))(said.get("msg", {}), "msg")
        if topic == self._edits_topic:
            self._edit(client, topic, msg, said)
            return
        self._allowed.publishing(topic, said.get("type"), client.role)
        if topic == self._allowed.full("study_events"):
            _sign(msg, client.identity, self._graph.now_ns())
        self._graph.publish(topic, msg)

    def _edit(self, client: Client, topic: str, msg: Any, said: dict[str, Any]) -> None:
        label_ns = label_of(msg)
        try:
            self._allowed.publishing(topic, said.get("type"), client.role)
            require_place(said.get("msg"), msg)
            client.edits = True
            reason = self.desk.take(client, msg)
        except NotAllowedError as error:
            reason = str(error)
        if reason:
            self._refuse_edit(client, msg.marker_name, label_ns, reason)

    def _call_service(self, client: Client, said: dict[str, Any]) -> None:
        name, identity = said.get("service"), said.get("id")
        try:
            values = answer_rosapi(name, said.get("args"), self._allowed)
            if values is not None:
                _respond(client, name, identity, values, done=True)
                return
            full, service = self._allowed.calling(name, said.get("type"), client.role)
            cls = service_class(service.type_name)
            request = decoder(cls.Request)(_arguments(said.get("args"), cls.Request), "args")
            if service.sets_parameters:
                require_settable(request.parameters)
            if client.calls >= MAX_CALLS:
                raise NotAllowedError(f"call {full}", f"{MAX_CALLS} calls wait for their answers already")
        except WalkError as error:
            _respond(client, name, identity, str(error), done=False)
            return
        client.calls += 1

        def done(response: Any, reason: str) -> None:
            client.calls -= 1
            if response is None:
                _respond(client, name, identity, reason, done=False)
            else:
                if service.sets_parameters:
                    name_unknown(full, request.parameters, response)
                _respond(client, name, identity, encoder(cls.Response, "json")(response), done=True)

        self._graph.call(full, cls, request, done)

    def _fragment(self, client: Client, said: dict[str, Any]) -> None:
        identity, data = str(said.get("id")), said.get("data")
        num, total = said.get("num"), said.get("total")
        whole = type(num) is int and type(total) is int and 0 <= num < total <= MAX_FRAGMENTS
        if not whole or not isinstance(data, str):
            raise ProtocolError(f"a fragment needs data, num and total, and has at most {MAX_FRAGMENTS} parts")
        if identity not in client.fragments and len(client.fragments) >= 4:
            client.fragments.pop(next(iter(client.fragments)))
        parts = client.fragments.setdefault(identity, {})
        parts[int(num or 0)] = data
        if sum(map(len, parts.values())) > MAX_MESSAGE:
            del client.fragments[identity]
            raise ProtocolError(f"the fragments of {identity[:60]} are more than {MAX_MESSAGE} bytes")
        if len(parts) == total:
            del client.fragments[identity]
            text = "".join(part for _, part in sorted(parts.items()))
            if _nests(text):
                raise ProtocolError("a fragment holds a fragment")
            self.receive(client, text)

    def _set_level(self, client: Client, said: dict[str, Any]) -> None:
        if said.get("level") not in LEVELS:
            raise ProtocolError(f"level is {said.get('level')!r:.60}; expected one of {', '.join(LEVELS)}")
        client.level = said["level"]


def _read(data: str | bytes) -> dict[str, Any]:
    """Returns what a frame says; raises UnreadableError where it is no JSON object."""
    try:
        return parse(data)
    except ProtocolError as error:
        said = gist(data)
        reason = "a number is NaN or infinite; expected a finite one" if said else error.reason
        raise UnreadableError(reason, said) from error


def _nests(text: str) -> bool:
    """Returns whether the whole of some fragments is a fragment again."""
    try:
        return parse(text).get("op") == "fragment"
    except ProtocolError:
        return False


def parse(data: str | bytes) -> dict[str, Any]:
    """Returns what a frame says; raises ProtocolError where it is no JSON object."""
    try:
        said = orjson.loads(data)
    except (ValueError, RecursionError) as error:
        raise ProtocolError(f"the frame is no JSON: {str(error)[:120]}") from error
    if not isinstance(said, dict):
        raise ProtocolError("the frame is no JSON object")
    return said


def _wish(said: dict[str, Any]) -> Wish:
    form = said.get("compression") or "none"
    if form not in FORMS:
        raise ProtocolError(f"compression is {form!r:.60}; expected one of {', '.join(FORMS)}")
    numbers = {}
    for name, most in (("throttle_rate", 3_600_000), ("queue_length", 1000), ("fragment_size", 2**31)):
        value = said.get(name) or 0
        if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= most:
            raise ProtocolError(f"{name} is {value!r:.60}; expected a number from 0 to {most}")
        numbers[name] = value
    fragment = int(numbers["fragment_size"])
    return Wish(
        throttle_s=numbers["throttle_rate"] / 1000,
        depth=max(1, int(numbers["queue_length"])),
        form=form,
        fragment=max(1024, fragment) if fragment else 0,
    )


def _arguments(args: Any, request: Any) -> Any:
    """Returns the arguments of a service by name; they may come in the order of its fields."""
    if args is None:
        return {}
    if isinstance(args, list):
        names = [field.name for field in fields_of(request)]
        if len(args) > len(names):
            raise ProtocolError(f"args has {len(args)} items; expected {len(names)}: {', '.join(names)}")
        return dict(zip(names, args, strict=False))
    return args


def _respond(client: Client, name: object, identity: object, values: Any, *, done: bool) -> None:
    answer = {"op": "service_response", "service": name, "values": values, "result": done}
    client.answer(answer if identity is None else answer | {"id": identity})


def _sign(msg: Any, identity: str, now_ns: int) -> None:
    """Puts time and client into a study event."""
    if len(msg.status) != 1:
        raise ProtocolError(f"a study event has {len(msg.status)} statuses; expected 1")
    msg.header.stamp.sec, msg.header.stamp.nanosec = divmod(now_ns, 10**9)
    msg.status[0].hardware_id = identity
