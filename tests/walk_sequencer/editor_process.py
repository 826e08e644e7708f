# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Edits at random until it is killed; prints what the keypoints are once each edit is in the journal."""

import hashlib
import random
import sys
from pathlib import Path

from walk_sequencer import changes
from walk_sequencer.history import REDO, UNDO
from walk_sequencer.journal import Journal

AHEAD = [0.0, 0.0, 0.0, 1.0]


def main(folder: str, seed: str) -> None:
    journal, dice = Journal(Path(folder), "rooms"), random.Random(int(seed))
    history = journal.replay()

    def do(entry: changes.Entry) -> None:
        history.after(entry)
        journal.append(entry)
        history.apply(entry)
        sys.stdout.write(hashlib.sha256(repr(history.present).encode()).hexdigest() + "\n")
        sys.stdout.flush()

    if not history.present.ids:
        do(changes.suggested_entry([[i, 2.0, 1.6] for i in range(4)], [AHEAD] * 4))
        do(changes.order_entry(range(4)))
    while True:
        now = history.present
        place, one = [dice.random(), dice.random(), 1.6], dice.choice(now.ids)
        kind = dice.choice(["move", "insert", "dwell", "undo", "redo", "delete"])
        if kind == "move":
            do(changes.move_entry(one, place, AHEAD, "anna"))
        elif kind == "insert" and len(now.ids) < 9:
            do(changes.insert_entry(now.next_id, dice.randint(0, len(now.order)), place, AHEAD, "anna"))
        elif kind == "dwell":
            do(changes.dwell_entry(one, dice.random(), "anna"))
        elif kind == "undo" and history.can_undo:
            do(UNDO)
        elif kind == "redo" and history.can_redo:
            do(REDO)
        elif kind == "delete" and len(now.ids) > 2:
            do(changes.delete_entry(one, "anna"))


if __name__ == "__main__":
    main(*sys.argv[1:])
