# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A whole bag of one whose recording was cut off, and the executable that makes it."""

from __future__ import annotations

import argparse
import itertools
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from walk_bag.bag_reader import read_bag, unfinished_file
from walk_bag.bag_writer import BagWriter
from walk_bag.errors import BagError


def recover_bag(path: Path | str, out: Path | str) -> int:
    """Writes what can be read of a broken bag as a whole one; returns how many messages that is.

    Raises:
        BagError: There is nothing to read, or `out` cannot be written.
    """
    messages = read_bag(path)
    first = next(messages, None)
    if first is None:
        raise BagError(path, "is cut within its first messages: there is nothing to recover")
    with BagWriter(out) as writer:
        for message in itertools.chain([first], messages):
            writer.write(message.topic, message.stamp_ns, message.data)
        return writer.message_count


def parse(argv: Sequence[str]) -> argparse.Namespace:
    """Returns the options of the command line."""
    parser = argparse.ArgumentParser(
        prog=os.environ.get("WALK_COMMAND", "recover"),
        description="Make a whole bag of one whose recording was killed or ran out of disk.",
    )
    parser.add_argument("bag", type=Path, help="bag directory or .mcap file; it stays as it is")
    parser.add_argument("--out", type=Path, help="the new bag (default: BAG-recovered beside it)")
    options = parser.parse_args(argv)
    if options.out is None:
        options.out = options.bag.with_name(f"{options.bag.stem}-recovered{options.bag.suffix}")
    return options


def main(argv: Sequence[str] | None = None) -> int:
    """Recovers the bag; returns the exit code."""
    options = parse((sys.argv if argv is None else list(argv))[1:])
    try:
        if options.bag.exists() and unfinished_file(options.bag) is None:
            sys.stdout.write(f"walk: {options.bag} is whole: nothing to recover.\n")
            return 0
        count = recover_bag(options.bag, options.out)
    except BagError as error:
        sys.stderr.write(f"walk: {error}\n")
        return 2
    sys.stdout.write(f"walk: {count} messages recovered, in {options.out}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
