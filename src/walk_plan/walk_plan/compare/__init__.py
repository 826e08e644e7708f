# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What each part of the method is for: the same walk without it, in numbers and pictures."""
