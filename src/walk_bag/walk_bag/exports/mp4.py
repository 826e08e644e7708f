# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The ride as a video."""

from __future__ import annotations

from pathlib import Path

import imageio_ffmpeg

from walk_bag.errors import ExportError
from walk_bag.exports.renderer import Renderer
from walk_bag.exports.resample import sample_at
from walk_bag.exports.ride import ExportConfig, Ride
from walk_bag.exports.times import frame_times
from walk_building.progress import Progress, no_progress

# Coding takes a tenth of the time of drawing this way, and its pictures have few colours and sharp edges anyway.
_CODING = ["-preset", "veryfast", "-crf", "20", "-movflags", "+faststart"]


def write_mp4(path: Path, ride: Ride, config: ExportConfig | None = None, progress: Progress = no_progress) -> None:
    """Writes what the eye sees as H.264 in MP4, in real time; needs neither a display nor a graphics card.

    Raises:
        ExportError: The building is not known, the size is odd, or the file cannot be written.
    """
    config = config or ExportConfig()
    if ride.model is None:
        raise ExportError(path, "a video needs the building: name its file with --building")
    if config.width % 2 or config.height % 2:
        raise ExportError(
            path, f"a video of {config.width} x {config.height} pixels cannot be coded; take even numbers"
        )
    samples = sample_at(ride, frame_times(ride, config.fps))
    part = path.with_name(f".{path.stem}.part{path.suffix}")
    size = (config.width, config.height)
    try:
        writer = imageio_ffmpeg.write_frames(
            str(part), size, fps=config.fps, codec="libx264", pix_fmt_out="yuv420p", quality=None, macro_block_size=2,
            output_params=_CODING, ffmpeg_log_level="error",
        )  # fmt: skip
        writer.send(None)
        try:
            with Renderer(ride.model, config) as renderer:
                for frame, picture in enumerate(renderer.pictures(samples.positions, samples.quat_xyzw), start=1):
                    writer.send(picture)
                    progress("render", frame / len(samples.t_s))
        finally:
            writer.close()
        part.replace(path)
    except OSError as error:
        raise ExportError(path, f"cannot be written: {error.strerror or error}") from error
    finally:
        part.unlink(missing_ok=True)
