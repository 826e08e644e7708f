# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The only shared ROS code: conversions, topics and their QoS, parameters, running a node."""
