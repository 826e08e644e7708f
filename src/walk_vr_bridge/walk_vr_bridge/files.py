# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What is served over HTTP beside the page: the newest building and importance volume."""

from __future__ import annotations

import dataclasses

import orjson

from walk_vr_bridge.content import Content, content
from walk_vr_bridge.model.scene import Scene
from walk_vr_bridge.model.volume import Volume


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Missing:
    """A file that is not there: the HTTP status and the sentence that says why."""

    status: int
    reason: str


class Files:
    """The files by path; set from the node's worker, read by the web server: each call swaps whole files."""

    def __init__(self) -> None:
        self._building: dict[str, Content] | Missing = Missing(status=503, reason="the building is being loaded")
        self._importance: Content | Missing = Missing(status=503, reason="there is no importance map yet")
        # By revision, the newest last; the one before it is for who read its description just before it was replaced.
        self._volumes: dict[str, Content] = {}
        self._told = {"building": "", "building_etag": "", "miniature_etag": "", "importance_ns": ""}

    def set_scene(self, scene: Scene) -> None:
        """Serves a building."""
        self._building = {
            "/building.json": content(orjson.dumps(scene.description), "application/json"),
            "/building.glb": scene.building,
            "/miniature.glb": scene.miniature,
        }
        etags = {"building_etag": scene.building.etag.strip('"'), "miniature_etag": scene.miniature.etag.strip('"')}
        self._told = {**self._told, "building": scene.hash, **etags}

    def set_volume(self, volume: Volume) -> None:
        """Serves an importance volume."""
        # Level 1: a map is looked at for seconds until the next one comes.
        data = content(volume.data, "application/octet-stream", level=1)
        before = list(self._volumes.items())[-1:]
        self._volumes = {**dict(before), volume.description["revision_ns"]: data}
        self._importance = content(orjson.dumps(volume.description), "application/json")
        self._told = {**self._told, "importance_ns": volume.description["revision_ns"]}

    def no_building(self, reason: str, *, loading: bool) -> None:
        """Serves no building, and says why."""
        self._building = Missing(status=503 if loading else 424, reason=reason)
        self._told = {**self._told, "building": "", "building_etag": "", "miniature_etag": ""}

    def no_volume(self) -> None:
        """Serves no importance volume."""
        self._importance = Missing(status=503, reason="there is no importance map yet")
        self._volumes = {}
        self._told = {**self._told, "importance_ns": ""}

    def told(self) -> dict[str, str]:
        """Returns what `bridge/files` says."""
        return self._told

    def get(self, path: str, revision: str | None = None) -> Content | Missing | None:
        """Returns the file of a path, why it is missing, or None for another path."""
        if path in ("/building.json", "/building.glb", "/miniature.glb"):
            return self._building if isinstance(self._building, Missing) else self._building[path]
        if path == "/importance.json":
            return self._importance
        if path == "/importance.bin":
            return self._volume(revision)
        return None

    def _volume(self, revision: str | None) -> Content | Missing:
        volumes = self._volumes
        if not volumes:
            return Missing(status=503, reason="there is no importance map yet")
        if revision is None:
            return list(volumes.values())[-1]
        too_old = Missing(status=409, reason="there is a newer importance map: read /importance.json again")
        return volumes.get(revision, too_old)
