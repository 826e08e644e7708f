# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk plan`: the whole method once; its options are the fields of the stages' configs."""

from __future__ import annotations

import signal
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    TaskID,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from walk_bag.camera_path import camera_keypoints
from walk_bag.keypoint_files import ImportedKeypoints, read_keypoints
from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.bootstrap.errors import SetupError
from walk_bringup.cli.spoken import spoken
from walk_bringup.cli.units import UNITS_M, UnitOfLength
from walk_building.progress import no_progress
from walk_plan.options import PlanOption, plan_config, plan_options
from walk_plan.pipeline import plan_walkthrough
from walk_plan.stages import STAGES
from walk_plan.walkthrough import Walkthrough
from walk_plan.wording import duration


class SectionedCommand(click.Command):
    """A command whose help groups the options by the stage they belong to."""

    def format_options(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Writes one list of options per stage."""
        sections: dict[str, list[tuple[str, str]]] = {}
        for parameter in self.get_params(ctx):
            record = parameter.get_help_record(ctx)
            if record is not None:
                section = getattr(parameter, "section", "Options")
                sections.setdefault(section, []).append(record)
        for name, records in sections.items():
            with formatter.section(name):
                formatter.write_dl(records)


class PlanClickOption(click.Option):
    """An option of the command line for one field of a config."""

    def __init__(self, option: PlanOption) -> None:
        names = [f"--{option.name}"]
        kind: Any = type(option.field.default)
        if kind is bool:
            names = [f"--{option.name}/--no-{option.name}"]
        elif option.field.name == "units_m":
            kind = UnitOfLength()
        elif option.field.metadata["choices"]:
            kind = click.Choice(option.field.metadata["choices"])
        self.section = f"Options of the stage '{option.section}'"
        self.field_name = option.name
        words = f"; or {', '.join(UNITS_M)}" if isinstance(kind, UnitOfLength) else ""
        help_text = f"{option.help}{words} (default: {_shown(option.field.default)})"
        super().__init__([*names, _variable(option)], type=kind, default=None, help=help_text)


def _shown(default: Any) -> str:
    if isinstance(default, bool):
        return "yes" if default else "no"
    return f"{default:g}" if isinstance(default, float) else str(default) or "none"


def _variable(option: PlanOption) -> str:
    return option.name.replace("-", "_")


def _with_plan_options(command: click.Command) -> click.Command:
    command.params.extend(PlanClickOption(option) for option in plan_options())
    return command


@_with_plan_options
@click.command(cls=SectionedCommand, short_help=COMMANDS["plan"])
@click.argument("building", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(path_type=Path), required=True, help="Folder for the results.")
@click.option(
    "--keypoints-file",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Visit the keypoints of FILE: CSV, JSON, or a bag, whose last ones count.",
)
@click.option(
    "--camera-path",
    type=click.Path(path_type=Path),
    metavar="BAG",
    help="Walk where somebody looked around while BAG was recorded, in that order.",
)
@click.option("--compare", is_flag=True, help="Write compare.html and compare.json too: the walk without its parts.")
@click.option("--quiet", is_flag=True, help="Show no progress.")
def plan(
    building: Path,
    out: Path,
    keypoints_file: Path | None,
    camera_path: Path | None,
    compare: bool,
    quiet: bool,
    **values: Any,
) -> int:
    """Turn BUILDING into a collision-free, timed, recorded walkthrough.

    Writes tour.mcap, report.json, report.html, trajectory.csv and walkthrough.glb.

    \b
    Examples:
      ./walk plan building.ifc --out out/building
      ./walk plan house.obj --units mm --up y --out out/house
      ./walk plan building.ifc --out out/slow --speed 0.8 --keypoints 12
      ./walk plan building.ifc --out out/mine --keypoints-file keypoints.csv --order given
    """
    names = {_variable(option): option.name for option in plan_options()}
    given = {names[variable]: value for variable, value in values.items() if value is not None}
    if camera_path is not None:
        given.setdefault("order", "given")
    # Told to end, it leaves as at Ctrl-C: nothing half-written stays behind.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    started = time.monotonic()
    # Some values are found wrong only once the building and its keypoints are known.
    with spoken(_options_by_field()):
        config = plan_config(given)
        brought = brought_keypoints(keypoints_file, camera_path, given.get("keypoints"))
        with _shown_progress(quiet) as progress:
            walkthrough = plan_walkthrough(building, out, config, progress, comparison=compare, given=brought)
    for line in summary_lines(walkthrough, out, time.monotonic() - started, compare):
        print(line)
    return 0


def _options_by_field() -> dict[str, str]:
    """Returns what is typed for each field; two configs may share a field's name."""
    found: dict[str, list[str]] = {}
    for option in plan_options():
        found.setdefault(option.field.name, []).append(f"--{option.name}")
    return {field: " or ".join(names) for field, names in found.items()}


def brought_keypoints(file: Path | None, camera_path: Path | None, count: int | None) -> ImportedKeypoints | None:
    """Returns the keypoints that the user brings; None where they are to be suggested.

    Raises:
        SetupError: The user asks for more than one source of keypoints.
        WalkError: What is named cannot be read.
    """
    named = {"--keypoints-file": file, "--camera-path": camera_path, "--keypoints": count}
    used = [name for name, value in named.items() if value is not None]
    if len(used) > 1:
        raise SetupError(f"{' and '.join(used)} exclude each other: each says which keypoints there are")
    if file is not None:
        return read_keypoints(file)
    return camera_keypoints(camera_path) if camera_path is not None else None


def summary_lines(walkthrough: Walkthrough, out: Path, seconds: float, compared: bool) -> Iterator[str]:
    """Yields what the user reads at the end of a plan."""
    quality = walkthrough.quality
    entered = sum(visit.entered for visit in walkthrough.visits)
    reachable = sum(room.reachable for room in walkthrough.building.rooms)
    beyond = len(walkthrough.building.rooms) - reachable
    past = f"past {len(walkthrough.keypoints)} keypoints"
    yield f"walk       {quality.length_m:.1f} m in {duration(quality.duration_s)} {past}"
    others = f"; {beyond} cannot be reached, the report says why" if beyond else ""
    yield f"rooms      {entered} of {reachable + beyond} entered{others}"
    yield f"collisions {quality.colliding_segments} of {quality.segments} segments"
    for warning in walkthrough.warnings:
        yield f"note       {warning}"
    yield f"results    {out} (planned in {seconds:.1f} s); open {out / 'report.html'}"
    if compared:
        yield f"comparison {out / 'compare.html'}: the walk without each part of the method"


@contextmanager
def _shown_progress(quiet: bool) -> Iterator[Callable[[str, float], None]]:
    if quiet:
        yield no_progress
    elif not sys.stderr.isatty():
        yield _print_ends
    else:
        columns = (
            TextColumn("{task.description:<12}"),
            BarColumn(),
            TaskProgressColumn(),
            TimeElapsedColumn(),
            TextColumn("left"),
            TimeRemainingColumn(),
        )
        with Progress(*columns, console=Console(stderr=True)) as bars:
            yield _StageBars(bars)


class _StageBars:
    """A bar for each stage, added when the stage begins."""

    def __init__(self, bars: Progress) -> None:
        self._bars = bars
        self._tasks: dict[str, TaskID] = {}

    def __call__(self, stage: str, fraction: float) -> None:
        if stage not in self._tasks:
            number = STAGES.index(stage) + 1 if stage in STAGES else len(self._tasks) + 1
            self._tasks[stage] = self._bars.add_task(f"{number}/{max(number, len(STAGES))} {stage}", total=1.0)
        self._bars.update(self._tasks[stage], completed=fraction)


def _print_ends(stage: str, fraction: float) -> None:
    if fraction >= 1.0:
        print(f"{stage} done", file=sys.stderr, flush=True)
