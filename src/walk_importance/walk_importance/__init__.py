# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Importance maps and keypoints: what in a building is worth seeing, and from where."""
