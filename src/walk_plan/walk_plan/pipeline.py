# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The whole method in one process: from a building file to a folder of results."""

from __future__ import annotations

import dataclasses
from pathlib import Path

from walk_bag.keypoint_files import ImportedKeypoints
from walk_building.building import Building
from walk_building.pipeline import load_building
from walk_building.progress import Progress, no_progress
from walk_building.sweep import BodySweep
from walk_importance.importance_map import ImportanceMap
from walk_importance.keypoints import Suggestion, suggest_keypoints
from walk_importance.pipeline import compute_importance
from walk_plan.baselines import baselines, look_targets
from walk_plan.clearance import SideClearance
from walk_plan.compare.comparison import compare
from walk_plan.errors import NoWalkError, TooFewKeypointsError
from walk_plan.given import given_suggestion, left_out
from walk_plan.options import PlanConfig
from walk_plan.output_folder import OutputFolder
from walk_plan.outputs import COMPARISON_WRITERS, MARKER, write_comparison, write_outputs
from walk_plan.profile import profile
from walk_plan.quality import Measure, PathQuality
from walk_plan.rooms import room_visits
from walk_plan.seen import sample_free_space
from walk_plan.stages import StageClock
from walk_plan.walkthrough import Walkthrough
from walk_sequencer.pipeline import plan_tour
from walk_sequencer.tour import Tour
from walk_trajopt.path import OptimisedPath
from walk_trajopt.pipeline import optimise_path
from walk_trajopt.timing import time_path
from walk_trajopt.trajectory import Trajectory


def plan_walkthrough(
    building_path: Path | str,
    out_dir: Path | str,
    options: PlanConfig | None = None,
    progress: Progress = no_progress,
    *,
    comparison: bool = False,
    given: ImportedKeypoints | None = None,
) -> Walkthrough:
    """Plans a walk through a building and writes all results to a folder.

    Args:
        building_path: The building file.
        out_dir: Where the results go: all of them, or none if anything goes wrong.
        options: Everything a user can tune.
        progress: Told of the stages in `stages.STAGES`.
        comparison: Whether to compare the walk with others too, and what it is without each objective.
        given: The user's keypoints in place of those that the importance map suggests.

    Raises:
        WalkError: The building cannot be used, nothing in it can be walked, or the folder cannot be written.
    """
    with OutputFolder(out_dir, MARKER, tuple(COMPARISON_WRITERS)) as folder:
        clock = StageClock(progress)
        walkthrough = make_walkthrough(building_path, options or PlanConfig(), clock, given)
        with clock.stage("write") as told:
            write_outputs(walkthrough, folder, told)
        if comparison:
            with clock.stage("compare") as told:
                write_comparison(compare(walkthrough, told), folder)
    return walkthrough


def make_walkthrough(
    building_path: Path | str, config: PlanConfig, clock: StageClock, given: ImportedKeypoints | None = None
) -> Walkthrough:
    """Returns the planned walk with its figures; writes nothing.

    Raises:
        WalkError: The building cannot be used, or nothing in it can be walked.
    """
    if given is not None and len(given.positions) < 2:
        raise TooFewKeypointsError(given.source, len(given.positions))
    with clock.stage("load") as told:
        building = load_building(building_path, config.load, config.walker, told)
    with clock.stage("importance") as told:
        importance_map = compute_importance(building, config.importance, told)
    with clock.stage("keypoints"):
        if given is None:
            suggestion = suggest_keypoints(building, importance_map, config.keypoints)
        else:
            suggestion = given_suggestion(building, importance_map, given)
    with clock.stage("tour") as told:
        tour = plan_tour(building, suggestion.positions, config.tour, told)
        _check(building, tour, given)
    with clock.stage("trajectory") as told:
        path = optimise_path(building, tour.polyline, tour.stands[tour.order], config.trajectory, told)
    with clock.stage("timing"):
        trajectory = time_path(path, config.timing, look_targets(suggestion, tour.stands, tour.order))
    with clock.stage("metrics") as told:
        walkthrough = _assess(config, building, importance_map, suggestion, tour, path, trajectory, clock, told)
    notes = left_out(building, given, tour) if given is not None else ()
    return dataclasses.replace(walkthrough, warnings=(*building.warnings, *notes))


def _check(building: Building, tour: Tour, given: ImportedKeypoints | None) -> None:
    if len(tour.order) < 2 and given is not None:
        raise TooFewKeypointsError(given.source, len(tour.order), left_out(building, given, tour))
    if len(tour.order) < 2:
        reasons = "; ".join(sorted({unreachable.reason for unreachable in tour.unreachable}))
        raise NoWalkError(building.model.source, len(tour.order), reasons)


def _assess(
    config: PlanConfig,
    building: Building,
    importance_map: ImportanceMap,
    suggestion: Suggestion,
    tour: Tour,
    path: OptimisedPath,
    trajectory: Trajectory,
    clock: StageClock,
    progress: Progress,
) -> Walkthrough:
    """Measures the walk and those it is compared with."""
    sweep = BodySweep(building.geometry, building.walker)
    beside = SideClearance(building)
    free_space = sample_free_space(building, importance_map)
    measure = Measure(building, sweep, beside, free_space)
    qualities: list[PathQuality] = [measure("ours", path.points, trajectory)]
    progress("metrics", 0.3)
    others = baselines(building, suggestion, tour, config)
    for done, walk in enumerate(others, start=1):
        qualities.append(measure(walk.name, walk.path, walk.trajectory))
        progress("metrics", 0.5 + 0.4 * done / len(others))
    return Walkthrough(
        config=config,
        building=building,
        importance_map=importance_map,
        suggestion=suggestion,
        tour=tour,
        path=path,
        trajectory=trajectory,
        profile=profile(building, beside, trajectory),
        qualities=tuple(qualities),
        visits=room_visits(building, suggestion, tour.order, qualities[0].rooms),
        warnings=building.warnings,
        stage_s=clock.seconds,
    )
