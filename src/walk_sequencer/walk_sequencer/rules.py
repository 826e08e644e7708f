# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a user lays down about the order: keypoints that come before others, and stretches that stay together."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Callable

from walk_building.errors import ParameterError

Pair = tuple[int, int]


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Rules:
    """Numbers are keypoints: identities to the user, rows of the costs to a method."""

    before: tuple[Pair, ...] = ()  # the first comes somewhere before the second
    stretches: tuple[tuple[int, ...], ...] = ()  # come one right behind the other, in this order

    def __bool__(self) -> bool:
        return bool(self.before or self.stretches)

    @property
    def links(self) -> tuple[Pair, ...]:
        """Which keypoint comes right behind which."""
        return tuple(pair for stretch in self.stretches for pair in itertools.pairwise(stretch))

    @property
    def keypoints(self) -> frozenset[int]:
        """All keypoints that are named."""
        return frozenset(itertools.chain(*self.before, *self.stretches))

    def renamed(self, name: Callable[[int], int]) -> Rules:
        """Returns the same rules by other numbers; a keypoint that becomes negative is left out.

        What follows from rules through a keypoint that is left out stays: of 1 before 2 before 3 without 2 stays
        1 before 3, and a stretch closes its gap.
        """
        new = {k: name(k) for k in self.keypoints}
        pairs = sorted((new[a], new[b]) for a, b in self.implied() if new[a] >= 0 and new[b] >= 0)
        kept = (tuple(new[k] for k in stretch if new[k] >= 0) for stretch in self.stretches)
        return Rules(before=tuple(pairs), stretches=tuple(stretch for stretch in kept if len(stretch) > 1))

    def implied(self) -> set[Pair]:
        """Returns all pairs of which the first comes before the second, directly or through others."""
        after: dict[int, set[int]] = {k: set() for k in self.keypoints}
        for a, b in (*self.before, *self.links):
            after[a].add(b)
        for through in after:
            for a in after:
                if through in after[a]:
                    after[a] |= after[through]
        return {(a, b) for a, followers in after.items() for b in followers}

    def texts(self) -> tuple[str, str]:
        """Returns the rules as `parse` reads them."""
        before = ", ".join(f"{a}<{b}" for a, b in self.before)
        return before, ", ".join("-".join(map(str, stretch)) for stretch in self.stretches)


FREE = Rules()


def parse(before: str, together: str) -> Rules:
    """Returns the rules of texts such as "3<7<2, 5<2" and "4-8-1, 6-9".

    Raises:
        ParameterError: A text of another form.
    """
    pairs = [pair for chain in _numbers("before", before, "<") for pair in itertools.pairwise(chain)]
    stretches = _numbers("together", together, "-")
    twice = [k for stretch in stretches for k in stretch]
    if len(set(twice)) < len(twice):
        raise ParameterError("together", together, "each keypoint at most once")
    return Rules(before=tuple(pairs), stretches=tuple(stretches))


def conflict(rules: Rules, start: int = -1, end: int = -1) -> str:
    """Returns why no order keeps the rules and the ends (-1: free), "" if one does."""
    circle = _circle((*rules.before, *rules.links))
    if circle:
        return "a circle: " + " before ".join(map(str, circle))
    # What comes before one of a stretch and is not of it comes before its first.
    stretch_of = {k: stretch for stretch in rules.stretches for k in stretch}
    head = {k: stretch_of.get(k, (k,))[0] for k in (*rules.keypoints, start, end)}
    heads = Rules(before=tuple((head[a], head[b]) for a, b in rules.before if head[a] != head[b]))
    circle = _circle(heads.before)
    if circle:
        shown = ("-".join(map(str, stretch_of.get(k, (k,)))) for k in circle)
        return "a circle around what stays together: " + " before ".join(shown)
    within = rules.links + tuple(sorted(heads.implied()))
    for a, b in within:
        if start >= 0 and b in (start, head[start]):
            return f"{a} before {start}, where the tour starts"
        if end >= 0 and a in (end, head[end]) and b not in stretch_of.get(end, ()):
            return f"{b} behind {end}, where the tour ends"
    for a, b in rules.links:
        if a == end:
            return f"{b} right behind {end}, where the tour ends"
    if start >= 0 and end >= 0 and head[start] == head[end] and start != end:
        return f"{start}, where the tour starts, in one stretch with {end}, where it ends"
    return ""


def _circle(pairs: tuple[Pair, ...]) -> list[int]:
    """Returns keypoints of which each comes before the next and the last is the first again; none: []."""
    after: dict[int, list[int]] = {}
    for a, b in pairs:
        after.setdefault(a, []).append(b)
        after.setdefault(b, [])
    done: set[int] = set()
    for first in sorted(after):
        way, left = [first], [list(after[first])]
        while way and first not in done:
            if not left[-1]:
                done.add(way.pop())
                left.pop()
                continue
            k = left[-1].pop()
            if k in way:
                return [*way[way.index(k) :], k]
            if k not in done:
                way.append(k)
                left.append(list(after[k]))
    return []


def _numbers(name: str, text: str, sign: str) -> list[tuple[int, ...]]:
    found = []
    for chain in filter(None, (part.strip() for part in text.split(","))):
        numbers = [number.strip() for number in chain.split(sign)]
        if len(numbers) < 2 or not all(number.isascii() and number.isdigit() for number in numbers):
            raise ParameterError(name, text, f"numbers of keypoints such as 3{sign}7, more of them behind commas")
        found.append(tuple(map(int, numbers)))
    return found
