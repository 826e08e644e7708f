# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A recorder misses nothing of a fast session, thins what it is told to thin, and can be killed; its measurement runs.

WALK_KILLS says how often it is killed; 100 is the full run, by hand and for releases.
"""

import json
import os
import random
import subprocess
import sys
import time

import numpy as np
import pytest
from graph.processes import LIMIT_S, Graph, Observer

from walk_bag import BagError, BagWriter, read_bag
from walk_bag.bag_reader import unfinished_file
from walk_bag.record import main as record
from walk_bag.record import pace
from walk_ros import conversions as c
from walk_ros.raw import from_bytes
from walk_ros.topics import TOPICS, absolute_name, type_name

pytestmark = pytest.mark.ros

KILLS = int(os.environ.get("WALK_KILLS", "6"))
PATHS = 150
HZ = 60.0
LINE = np.column_stack([np.arange(200.0), np.zeros(200), np.full(200, 1.6)])
AHEAD = np.tile([0.0, 0.0, 0.0, 1.0], (200, 1))


def answer(k):
    result = c.EditResult(
        outcome=c.Outcome.ACCEPTED, keypoint="0", client_id="anna", reason="", revision_ns=k, edit_stamp_ns=k
    )
    return c.edit_result_to_msg(result)


def recorded(domain, folder, *arguments):
    """Returns the stamps of paths and edits in a bag that was recorded while both were published 60 times a second."""
    graph, talker = Graph(domain, folder, ""), Observer(domain, "talker")
    publishers = {
        name: talker.node.create_publisher(TOPICS[name].type, absolute_name(name), TOPICS[name].qos)
        for name in ("path", "edit_results")
    }
    try:
        graph.run("record", "walk_bag.record", "--out", str(folder / "bag"), *arguments)
        for name, publisher in publishers.items():
            # One is this observer itself.
            talker.wait(lambda p=publisher: p.get_subscription_count() >= 2, f"the recorder to hear {name}")
        for k in range(1, PATHS + 1):
            publishers["path"].publish(c.path_to_msg(np.arange(200.0), LINE, AHEAD, k))
            publishers["edit_results"].publish(answer(k))
            until = time.monotonic() + 1.0 / HZ
            while (left := until - time.monotonic()) > 0:
                talker.executor.spin_once(timeout_sec=left)
        talker.wait(lambda: len(talker.heard["edit_results"]) == PATHS, "the last answer")
        assert graph.interrupt("record") == 0, graph.log("record")
    finally:
        talker.close()
        graph.close()
    found = {"path": [], "edit_results": []}
    times = []
    for message in read_bag(folder / "bag"):
        name = message.topic.name.rpartition("/")[2]
        times.append(message.stamp_ns)
        if name == "path":
            stamp = from_bytes(message.data, message.topic.type_name).header.stamp
            found[name].append(stamp.sec * 10**9 + stamp.nanosec)
        elif name == "edit_results":
            msg = from_bytes(message.data, message.topic.type_name)
            found[name].append(c.edit_result_from_msg(msg).edit_stamp_ns)
    assert times == sorted(times)
    return found


def test_every_message_of_a_fast_session_is_in_the_bag_in_order(other_domain, tmp_path):
    found = recorded(other_domain, tmp_path, "--previews", "0")
    assert found["edit_results"] == list(range(1, PATHS + 1))
    # Of a latched topic the middleware leaves out what was replaced before it was sent, more so on a busy machine.
    assert found["path"] == sorted(set(found["path"]))
    assert found["path"][-1] == PATHS
    assert len(found["path"]) > 0.5 * PATHS


@pytest.mark.parametrize("arguments", [(), ("--previews", "2")])
def test_previews_are_thinned_to_the_rate_and_the_last_one_is_kept(other_domain, tmp_path, arguments):
    found = recorded(other_domain, tmp_path, *arguments)
    assert found["edit_results"] == list(range(1, PATHS + 1))
    assert 2 <= len(found["path"]) <= 12
    assert found["path"] == sorted(set(found["path"]))
    assert found["path"][-1] == PATHS


def test_a_recorder_killed_at_any_moment_leaves_a_bag_that_opens(other_domain, tmp_path):
    """The real process under a stream of answers and paths: killed on its way up, while it writes, at any byte."""
    graph, talker, dice = (
        Graph(other_domain, tmp_path, ""),
        Observer(other_domain, "talker", topics=()),
        random.Random(5),
    )
    publishers = {
        name: talker.node.create_publisher(TOPICS[name].type, absolute_name(name), TOPICS[name].qos)
        for name in ("path", "edit_results")
    }
    sent, kept = 0, []

    def talk_for(seconds):
        nonlocal sent
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            sent += 1
            publishers["edit_results"].publish(answer(sent))
            publishers["path"].publish(c.path_to_msg(np.arange(200.0), LINE, AHEAD, sent))
            talker.executor.spin_once(timeout_sec=0.005)

    try:
        for kill in range(KILLS):
            name, bag = f"record{kill}", tmp_path / f"bag{kill}"
            graph.run(name, "walk_bag.record", "--out", str(bag), "--previews", "0")
            if dice.random() < 0.2:
                talk_for(dice.uniform(0.0, 2.0))
            else:
                while "first of /walk/edit_results" not in graph.log(name):
                    talk_for(0.05)
                talk_for(dice.uniform(0.0, 4.0))
            graph.kill(name)
            if bag.exists() and any(bag.iterdir()):
                kept.append(_unbroken(bag))
    finally:
        talker.close()
        graph.close()
    # Not only empty ones, which are those of the first second.
    assert np.count_nonzero(kept) >= 0.3 * KILLS and max(kept) > 100, kept


@pytest.mark.parametrize("delay_s", [0.0, 0.02, 0.1, 0.3])
def test_a_recorder_told_to_end_as_it_begins_leaves_a_whole_bag(other_domain, tmp_path, delay_s):
    graph = Graph(other_domain, tmp_path, "")
    try:
        for attempt in range(3):
            name, bag = f"record{attempt}", tmp_path / f"bag{attempt}"
            graph.run(name, "walk_bag.record", "--out", str(bag))
            until = time.monotonic() + LIMIT_S
            while "recording" not in graph.log(name):
                assert time.monotonic() < until, graph.log(name)
            time.sleep(delay_s)
            assert graph.interrupt(name) == 0, graph.log(name)
            assert unfinished_file(bag) is None
            assert list(read_bag(bag)) == []
    finally:
        graph.close()


SMALL_DISK = """
import resource, signal, sys
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (2_000_000, 2_000_000))
from walk_bag.record import main
sys.exit(main(["record", *sys.argv[1:]]))
"""


def test_a_full_disk_ends_the_recorder_with_a_sentence_and_nothing_else(other_domain, tmp_path):
    """A limit on the size of files is as good as a full disk: the kernel refuses the write half-way."""
    graph, talker = Graph(other_domain, tmp_path, ""), Observer(other_domain, "talker", topics=("path",))
    spec = TOPICS["path"]
    publisher = talker.node.create_publisher(spec.type, absolute_name("path"), spec.qos)
    rng = np.random.default_rng(0)
    try:
        with (tmp_path / "record.log").open("wb") as log:
            process = subprocess.Popen(
                [sys.executable, "-c", SMALL_DISK, "--out", str(tmp_path / "bag"), "--previews", "0"],
                env=graph.environment(), stdout=log, stderr=log,
            )  # fmt: skip
        graph.processes["record"] = process
        stamp = 0

        def ended():
            nonlocal stamp
            stamp += 1
            publisher.publish(c.path_to_msg(np.arange(200.0), rng.normal(size=(200, 3)), AHEAD, stamp))
            return process.poll() is not None

        talker.wait(ended, "the recorder to end")
        assert process.returncode == 1
        assert "cannot be written any more: File too large" in graph.log("record")
        # The graph lives on: what is said after that is heard.
        heard = len(talker.heard["path"])
        assert ended()
        talker.after("path", heard, "another path")
    finally:
        talker.close()
        graph.close()
    assert _unbroken(tmp_path / "bag") > 50


def _unbroken(bag):
    """Asserts that a bag opens and has every answer from the first it heard to the last; returns how many messages."""
    try:
        messages = list(read_bag(bag))
    except BagError:
        # Nothing but a file that was made and not yet begun.
        assert max(f.stat().st_size for f in bag.iterdir()) < 100
        return 0
    heard = [m for m in messages if m.topic.name == absolute_name("edit_results")]
    stamps = [c.edit_result_from_msg(from_bytes(m.data, m.topic.type_name)).edit_stamp_ns for m in heard]
    assert stamps == list(range(stamps[0], stamps[0] + len(stamps))) if stamps else True
    for message in messages:
        from_bytes(message.data, message.topic.type_name)
    return len(messages)


def test_the_type_hashes_in_a_bag_are_those_that_publishers_announce(other_domain, tmp_path):
    """The middleware is the oracle: it has them from the installed message packages, the bag from its own library."""
    talker = Observer(other_domain, "talker", topics=())
    try:
        publishers = [
            talker.node.create_publisher(spec.type, absolute_name(name), spec.qos) for name, spec in TOPICS.items()
        ]
        with BagWriter(tmp_path / "bag") as writer:
            for name, spec in TOPICS.items():
                infos = talker.node.get_publishers_info_by_topic(absolute_name(name))
                assert {str(i.topic_type_hash) for i in infos} == {writer.type_hash(type_name(spec.type))}, name
        assert len(publishers) == len(TOPICS)
    finally:
        talker.close()


@pytest.mark.parametrize(("hz", "lost_s"), [(0.0, 1.0), (0.5, 2.5), (2.0, 1.0), (50.0, 1.0)])
def test_a_killed_recorder_loses_a_second_unless_previews_are_rarer(hz, lost_s):
    assert sum(pace(hz)) == pytest.approx(lost_s)


@pytest.mark.parametrize("hz", ["-1", "0.1", "500", "nan"])
def test_a_rate_that_cannot_be_is_said(hz, capsys):
    with pytest.raises(SystemExit) as ended:
        record(["record", f"--previews={hz}"])
    assert ended.value.code == 2
    assert "expected 0.5 to 50 a second, or 0 for all" in capsys.readouterr().err


def bench(graph, *arguments):
    done = subprocess.run(
        [sys.executable, "-m", "walk_bag.record_bench", *arguments],
        env=graph.environment(),
        capture_output=True,
        text=True,
        timeout=4 * LIMIT_S,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_the_measurement_runs_from_start_to_end(graph, rooms, tmp_path):
    pairs = bench(graph, str(rooms), "--pairs", "1", "--seconds", "3")
    assert pairs["edit_to_path_ms"]["with"]["count"] > 0
    assert pairs["edit_to_path_ms"]["without"]["count"] > 0
    assert pairs["recording"]["edits"]["in_bags"] == pairs["recording"]["edits"]["sent"]
    bag = tmp_path / "session"
    session = bench(graph, str(rooms), "--session", "9", "--previews", "1", "--insert-every", "1", "--keep", str(bag))
    assert session["recording"]["edits"]["in_bags"] == session["recording"]["edits"]["sent"]
    assert session["recording"]["paths"]["in_bags"] < session["recording"]["paths"]["received"]
    assert session["recording"]["mb"] == [round(sum(f.stat().st_size for f in bag.iterdir()) / 1e6, 2)]
