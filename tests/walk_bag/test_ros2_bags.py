# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Bags of `ros2 bag record` are read, and ours have what rosbag2 looks for where it looks for it."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from mcap.reader import make_reader
from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
from rosbags.typesys import Stores, get_typestore

from walk_bag import BagError, BagTopic, BagWriter, read_bag, recover_bag
from walk_bag.bag_reader import read_span, read_topics
from walk_bag.imports import load_ride, recorded_building
from walk_bag.keypoint_files import read_keypoints
from walk_bag.replay import chosen
from walk_bag.timeline import Timeline
from walk_bag.walkthrough import bag_topic
from walk_ros import conversions as c
from walk_ros.diagnostics import Diagnostics
from walk_ros.raw import to_bytes
from walk_ros.topics import TOPICS, type_name

REAL = Path(__file__).with_name("rosbag2")
STAMP = 1_700_000_000_000_000_000
FOREVER = QosTime(sec=9223372036, nsec=854775807)  # as a Jazzy publisher announces "infinite"
KINDS = [
    (StoragePlugin.MCAP, 9, CompressionMode.NONE),
    (StoragePlugin.MCAP, 8, CompressionMode.NONE),
    (StoragePlugin.MCAP, 9, CompressionMode.FILE),
    (StoragePlugin.SQLITE3, 9, CompressionMode.NONE),
    (StoragePlugin.SQLITE3, 8, CompressionMode.FILE),
    (StoragePlugin.SQLITE3, 9, CompressionMode.MESSAGE),
]


def qos_of(topic: BagTopic) -> Qos:
    return Qos(
        history=QosHistory.KEEP_LAST,
        depth=topic.depth,
        reliability=QosReliability.RELIABLE if topic.reliable else QosReliability.BEST_EFFORT,
        durability=QosDurability.TRANSIENT_LOCAL if topic.latched else QosDurability.VOLATILE,
        deadline=FOREVER,
        lifespan=FOREVER,
        liveliness=QosLiveliness.AUTOMATIC,
        liveliness_lease_duration=FOREVER,
        avoid_ros_namespace_conventions=False,
    )


def session() -> list[tuple[BagTopic, int, bytes]]:
    """A message of every topic of the table; a walk of three rows, two keypoints, and whose building it is."""

    class Walk:
        t_s = np.array([0.0, 1.0, 2.0])
        positions = np.array([[1.0, 2.0, 1.6], [2.0, 2.0, 1.6], [3.0, 2.0, 1.6]])
        quat_xyzw = np.tile([0.0, 0.0, 0.0, 1.0], (3, 1))
        velocities = accelerations = np.zeros((3, 3))

    told = Diagnostics("/walk/sequencer")
    told.building("/data/house.ifc", "abc")
    known: dict[str, Any] = {
        "keypoints": c.keypoints_to_msg(Walk.positions[:2], Walk.quat_xyzw[:2], STAMP),
        "trajectory": c.trajectory_to_msg(Walk(), STAMP),
        "viewpoint": c.viewpoint_to_msg(Walk.positions[0], Walk.quat_xyzw[0], STAMP),
        "/diagnostics": told.to_msg(STAMP),
    }
    return [
        (bag_topic(name), STAMP + i, to_bytes(known.get(name) or spec.type()))
        for i, (name, spec) in enumerate(TOPICS.items())
    ]


def record_as_ros2(
    path: Path, storage: StoragePlugin, version: Any = 9, compression: CompressionMode = CompressionMode.NONE
) -> list[tuple[BagTopic, int, bytes]]:
    """Writes the session by a library of others, as `ros2 bag record -a` would: with what else is in a graph."""
    store, messages = get_typestore(Stores.ROS2_JAZZY), session()
    writer = Writer(path, version=version, storage_plugin=storage)
    writer.set_compression(compression, CompressionFormat.ZSTD)
    with writer:
        for topic, stamp_ns, data in messages:
            connection = writer.add_connection(
                topic.name, topic.type_name, typestore=store, offered_qos_profiles=[qos_of(topic)]
            )
            writer.write(connection, stamp_ns, data)
        other = writer.add_connection(
            "/tf_static",
            "tf2_msgs/msg/TFMessage",
            msgdef="geometry_msgs/TransformStamped[] transforms",
            rihs01="RIHS01_0",
        )
        writer.write(other, STAMP + 1000, b"\x00\x01\x00\x00\x00\x00\x00\x00")
    return messages


