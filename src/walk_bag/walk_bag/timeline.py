# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A bag from any moment on: first what held at that moment, then what came."""

from __future__ import annotations

import dataclasses
import heapq
from collections import deque
from collections.abc import Iterator
from pathlib import Path

from walk_bag.bag_reader import read_bag, read_span, read_topics
from walk_bag.topics import BagMessage, BagTopic


@dataclasses.dataclass(frozen=True, slots=True)
class Timeline:
    """The times and topics of a bag."""

    path: Path
    topics: tuple[BagTopic, ...]
    start_ns: int
    end_ns: int

    @classmethod
    def of(cls, path: Path, names: set[str] | None = None) -> Timeline:
        """Returns the timeline of a bag, or of those topics of it that are named in full.

        Raises:
            BagError: The bag cannot be read.
        """
        topics = tuple(topic for topic in read_topics(path) if names is None or topic.name in names)
        return cls(path, topics, *read_span(path))

    @property
    def duration_s(self) -> float:
        """Time from the first message to the last."""
        return (self.end_ns - self.start_ns) / 1e9

    def state_at(self, at_ns: int) -> list[BagMessage]:
        """Returns what a late subscriber would have got at the moment: the last messages of each latched topic."""
        latched = {topic.name: topic for topic in self.topics if topic.latched}
        kept: dict[str, deque[BagMessage]] = {name: deque(maxlen=topic.depth) for name, topic in latched.items()}
        for message in read_bag(self.path, set(latched), stop_ns=at_ns):
            kept[message.topic.name].append(message)
        return list(heapq.merge(*kept.values(), key=lambda m: m.stamp_ns))

    def messages_from(self, at_ns: int) -> Iterator[BagMessage]:
        """Yields the messages recorded at the moment and later."""
        return read_bag(self.path, {topic.name for topic in self.topics}, start_ns=at_ns)
