# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The commands of `./walk` that run inside of the virtual environment, a file each."""
