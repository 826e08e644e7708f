# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""From plain values to messages: one compiled function per message type, which checks what it takes over.

A field that is left out keeps its default. What does not belong raises ProtocolError with the field's path.
"""

from __future__ import annotations

import array
import base64
import binascii
import functools
import math
from collections.abc import Callable
from typing import Any

from walk_vr_bridge.errors import ProtocolError
from walk_vr_bridge.wire.schema import FLOATS, INTEGERS, Field, fields_of, message_class

MAX_ITEMS = 20_000
"""Items of one list; nothing that a client may send has more."""

_ALIASES = {"builtin_interfaces/Time": {"secs": "sec", "nsecs": "nanosec"},
            "builtin_interfaces/Duration": {"secs": "sec", "nsecs": "nanosec"}}  # fmt: skip
"""Names of fields in ROS 1, which some client libraries still send."""

_TYPE_CODES = {
    "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "int64": "q", "uint64": "Q",
    "float": "f", "double": "d",
}  # fmt: skip

Decoder = Callable[[Any, str], Any]
"""Takes the values and the path of the field they are for; returns the message."""


@functools.cache
def decoder(cls: Any) -> Decoder:
    """Returns the function that makes a message of the class from a dict."""
    package = cls.__module__.split(".")[0]
    fields = fields_of(cls)
    aliases = _ALIASES.get(f"{package}/{cls.__name__}", {})
    names: dict[str, Any] = {"cls": cls, "check": _check_dict, "known": frozenset(f.name for f in fields)}
    lines = ["def decode(values, path):", f"    values = check(values, path, known, {aliases!r})", "    m = cls()"]
    for at, field in enumerate(fields):
        names[f"take{at}"] = _taker(field)
        lines += [
            f"    if {field.name!r} in values:",
            f"        m._{field.name} = take{at}(values[{field.name!r}], path + '.{field.name}')",
        ]
    lines.append("    return m")
    exec(compile("\n".join(lines), f"<decode {cls.__name__}>", "exec"), names)
    function: Decoder = names["decode"]
    return function


def _check_dict(values: Any, path: str, known: frozenset[str], aliases: dict[str, str]) -> dict[str, Any]:
    if type(values) is not dict:
        raise ProtocolError(f"{path} is {_shown(values)}; expected an object")
    if aliases and not known.issuperset(values):
        values = {aliases.get(name, name): value for name, value in values.items()}
    if not known.issuperset(values):
        unknown = sorted(str(name) for name in values if name not in known)[0]
        raise ProtocolError(f"{path} has no field {unknown[:60]!r}; it has {', '.join(sorted(known)) or 'none'}")
    return values


def _taker(field: Field) -> Decoder:
    take = _item_taker(field.item)
    return _sequence_taker(field, take) if field.sequence else take


def _item_taker(item: str) -> Decoder:
    if "/" in item:
        return decoder(message_class(item))
    if item in INTEGERS:
        return _integer(*INTEGERS[item])
    if item in FLOATS:
        return _number
    return {"boolean": _boolean, "octet": _octet}.get(item, _text)


def _integer(low: int, high: int) -> Decoder:
    def take(value: Any, path: str) -> int:
        if type(value) is float and value.is_integer():
            value = int(value)
        if type(value) is not int or not low <= value <= high:
            raise ProtocolError(f"{path} is {_shown(value)}; expected a whole number from {low} to {high}")
        return value

    return take


def _number(value: Any, path: str) -> float:
    kind = type(value)
    if kind is float:
        return value
    if kind is int:
        return float(value)
    if value is None:
        return math.nan  # what JSON has for it
    raise ProtocolError(f"{path} is {_shown(value)}; expected a number")


def _boolean(value: Any, path: str) -> bool:
    if type(value) is not bool:
        raise ProtocolError(f"{path} is {_shown(value)}; expected true or false")
    return value


def _octet(value: Any, path: str) -> bytes:
    return bytes([_integer(0, 255)(value, path)])


def _text(value: Any, path: str) -> str:
    if type(value) is not str or "\0" in value:
        raise ProtocolError(f"{path} is {_shown(value)}; expected a text")
    return value


def _sequence_taker(field: Field, take: Decoder) -> Decoder:
    code = _TYPE_CODES.get(field.item)

    def sequence(values: Any, path: str) -> Any:
        if type(values) is str and field.item in ("uint8", "octet"):
            values = list(_unbase64(values, path))
        if type(values) is not list or len(values) > MAX_ITEMS:
            raise ProtocolError(f"{path} is {_shown(values)}; expected a list of at most {MAX_ITEMS} items")
        if field.size not in (-1, len(values)) or (field.bound != -1 and len(values) > field.bound):
            limit = f"{field.size}" if field.size != -1 else f"at most {field.bound}"
            raise ProtocolError(f"{path} has {len(values)} items; expected {limit}")
        items = [take(value, f"{path}[{at}]") for at, value in enumerate(values)]
        return array.array(code, items) if code and field.size == -1 else items

    return sequence


def _unbase64(text: str, path: str) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError) as error:
        raise ProtocolError(f"{path} is no base64") from error


def _shown(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
