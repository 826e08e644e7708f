# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Whatever happens to a recorder, what it has handed to the disk can be read again."""

import os
import resource
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from walk_bag import BagError, BagTopic, BagWriter, read_bag, recover_bag
from walk_bag.bag_reader import cut_off_note, read_span, read_topics, unfinished_file
from walk_bag.mcap_file import MAGIC
from walk_bag.recover import main as recover
from walk_bag.spool import Spool

TOUR = BagTopic(name="/walk/tour", type_name="nav_msgs/msg/Path", latched=True, reliable=True, depth=1)
EDITS = BagTopic(
    name="/walk/keypoint_edits",
    type_name="visualization_msgs/msg/InteractiveMarkerFeedback",
    latched=False,
    reliable=True,
    depth=64,
)
FLUSH_S = 0.01


def _record_until_killed(path: Path) -> None:
    writer = BagWriter(path, keep=True)
    spool = Spool(writer, lambda error: os._exit(3), flush_s=FLUSH_S)
    rng = np.random.default_rng(0)
    for i in range(10**6):
        spool.put(EDITS if i % 3 else TOUR, i, i.to_bytes(8, "little") + rng.bytes(2000))
        time.sleep(0.0002)


def _sound(path: Path, every: BagTopic | None = None) -> int:
    """Asserts that a bag holds an unbroken beginning of what was recorded; returns how many messages."""
    messages = list(read_bag(path))
    assert [m.stamp_ns for m in messages] == list(range(len(messages)))
    for i, message in enumerate(messages):
        assert int.from_bytes(message.data[:8], "little") == i
        assert len(message.data) == 2008
        assert message.topic == (every or (EDITS if i % 3 else TOUR))
    return len(messages)


@pytest.mark.parametrize("suffix", ["", ".mcap"])
def test_a_recorder_killed_at_random_leaves_a_bag_that_opens(tmp_path, suffix):
    rng = np.random.default_rng(7)
    kept = []
    for i in range(50):
        out = tmp_path / f"bag{i}{suffix}"
        child = os.fork()
        if child == 0:
            _record_until_killed(out)
        there = out.with_suffix(".part.mcap") if suffix else out / f"{out.name}.mcap"
        # A moment told by what has been written, so that a busy machine sees the same kills as an idle one.
        enough = rng.uniform(2 * len(MAGIC), 400_000)
        while not there.exists() or there.stat().st_size < enough:
            time.sleep(0.0005)
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
        kept.append(_sound(there if suffix else out))
    # Not only empty ones: half of the kills come after 200 kB, which are a hundred messages.
    assert np.median(kept) > 50


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    path = tmp_path_factory.mktemp("whole") / "whole.mcap"
    rng = np.random.default_rng(1)
    with BagWriter(path) as writer:
        for i in range(12):
            writer.write(EDITS if i % 3 else TOUR, i, i.to_bytes(8, "little") + rng.bytes(2000))
            if i % 4 == 3:
                writer.flush()
    return path


@settings(max_examples=150, deadline=None)
@given(share=st.floats(0.0, 0.999999))
def test_a_bag_cut_at_any_byte_gives_what_is_before_the_cut(tmp_path_factory, whole, share):
    data = whole.read_bytes()
    cut = tmp_path_factory.mktemp("cut") / "cut.mcap"
    cut.write_bytes(data[: int(share * len(data))])
    try:
        count = _sound(cut)
    except BagError as error:
        assert int(share * len(data)) < 200, "only what is cut within its header is no bag"
        assert "cut.mcap" in str(error)
    else:
        assert count % 4 == 0


def test_a_recovered_bag_is_whole(tmp_path, whole, capsys):
    data = whole.read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) // 2])
    assert unfinished_file(tmp_path / "cut.mcap") is not None
    assert "cut.mcap was cut off" in cut_off_note(tmp_path / "cut.mcap")
    assert recover(["recover", str(tmp_path / "cut.mcap")]) == 0
    out = tmp_path / "cut-recovered.mcap"
    assert unfinished_file(out) is None
    assert cut_off_note(out) == ""
    assert _sound(out) > 0
    assert read_topics(out) == (TOUR, EDITS)
    assert f"{_sound(out)} messages recovered" in capsys.readouterr().out
    assert recover(["recover", str(out)]) == 0
    assert "is whole" in capsys.readouterr().out


