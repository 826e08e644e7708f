# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The past is kept small and comes back bit for bit, beside a plain stack of whole values."""

import dataclasses
import tracemalloc

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from walk_sequencer import changes
from walk_sequencer.history import REDO, UNDO, History

AHEAD = [0.0, 0.0, 0.0, 1.0]


def bits(keypoints):
    """Every field as it is, arrays as bytes; identities used up go on and are not compared."""
    fields = {f.name: getattr(keypoints, f.name) for f in dataclasses.fields(keypoints) if f.name != "next_id"}
    return {k: (v.shape, v.tobytes()) if isinstance(v, np.ndarray) else v for k, v in fields.items()}


def begun(count):
    history = History()
    history.apply(changes.suggested_entry([[i, 2.0, 1.6] for i in range(count)], [AHEAD] * count))
    history.apply(changes.order_entry(range(count)))
    return history


def entry(history, kind, dice):
    now = history.present
    one, place = int(dice.choice(now.ids)), dice.random(3)
    if kind == "insert":
        return changes.insert_entry(now.next_id, int(dice.integers(len(now.order) + 1)), place, AHEAD, "anna")
    if kind == "delete" and len(now.ids) > 2:
        return changes.delete_entry(one, "anna")
    if kind == "dwell":
        return changes.dwell_entry(one, dice.choice([None, -0.0, 0.0, 2.5]), "anna")
    if kind == "look_at":
        return changes.look_at_entry(one, None if dice.random() < 0.5 else place, "anna")
    if kind == "order":
        return changes.order_entry(dice.permutation(now.order))
    return changes.move_entry(one, place, AHEAD, "anna")


KINDS = st.lists(
    st.sampled_from(["move", "insert", "delete", "dwell", "look_at", "order", "undo", "redo"]), max_size=40
)


@settings(deadline=None)
@given(KINDS, st.integers(0, 2**32))
def test_any_undo_and_redo_restores_every_bit(kinds, seed):
    history, dice = begun(4), np.random.default_rng(seed)
    past, future = [], []
    for kind in kinds:
        before = bits(history.present)
        source, other = (past, future) if kind == "undo" else (future, past)
        if kind in ("undo", "redo"):
            assert (history.can_undo, history.can_redo) == (bool(past), bool(future))
            if not source:
                continue
            history.apply(UNDO if kind == "undo" else REDO)
            assert bits(history.present) == source.pop()
            other.append(before)
            continue
        history.apply(entry(history, kind, dice))
        if kind != "order":
            past.append(before)
            future.clear()
    for earlier in reversed(past):
        history.apply(UNDO)
        assert bits(history.present) == earlier


def test_ten_thousand_moves_of_a_hundred_keypoints_need_little_memory():
    history, dice = begun(100), np.random.default_rng(1)
    count = 10_000
    tracemalloc.start()
    try:
        for _ in range(count):
            history.apply(entry(history, "move", dice))
        grown, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert grown < 1500 * count  # the values themselves are 5600 bytes each
    for _ in range(count):
        history.apply(UNDO)
    assert bits(history.present) == bits(begun(100).present)
