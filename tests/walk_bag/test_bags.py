# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is written is read: bags without a graph."""

import time
from types import SimpleNamespace

import numpy as np
import pytest
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability, QosReliability

from walk_bag import BagError, BagTopic, BagWriter, read_bag, write_walkthrough_bag
from walk_bag.bag_reader import read_topics
from walk_bag.walkthrough import bag_topic, walkthrough_messages
from walk_ros import conversions as c
from walk_ros.raw import from_bytes, to_bytes
from walk_ros.topics import TOPICS, type_name

STAMP = 1_700_000_000_000_000_000


@pytest.fixture
def results():
    rng = np.random.default_rng(3)
    shape = (4, 3, 2)
    fields = {k: rng.random(shape, dtype=np.float32) for k in ("obstacle", "distance", "visibility", "importance")}
    grid = SimpleNamespace(origin=np.zeros(3), voxel_size_m=0.5, shape=shape)
    points = rng.normal(size=(3, 3))
    quat = np.tile([0.0, 0.0, 0.0, 1.0], (3, 1))
    leg = SimpleNamespace(start=0, goal=1, points=points[:2], length_m=2.5)
    lengths = np.array([[0, 2.5, np.inf], [2.5, 0, np.inf], [np.inf, np.inf, 0]])
    tour = SimpleNamespace(
        order=np.array([1, 0]),
        unreachable=(SimpleNamespace(index=2, reason="on the roof"),),
        pairs=(leg,),
        lengths_m=lengths,
        stands=np.vstack([points[:2], [[np.nan] * 3]]),
        polyline=points[[1, 0]],
    )
    t = np.linspace(0.0, 2.0, 21)
    rows = {k: rng.normal(size=(21, 3)) for k in ("positions", "velocities", "accelerations")}
    trajectory = SimpleNamespace(t_s=t, quat_xyzw=np.tile([0.0, 0.0, 0.0, 1.0], (21, 1)), **rows)
    return {
        "importance_map": SimpleNamespace(grid=grid, **fields),
        "floors_z": [0.0, 0.4],
        "eye_height_m": 0.3,
        "positions": points,
        "quat_xyzw": quat,
        "labels": ["hall", "kitchen", ""],
        "tour": tour,
        "trajectory": trajectory,
        "stamp_ns": STAMP,
    }


@pytest.mark.parametrize("name", ["tour.mcap", "tour"])
def test_a_walkthrough_is_read_back_message_by_message(tmp_path, results, name):
    messages = walkthrough_messages(**results)
    write_walkthrough_bag(tmp_path / name, messages)
    got = list(read_bag(tmp_path / name))
    assert len(got) == len(messages)
    by_topic = {}
    for message in got:
        by_topic.setdefault(message.topic.name, []).append(message)
    for stamp, topic, msg in messages:
        message = by_topic[f"/walk/{topic}"].pop(0)
        assert message.stamp_ns == stamp
        assert from_bytes(message.data, message.topic.type_name) == msg
    assert [p.name for p in tmp_path.iterdir()] == [name]


def test_another_library_reads_the_same_numbers(tmp_path, results):
    """The oracle: rosbags' own message classes, which share nothing with ours."""
    write_walkthrough_bag(tmp_path / "tour.mcap", walkthrough_messages(**results))
    with AnyReader([tmp_path / "tour.mcap"]) as reader:
        seen = {}
        for connection, stamp, data in reader.messages():
            seen.setdefault(connection.topic, []).append((stamp, reader.deserialize(data, connection.msgtype)))
    ((_, trajectory),) = seen["/walk/trajectory"]
    got = [[getattr(p.transforms[0].translation, a) for a in "xyz"] for p in trajectory.points]
    np.testing.assert_array_equal(got, results["trajectory"].positions)
    ((_, cloud),) = seen["/walk/importance_map"]
    table = np.frombuffer(cloud.data.tobytes(), np.float32).reshape(-1, 7)
    np.testing.assert_array_equal(table[:, 6], results["importance_map"].importance.ravel(order="F"))
    assert len(seen["/walk/importance_map/storeys"]) == 2
    viewpoints = seen["/walk/viewpoint"]
    assert [s - STAMP for s, _ in viewpoints] == np.rint(results["trajectory"].t_s * 1e9).astype(int).tolist()


