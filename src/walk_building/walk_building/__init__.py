# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Building files as something to plan in: triangles, rooms, storeys, walkable surface, exact queries."""