@pytest.mark.parametrize(("storage", "version", "compression"), KINDS)
def test_a_session_recorded_by_ros2_is_read_byte_by_byte(
    tmp_path: Path, storage: StoragePlugin, version: int, compression: CompressionMode
) -> None:
    messages = record_as_ros2(tmp_path / "bag", storage, version, compression)
    read = [(m.topic, m.stamp_ns, m.data) for m in read_bag(tmp_path / "bag")]
    assert read[:-1] == messages and read[-1][0].name == "/tf_static"
    assert set(read_topics(tmp_path / "bag")) == {topic for topic, _, _ in read}
    assert read_span(tmp_path / "bag") == (STAMP, STAMP + 1000)


@pytest.mark.parametrize("storage", [StoragePlugin.MCAP, StoragePlugin.SQLITE3])
def test_a_session_recorded_by_ros2_is_exported_imported_and_sought_in(tmp_path: Path, storage: StoragePlugin) -> None:
    bag = tmp_path / "bag"
    messages = record_as_ros2(bag, storage)
    np.testing.assert_array_equal(load_ride(bag).positions[:, 0], [1.0, 2.0, 3.0])
    with pytest.raises(BagError, match="no viewpoint that moves"):  # it is read; one is no way
        load_ride(bag, "viewpoint")
    np.testing.assert_array_equal(read_keypoints(bag).positions, [[1.0, 2.0, 1.6], [2.0, 2.0, 1.6]])
    assert recorded_building(bag).path == "/data/house.ifc"
    held = Timeline.of(bag).state_at(STAMP + 1001)
    assert [m.topic for m in held] == [topic for topic, _, _ in messages if topic.latched]


