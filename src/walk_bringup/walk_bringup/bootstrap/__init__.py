# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What runs before anything is installed: finding out about the machine and setting the workspace up.

Only the standard library may be imported here, walk_building's errors included.
"""
