# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The importance map as a node: published as it gets better, and the keypoints it suggests.

What computes is imported where it is used: a later start publishes what is kept before those imports are done.
"""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from walk_building.errors import WalkError
from walk_building.model import LoadOptions
from walk_building.walker import Walker
from walk_importance.cache import default_cache_dir, same_maps
from walk_importance.config import ImportanceConfig, KeypointConfig
from walk_importance.errors import MapNotReadyError
from walk_importance.importance_map import ImportanceMap, reweigh
from walk_importance.store import MapStore, Start
from walk_ros.near_desk import NearDesk, Place
from walk_ros.node import STOP_S, WalkNode
from walk_ros.results import NO_POINTS, NO_TURNS, map_bytes, map_messages, suggestion_messages
from walk_ros.runner import run_node

if TYPE_CHECKING:
    from walk_building.building import Building
    from walk_importance.candidates import Candidates
    from walk_importance.keypoints import Suggestion


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class _Ready:
    """What a place near a point is found with; replaced as a whole, so that another thread may take it at any time."""

    building: Building
    importance_map: ImportanceMap
    candidates: Candidates


class ImportanceNode(WalkNode):
    """Publishes the importance map, a grid of it per storey, and suggested keypoints.

    Other weights need no new maps, another cone neither maps nor weights; what does not depend on a change is not
    published again.
    """

    niceness = 10

    def __init__(self) -> None:
        super().__init__("importance", {"importance": ImportanceConfig, "keypoints": KeypointConfig})
        self.declare_text("cache_dir", str(default_cache_dir()), "folder of computed maps; empty keeps none")
        self.declare_text(
            "keypoints_file", "", "CSV, JSON or bag whose keypoints are suggested; empty: those of the map"
        )
        self._map: ImportanceMap | None = None
        self._candidates: Candidates | None = None
        self._ready: _Ready | None = None
        self._map_for: ImportanceConfig | None = None
        self._suggested_for: KeypointConfig | None = None
        self._early: Start | None = None
        self._storeys = 0
        self._notes: tuple[str, ...] = ()  # of the map published last
        self.offer("importance_map", "importance_map/storeys", "suggested_keypoints")
        self._near = NearDesk(self, self._find_near)
        self.start()

    def destroy_node(self) -> None:
        """Ends both threads, then the node."""
        self._near.stop(STOP_S)
        super().destroy_node()

    def after_loading(self, building: Building) -> None:
        """Says what the file leaves open and what was made of it: once, though all nodes load it."""
        for warning in building.warnings:
            self.get_logger().warning(warning)

    def before_loading(self, source: Path, options: LoadOptions, walker: Walker) -> None:
        """Publishes what an earlier start with this file came to, if that is kept."""
        began = self.now_s()
        config, suggest = self._configs()
        early = self._early = self._store().start(source, options, walker, config, suggest)
        if early is None:
            return
        self._map, self._map_for = early.importance_map, config
        self._publish_map(early.floors_z, walker.eye_height_m)
        if early.positions is not None and early.quat_xyzw is not None and not self._keypoints_file:
            self._suggested_for = suggest
            self.publish_all(suggestion_messages(early.positions, early.quat_xyzw, self.revision()))
        self.get_logger().info(f"the map of an earlier start is published, {1e3 * (self.now_s() - began):.0f} ms")

    def work(self, building: Building) -> None:
        """Computes the map if what it depends on has changed, then the keypoints if what they depend on has."""
        if self._early is not None and self._early.building_hash != building.hash:
            # A file that the building file refers to has changed.
            self.forget()
        self._early = None
        config, suggest = self._configs()
        if config != self._map_for:
            self._update_map(building, config)
        if self._map is None:
            return
        from walk_importance.candidates import find_candidates

        if self._candidates is None:
            self._candidates = find_candidates(building, self._map)
        self._ready = _Ready(building=building, importance_map=self._map, candidates=self._candidates)
        if suggest != self._suggested_for:
            self._suggested_for = suggest
            self._suggest(building, self._map, suggest)

    def forget(self) -> None:
        """Drops the map of another building."""
        self._map = self._candidates = self._map_for = self._suggested_for = self._early = None
        self._ready = None

    def fail(self, stamp_ns: int) -> None:
        """Publishes an empty map, unless there is one, and no keypoints."""
        if self._early is not None:
            # What an earlier start left is of no building that can be loaded.
            self.forget()
        if self._map is None:
            self._offer_storeys(1)
            self.publish_all(map_messages(None, (), 0.0, stamp_ns))
        self.publish_all(suggestion_messages(NO_POINTS, NO_TURNS, stamp_ns))

    def supersedes(self, groups: frozenset[str]) -> bool:
        """Returns whether a change of these groups makes the running step pointless."""
        if self.building is None or "importance" not in groups:
            return False  # loading goes on, whatever the map is to be like
        running = self._map_for
        return running is None or not same_maps(running, self._configs()[0])

    def _find_near(self, point: NDArray[np.float64], taken: NDArray[np.float64]) -> Place:
        """Returns the best place around a point, in the thread of the desk that asks for it."""
        ready = self._ready
        if ready is None:
            raise MapNotReadyError
        from walk_building.footing import eye_over_floor
        from walk_importance.keypoints import snap_keypoint

        eye = eye_over_floor(ready.building, point)
        config = self.parameters.get("keypoints", KeypointConfig)
        found = snap_keypoint(ready.building, ready.importance_map, eye, config, ready.candidates, taken)
        return found.positions[0], found.quat_xyzw[0]

    def _configs(self) -> tuple[ImportanceConfig, KeypointConfig]:
        # Suggestions do not depend on how far a keypoint asked for is moved.
        suggest = dataclasses.replace(self.parameters.get("keypoints", KeypointConfig), snap_radius_m=1.0)
        return self.parameters.get("importance", ImportanceConfig), suggest

    def _store(self) -> MapStore:
        folder = str(self.get_parameter("cache_dir").value)
        return MapStore(Path(folder).expanduser() if folder else None)

    def _update_map(self, building: Building, config: ImportanceConfig) -> None:
        """Publishes the map anew: weighed, from the disk, or computed."""
        self._suggested_for = None
        floors_z = [storey.elevation_m for storey in building.storeys]
        began = self.now_s()
        if self._map is not None and self._map_for is not None and same_maps(config, self._map_for):
            self._map, self._map_for = reweigh(self._map, config), config
            if self._candidates is not None:
                from walk_importance.candidates import rescored

                self._candidates = rescored(self._candidates, self._map)
            self._publish_map(floors_z, building.walker.eye_height_m)
        else:
            self._map = self._candidates = None
            # Set before it is computed: settings that fail would fail again, and are tried again when they change.
            self._map_for = config
            self._compute(building, config, floors_z)
        self.diagnostics.latency(self.now_s() - began)

    def _compute(self, building: Building, config: ImportanceConfig, floors_z: Sequence[float]) -> None:
        """Publishes every map as it comes, each better than the one before; a kept one is the last."""
        kept = self._store().maps(building.hash, config)
        if kept is not None:
            self._map = kept
            self._publish_map(floors_z, building.walker.eye_height_m)
            return
        from walk_importance.pipeline import refine_importance

        self.diagnostics.state("computing", "computing the importance map")
        latest: ImportanceMap | None = None
        try:
            for found in refine_importance(building, config, self.worker.progress):
                now = self._configs()[0]
                # Other weights do not end the work; they are applied from the next map on.
                self._map_for = now if same_maps(now, config) else config
                latest = reweigh(found, self._map_for)
                self._publish(latest, floors_z, building.walker.eye_height_m)
        except WalkError:
            raise
        except BaseException:
            self._map_for = None  # superseded: begun again even if the settings come back
            raise
        if latest is not None:
            self._map = latest
            self._store().keep_maps(building.hash, config, latest)

    def _publish_map(self, floors_z: Sequence[float], eye_height_m: float) -> None:
        if self._map is not None:
            self._publish(self._map, floors_z, eye_height_m)

    def _publish(self, importance_map: ImportanceMap, floors_z: Sequence[float], eye_height_m: float) -> None:
        """Publishes a map and its storeys, and right behind them how exact they are."""
        self._offer_storeys(max(len(floors_z), 1))
        stamp_ns, stderr = self.revision(), importance_map.visibility_stderr
        self.publish_all(map_bytes(importance_map, floors_z, eye_height_m, stamp_ns))
        self.diagnostics.note(
            solver_status=f"visibility to {stderr:.4f} (standard error)",
            visibility_stderr=stderr,
            map_revision_ns=stamp_ns,
        )
        self.publish_diagnostics()
        if importance_map.notes != self._notes:
            self._notes = importance_map.notes
            for note in self._notes:
                self.get_logger().warning(note)

    def _offer_storeys(self, count: int) -> None:
        # Latched keeps the last few messages of a topic: as many as there are storeys, or some would be lost.
        if count != self._storeys:
            self._storeys = count
            self.offer("importance_map/storeys", depth=count)

    def _suggest(self, building: Building, importance_map: ImportanceMap, config: KeypointConfig) -> None:
        from walk_importance.keypoints import suggest_keypoints

        began = self.now_s()
        if self._keypoints_file:
            suggestion = self._given(building, importance_map, self._keypoints_file)
        else:
            suggestion = suggest_keypoints(building, importance_map, config, self._candidates)
        stamp_ns = self.revision()
        self.publish_all(suggestion_messages(suggestion.positions, suggestion.quat_xyzw, stamp_ns))
        self.diagnostics.latency(self.now_s() - began)
        for skipped in suggestion.skipped:
            self.get_logger().info(f"no keypoint in {building.rooms[skipped.room].name}: {skipped.reason}")
        sentence = f"{len(suggestion.positions)} keypoints suggested, {len(suggestion.skipped)} rooms skipped"
        self.diagnostics.state("ready", sentence)
        self.diagnostics.note(revision_ns=stamp_ns)
        options = self.parameters.get("load", LoadOptions)
        importance = self._map_for
        if importance is not None and not self._keypoints_file:
            self._store().keep_start(building, options, importance, config, suggestion)

    @property
    def _keypoints_file(self) -> str:
        return str(self.get_parameter("keypoints_file").value)

    def _given(self, building: Building, importance_map: ImportanceMap, file: str) -> Suggestion:
        """Returns the keypoints of the user's file; raises WalkError where it says something else."""
        from walk_bag.keypoint_files import read_keypoints
        from walk_importance.given import given_suggestion

        given = read_keypoints(file)
        eyes = given.eyes_in(building)
        self.get_logger().info(f"suggested keypoints 1 to {len(eyes)} are those of {given.source}, in its order")
        return given_suggestion(building, importance_map, eyes, given.quat_xyzw, given.looks, given.source)


def main() -> int:
    """Runs the node; returns the exit code."""
    return run_node(ImportanceNode)


if __name__ == "__main__":
    sys.exit(main())
