# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The first Python file that `./walk` runs, with whatever Python it found."""

import sys
from pathlib import Path

sys.dont_write_bytecode = True  # the checkout may be another user's
sys.path[0] = str(Path(__file__).resolve().parents[2])

from walk_bringup.bootstrap.main import main  # noqa: E402  (the path has to be set first)

sys.exit(main(sys.argv[1:]))