def test_a_topic_of_a_type_that_is_not_installed_is_left_out_of_a_replay(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record_as_ros2(tmp_path / "bag", StoragePlugin.MCAP)
    options = argparse.Namespace(bag=tmp_path / "bag", topics=[], namespace="walk", start=0.0)
    names = {topic.name for topic in chosen(options).topics}
    assert "/walk/path" in names and "/tf_static" not in names
    assert "/tf_static is left out: its type, tf2_msgs/msg/TFMessage, is not installed" in capsys.readouterr().err
    options.topics = ["/tf_static"]
    with pytest.raises(BagError, match="tf2_msgs/msg/TFMessage"):
        chosen(options)


@pytest.mark.parametrize(
    ("name", "count", "topics"), [("topics_and_services.mcap", 13, 5), ("topics_and_services", 10, 5)]
)
def test_what_the_real_rosbag2_wrote_is_read_with_its_service_events(name: str, count: int, topics: int) -> None:
    messages = list(read_bag(REAL / name))
    assert len(messages) == count and len({t.name for t in read_topics(REAL / name)}) == topics
    assert [m.stamp_ns for m in messages] == sorted(m.stamp_ns for m in messages)
    assert any(t.name.endswith("/_service_event") and t.latched for t in read_topics(REAL / name))


def test_a_directory_whose_metadata_tell_another_qos_than_its_file_is_read(tmp_path: Path) -> None:
    """Tools that rewrite a bag leave such ones; the library would give no message of that topic, and no word."""
    messages = record_as_ros2(tmp_path / "bag", StoragePlugin.MCAP)
    text = (tmp_path / "bag" / "metadata.yaml").read_text()
    (tmp_path / "bag" / "metadata.yaml").write_text(text.replace("depth: 1\n", "depth: 7\n"))
    assert len(list(read_bag(tmp_path / "bag"))) == len(messages) + 1


def test_of_a_recording_in_several_files_that_was_killed_all_are_read(tmp_path: Path) -> None:
    (tmp_path / "bag").mkdir()
    topic = bag_topic("tour")
    for number in range(11):
        with BagWriter(tmp_path / "one.mcap") as writer:
            for i in range(3):
                writer.write(topic, STAMP + 3 * number + i, bytes([number, i]) * 500)
                writer.flush()
        (tmp_path / "one.mcap").rename(tmp_path / "bag" / f"bag_{number}.mcap")
    last = tmp_path / "bag" / "bag_10.mcap"
    last.write_bytes(last.read_bytes()[:-600])
    assert [m.stamp_ns - STAMP for m in read_bag(tmp_path / "bag")] == list(range(33))
    assert recover_bag(tmp_path / "bag", tmp_path / "whole") == 33
    last.write_bytes(b"")
    assert len(list(read_bag(tmp_path / "bag"))) == 30


def as_rosbag2_reads(about: dict[str, Any]) -> dict[str, str]:
    """Takes what rosbag2 of Jazzy takes from a bag's metadata (`yaml.hpp`, BagMetadata::decode); returns types."""
    assert isinstance(about["version"], int) and isinstance(about["storage_identifier"], str)
    assert about["duration"]["nanoseconds"] >= 0
    assert about["starting_time"]["nanoseconds_since_epoch"] >= 0
    assert isinstance(about["compression_format"], str) and isinstance(about["compression_mode"], str)
    for file in about["files"]:
        assert file["path"] in about["relative_file_paths"]
        assert file["starting_time"]["nanoseconds_since_epoch"] == about["starting_time"]["nanoseconds_since_epoch"]
    assert about["custom_data"] is None or isinstance(about["custom_data"], dict)
    assert isinstance(about["ros_distro"], str)
    assert about["message_count"] == sum(t["message_count"] for t in about["topics_with_message_count"])
    types = {}
    for topic in (t["topic_metadata"] for t in about["topics_with_message_count"]):
        assert topic["serialization_format"] == "cdr" and topic["type_description_hash"].startswith("RIHS01_")
        (qos,) = yaml.safe_load(topic["offered_qos_profiles"])
        # Whole numbers, as version 8 has them; words come with version 9.
        assert all(isinstance(qos[k], int) for k in ("history", "depth", "reliability", "durability", "liveliness"))
        assert set(qos["deadline"]) == {"sec", "nsec"} and qos["avoid_ros_namespace_conventions"] is False
        types[topic["name"]] = topic["type"]
    return types


def embedded(path: Path) -> dict[str, Any]:
    """Returns what an MCAP file says of the bag, from the place and in the form in which rosbag2 looks for it."""
    with path.open("rb") as file:
        *_, record = (m for m in make_reader(file).iter_metadata() if m.name == "rosbag2")  # the last one counts
    return dict(yaml.safe_load(record.metadata["serialized_metadata"]))


def test_ours_have_their_metadata_where_rosbag2_looks_for_them(tmp_path: Path) -> None:
    wanted = {bag_topic(name).name: type_name(spec.type) for name, spec in TOPICS.items()}
    for name in ("bag", "bare.mcap"):
        with BagWriter(tmp_path / name) as writer:
            for topic, stamp_ns, data in session():
                writer.write(topic, stamp_ns, data)
    for file in (tmp_path / "bare.mcap", tmp_path / "bag" / "bag.mcap"):
        about = embedded(file)
        assert as_rosbag2_reads(about) == wanted
        # The same keys in the same place as in a file of rosbag2's own; `version` first, for it is asked for first.
        assert list(about) == list(embedded(REAL / "topics_and_services.mcap"))
    outside = yaml.safe_load((tmp_path / "bag" / "metadata.yaml").read_text())
    assert list(outside) == ["rosbag2_bagfile_information"]
    assert as_rosbag2_reads(outside["rosbag2_bagfile_information"]) == wanted


def test_an_mcap_file_of_ours_has_the_records_that_rosbag2_needs(tmp_path: Path) -> None:
    """Header, schemas and channels as in a file of rosbag2's own, and the statistics that it opens a bag with."""
    with BagWriter(tmp_path / "bare.mcap") as writer:
        for topic, stamp_ns, data in session():
            writer.write(topic, stamp_ns, data)
    found = {}
    for name, path in (("ours", tmp_path / "bare.mcap"), ("theirs", REAL / "topics_and_services.mcap")):
        with path.open("rb") as file:
            reader = make_reader(file)
            summary = reader.get_summary()
            assert summary is not None and summary.statistics is not None and summary.chunk_indexes
            channel, schema = next(iter(summary.channels.values())), next(iter(summary.schemas.values()))
            found[name] = (
                reader.get_header().profile, channel.message_encoding, sorted(channel.metadata),
                schema.encoding, summary.statistics.message_count > 0,
            )  # fmt: skip
    assert found["ours"] == found["theirs"]
