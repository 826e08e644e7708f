# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What the bridge adds to an edit, and what a crowd of clients does to it, as JSON."""
