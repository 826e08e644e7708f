# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The headset page and the WebSocket through which headsets, Unity and scripts edit a walkthrough."""
