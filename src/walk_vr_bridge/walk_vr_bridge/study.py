# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The scores of a user study out of its recorded events, as the instruments prescribe (`brooke1996`, `hart1988`)."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, Final

from walk_building.errors import WalkError

TLX_SCALES: Final = ("mental", "physical", "temporal", "performance", "effort", "frustration")
TLX_PAIRS: Final = tuple(itertools.combinations(TLX_SCALES, 2))
_SUS_ITEMS: Final = 10
_TLX_STEP: Final = 5

Event = tuple[str, Mapping[str, str]]
"""An event's name and what it says."""


class StudyError(WalkError, ValueError):
    """Events that no scores can be computed of; the text says which answer is missing or wrong."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class StudyScore:
    """What one participant said about one condition, and how long the tasks took."""

    participant: str
    condition: str  # optimiser_off or optimiser_on
    sus: float  # 0 (worst) to 100
    raw_tlx: float  # 0 (no load) to 100
    weighted_tlx: float  # the same, by the participant's own weights
    task_s: tuple[float, ...]  # in the order of the tasks [s]


def sus_score(answers: Sequence[int]) -> float:
    """Returns the System Usability Scale's score of ten answers from 1 to 5 (`brooke1996`).

    Odd items contribute their answer less 1, even ones 5 less their answer; the sum is multiplied by 2.5.

    Raises:
        StudyError: There are not ten, or one is off the scale.
    """
    if len(answers) != _SUS_ITEMS or any(answer not in range(1, 6) for answer in answers):
        raise StudyError(f"the SUS takes ten answers from 1 to 5, not {list(answers)}")
    return 2.5 * sum(answer - 1 if item % 2 == 0 else 5 - answer for item, answer in enumerate(answers))


def tlx_scores(ratings: Mapping[str, int], chosen: Sequence[str]) -> tuple[float, float]:
    """Returns the raw (`hart2006`) and the weighted (`hart1988`) NASA Task Load Index, 0 to 100.

    Args:
        ratings: 0 to 100 in steps of 5, by scale.
        chosen: The scale that contributed more, of each of TLX_PAIRS.

    Raises:
        StudyError: A rating or a choice is missing or is none.
    """
    for scale in TLX_SCALES:
        if ratings.get(scale) not in range(0, 101, _TLX_STEP):
            raise StudyError(f"the TLX rating of {scale} is 0 to 100 in steps of 5, not {ratings.get(scale)}")
    if len(chosen) != len(TLX_PAIRS) or any(one not in pair for one, pair in zip(chosen, TLX_PAIRS, strict=True)):
        raise StudyError(f"the TLX takes one of each of its {len(TLX_PAIRS)} pairs, not {list(chosen)}")
    raw = sum(ratings[scale] for scale in TLX_SCALES) / len(TLX_SCALES)
    weighted = sum(ratings[scale] for scale in chosen) / len(TLX_PAIRS)
    return raw, weighted


def events_of(messages: Iterable[Any]) -> Iterator[Event]:
    """Returns the events of `study_events` messages (diagnostic_msgs/DiagnosticArray), as read from a bag."""
    for message in messages:
        for status in message.status:
            yield status.name, {pair.key: pair.value for pair in status.values}


def scores_from_events(events: Iterable[Event]) -> tuple[StudyScore, ...]:
    """Returns a score per participant and condition that was gone through, in the order they were finished.

    Of a question answered twice the last answer counts. A part that was broken off has no score.

    Raises:
        StudyError: A finished part lacks an answer.
    """
    scores: list[StudyScore] = []
    part: list[Event] = []
    for name, values in events:
        if name in ("participant", "condition"):
            part = []
        elif name in ("task", "answer"):
            part.append((name, values))
        elif name == "score":
            scores.append(_score(part, values))
    return tuple(scores)


def _score(part: Sequence[Event], whose: Mapping[str, str]) -> StudyScore:
    answers: dict[tuple[str, str], str] = {}
    for name, values in part:
        if name == "answer":
            answers[values.get("instrument", ""), values.get("item", "")] = values.get("value", "")
    ratings = {scale: _number(answers, ("tlx", scale)) for scale in TLX_SCALES}
    chosen = [answers.get(("tlx_pair", f"{first}-{second}"), "") for first, second in TLX_PAIRS]
    raw, weighted = tlx_scores(ratings, chosen)
    return StudyScore(
        participant=whose.get("participant", ""),
        condition=whose.get("condition", ""),
        sus=sus_score([_number(answers, ("sus", str(item))) for item in range(1, _SUS_ITEMS + 1)]),
        raw_tlx=raw,
        weighted_tlx=weighted,
        task_s=tuple(float(values["seconds"]) for name, values in part if name == "task" and "seconds" in values),
    )


def _number(answers: Mapping[tuple[str, str], str], question: tuple[str, str]) -> int:
    try:
        return int(answers[question])
    except (KeyError, ValueError):
        raise StudyError(f"there is no answer to {' '.join(question)}") from None
