# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The whole method in one process: from a building file to a walk, its figures, its report and its exports."""
