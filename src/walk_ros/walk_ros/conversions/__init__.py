# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Messages and the project's values, in pairs: `x_to_msg` and `x_from_msg`.

Every `x_from_msg` checks what comes in and raises MessageError with the reason; nothing unsound passes it.
"""

from walk_ros.conversions.edit_marks import KeypointMarks, keypoint_marks_from_msg, keypoint_marks_to_msgs
from walk_ros.conversions.edits import (
    Change,
    EditKind,
    EditResult,
    KeypointEdit,
    Outcome,
    edit_from_msg,
    edit_result_from_msg,
    edit_result_to_msg,
    edit_to_msg,
)
from walk_ros.conversions.edits_cdr import edit_from_bytes
from walk_ros.conversions.importance import ReceivedImportanceMap, importance_map_from_msg, importance_map_to_msg
from walk_ros.conversions.legs import ReceivedLeg, ReceivedLegs, pairwise_paths_from_msg, pairwise_paths_to_msg
from walk_ros.conversions.markers import LabelledKeypoints, keypoint_markers_from_msg, keypoint_markers_to_msg
from walk_ros.conversions.paths import TimedPath, path_from_msg, path_to_msg, tour_from_msg, tour_to_msg
from walk_ros.conversions.poses import (
    Poses,
    keypoints_from_msg,
    keypoints_to_msg,
    viewpoint_from_msg,
    viewpoint_to_msg,
)
from walk_ros.conversions.stamps import stamp_from_msg, stamp_to_msg
from walk_ros.conversions.storeys import StoreyGrid, storey_grid, storey_grid_from_msg, storey_grid_to_msg
from walk_ros.conversions.trajectories import ReceivedTrajectory, trajectory_from_msg, trajectory_to_msg

__all__ = [
    "Change",
    "EditKind",
    "EditResult",
    "KeypointEdit",
    "KeypointMarks",
    "LabelledKeypoints",
    "Outcome",
    "Poses",
    "ReceivedImportanceMap",
    "ReceivedLeg",
    "ReceivedLegs",
    "ReceivedTrajectory",
    "StoreyGrid",
    "TimedPath",
    "edit_from_bytes",
    "edit_from_msg",
    "edit_result_from_msg",
    "edit_result_to_msg",
    "edit_to_msg",
    "importance_map_from_msg",
    "importance_map_to_msg",
    "keypoint_marks_from_msg",
    "keypoint_marks_to_msgs",
    "keypoint_markers_from_msg",
    "keypoint_markers_to_msg",
    "keypoints_from_msg",
    "keypoints_to_msg",
    "pairwise_paths_from_msg",
    "pairwise_paths_to_msg",
    "path_from_msg",
    "path_to_msg",
    "stamp_from_msg",
    "stamp_to_msg",
    "storey_grid",
    "storey_grid_from_msg",
    "storey_grid_to_msg",
    "tour_from_msg",
    "tour_to_msg",
    "trajectory_from_msg",
    "trajectory_to_msg",
    "viewpoint_from_msg",
    "viewpoint_to_msg",
]