def test_a_directory_without_its_metadata_is_read_and_recovered(tmp_path):
    with BagWriter(tmp_path / "bag") as writer:
        for i in range(4):
            writer.write(EDITS if i % 3 else TOUR, i, i.to_bytes(8, "little") + bytes(2000))
    (tmp_path / "bag" / "metadata.yaml").unlink()
    assert _sound(tmp_path / "bag") == 4
    assert recover_bag(tmp_path / "bag", tmp_path / "new") == 4
    assert _sound(tmp_path / "new") == 4


def test_a_recording_that_was_cut_off_is_not_written_over(tmp_path):
    (tmp_path / "tour.part.mcap").write_bytes(MAGIC)
    with pytest.raises(BagError, match=r"recover it or take it away"):
        BagWriter(tmp_path / "tour.mcap", keep=True)


def test_what_came_before_a_large_message_is_whole_when_the_file_is_cut_in_it(tmp_path):
    path = tmp_path / "large.mcap"
    with BagWriter(path) as writer:
        writer.write(TOUR, 0, b"small")
        writer.write(TOUR, 1, np.random.default_rng(0).bytes(2_000_000))
        writer.write(TOUR, 2, b"small")
    data = path.read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) // 2])
    assert [m.stamp_ns for m in read_bag(tmp_path / "cut.mcap")] == [0]


def test_a_bag_cut_within_its_first_messages_is_not_called_recovered(tmp_path, whole, capsys):
    data = whole.read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[:300])
    assert recover(["recover", str(tmp_path / "cut.mcap")]) == 2
    assert "is cut within its first messages" in capsys.readouterr().err
    assert not (tmp_path / "cut-recovered.mcap").exists()


def test_nothing_to_recover_is_said(tmp_path, capsys):
    (tmp_path / "empty.mcap").write_bytes(MAGIC)
    assert recover(["recover", str(tmp_path / "empty.mcap")]) == 2
    assert "nothing of it is whole" in capsys.readouterr().err


def test_the_span_is_that_of_the_messages(tmp_path, whole):
    assert read_span(whole) == (0, 11)
    data = whole.read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) // 2])
    first, last = read_span(tmp_path / "cut.mcap")
    assert first == 0
    assert last == _sound(tmp_path / "cut.mcap") - 1


FULL = """
import resource, signal, sys
from pathlib import Path
sys.path[:0] = {paths!r}
import numpy as np
from walk_bag import BagError, BagTopic, BagWriter
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, 100_000))
topic = BagTopic(name="/walk/tour", type_name="nav_msgs/msg/Path", latched=True, reliable=True, depth=1)
rng = np.random.default_rng(0)
try:
    with BagWriter(sys.argv[1], keep=True) as writer:
        for i in range(200):
            writer.write(topic, i, i.to_bytes(8, "little") + rng.bytes(2000))
            if i % 4 == 3:
                writer.flush()
except BagError as error:
    print(error)
"""


@pytest.mark.parametrize("name", ["bag", "bag.mcap"])
def test_a_full_disk_is_a_sentence_and_what_was_written_stays(tmp_path, name):
    """A limit on the size of files is as good as a full disk: the kernel refuses the write half-way."""
    assert resource.RLIMIT_FSIZE
    script = FULL.format(paths=[p for p in sys.path if p])
    done = subprocess.run([sys.executable, "-c", script, str(tmp_path / name)], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "cannot be written any more" in done.stdout
    left = tmp_path / ("bag" if name == "bag" else "bag.part.mcap")
    kept = _sound(left, every=TOUR)
    assert kept % 4 == 0
    assert 40 <= kept < 50
