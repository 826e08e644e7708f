# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""report.html: one file, pictures inside, that a client can be sent."""

from __future__ import annotations

import base64
import dataclasses
import io
from pathlib import Path
from typing import Any, cast

import jinja2
import matplotlib
import numpy as np
from matplotlib.figure import Figure

from walk_building.building import Room
from walk_building.storeys import storey_of
from walk_plan import wording
from walk_plan.drawing import style
from walk_plan.drawing.floor import shown_places
from walk_plan.drawing.maps import draw_maps
from walk_plan.drawing.profiles import draw_profiles
from walk_plan.drawing.storey_plan import draw_storey
from walk_plan.options import PlanOption, plan_options
from walk_plan.stages import peak_memory_mib
from walk_plan.walkthrough import Walkthrough

_TEMPLATES = Path(__file__).parent / "templates"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A drawing as it stands in the page."""

    title: str
    alt: str
    width_percent: float  # of the text's width
    uri: str  # data: URI, so that the page needs no other file


def write_report(path: Path, walkthrough: Walkthrough, summary: dict[str, Any]) -> None:
    """Writes the report of a walkthrough.

    Args:
        path: The .html file.
        walkthrough: What is reported.
        summary: Its figures as plain data (`summary.summary`).
    """
    path.write_text(
        environment().get_template("report.html.j2").render(context(walkthrough, summary)), encoding="utf-8"
    )


def environment() -> jinja2.Environment:
    """Returns what the pages are rendered with."""
    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES), autoescape=True, undefined=jinja2.StrictUndefined,
        trim_blocks=True, lstrip_blocks=True,
    )  # fmt: skip


def context(walkthrough: Walkthrough, summary: dict[str, Any]) -> dict[str, Any]:
    """Returns what the template shows."""
    building = walkthrough.building
    storeys = shown_storeys(walkthrough)
    reachable = frozenset(index for index, room in enumerate(building.rooms) if room.reachable)
    rows = wording.quality_rows(walkthrough.qualities, reachable)
    return {
        "title": building.model.source.stem.replace("_", " "),
        "headline": wording.headline(walkthrough),
        "tiles": _tiles(walkthrough, len(reachable)),
        "plans": [_plan(walkthrough, storey) for storey in storeys],
        "maps": picture(draw_maps(walkthrough, storeys), "", "Maps of obstacles, distance, openness and importance"),
        "profiles": picture(draw_profiles(walkthrough), "", "Level, height, space, speed and turn over the walk"),
        "walks": [wording.TITLES.get(quality.name, quality.name) for quality in walkthrough.qualities],
        "quality": rows,
        "rooms": _rooms(walkthrough),
        "warnings": walkthrough.warnings,
        "unreachable": [unreachable.reason for unreachable in walkthrough.tour.unreachable],
        "colliding": [str(stretch) for stretch in walkthrough.path.colliding],
        "notes": walkthrough.importance_map.notes,
        "parameters": _parameters(walkthrough),
        "summary": summary,
        "peak_memory_mib": peak_memory_mib(),
    }


def picture(figure: Figure, title: str, alt: str) -> Picture:
    """Returns a figure as scalable drawing inside a data URI."""
    buffer = io.BytesIO()
    # A fixed salt and no date: the same plan gives the same file.
    with matplotlib.rc_context({"svg.hashsalt": "walk_plan", "svg.fonttype": "path", "image.composite_image": False}):
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    share = min(round(100 * figure.get_figwidth() / style.WIDTH_IN, 1), 100.0)
    data = base64.b64encode(buffer.getvalue()).decode()
    return Picture(title=title, alt=alt, width_percent=share, uri="data:image/svg+xml;base64," + data)


def shown_storeys(walkthrough: Walkthrough) -> list[int]:
    """Returns the storeys with something to show, lowest first: a floor inside the building, or a piece of the walk."""
    building = walkthrough.building
    inside = building.surface.storey[shown_places(building)]
    narrow = storey_of(building.storeys, building.narrow_floor[:, 2])
    found = {*np.unique(inside).tolist(), *np.unique(narrow).tolist(), *map(int, walkthrough.profile.storey)}
    return sorted(storey for storey in found if storey >= 0)


def _plan(walkthrough: Walkthrough, storey: int) -> Picture:
    here = walkthrough.building.storeys[storey]
    level = here.elevation_m + walkthrough.building.model.offset_m[2]
    # Adding zero turns a level of -0.00 into +0.00.
    title = f"{here.name} (floor at {round(level, 2) + 0.0:+.2f} m)"
    return picture(draw_storey(walkthrough, storey), title, f"Plan of {here.name} with the walk")


def _tiles(walkthrough: Walkthrough, reachable: int) -> list[tuple[str, str]]:
    quality = walkthrough.quality
    entered = sum(walkthrough.building.rooms[room].reachable for room in quality.rooms)
    return [
        (f"{quality.length_m:.0f} m", "walked"),
        (wording.duration(quality.duration_s), "duration"),
        (f"{entered} of {reachable}", "reachable rooms visited"),
        (str(len(walkthrough.keypoints)), "viewpoints"),
        (str(quality.colliding_segments), "collisions"),
        (wording.centimetres(quality.min_clearance_m), "tightest spot"),
        (wording.percent(quality.seen_share), "of the space seen"),
    ]


def _rooms(walkthrough: Walkthrough) -> list[dict[str, Any]]:
    """Returns for each storey the rooms that are visited, and those that are not by reason."""
    building = walkthrough.building
    table = []
    for storey, level in enumerate(building.storeys):
        visits = [visit for visit in walkthrough.visits if building.rooms[visit.room].storey == storey]
        missed: dict[str, list[Room]] = {}
        for visit in visits:
            if not visit.entered:
                missed.setdefault(visit.reason, []).append(building.rooms[visit.room])
        visited = [(building.rooms[visit.room], visit.keypoints) for visit in visits if visit.entered]
        if visits:
            reasons = [(reason[:1].upper() + reason[1:].rstrip("."), rooms) for reason, rooms in missed.items()]
            table.append({"name": level.name, "visited": visited, "missed": reasons})
    return table


def _parameters(walkthrough: Walkthrough) -> list[dict[str, Any]]:
    headings = {
        "walker": "Walker", "load": "Reading the file", "importance": "Importance map", "keypoints": "Viewpoints",
        "tour": "Tour", "trajectory": "Path", "timing": "Clock and look",
    }  # fmt: skip
    groups: dict[str, list[tuple[PlanOption, str]]] = {}
    for option in plan_options():
        value = getattr(getattr(walkthrough.config, option.section), option.field.name)
        text = wording.setting(value, cast(Any, option.field.default), option.field.metadata["unit"])
        groups.setdefault(option.section, []).append((option, text))
    return [{"name": headings[section], "options": options} for section, options in groups.items()]
