# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The `walk` command, its set-up, launch files, parameters and the sample building."""
