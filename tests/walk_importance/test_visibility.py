# SPDX-FileCopyrightText: The walkthrough planner's authors
# SPDX-License-Identifier: Apache-2.0
from __future__ import annotations

import itertools
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from walk_importance.grid import VoxelGrid
from walk_importance.visibility import MODES, Scene, VisibilityEstimate
from walk_importance.visibility.exact import half_space, nth_displacements
from walk_importance.visibility.sampling import shells

Grid = NDArray[np.bool_]


def scene_of(free: Grid, targets: Grid | None = None, sources: Grid | None = None) -> Scene:
    grid = VoxelGrid(origin=np.zeros(3), voxel_size_m=1.0, shape=free.shape)
    targets = free if targets is None else targets
    return Scene(grid=grid, free=free, targets=targets, sources=targets if sources is None else sources)


def final(mode: str, scene: Scene) -> VisibilityEstimate:
    *_, last = MODES[mode](scene)
    return last


def exact_share(free: Grid) -> NDArray[np.float32]:
    return final("exact", scene_of(free)).share


def touched(d: tuple[int, ...]) -> list[tuple[int, ...]]:
    """All closed unit cubes that the segment from 0 to d meets, by clipping it against each in fractions."""
    found = []
    for cell in itertools.product(*(range(min(0, c), max(0, c) + 1) for c in d)):
        low, high = Fraction(0), Fraction(1)
        for c, along in zip(cell, d, strict=True):
            if along:
                enter, leave = sorted((Fraction(2 * c - 1, 2 * along), Fraction(2 * c + 1, 2 * along)))
                low, high = max(low, enter), min(high, leave)
        if low <= high:
            found.append(cell)
    return found


def brute_force(free: Grid) -> NDArray[np.float64]:
    """The definition, pair by pair in fractions."""
    cells = [tuple(int(c) for c in v) for v in np.argwhere(free)]
    seen = np.zeros(free.shape)
    for a, b in itertools.combinations(cells, 2):
        d = tuple(q - p for p, q in zip(a, b, strict=True))
        if all(free[tuple(p + c for p, c in zip(a, cell, strict=True))] for cell in touched(d)):
            seen[a] += 1
            seen[b] += 1
    return seen / max(len(cells) - 1, 1)


SMALL = st.tuples(st.integers(1, 5), st.integers(1, 5), st.integers(1, 5))


@settings(max_examples=25, deadline=None)
@given(SMALL.flatmap(lambda shape: arrays(bool, shape, elements=st.booleans())))
def test_exact_equals_the_definition_on_any_grid(free: Grid) -> None:
    np.testing.assert_allclose(exact_share(free), brute_force(free), atol=1e-6)


@pytest.mark.parametrize("shape", [(4, 5, 3), (1, 9, 6), (23, 9, 13), (12, 30, 8), (70, 3, 2)])
@pytest.mark.parametrize("filled", [0.03, 0.3])
def test_every_mode_that_asks_voxels_agrees_with_the_scalar_walk(shape: tuple[int, int, int], filled: float) -> None:
    free = np.random.default_rng(len(shape) + shape[1]).random(shape) > filled
    truth = final("voxel_rays", scene_of(free)).share
    np.testing.assert_array_equal(exact_share(free), truth)
    np.testing.assert_array_equal(final("progressive", scene_of(free)).share, truth)


def test_targets_and_sources_count_only_what_they_name() -> None:
    rng = np.random.default_rng(3)
    free = rng.random((14, 11, 9)) > 0.1
    targets = free & (rng.random(free.shape) > 0.4)
    sources = targets & (rng.random(free.shape) > 0.7)
    scene = scene_of(free, targets, sources)
    truth = final("voxel_rays", scene).share
    assert truth[~sources].max() == 0 < truth[sources].max()
    np.testing.assert_array_equal(final("exact", scene).share, truth)
    np.testing.assert_array_equal(final("progressive", scene).share, truth)


def test_in_an_empty_box_every_voxel_sees_all() -> None:
    np.testing.assert_array_equal(exact_share(np.ones((9, 17, 6), bool)), 1.0)


def test_through_a_slit_two_rows_see_each_other_along_its_line_only() -> None:
    # Two corridors of one row each, a wall with one hole between them: (x, 0) sees (u, 2) only through (3, 1).
    free = np.ones((7, 3, 1), bool)
    free[:, 1] = False
    free[3, 1] = True
    # From (x, 0) to (u, 2) the middle voxel must be (3, 1) and nothing else of row 1 may be touched: the segment is
    # within that row for |u - x| / 2 voxels around (x + u) / 2, which fits the closed voxel only for x = u = 3.
    share = exact_share(free)[:, :, 0] * (free.sum() - 1)
    expected_row = np.full(7, 6.0)
    expected_row[3] += 2.0  # the hole and the voxel opposite
    expected_row[[2, 4]] += 0.0  # the diagonal into the hole touches the wall's corner
    np.testing.assert_allclose(share[:, 0], expected_row, atol=1e-4)
    np.testing.assert_allclose(share[3, 1], 2.0, atol=1e-4)


