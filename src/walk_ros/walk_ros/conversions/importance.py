# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The importance map as sensor_msgs/PointCloud2: one point per voxel centre, x fastest, then y, then z."""

from __future__ import annotations

import array
import dataclasses
import struct
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2, PointField

from walk_ros.conversions.checks import require
from walk_ros.conversions.stamps import header_from_msg, header_to_msg

KIND = "sensor_msgs/PointCloud2"
FIELDS = ("x", "y", "z", "obstacle", "distance", "visibility", "importance")
MAPS = FIELDS[3:]


class GridLike(Protocol):
    """What a voxel grid has."""

    @property
    def origin(self) -> NDArray[np.float64]:
        """(3,) lowest corner of the lowest voxel [m]."""

    @property
    def voxel_size_m(self) -> float:
        """Edge of a voxel [m]."""

    @property
    def shape(self) -> tuple[int, int, int]:
        """Voxels along x, y, z."""


class ImportanceMapLike(Protocol):
    """What an importance map has: walk_importance's result, or one that came in as a message."""

    @property
    def grid(self) -> GridLike:
        """The voxels."""

    @property
    def obstacle(self) -> NDArray[np.float32]:
        """(nx, ny, nz): 1 where the voxel meets geometry, else 0."""

    @property
    def distance(self) -> NDArray[np.float32]:
        """(nx, ny, nz): to the closest obstacle, 0 to 1."""

    @property
    def visibility(self) -> NDArray[np.float32]:
        """(nx, ny, nz): share of the free voxels seen, 0 to 1."""

    @property
    def importance(self) -> NDArray[np.float32]:
        """(nx, ny, nz): the weighted sum."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ReceivedGrid:
    """The voxel grid of a map that came in as a message, exact to float32."""

    origin: NDArray[np.float64]  # (3,) lowest corner of the lowest voxel [m]
    voxel_size_m: float
    shape: tuple[int, int, int]


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class ReceivedImportanceMap:
    """An importance map that came in as a message; arrays (nx, ny, nz) float32, read-only."""

    stamp_ns: int
    grid: ReceivedGrid
    obstacle: NDArray[np.float32]
    distance: NDArray[np.float32]
    visibility: NDArray[np.float32]
    importance: NDArray[np.float32]


def importance_map_to_msg(importance_map: ImportanceMapLike | None, stamp_ns: int) -> PointCloud2:
    """Returns the map as a cloud of `FIELDS`; None gives an empty one that still names its fields and revision."""
    values = np.empty((0, len(FIELDS)), np.float32) if importance_map is None else _table(importance_map)
    data = array.array("B")
    # From bytes: assigning the numpy array would convert element by element, half a second for 10 MB.
    data.frombytes(values.data.cast("B") if values.size else b"")
    return _cloud(len(values), data, stamp_ns)


def importance_map_to_bytes(importance_map: ImportanceMapLike, stamp_ns: int) -> bytes:
    """Returns the serialised message that `importance_map_to_msg` of the same arguments is, copied once, not thrice."""
    values = _table(importance_map)
    # The data are the last field but one: behind them is a single byte, `is_dense`, before them their number.
    empty = bytes(serialize_message(_cloud(len(values), array.array("B"), stamp_ns)))
    return b"".join([empty[:-5], struct.pack("<I", values.nbytes), values.data.cast("B"), empty[-1:]])


def _cloud(points: int, data: array.array[int], stamp_ns: int) -> PointCloud2:
    size = 4 * len(FIELDS)
    return PointCloud2(
        header=header_to_msg(stamp_ns),
        height=1,
        width=points,
        fields=[PointField(name=n, offset=4 * i, datatype=PointField.FLOAT32, count=1) for i, n in enumerate(FIELDS)],
        is_bigendian=False,
        point_step=size,
        row_step=size * points,
        data=data,
        is_dense=True,
    )


def _table(importance_map: ImportanceMapLike) -> NDArray[np.float32]:
    """Returns (N, 7) float32 rows of the fields, x fastest."""
    grid = importance_map.grid
    nx, ny, nz = grid.shape
    table = np.empty((nz, ny, nx, len(FIELDS)), np.float32)
    centres = [grid.origin[a] + (np.arange(n) + 0.5) * grid.voxel_size_m for a, n in enumerate(grid.shape)]
    table[..., 0] = centres[0][None, None, :]
    table[..., 1] = centres[1][None, :, None]
    table[..., 2] = centres[2][:, None, None]
    maps = [getattr(importance_map, name) for name in MAPS]
    # A plane at a time: both its orders of voxels fit the processor's cache.
    for j in range(ny):
        for i, values in enumerate(maps):
            table[:, j, :, 3 + i] = values[:, j, :].T
    return table.reshape(-1, len(FIELDS))


def importance_map_from_msg(msg: PointCloud2) -> ReceivedImportanceMap | None:
    """Returns the map of a cloud, None for an empty one; raises MessageError if it is not a whole, sound grid."""
    stamp_ns = header_from_msg(msg.header, KIND)
    table = _rows(msg)
    if not len(table):
        return None
    require(bool(np.isfinite(table).all()), KIND, "a value is not finite; expected numbers")
    grid = _grid(table)
    cube = table.reshape(grid.shape[2], grid.shape[1], grid.shape[0], len(FIELDS))
    maps = {name: cube[..., 3 + i].transpose(2, 1, 0) for i, name in enumerate(MAPS)}
    return ReceivedImportanceMap(stamp_ns=stamp_ns, grid=grid, **maps)


def _rows(msg: PointCloud2) -> NDArray[np.float32]:
    """Returns the (N, 7) rows of the message without copying; read-only."""
    named = [(f.name, f.offset, f.datatype, f.count) for f in msg.fields]
    wanted = [(n, 4 * i, PointField.FLOAT32, 1) for i, n in enumerate(FIELDS)]
    require(named == wanted, KIND, f"fields are {[f[0] for f in named]}; expected float32 {', '.join(FIELDS)}")
    count = msg.width * msg.height
    size = 4 * len(FIELDS)
    right = msg.point_step == size and msg.row_step == size * msg.width and len(msg.data) == size * count
    require(right, KIND, f"{len(msg.data)} bytes for {count} points of {size} bytes; sizes do not agree")
    require(not msg.is_bigendian, KIND, "data is big-endian; expected little-endian")
    table: NDArray[np.float32] = np.frombuffer(memoryview(msg.data), dtype="<f4").reshape(count, len(FIELDS))
    table.flags.writeable = False
    return table


def _grid(table: NDArray[np.float32]) -> ReceivedGrid:
    """Returns the grid whose centres the rows are; raises MessageError if they are not one in the right order."""
    axes = [np.unique(table[:, a]).astype(np.float64) for a in range(3)]
    nx, ny, nz = (len(a) for a in axes)
    require(nx * ny * nz == len(table), KIND, f"{len(table)} points are not a grid of {nx} x {ny} x {nz}")
    longest = max(axes, key=len)
    require(len(longest) > 1, KIND, "one voxel alone does not tell its size; expected at least two")
    size = float((longest[-1] - longest[0]) / (len(longest) - 1))
    # What float32 leaves of a coordinate a kilometre from the origin, with room.
    tolerance = 1e-3 * size + 1e-6 * max(float(np.abs(a).max()) for a in axes)
    origin = np.array([a[0] - size / 2 for a in axes])
    for a, n in enumerate((nx, ny, nz)):
        shape = [1, 1, 1]
        shape[2 - a] = n
        expected = (origin[a] + (np.arange(n) + 0.5) * size).reshape(shape)
        off = np.abs(table[:, a].reshape(nz, ny, nx) - expected).max()
        require(bool(off <= tolerance), KIND, f"{FIELDS[a]} is not a grid of {size:g} m, x fastest")
    origin.flags.writeable = False
    return ReceivedGrid(origin=origin, voxel_size_m=size, shape=(nx, ny, nz))
