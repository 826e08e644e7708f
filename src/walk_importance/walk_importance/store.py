# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a later start finds on disk: the maps, and what is published before the building is loaded."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import logging
import os
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from walk_building.fingerprint import content_hash
from walk_building.model import LoadOptions
from walk_building.walker import Walker
from walk_importance.cache import cache_file, load_map, save_map, trim, write_whole
from walk_importance.config import ImportanceConfig, KeypointConfig
from walk_importance.importance_map import ImportanceMap

if TYPE_CHECKING:
    from walk_building.building import Building
    from walk_importance.keypoints import Suggestion

_log = logging.getLogger(__name__)
_FORMAT = 1  # raise when the record or what it is made from changes


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Start:
    """What an earlier run knew about a building file, good until the file is loaded and its hash can be compared.

    Attributes:
        building_hash: Of the building that was loaded from the same bytes, options and walker.
        floors_z: Floors of its storeys [m].
        importance_map: Its maps with the weights asked for.
        positions: (K, 3) suggested keypoints [m], None where they were chosen under other parameters.
        quat_xyzw: (K, 4) their view directions.
    """

    building_hash: str
    floors_z: tuple[float, ...]
    importance_map: ImportanceMap
    positions: NDArray[np.float64] | None
    quat_xyzw: NDArray[np.float64] | None


class MapStore:
    """A folder of maps; what goes wrong with it is logged, and everything is computed as if it were empty."""

    def __init__(self, folder: Path | None) -> None:
        """Uses a folder, which need not exist yet; None keeps nothing."""
        self._folder = folder

    def maps(self, building_hash: str, config: ImportanceConfig) -> ImportanceMap | None:
        """Returns the kept maps of a building, weighed by `config`; None where there are none."""
        if self._folder is None:
            return None
        file = cache_file(self._folder, building_hash, config)
        found = load_map(file, config)
        if found is not None:
            # Used now, so among the last to be deleted.
            self._try(lambda: os.utime(file))
        return found

    def keep_maps(self, building_hash: str, config: ImportanceConfig, importance_map: ImportanceMap) -> None:
        """Writes the maps and deletes old ones."""
        if self._folder is not None:
            folder = self._folder
            self._try(lambda: save_map(cache_file(folder, building_hash, config), importance_map))
            self._try(lambda: trim(folder))

    def start(
        self, source: Path, options: LoadOptions, walker: Walker, config: ImportanceConfig, keypoints: KeypointConfig
    ) -> Start | None:
        """Returns what is known about a building file that is not loaded yet; None where that is nothing."""
        if self._folder is None:
            return None
        try:
            file = start_file(self._folder, source, options, walker)
            head = _read(file)
            maps = self.maps(head["building_hash"], config)
            known = head["suggested_for"] == _settings(config, keypoints)
            return (
                None
                if maps is None
                else Start(
                    building_hash=head["building_hash"],
                    floors_z=tuple(head["floors_z"]),
                    importance_map=maps,
                    positions=np.array(head["positions"], np.float64).reshape(-1, 3) if known else None,
                    quat_xyzw=np.array(head["quat_xyzw"], np.float64).reshape(-1, 4) if known else None,
                )
            )
        except OSError:
            return None  # the first start, or a building that cannot be read, which loading it will say
        except (ValueError, KeyError, TypeError) as error:
            _log.warning("%s is damaged (%s) and is written anew", file, error)
            return None

    def keep_start(
        self, building: Building, options: LoadOptions, config: ImportanceConfig, keypoints: KeypointConfig,
        suggestion: Suggestion,
    ) -> None:  # fmt: skip
        """Writes what the next start with the same building file publishes first."""
        if self._folder is None:
            return
        body = {
            "building_hash": building.hash,
            "floors_z": [storey.elevation_m for storey in building.storeys],
            "suggested_for": _settings(config, keypoints),
            "positions": suggestion.positions.tolist(),
            "quat_xyzw": suggestion.quat_xyzw.tolist(),
        }
        text = json.dumps(body).encode()
        folder, source = self._folder, Path(building.model.source)
        self._try(
            lambda: write_whole(start_file(folder, source, options, building.walker), b"%d\n" % zlib.crc32(text), text)
        )

    def _try(self, write: Callable[[], None]) -> None:
        try:
            write()
        except OSError as error:
            _log.warning(
                "maps cannot be kept in %s (%s); set cache_dir to another folder, or to '' to keep none",
                self._folder,
                error.strerror or error,
            )


def start_file(folder: Path, source: Path, options: LoadOptions, walker: Walker) -> Path:
    """Returns where the start with a building file is kept: named by its bytes, not by those of files it refers to.

    Raises:
        OSError: The building file cannot be read.
    """
    text = json.dumps([_FORMAT, content_hash(source, (), options), dataclasses.asdict(walker)], sort_keys=True)
    return folder / f"start-{hashlib.sha256(text.encode()).hexdigest()[:32]}.json"


def _settings(config: ImportanceConfig, keypoints: KeypointConfig) -> list[dict[str, object]]:
    return [dataclasses.asdict(config), dataclasses.asdict(keypoints)]


def _read(file: Path) -> dict[str, Any]:
    checksum, text = file.read_bytes().split(b"\n", 1)
    if zlib.crc32(text) != int(checksum):
        raise ValueError("the checksum differs")
    head = json.loads(text)
    if not isinstance(head, dict):
        raise ValueError("it holds no record")
    return head
