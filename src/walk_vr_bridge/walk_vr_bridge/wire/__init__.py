# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""ROS messages as JSON and CBOR, in the forms of rosbridge v2."""
