# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a page shows of a building: meshes, storeys and rooms, the importance volume. Knows no web server and no ROS."""
