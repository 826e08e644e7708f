# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Projects: a building's parameters and tours in one folder of readable files, saved and opened again."""
