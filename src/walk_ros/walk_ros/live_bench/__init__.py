# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What an edit costs over real DDS: from published to the new path received, beside a node that only copies."""
