# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Who is let in: certificate, tokens, pairing, and what a request must look like. Knows no web server and no ROS."""
