# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The fields of message types, read once from the generated message classes."""

from __future__ import annotations

import dataclasses
import functools
import importlib
import re
from typing import Any

from walk_vr_bridge.errors import ProtocolError

INTEGERS = {
    "int8": (-(2**7), 2**7 - 1), "uint8": (0, 2**8 - 1), "int16": (-(2**15), 2**15 - 1), "uint16": (0, 2**16 - 1),
    "int32": (-(2**31), 2**31 - 1), "uint32": (0, 2**32 - 1), "int64": (-(2**63), 2**63 - 1), "uint64": (0, 2**64 - 1),
}  # fmt: skip
"""Least and greatest value by type."""

FLOATS = ("float", "double")
_SEQUENCE = re.compile(r"sequence<(?P<item>[^,]+)(?:, (?P<bound>\d+))?>")
_ARRAY = re.compile(r"(?P<item>[^\[]+)\[(?P<size>\d+)\]")


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """A field of a message."""

    name: str
    item: str  # a basic type, "string", "octet", or the name of a message as pkg/Type
    sequence: bool  # whether it is a list of items
    size: int  # of a list: how many there must be, -1 for any number
    bound: int  # of a list: how many there may be, -1 for any number

    @property
    def nested(self) -> bool:
        """Whether the items are messages."""
        return "/" in self.item


def fields_of(cls: Any) -> tuple[Field, ...]:
    """Returns the fields of a message class, in their order."""
    return tuple(_field(name, text) for name, text in cls.get_fields_and_field_types().items())


def _field(name: str, text: str) -> Field:
    if match := _SEQUENCE.fullmatch(text):
        return Field(name=name, item=_plain(match["item"]), sequence=True, size=-1, bound=int(match["bound"] or -1))
    if match := _ARRAY.fullmatch(text):
        return Field(name=name, item=_plain(match["item"]), sequence=True, size=int(match["size"]), bound=-1)
    return Field(name=name, item=_plain(text), sequence=False, size=-1, bound=-1)


def _plain(item: str) -> str:
    # A bounded text is checked by the message's own writer; its length is no concern of the wire.
    return "string" if item.startswith(("string", "wstring")) else item


@functools.cache
def message_class(name: str) -> Any:
    """Returns the class of a message type given as pkg/Type or pkg/msg/Type; raises ProtocolError."""
    return _load(name, "msg")


@functools.cache
def service_class(name: str) -> Any:
    """Returns the class of a service type given as pkg/Type or pkg/srv/Type; raises ProtocolError."""
    return _load(name, "srv")


def short_name(name: str) -> str:
    """Returns a type's name as pkg/Type, whichever way it was written."""
    parts = name.split("/")
    return f"{parts[0]}/{parts[-1]}"


def _load(name: str, kind: str) -> Any:
    parts = name.split("/")
    if not (len(parts) == 2 or (len(parts) == 3 and parts[1] == kind)) or not all(p.isidentifier() for p in parts):
        raise ProtocolError(f"{name!r} is no type; expected PACKAGE/Type or PACKAGE/{kind}/Type")
    try:
        return getattr(importlib.import_module(f"{parts[0]}.{kind}"), parts[-1])
    except (ImportError, AttributeError) as error:
        raise ProtocolError(f"the type {name!r} is not installed") from error
