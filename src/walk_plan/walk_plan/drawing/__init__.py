# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of a walkthrough, drawn with matplotlib: each function returns one figure."""
