# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The whole plan: its options, its folder of results, and what happens when something is wrong."""

from __future__ import annotations

import dataclasses
import itertools
import json
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scenes import box, building_of, shell, two_rooms

from walk_building.errors import BuildingError, ParameterError, WalkError
from walk_plan.baselines import look_targets
from walk_plan.errors import NoWalkError, OutputError
from walk_plan.options import PlanConfig, plan_config, plan_options
from walk_plan.output_folder import OutputFolder
from walk_plan.outputs import MARKER, WRITERS
from walk_plan.pipeline import plan_walkthrough
from walk_plan.rooms_and_doors import DWELL_S, LEG_S, rooms_and_doors, short_order
from walk_plan.stages import STAGES
from walk_plan.walkthrough import Walkthrough

FILES = {*WRITERS, "report.html", MARKER}


def test_every_field_of_every_config_is_one_option_with_a_name_of_its_own() -> None:
    options = plan_options()
    names = [option.name for option in options]
    assert len(set(names)) == len(names)
    fields = [
        (section.name, field.name)
        for section in dataclasses.fields(PlanConfig)
        for field in dataclasses.fields(getattr(PlanConfig(), section.name))
    ]
    assert [(option.section, option.field.name) for option in options] == fields
    assert {"voxel-size", "speed", "radius", "units", "keypoints", "order"} <= set(names)
    assert all(option.help for option in options)


@pytest.mark.parametrize("option", plan_options(), ids=lambda option: option.name)
def test_an_option_sets_its_field_and_no_other(option) -> None:  # type: ignore[no-untyped-def]
    default = option.field.default
    meta = option.field.metadata
    if isinstance(default, bool):
        value = not default
    elif isinstance(default, str):
        value = next(choice for choice in (*meta["choices"], "other") if choice != default)
    else:
        ends = [end for end in (meta["low"], meta["high"]) if end is not None and end != default]
        value = type(default)(ends[0]) if ends else default + 1
    try:
        changed = plan_config({option.name: value})
    except ParameterError:
        pytest.skip("this end of the range needs another field to change too")
    expected = dataclasses.asdict(PlanConfig())
    expected[option.section][option.field.name] = value
    assert dataclasses.asdict(changed) == expected


def test_a_value_out_of_range_is_refused_by_name() -> None:
    with pytest.raises(ParameterError, match="voxel_size_m"):
        plan_config({"voxel-size": 50.0})
    with pytest.raises(KeyError):
        plan_config({"no-such-option": 1})


def test_plan_writes_all_files_and_tells_the_stages_in_order(rooms_file: Path, tmp_path: Path) -> None:
    told: list[tuple[str, float]] = []
    out = tmp_path / "new" / "out"
    walkthrough = plan_walkthrough(rooms_file, out, progress=lambda stage, done: told.append((stage, done)))
    assert {made.name for made in out.iterdir()} == FILES
    assert [made for made in out.parent.iterdir() if made != out] == []
    assert [stage for stage, _ in itertools.groupby(told, key=lambda told: told[0])] == list(STAGES)
    for stage in STAGES:
        done = [fraction for name, fraction in told if name == stage]
        assert done[0] == 0.0 and done[-1] == 1.0 and done == sorted(done)
    report = json.loads((out / MARKER).read_text())
    assert set(report["stages_s"]) == set(STAGES)
    assert walkthrough.quality.colliding_segments == 0
    assert len(walkthrough.quality.rooms) == 2


def test_the_same_building_gives_the_same_plan(walkthrough: Walkthrough, rooms_file: Path, tmp_path: Path) -> None:
    again = plan_walkthrough(rooms_file, tmp_path / "out")
    assert np.array_equal(again.trajectory.positions, walkthrough.trajectory.positions)
    assert again.qualities == walkthrough.qualities


def test_ours_collides_nowhere_and_visits_what_the_others_are_asked_to(walkthrough: Walkthrough) -> None:
    by_name = {quality.name: quality for quality in walkthrough.qualities}
    assert by_name["ours"].colliding_segments == 0
    assert by_name["mst_dfs"].length_m >= by_name["ours"].length_m - 0.5
    assert set(by_name["mst_dfs"].rooms) == set(by_name["ours"].rooms)
    assert [visit.entered for visit in walkthrough.visits] == [True, True]


