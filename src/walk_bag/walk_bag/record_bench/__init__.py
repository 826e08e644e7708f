# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What recording costs the graph that is recorded, and how large the bags become."""
