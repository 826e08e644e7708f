# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""`./walk export`: a recorded walk in the formats of other programs."""

from __future__ import annotations

import dataclasses
import json
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click
import numpy as np
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from walk_bag.bag_reader import cut_off_note
from walk_bag.exports import EXPORTERS, export_ride
from walk_bag.exports.ride import ExportConfig, Ride
from walk_bag.imports import SOURCES, RecordedBuilding, load_ride, recorded_building
from walk_bringup.bootstrap.commands import COMMANDS
from walk_bringup.cli.spoken import spoken
from walk_bringup.cli.units import UnitOfLength
from walk_building.loaders import load_model
from walk_building.model import LoadOptions, Model
from walk_building.pipeline import building_hash
from walk_building.progress import no_progress

_FORMATS = "\n".join(f"  {name:<15} {exporter.doc} ({exporter.suffix})" for name, exporter in EXPORTERS.items())


def _with_config(command: click.Command) -> click.Command:
    for field in dataclasses.fields(ExportConfig):
        meta = field.metadata
        limits = ", ".join(filter(None, (meta["unit"], f"{meta['low']:g} to {meta['high']:g}")))
        text = f"{meta['doc']} [{limits}] (default: {field.default:g})"
        command.params.append(click.Option([f"--{_option(field)}", field.name], type=type(field.default), help=text))
    return command


def _option(field: dataclasses.Field[Any]) -> str:
    return field.name.removesuffix("_rad").replace("_", "-")


@_with_config
@click.command(
    short_help=COMMANDS.get("export"),
    epilog=f"\b\nFormats:\n{_FORMATS}\n\n\b\nExamples:\n"
    "  ./walk export out/building/tour.mcap --to glb --building building.ifc\n"
    "  ./walk export out/building/tour.mcap --to mp4 --building building.ifc --out ride.mp4\n"
    "  ./walk export session_bag --to blender --from viewpoint --fps 30",
)
@click.argument("bag", type=click.Path(path_type=Path))
@click.option("--to", "name", type=click.Choice(list(EXPORTERS)), required=True, help="The format, see below.")
@click.option("--out", type=click.Path(path_type=Path), help="The file; default: beside the bag, named as it is.")
@click.option("--building", type=click.Path(path_type=Path), help="The building's file; default: what the bag names.")
@click.option("--units", type=UnitOfLength(), default=0.0, help="Unit of the building's file: cm, ft, … or metres.")
@click.option("--up", type=click.Choice(["auto", "y", "z"]), default="auto", help="The axis that points up in it.")
@click.option("--from", "source", type=click.Choice(SOURCES), default=SOURCES[0], show_default=True,
              help="What was planned last, or what was looked at while it was recorded.")  # fmt: skip
@click.option("--quiet", is_flag=True, help="Show no progress.")
def export(
    bag: Path, name: str, out: Path | None, building: Path | None, units: float, up: str, source: str, quiet: bool,
    **values: Any,
) -> int:  # fmt: skip
    """Write the walk recorded in BAG (such as tour.mcap of `./walk plan`) in another program's format."""
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    with spoken({field.name: f"--{_option(field)}" for field in dataclasses.fields(ExportConfig)}):
        config = ExportConfig(**{key: value for key, value in values.items() if value is not None})
    with spoken({"units_m": "--units"}):
        options = LoadOptions(units_m=units, up=up)
    ride = load_ride(bag, source)
    ride, notes = _placed(ride, bag, building, options, EXPORTERS[name].shows_building)
    notes += filter(None, [cut_off_note(bag)])
    path = out or bag.with_name(f"{bag.name.removesuffix('.mcap')}-{name}{EXPORTERS[name].suffix}")
    with _shown_progress(quiet) as progress:
        export_ride(ride, name, path, config, progress)
    for note in notes:
        print(f"note       {note}")
    print(f"{name:<10} {path} ({path.stat().st_size / 1e6:.1f} MB, {ride.t_s[-1]:.0f} s of walk)")
    return 0


def _placed(
    ride: Ride, bag: Path, building: Path | None, options: LoadOptions, shows_building: bool
) -> tuple[Ride, list[str]]:
    """Returns the ride with its building, or at least with where that lies, and what the user has to know of it."""
    named = recorded_building(bag)
    report = _report_beside(bag)
    content = named.content_hash or report.get("content_hash", "")
    ride = dataclasses.replace(ride, building_hash=named.hash or report.get("hash", ""))
    file = building or (Path(named.path) if named.path and Path(named.path).is_file() else None)
    if file is not None:
        # Options on the command line go before those of the plan.
        load = named.load if named.load is not None and options == LoadOptions() else options
        model = load_model(file, load)
        placed = dataclasses.replace(ride, model=model, offset_m=model.offset_m, building_name=file.name)
        changed = _differs(model, load, named, content)
        return placed, [f"{file} is not what the walk was planned in, or was loaded otherwise"] if changed else []
    offset = named.offset_m if named.offset_m is not None else report.get("offset_m")
    name = named.path or report.get("file", "")
    if offset is not None:
        placed = dataclasses.replace(ride, offset_m=offset, building_name=Path(name).name)
        gone = f"{name} is not there any more" if named.path else f"the bag does not hold {name}"
        return placed, [f"{gone}; --building FILE shows it"] if shows_building else []
    return ride, [
        f"the building is not known ({name or 'the bag names none'}): positions are those of the planner, near the "
        "origin; --building FILE gives the building's own"
    ]


def _differs(model: Model, load: LoadOptions, named: RecordedBuilding, content_hash: str) -> bool:
    """Returns whether a model is another than the bag's, as far as that says which it was."""
    if content_hash:
        return content_hash != model.content_hash
    return named.walker is not None and building_hash(model, load, named.walker) != named.hash


def _report_beside(bag: Path) -> dict[str, Any]:
    """Returns what the report of a plan beside the bag says of the building; empty where there is none."""
    try:
        report = json.loads((bag.parent / "report.json").read_text(encoding="utf-8"))
        facts = dict(report["building"])
        offset = np.array(facts["offset_m"], float)
    except (OSError, ValueError, KeyError, TypeError):
        return {}
    return {**facts, "offset_m": offset} if offset.shape == (3,) and np.isfinite(offset).all() else {}


@contextmanager
def _shown_progress(quiet: bool) -> Iterator[Callable[[str, float], None]]:
    if quiet or not sys.stderr.isatty():
        yield no_progress
        return
    columns = (TextColumn("{task.description:<8}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with Progress(*columns, TextColumn("left"), TimeRemainingColumn(), console=Console(stderr=True)) as bars:
        tasks: dict[str, Any] = {}

        def show(stage: str, fraction: float) -> None:
            if stage not in tasks:
                tasks[stage] = bars.add_task(stage, total=1.0)
            bars.update(tasks[stage], completed=fraction)

        yield show
