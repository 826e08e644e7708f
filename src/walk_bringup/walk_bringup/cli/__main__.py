# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Lets `python -m walk_bringup.cli` be the command."""

import sys

from walk_bringup.cli.main import main

sys.exit(main())
