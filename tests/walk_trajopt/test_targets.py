# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is looked at: a chosen point, else the one ahead."""

import numpy as np

from walk_trajopt.targets import LOOK_DISTANCE_M, NOWHERE, look_targets

EYES = np.array([[1.0, 2.0, 1.6], [5.0, 2.0, 1.6]])
NORTH = np.tile([0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)], (2, 1))


def test_a_chosen_point_replaces_the_one_ahead():
    point = np.array([0.5, 7.0, 2.0])
    targets = look_targets(EYES, NORTH, np.array([NOWHERE, point]))
    np.testing.assert_allclose(targets, [EYES[0] + [0.0, LOOK_DISTANCE_M, 0.0], point])


def test_nothing_chosen_is_straight_ahead():
    np.testing.assert_allclose(look_targets(EYES, NORTH), EYES + [0.0, LOOK_DISTANCE_M, 0.0])
