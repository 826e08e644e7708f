# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
"""Texts on a plan that do not cover each other."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.font_manager import FontProperties
from numpy.typing import NDArray


@dataclasses.dataclass(slots=True)
class LabelBoard:
    """The boxes that are taken on one set of axes, in pixels; its limits and size must not change any more."""

    axes: Axes
    renderer: Any = dataclasses.field(init=False)  # of matplotlib, which gives it no type
    boxes: list[tuple[float, float, float, float]] = dataclasses.field(default_factory=list)

    def __post_init__(self) -> None:
        canvas: Any = self.axes.figure.canvas
        self.renderer = canvas.get_renderer()

    @property
    def pixels_per_point(self) -> float:
        """Pixels to a typographic point."""
        return float(self.axes.figure.dpi) / 72.0

    def to_pixels(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns (n, 2) map positions [m] as pixels."""
        return np.asarray(self.axes.transData.transform(points))

    def to_map(self, pixels: NDArray[np.float64]) -> NDArray[np.float64]:
        """Returns (n, 2) pixels as map positions [m]."""
        return np.asarray(self.axes.transData.inverted().transform(pixels))

    def text_size(self, text: str, size_pt: float, weight: str = "normal") -> tuple[float, float]:
        """Returns the width and height of a text of one or more lines [pixels]."""
        font = FontProperties(size=size_pt, weight=weight)
        lines = text.split("\n")
        widths = [self.renderer.get_text_width_height_descent(line, font, ismath=False)[0] for line in lines]
        return float(max(widths)), 1.25 * size_pt * len(lines) * self.pixels_per_point

    def place(
        self,
        candidates: NDArray[np.float64],
        size: tuple[float, float],
        avoid: NDArray[np.float64] | None = None,
    ) -> NDArray[np.float64] | None:
        """Takes the first free box around one of the candidates.

        Args:
            candidates: (n, 2) centres of the box, best first [pixels].
            size: Width and height of the box [pixels].
            avoid: (k, 2) pixels that it must not cover, such as a drawn path.

        Returns:
            The centre (2,) [pixels]; None where every candidate is taken.
        """
        half = np.array(size) / 2
        frame = self.axes.bbox.extents
        for centre in candidates:
            if np.any(centre - half < frame[:2]) or np.any(centre + half > frame[2:]) or self._taken(centre, half):
                continue
            if avoid is None or not np.all(np.abs(avoid - centre) < half, axis=1).any():
                self.take(centre, size)
                return np.asarray(centre)
        return None

    def take(self, centre: NDArray[np.float64], size: tuple[float, float]) -> None:
        """Marks a box as taken."""
        w, h = size[0] / 2, size[1] / 2
        self.boxes.append((centre[0] - w, centre[1] - h, centre[0] + w, centre[1] + h))

    def _taken(self, centre: NDArray[np.float64], half: NDArray[np.float64]) -> bool:
        low, high = centre - half, centre + half
        return any(low[0] < x1 and high[0] > x0 and low[1] < y1 and high[1] > y0 for x0, y0, x1, y1 in self.boxes)


def ring(centre: NDArray[np.float64], radii: tuple[float, ...], count: int = 12) -> NDArray[np.float64]:
    """Returns the centre, then points on circles around it, smallest first."""
    angles = np.linspace(0.0, 2 * np.pi, count, endpoint=False) + 0.3
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    return np.vstack([centre[None, :], *(centre + radius * circle for radius in radii)])