@pytest.mark.parametrize(("near", "far", "width", "slit"), [(4, 4, 9, 4), (3, 5, 8, 2), (6, 2, 11, 0)])
def test_two_rooms_and_a_slit_in_closed_form(near: int, far: int, width: int, slit: int) -> None:
    """A wall one voxel thick between two rooms, with a slit of one voxel over all the height."""
    height = 3
    free = np.ones((width, near + 1 + far, height), bool)
    free[:, near] = False
    free[slit, near] = True
    seen = exact_share(free) * (free.sum() - 1)

    def through(x: int, a: int, u: int, b: int) -> bool:
        # From a rows before the wall to b behind it the segment is in the wall's row from a - 1/2 to a + 1/2 rows on;
        # there it must stay off the slit's sides, by less than half a voxel from its middle.
        return all(abs(2 * (x - slit) * (a + b) + (u - x) * (2 * a + side)) < a + b for side in (-1, 1))

    for x in range(width):
        for a in range(1, near + 1):
            opposite = sum(through(x, a, u, b) for u in range(width) for b in range(1, far + 1))
            # From a rows off, the slit is seen within a voxels to either side.
            expected = near * width * height - 1 + height * ((abs(x - slit) < a) + opposite)
            np.testing.assert_allclose(seen[x, near - a], expected, atol=1e-2)


def test_along_a_row_an_obstacle_parts_those_on_either_side() -> None:
    free = np.ones((11, 1, 1), bool)
    free[4] = False
    share = exact_share(free).ravel() * (free.sum() - 1)
    np.testing.assert_allclose(share, [3, 3, 3, 3, 0, 5, 5, 5, 5, 5, 5], atol=1e-4)


@settings(max_examples=15, deadline=None)
@given(arrays(bool, (6, 7, 4), elements=st.booleans()), st.data())
def test_adding_an_obstacle_never_lets_anyone_see_more(free: Grid, data: st.DataObject) -> None:
    where = data.draw(st.tuples(st.integers(0, 5), st.integers(0, 6), st.integers(0, 3)))
    fewer = free.copy()
    fewer[where] = False
    before = exact_share(free) * max(free.sum() - 1, 1)
    after = exact_share(fewer) * max(fewer.sum() - 1, 1)
    assert np.all(after <= before + 1e-3)


@settings(max_examples=10, deadline=None)
@given(arrays(bool, (7, 5, 4), elements=st.booleans()))
def test_mirroring_and_turning_the_grid_mirrors_and_turns_the_map(free: Grid) -> None:
    share = exact_share(free)
    for axis in range(3):
        np.testing.assert_array_equal(exact_share(np.flip(free, axis).copy()), np.flip(share, axis))
    np.testing.assert_array_equal(exact_share(np.rot90(free).copy()), np.rot90(share))
    np.testing.assert_array_equal(exact_share(np.rot90(free, axes=(0, 2)).copy()), np.rot90(share, axes=(0, 2)))


def test_seeing_is_mutual() -> None:
    rng = np.random.default_rng(5)
    free = rng.random((8, 9, 7)) > 0.2
    cells = np.argwhere(free)
    for a, b in rng.choice(len(cells), (20, 2)):
        one, other = np.zeros_like(free), np.zeros_like(free)
        one[tuple(cells[a])] = other[tuple(cells[b])] = True
        both = one | other
        share = final("exact", scene_of(free, both)).share
        assert share[tuple(cells[a])] == share[tuple(cells[b])]


def test_progressive_names_an_error_it_keeps_and_ends_exact() -> None:
    rng = np.random.default_rng(8)
    free = np.ones((40, 32, 12), bool)
    free[13, :20] = free[26, 12:] = free[:, 16, :8] = False
    free &= rng.random(free.shape) > 0.01
    truth = exact_share(free)[free]
    steps = list(MODES["progressive"](scene_of(free)))
    assert [s.done for s in steps] == sorted(s.done for s in steps)
    for step in steps[:-1]:
        actual = np.sqrt(np.mean((step.share[free] - truth) ** 2))
        assert actual <= 1.5 * step.stderr
    assert steps[-1].stderr == 0.0
    np.testing.assert_array_equal(steps[-1].share[free], truth)
    tenth = next(s for s in steps if s.done > 0.05)
    assert np.corrcoef(tenth.share[free], truth)[0, 1] > 0.99


def test_the_same_seed_gives_the_same_map_and_another_seed_another() -> None:
    free = np.random.default_rng(0).random((24, 24, 8)) > 0.05
    grid = VoxelGrid(origin=np.zeros(3), voxel_size_m=1.0, shape=free.shape)
    first, again, other = (next(iter(MODES["progressive"](Scene.of(grid, free, seed)))).share for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert np.any(first != other)


@settings(max_examples=20, deadline=None)
@given(st.tuples(st.integers(1, 9), st.integers(1, 9), st.integers(1, 20)), st.integers(0, 99))
def test_each_displacement_is_drawn_once_whatever_the_order(shape: tuple[int, int, int], seed: int) -> None:
    drawn = [tuple(d) for shell in shells(shape, seed) for d in shell.draw(10**9)]
    listed = [tuple(d) for d in nth_displacements(0, half_space(shape), np.array(shape))]
    assert len(drawn) == len(set(drawn))
    assert sorted(drawn) == sorted(listed)
    assert not any((-x, -y, -z) in set(listed) for x, y, z in listed)


def test_rays_on_the_triangles_see_a_little_more_than_voxels_and_rank_them_alike() -> None:
    from scenes import building_of, two_rooms

    from walk_importance.config import ImportanceConfig
    from walk_importance.pipeline import compute_importance

    building = building_of(two_rooms(door_m=2.0))
    by_rays = compute_importance(building, ImportanceConfig(visibility="rays", voxel_size_m=0.4))
    by_voxels = compute_importance(building, ImportanceConfig(visibility="exact", voxel_size_m=0.4))
    free = by_rays.obstacle == 0
    # Voxels are thicker than walls, so they hide more, but what is seen goes up and down alike.
    assert np.mean(by_voxels.visibility[free]) <= np.mean(by_rays.visibility[free]) + 1e-6
    assert np.corrcoef(by_rays.visibility[free], by_voxels.visibility[free])[0, 1] > 0.9
