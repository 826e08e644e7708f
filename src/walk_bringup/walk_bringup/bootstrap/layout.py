# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Where things are in a checkout."""

from __future__ import annotations

import dataclasses
import os
from pathlib import Path

PACKAGES = (
    "walk_building",
    "walk_ros",
    "walk_importance",
    "walk_sequencer",
    "walk_trajopt",
    "walk_vr_bridge",
    "walk_plan",
    "walk_bag",
    "walk_bringup",
)
"""The packages in the order of the data flow; others that lie in src/ are built too."""


@dataclasses.dataclass(frozen=True, slots=True)
class Layout:
    """The paths of one checkout."""

    root: Path

    @classmethod
    def here(cls) -> Layout:
        """Returns the layout of the checkout that this file belongs to."""
        return cls(Path(__file__).resolve().parents[4])

    @property
    def venv(self) -> Path:
        """The virtual environment; colcon would look for packages in it under a name without a dot."""
        return self.root / ".venv"

    @property
    def python(self) -> Path:
        """The Python of the virtual environment."""
        return self.venv / "bin" / "python"

    @property
    def state(self) -> Path:
        """Folder of what the set-up remembers: stamps, environment, logs."""
        return self.root / "build" / "walk"

    @property
    def install(self) -> Path:
        """Where colcon installs."""
        return self.root / "install"

    @property
    def lock(self) -> Path:
        """The pinned requirements."""
        return self.root / "requirements.lock"

    @property
    def environment(self) -> Path:
        """The stored environment of the built packages."""
        return self.state / "environment.json"

    @property
    def web(self) -> Path:
        """The sources of the headset page."""
        return self.root / "src" / "walk_vr_bridge" / "web"

    @property
    def page(self) -> Path:
        """The built headset page."""
        return self.root / "src" / "walk_vr_bridge" / "walk_vr_bridge" / "static" / "index.html"

    @property
    def buildings(self) -> Path:
        """The folder of real buildings: WALK_BUILDINGS, or shared/buildings beside the checkout."""
        given = os.environ.get("WALK_BUILDINGS")
        return Path(given) if given else self.root.parent / "shared" / "buildings"

    def packages(self) -> list[Path]:
        """Returns the folders of the packages in src/, in the order of their names."""
        return sorted(file.parent for file in self.root.glob("src/*/package.xml"))

    def executable(self, package: str, name: str) -> Path:
        """Returns where colcon puts an executable of a package."""
        return self.install / package / "lib" / package / name
