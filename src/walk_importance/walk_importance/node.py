# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""The importance map as a node: published as it gets better, and the keypoints it suggests."""

from __future__ import annotations

import sys

from walk_building.building import Building
from walk_building.errors import WalkError
from walk_importance.config import ImportanceConfig, KeypointConfig
from walk_importance.importance_map import ImportanceMap
from walk_importance.keypoints import suggest_keypoints
from walk_importance.pipeline import refine_importance
from walk_ros.node import WalkNode
from walk_ros.results import NO_POINTS, NO_TURNS, map_messages, suggestion_messages
from walk_ros.runner import run_node


class ImportanceNode(WalkNode):
    """Publishes the importance map, a grid of it per storey, and suggested keypoints."""

    def __init__(self) -> None:
        super().__init__("importance", {"importance": ImportanceConfig, "keypoints": KeypointConfig})
        self._map: ImportanceMap | None = None
        self._map_for: ImportanceConfig | None = None
        self._suggested_for: KeypointConfig | None = None
        self.offer("importance_map", "importance_map/storeys", "suggested_keypoints")
        self.start()

    def work(self, building: Building) -> None:
        """Computes the map if what it depends on has changed, then the keypoints if what they depend on has."""
        config = self.parameters.get("importance", ImportanceConfig)
        if config != self._map_for:
            self.diagnostics.state("computing", "computing the importance map")
            self._suggested_for = None
            began = self.now_s()
            self._map = self._map_for = None
            try:
                self._refine(building, config)
            except WalkError:
                # The same settings would fail again; they are tried again when they change.
                self._map_for = config
                raise
            self._map_for = config
            self.diagnostics.latency(self.now_s() - began)
        suggest = self.parameters.get("keypoints", KeypointConfig)
        if self._map is not None and suggest != self._suggested_for:
            self._suggested_for = suggest
            self._suggest(building, self._map, suggest)

    def forget(self) -> None:
        """Drops the map of another building."""
        self._map = self._map_for = self._suggested_for = None

    def fail(self, stamp_ns: int) -> None:
        """Publishes an empty map, unless there is one, and no keypoints."""
        if self._map is None:
            self.publish_all(map_messages(None, (), 0.0, stamp_ns))
        self.publish_all(suggestion_messages(NO_POINTS, NO_TURNS, stamp_ns))

    def supersedes(self, groups: frozenset[str]) -> bool:
        """Returns whether a change of these groups makes the running step pointless."""
        return "importance" in groups

    def _refine(self, building: Building, config: ImportanceConfig) -> None:
        """Publishes every map as it comes, each better than the one before."""
        floors_z = [storey.elevation_m for storey in building.storeys]
        # Latched keeps the last few messages of a topic: as many as there are storeys, or some would be lost.
        self.offer("importance_map/storeys", depth=max(len(floors_z), 1))
        latest: ImportanceMap | None = None
        for latest in refine_importance(building, config, self.worker.progress):
            self.publish_all(map_messages(latest, floors_z, building.walker.eye_height_m, self.revision()))
            self.diagnostics.note(solver_status=f"visibility to {latest.visibility_stderr:.4f} (standard error)")
        self._map = latest
        if latest is not None:
            for note in latest.notes:
                self.get_logger().warning(note)

    def _suggest(self, building: Building, importance_map: ImportanceMap, config: KeypointConfig) -> None:
        began = self.now_s()
        suggestion = suggest_keypoints(building, importance_map, config)
        stamp_ns = self.revision()
        self.publish_all(suggestion_messages(suggestion.positions, suggestion.quat_xyzw, stamp_ns))
        self.diagnostics.latency(self.now_s() - began)
        for skipped in suggestion.skipped:
            self.get_logger().info(f"no keypoint in {building.rooms[skipped.room].name}: {skipped.reason}")
        sentence = f"{len(suggestion.positions)} keypoints suggested, {len(suggestion.skipped)} rooms skipped"
        self.diagnostics.state("ready", sentence)
        self.diagnostics.note(revision_ns=stamp_ns)


def main() -> int:
    """Runs the node; returns the exit code."""
    return run_node(ImportanceNode)


if __name__ == "__main__":
    sys.exit(main())
