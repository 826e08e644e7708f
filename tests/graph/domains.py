# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""ROS domains that no other test uses, of this run or of another on this machine."""

import contextlib
import fcntl
import random
import tempfile
from pathlib import Path

# Above 101 the ports of a domain reach into those that Linux gives to outgoing connections; 0 is everybody's.
_DOMAINS = range(1, 102)


@contextlib.contextmanager
def own_domain():
    """Yields the number of a domain that is this caller's until the end of the block, by a lock on a file."""
    folder = Path(tempfile.gettempdir()) / "walk-test-domains"
    folder.mkdir(exist_ok=True)
    for number in random.sample(_DOMAINS, len(_DOMAINS)):
        with (folder / str(number)).open("w") as lock:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue
            yield number
            return
    raise AssertionError(f"all {len(_DOMAINS)} domains are in use; look for nodes that were left running")
