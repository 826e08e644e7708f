# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Scores of a study out of its events."""

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.serialization import serialize_message

from walk_bag.bag_reader import read_bag
from walk_bag.bag_writer import BagWriter
from walk_bag.topics import BagTopic
from walk_ros.raw import from_bytes
from walk_vr_bridge.study import TLX_PAIRS, TLX_SCALES, StudyError, events_of, scores_from_events, sus_score, tlx_scores

BROOKES_EXAMPLE = (5, 4, 2, 1, 2, 3, 2, 4, 5, 2)


def events(participant="1", condition="optimiser_on", sus=BROOKES_EXAMPLE, rating=35, seconds=(10.0, 20.5)):
    whose = {"participant": participant, "condition": condition}

    def answer(instrument, item, value):
        return "answer", {**whose, "instrument": instrument, "item": item, "value": str(value)}

    yield "condition", whose
    for took in seconds:
        yield "task", {**whose, "phase": "begin"}
        yield "task", {**whose, "phase": "done", "seconds": str(took)}
    yield from (answer("sus", str(item + 1), value) for item, value in enumerate(sus))
    yield from (answer("tlx", scale, rating) for scale in TLX_SCALES)
    yield from (answer("tlx_pair", f"{first}-{second}", first) for first, second in TLX_PAIRS)
    yield "score", whose


def test_sus_scores_brookes_example_with_55():
    assert sus_score(BROOKES_EXAMPLE) == 55.0


def test_sus_runs_from_0_to_100_with_50_in_the_middle():
    assert sus_score([5, 1] * 5) == 100.0
    assert sus_score([1, 5] * 5) == 0.0
    assert sus_score([3] * 10) == 50.0


def test_tlx_weighs_each_scale_by_how_often_it_was_chosen():
    ratings = dict(zip(TLX_SCALES, (30, 15, 60, 40, 40, 30), strict=True))
    first = [pair[0] for pair in TLX_PAIRS]  # weights 5, 4, 3, 2, 1, 0
    raw, weighted = tlx_scores(ratings, first)
    assert raw == pytest.approx(215 / 6)
    assert weighted == pytest.approx((5 * 30 + 4 * 15 + 3 * 60 + 2 * 40 + 1 * 40) / 15)


def test_each_finished_part_has_a_score_and_a_part_broken_off_has_none():
    broken = list(events(participant="2"))[:12]
    scores = scores_from_events([*events(), *broken, ("end", {}), *events(condition="optimiser_off", sus=[3] * 10)])
    assert [(s.condition, s.sus, s.raw_tlx, s.weighted_tlx) for s in scores] == [
        ("optimiser_on", 55.0, 35.0, 35.0),
        ("optimiser_off", 50.0, 35.0, 35.0),
    ]
    assert scores[0].task_s == (10.0, 20.5)


def test_the_last_answer_to_a_question_counts():
    again = list(events(sus=[3] * 10))
    at = next(i for i, (name, values) in enumerate(again) if values.get("instrument") == "sus")
    name, values = again[at]
    again.insert(at, (name, {**values, "value": "1"}))
    assert scores_from_events(again)[0].sus == 50.0


def test_a_missing_answer_is_named():
    short = [event for event in events() if event[1].get("item") != "effort"]
    with pytest.raises(StudyError, match="tlx effort"):
        scores_from_events(short)
    with pytest.raises(StudyError, match="ten answers"):
        sus_score([3] * 9)


def test_events_are_read_from_messages():
    values = [KeyValue(key="participant", value="4")]
    message = DiagnosticArray(status=[DiagnosticStatus(name="participant", values=values)])
    assert list(events_of([message])) == [("participant", {"participant": "4"})]


def test_a_bag_gives_the_scores_of_what_was_recorded_in_it(tmp_path):
    bag = tmp_path / "study.mcap"
    kind = "diagnostic_msgs/msg/DiagnosticArray"
    topic = BagTopic(name="/walk/study_events", type_name=kind, latched=False, reliable=True, depth=10)
    with BagWriter(bag) as writer:
        for stamp, (name, values) in enumerate(events()):
            pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
            message = DiagnosticArray(status=[DiagnosticStatus(name=name, values=pairs)])
            writer.write(topic, stamp, serialize_message(message))
    messages = (from_bytes(m.data, m.topic.type_name) for m in read_bag(bag, {"/walk/study_events"}))
    assert scores_from_events(events_of(messages)) == scores_from_events(events())
