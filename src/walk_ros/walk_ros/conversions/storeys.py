# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The importance at standing height, a storey at a time, as nav_msgs/OccupancyGrid."""

from __future__ import annotations

import array
import dataclasses

import numpy as np
from nav_msgs.msg import MapMetaData, OccupancyGrid
from numpy.typing import NDArray

from walk_ros.conversions.checks import finite_array, read_only, require, unit_quaternions
from walk_ros.conversions.importance import ImportanceMapLike
from walk_ros.conversions.poses import pose_msgs
from walk_ros.conversions.stamps import header_from_msg, header_to_msg, stamp_to_msg

KIND = "nav_msgs/OccupancyGrid"
UNKNOWN = -1


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class StoreyGrid:
    """The importance of one storey at the height of a standing walker's eye."""

    origin: NDArray[np.float64]  # (3,) lowest corner, z on the storey's floor [m]
    cell_m: float
    percent: NDArray[np.int8]  # (nx, ny): 0..100 from the least to the most important free voxel, -1 obstacle


def storey_grid(importance_map: ImportanceMapLike, floor_z: float, eye_height_m: float) -> StoreyGrid:
    """Returns the slice of the map at eye height above a storey's floor; above or below the map all is unknown."""
    grid = importance_map.grid
    layer = int(np.floor((floor_z + eye_height_m - grid.origin[2]) / grid.voxel_size_m))
    percent = np.full(grid.shape[:2], UNKNOWN, np.int8)
    if 0 <= layer < grid.shape[2]:
        free = np.asarray(importance_map.obstacle) < 0.5
        # Between the free voxels' extremes: their common share of the obstacle map would leave no contrast.
        of_free = importance_map.importance[free]
        low, high = (float(of_free.min()), float(of_free.max())) if of_free.size else (0.0, 1.0)
        here = free[:, :, layer]
        scaled = 100.0 * (importance_map.importance[:, :, layer][here] - low) / max(high - low, 1e-9)
        percent[here] = np.rint(np.clip(scaled, 0.0, 100.0)).astype(np.int8)
    origin = read_only([grid.origin[0], grid.origin[1], floor_z], np.float64, (3,))
    percent.flags.writeable = False
    return StoreyGrid(origin=origin, cell_m=grid.voxel_size_m, percent=percent)


def storey_grid_to_msg(grid: StoreyGrid | None, stamp_ns: int) -> OccupancyGrid:
    """Returns the storey's grid, x fastest; None gives an empty grid of the revision."""
    msg = OccupancyGrid(header=header_to_msg(stamp_ns))
    if grid is None:
        return msg
    nx, ny = grid.percent.shape
    (pose,) = pose_msgs([grid.origin], [[0.0, 0.0, 0.0, 1.0]])
    # A float32 field: round to it here, so that the checks of the message classes agree.
    resolution = float(np.float32(grid.cell_m))
    msg.info = MapMetaData(
        map_load_time=stamp_to_msg(stamp_ns), resolution=resolution, width=nx, height=ny, origin=pose
    )
    data = array.array("b")
    data.frombytes(np.ascontiguousarray(grid.percent.T).tobytes())
    msg.data = data
    return msg


def storey_grid_from_msg(msg: OccupancyGrid) -> StoreyGrid | None:
    """Returns the grid of a storey, None for an empty one; raises MessageError if it is not sound."""
    header_from_msg(msg.header, KIND)
    nx, ny = msg.info.width, msg.info.height
    require(len(msg.data) == nx * ny, KIND, f"{len(msg.data)} cells for a grid of {nx} x {ny}; sizes do not agree")
    if not nx * ny:
        return None
    size = msg.info.resolution
    require(bool(np.isfinite(size)) and size > 0, KIND, f"resolution is {size:g} m; expected above 0")
    pose = msg.info.origin
    origin = finite_array(KIND, "origin", [pose.position.x, pose.position.y, pose.position.z], 3)[0]
    turn = pose.orientation
    quat = unit_quaternions(KIND, [turn.x, turn.y, turn.z, turn.w])[0]
    require(bool(abs(quat[3]) > 1 - 1e-9), KIND, "the grid is turned; expected its axes along x and y")
    percent = np.frombuffer(memoryview(msg.data), np.int8).reshape(ny, nx).T
    require(bool((percent >= UNKNOWN).all() and (percent <= 100).all()), KIND, "a cell is not in -1..100")
    return StoreyGrid(origin=origin, cell_m=size, percent=read_only(percent, np.int8, (nx, ny)))