def test_qos_and_type_hashes_are_those_of_the_graph(tmp_path, results):
    write_walkthrough_bag(tmp_path / "tour", walkthrough_messages(**results))
    with AnyReader([tmp_path / "tour"]) as reader:
        for connection in reader.connections:
            qos = connection.ext.offered_qos_profiles[0]
            live = connection.topic == "/walk/viewpoint"
            assert qos.durability == (QosDurability.VOLATILE if live else QosDurability.TRANSIENT_LOCAL)
            assert qos.reliability == (QosReliability.BEST_EFFORT if live else QosReliability.RELIABLE)
    text = (tmp_path / "tour" / "metadata.yaml").read_text()
    assert "version: 8" in text
    # What a Jazzy publisher of nav_msgs/Path announces.
    with BagWriter(tmp_path / "other") as writer:
        known = writer.type_hash("nav_msgs/msg/Path")
        writer.write(bag_topic("tour"), STAMP, to_bytes(c.tour_to_msg(np.zeros((2, 3)), STAMP)))
    assert known.startswith("RIHS01_")
    assert known in text


def test_topics_are_told_with_their_policies(tmp_path, results):
    write_walkthrough_bag(tmp_path / "tour.mcap", walkthrough_messages(**results))
    topics = {t.name: t for t in read_topics(tmp_path / "tour.mcap")}
    assert topics["/walk/path"] == bag_topic("path")
    assert topics["/walk/viewpoint"].reliable is False
    assert topics["/walk/importance_map/storeys"].depth >= 2


def test_every_topic_of_the_table_can_be_in_a_bag(tmp_path):
    with BagWriter(tmp_path / "all.mcap") as writer:
        for name, spec in TOPICS.items():
            writer.write(bag_topic(name), STAMP, to_bytes(spec.type()))
            assert writer.type_hash(type_name(spec.type)).startswith("RIHS01_")
    assert len(list(read_bag(tmp_path / "all.mcap"))) == len(TOPICS)


def test_a_bag_without_messages_is_readable(tmp_path):
    for name in ("empty", "empty.mcap"):
        with BagWriter(tmp_path / name):
            pass
        assert list(read_bag(tmp_path / name)) == []


def test_a_bag_larger_than_a_chunk_keeps_its_order(tmp_path):
    topic = BagTopic(name="/walk/tour", type_name="nav_msgs/msg/Path", latched=True, reliable=True, depth=1)
    with BagWriter(tmp_path / "long.mcap") as writer:
        for i in range(40):
            writer.write(topic, STAMP + i, bytes([i]) * 100_000)
    got = list(read_bag(tmp_path / "long.mcap"))
    assert [m.stamp_ns - STAMP for m in got] == list(range(40))
    assert all(m.data == bytes([i]) * 100_000 for i, m in enumerate(got))


def test_a_directory_is_never_overwritten(tmp_path):
    (tmp_path / "mine").mkdir()
    with pytest.raises(BagError, match="exists already"):
        BagWriter(tmp_path / "mine")


def test_a_file_is_replaced_only_by_a_whole_one(tmp_path, results):
    path = tmp_path / "tour.mcap"
    write_walkthrough_bag(path, walkthrough_messages(**results))
    before = path.read_bytes()
    with pytest.raises(KeyError):
        write_walkthrough_bag(path, [(STAMP, "no_such_topic", c.tour_to_msg(np.zeros((2, 3)), STAMP))])
    assert path.read_bytes() == before
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("content", [b"", b"not a bag", b"\x89MCAP0\r\n" + b"\x01" * 50])
def test_what_is_no_bag_is_said_so(tmp_path, content):
    path = tmp_path / "bad.mcap"
    path.write_bytes(content)
    with pytest.raises(BagError, match=r"bad\.mcap"):
        list(read_bag(path))


def test_a_missing_bag_is_said_so(tmp_path):
    with pytest.raises(BagError, match="nothing"):
        list(read_bag(tmp_path / "nothing"))


def test_a_bag_that_cannot_be_written_is_said_so(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(BagError):
        BagWriter(tmp_path / "file" / "bag.mcap")


def test_writing_a_million_voxels_takes_seconds(tmp_path):
    shape = (100, 100, 100)
    fields = {k: np.ones(shape, np.float32) for k in ("obstacle", "distance", "visibility", "importance")}
    grid = SimpleNamespace(origin=np.zeros(3), voxel_size_m=0.5, shape=shape)
    began = time.perf_counter()
    msg = c.importance_map_to_msg(SimpleNamespace(grid=grid, **fields), STAMP)
    write_walkthrough_bag(tmp_path / "big.mcap", [(STAMP, "importance_map", msg)])
    assert time.perf_counter() - began < 10.0
    (got,) = read_bag(tmp_path / "big.mcap")
    assert from_bytes(got.data, got.topic.type_name) == msg
