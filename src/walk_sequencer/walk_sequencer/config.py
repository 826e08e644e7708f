# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""What a user can tune about the tour."""

from __future__ import annotations

import dataclasses

from walk_building.config import Config, param
from walk_building.errors import ParameterError
from walk_sequencer.rules import Rules, conflict, parse

METHODS = ("auto", "exact", "local_search", "mst_dfs", "given")


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class SequencerConfig(Config):
    """How legs are planned and in which order the keypoints are visited."""

    milestones: int = param(
        0, "milestones of the roadmap; 0 takes 800 and one more per square metre, at most 4000", low=0, high=20000
    )
    seed: int = param(1, "seed of the roadmap and of the order's random restarts", low=0, high=2**31 - 1)
    method: str = param(
        "auto",
        "how the order is found: auto is exact up to 16 keypoints and local_search above; given keeps the user's",
        choices=METHODS,
    )
    begin: str = param(
        "entrance",
        "where the tour begins unless start says so: at the keypoint nearest to the building's entrance, or wherever "
        "it is shortest",
        choices=("entrance", "anywhere"),
    )
    start: int = param(-1, "index of the keypoint to start at; -1 leaves it to begin", low=-1)
    end: int = param(-1, "index of the keypoint to end at; -1 leaves it free", low=-1)
    before: str = param(
        "",
        "which keypoints come before others, such as 3<7<2, 5<2; binds the search for an order, not a hand that edits",
    )
    together: str = param(
        "",
        "which keypoints stay together, one right behind the other in this order, such as 4-8-1, 6-9; binds likewise",
    )
    comfort_m: float = param(
        0.3, "distance to the walls, beyond the body, from which a leg has nothing to gain", unit="m", low=0.0, high=2.0
    )
    comfort_weight: float = param(
        0.5, "price of a metre walked at a wall, on top of its length; 0 plans the shortest legs", low=0.0, high=10.0
    )
    snap_m: float = param(
        0.5, "farthest a keypoint may be from a place to stand on and still count", unit="m", low=0.0, high=3.0
    )
    slope_break_m: float = param(
        0.02, "largest height by which a leg's straight pieces leave the floor", unit="m", low=0.001, high=0.1
    )
    kicks: int = param(
        40,
        "random restarts of the local search for each keypoint; each starts from the best order so far",
        low=0,
        high=10000,
    )

    def __post_init__(self) -> None:
        # The two-argument form: slots=True makes a new class, which the bare super() would not find.
        super(SequencerConfig, self).__post_init__()
        problem = conflict(self.rules, self.start, self.end)
        if problem:
            raise ParameterError(
                "before and together", self._rules_text(), f"rules that an order can keep, not {problem}"
            )

    @property
    def rules(self) -> Rules:
        """What `before` and `together` say."""
        return parse(self.before, self.together)

    def _rules_text(self) -> str:
        return "; ".join(filter(None, (self.before, self.together)))
