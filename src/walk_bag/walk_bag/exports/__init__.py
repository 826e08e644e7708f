# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded walk in the formats of other programs: one file a format, one line in `EXPORTERS`."""

from __future__ import annotations

import dataclasses
import importlib
from collections.abc import Callable
from pathlib import Path

from walk_bag.errors import ExportError
from walk_bag.exports.ride import ExportConfig, Ride
from walk_building.progress import Progress, no_progress

Write = Callable[[Path, Ride, ExportConfig, Progress], None]


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Exporter:
    """A format."""

    suffix: str  # of the file's name
    doc: str
    shows_building: bool = False  # the file holds the building where it is known
    needs_building: bool = False
    home: str  # module.function; imported when it is used, since some load large libraries

    @property
    def write(self) -> Write:
        """The function that writes a ride: path, ride, config, progress."""
        module, _, name = self.home.rpartition(".")
        write: Write = getattr(importlib.import_module(f"walk_bag.exports.{module}"), name)
        return write


EXPORTERS: dict[str, Exporter] = {
    "glb": Exporter(suffix=".glb", doc="glTF: building, path and an animated camera", home="glb.write_glb",
                    shows_building=True),
    "usd": Exporter(suffix=".usdc", doc="USD stage: building, path and a camera", home="usd.write_usd",
                    shows_building=True),
    "mp4": Exporter(suffix=".mp4", doc="video of the ride", home="mp4.write_mp4", shows_building=True,
                    needs_building=True),
    "enscape": Exporter(suffix=".xml", doc="camera path in XML in the style of Enscape", home="enscape.write_enscape"),
    "blender": Exporter(suffix=".json", doc="camera, frame by frame, for Blender", home="blender.write_blender"),
    "csv": Exporter(suffix=".csv", doc="table of times and poses", home="trajectory_csv.write_trajectory_csv"),
    "ros": Exporter(suffix=".yaml", doc="MultiDOFJointTrajectory in YAML", home="ros_yaml.write_ros_yaml"),
    "keypoints-csv": Exporter(suffix=".csv", doc="table of keypoints", home="keypoints.write_keypoints_csv"),
    "keypoints-json": Exporter(suffix=".json", doc="keypoints as JSON", home="keypoints.write_keypoints_json"),
}  # fmt: skip
"""The formats by name."""


def export_ride(
    ride: Ride, name: str, path: Path, config: ExportConfig | None = None, progress: Progress = no_progress
) -> None:
    """Writes a ride in a format of `EXPORTERS`.

    Raises:
        ExportError: There is no such format, it needs the building, or the file cannot be written.
    """
    if name not in EXPORTERS:
        raise ExportError(path, f"there is no format {name!r}; there are {', '.join(EXPORTERS)}")
    exporter = EXPORTERS[name]
    if exporter.needs_building and ride.model is None:
        raise ExportError(path, "this format shows the building, which is not known: name its file with --building")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        exporter.write(path, ride, config or ExportConfig(), progress)
    except OSError as error:
        raise ExportError(path, f"cannot be written: {error.strerror or error}") from error
