# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The sample building: a small house of culture, made by this package and stored beside it as IFC."""

from walk_bringup.sample.location import sample_path
from walk_bringup.sample.pipeline import make_sample

__all__ = ["make_sample", "sample_path"]