def test_a_building_that_cannot_be_read_leaves_no_folder(tmp_path: Path) -> None:
    with pytest.raises(BuildingError):
        plan_walkthrough(tmp_path / "missing.ifc", tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


def test_a_cupboard_to_stand_in_is_no_walk(tmp_path: Path) -> None:
    path = tmp_path / "cupboard.ply"
    trimesh.util.concatenate(shell(0.8, 0.8)).export(path)
    with pytest.raises(NoWalkError, match="at least two viewpoints"):
        plan_walkthrough(path, tmp_path / "out", plan_config({"keypoints": 1}))
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("error", [KeyboardInterrupt, MemoryError, ParameterError("a", 1, "2")])
def test_whatever_ends_a_plan_early_leaves_the_earlier_result(
    rooms_file: Path, tmp_path: Path, error: BaseException | type[BaseException]
) -> None:
    out = tmp_path / "out"
    plan_walkthrough(rooms_file, out)
    before = {made.name: made.read_bytes() for made in out.iterdir()}

    def stop(stage: str, done: float) -> None:
        if stage == "write" and done > 0.3:
            raise error

    with pytest.raises(error if isinstance(error, type) else type(error)):
        plan_walkthrough(rooms_file, out, progress=stop)
    assert {made.name: made.read_bytes() for made in out.iterdir()} == before
    assert list(tmp_path.iterdir()) == [out]


def test_a_folder_with_other_things_in_it_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("years of work")
    with pytest.raises(OutputError, match="no earlier plan"), OutputFolder(tmp_path, MARKER):
        raise AssertionError("must not get here")
    assert [made.name for made in tmp_path.iterdir()] == ["thesis.txt"]


def test_a_file_in_place_of_the_folder_is_refused_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("")
    with pytest.raises(OutputError, match="is a file") as caught, OutputFolder(tmp_path / "out", MARKER):
        pass
    assert isinstance(caught.value, WalkError) and "\n" not in str(caught.value)


def test_a_folder_that_cannot_be_made_is_refused_in_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError, match="cannot be written"), OutputFolder(tmp_path / "file" / "out", MARKER):
        pass


def test_an_earlier_result_is_replaced(tmp_path: Path) -> None:
    for text in ("first", "second"):
        with OutputFolder(tmp_path / "out", MARKER) as folder:
            (folder / MARKER).write_text(text)
            (folder / "bag").mkdir()
            (folder / "bag" / "x").write_text(text)
    assert (tmp_path / "out" / MARKER).read_text() == (tmp_path / "out" / "bag" / "x").read_text() == "second"


def test_look_targets_lie_ahead_of_the_best_view(walkthrough: Walkthrough) -> None:
    turned = dataclasses.replace(
        walkthrough.suggestion,
        quat_xyzw=np.tile([0.0, 0.0, np.sin(np.pi / 4), np.cos(np.pi / 4)], (len(walkthrough.suggestion.positions), 1)),
    )
    order = walkthrough.tour.order
    ahead = look_targets(turned, walkthrough.tour.stands, order) - walkthrough.tour.stands[order]
    assert ahead == pytest.approx(np.tile([0.0, 3.0, 0.0], (len(order), 1)), abs=1e-12)


def test_rooms_and_doors_keeps_its_own_clock_and_knows_no_walls() -> None:
    trajectory = rooms_and_doors(building_of(two_rooms()))
    assert trajectory is not None
    assert trajectory.t_s[-1] == pytest.approx(LEG_S)
    three = building_of([*two_rooms(), box((4.0, -0.2, 0), (4.1, 0, 3))])
    assert DWELL_S > 0 and rooms_and_doors(three) is not None
    assert rooms_and_doors(building_of(shell(4, 4))) is None


def test_short_order_of_few_stops_is_the_best_from_the_first() -> None:
    points = np.random.default_rng(3).uniform(0, 10, (6, 2))
    distance = np.linalg.norm(points[:, None] - points[None], axis=2)

    def length(order: tuple[int, ...]) -> float:
        return float(sum(distance[a, b] for a, b in itertools.pairwise(order)))

    found = tuple(short_order(distance).tolist())
    best = min(((0, *rest) for rest in itertools.permutations(range(1, 6))), key=length)
    assert sorted(found) == list(range(6)) and found[0] == 0
    assert length(found) <= 1.1 * length(best)
