"""Stones in a mortar: how they are drawn, placed and read, and what is refused."""

import numpy as np
import pytest

import treadload as tl
from treadload.materials.aggregates import Spheres, Window, check_apart

STONE = tl.Elastic(60e9, 0.2)
WINDOW = Window(36e-3, 36e-3, 16e-3)


def test_drawn_stones_fill_their_share_lie_inside_and_keep_their_distance():
    stones = tl.materials.Aggregates.random(0.28, [(2e-3, 0.4), (5e-3, 0.6)], STONE, seed=1, gap=0.3e-3, cover=0.5e-3)
    drawn = stones.spheres(WINDOW)
    # Whole stones: half of one of each size at most.
    assert drawn.volume / WINDOW.volume == pytest.approx(0.28, abs=0.5 * 4.19 * (5e-3**3 + 2e-3**3) / WINDOW.volume)
    large = drawn.radius > 3e-3
    assert (drawn.radius[large] ** 3).sum() / (drawn.radius**3).sum() == pytest.approx(0.6, abs=0.06)
    check_apart(Spheres(drawn.x, drawn.y, drawn.z, drawn.radius + 0.149e-3))
    assert (drawn.z - drawn.radius).min() >= 0.5e-3
    assert (np.abs(drawn.x) + drawn.radius).max() <= 18e-3
    again, other = (
        tl.materials.Aggregates.random(0.28, [(2e-3, 0.4), (5e-3, 0.6)], STONE, seed=seed, gap=0.3e-3, cover=0.5e-3)
        for seed in (1, 2)
    )
    np.testing.assert_array_equal(again.spheres(WINDOW).x, drawn.x)
    assert not np.array_equal(other.spheres(WINDOW).x, drawn.x)


def test_cells_belong_to_the_stone_that_holds_their_centre():
    stones = tl.materials.Aggregates.from_centres([0.0, 6e-3], 0.0, [5e-3, 4e-3], [4e-3, 2e-3], STONE)
    spheres = stones.spheres(WINDOW)
    x = (np.arange(36) - 17.5) * 1e-3
    z = (np.arange(16) + 0.5) * 1e-3
    numbers = stones.numbers(spheres, x, x, z)
    assert set(np.unique(numbers)) == {0, 1, 2}
    assert (numbers == 1).sum() * 1e-9 == pytest.approx(4 / 3 * np.pi * 4e-3**3, rel=0.05)
    assert numbers[4, 18, 18] == 1
    assert numbers[3, 18, 24] == 2
    assert numbers[0, 0, 0] == 0


def test_voxels_are_stones_by_their_numbers():
    numbers = np.zeros((2, 3, 4), int)
    numbers[1, 1, 1:3] = 4
    stones = tl.materials.Aggregates.from_voxels(numbers, 1e-3, None)
    assert stones.scanned == ((2, 3, 4), (1e-3, 1e-3, 1e-3))
    np.testing.assert_array_equal(stones.numbers(None, None, None, None), numbers)
    assert "voids: 1 of them" in str(stones)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (
            lambda: tl.materials.Aggregates.random(1.2, [2e-3], STONE),
            "fraction of stones must lie in (0, 1), got 1.2",
        ),
        (lambda: tl.materials.Aggregates.random(0.3, [], STONE), "radii of stones must be a list"),
        (lambda: tl.materials.Aggregates.random(0.3, [-1e-3], STONE), "radius of a stone must be a positive number"),
        (lambda: tl.materials.Aggregates.random(0.3, [(2e-3, 0.4), (3e-3, 0.4)], STONE), "add up to 0.8"),
        (lambda: tl.materials.Aggregates.random(0.3, [(2e-3, 0.4), 3e-3], STONE), "all or none"),
        (lambda: tl.materials.Aggregates.random(0.3, [2e-3], STONE, gap=-1.0), "gap between stones must be"),
        (lambda: tl.materials.Aggregates.random(0.3, [2e-3], STONE, seed=-1), "seed of a packing"),
        (lambda: tl.materials.Aggregates.random(0.3, [2e-3], tl.Elastic(60e9, 0.7)), "poisson must lie in (-1, 0.5]"),
        (lambda: tl.materials.Aggregates.random(0.3, [2e-3], "granite"), "stones must be Elastic, or None for voids"),
        (lambda: tl.materials.Aggregates.from_centres([0, 1], [0, 1, 2], 1, 1, STONE), "as many x, y, z and radius"),
        (lambda: tl.materials.Aggregates.from_centres(0, 0, 1e-3, 2e-3, STONE), "rises out of the road"),
        (lambda: tl.materials.Aggregates.from_centres(0, 0, 1e-3, 0, STONE), "radius of a stone must be positive"),
        (
            lambda: tl.materials.Aggregates.from_centres([0, 3e-3], 0, 5e-3, 2e-3, STONE),
            "stones 1 and 2 by 1 mm; stones are solid: move them apart",
        ),
        (lambda: tl.materials.Aggregates.from_voxels(np.zeros((2, 2)), 1e-3, STONE), "array (nz, ny, nx)"),
        (lambda: tl.materials.Aggregates.from_voxels(np.zeros((2, 2, 2)), 1e-3, STONE), "hold no stone"),
        (lambda: tl.materials.Aggregates.from_voxels(np.full((2, 2, 2), 0.5), 1e-3, STONE), "whole numbers >= 0"),
        (
            lambda: tl.materials.Aggregates.from_voxels(np.ones((2, 2, 2)), 0.0, STONE),
            "spacing of voxels must be a positive",
        ),
        (
            lambda: tl.materials.Aggregates.random(0.3, [9e-3], STONE).spheres(WINDOW),
            "larger than the window of 36 x 36 x 16",
        ),
        (
            lambda: tl.materials.Aggregates.from_centres(16e-3, 0, 8e-3, 4e-3, STONE).spheres(WINDOW),
            "stone 1 reaches 2 mm beyond the window",
        ),
        (lambda: tl.materials.Aggregates.random(0.001, [4e-3], STONE).spheres(WINDOW), "less than half a stone"),
        (lambda: tl.materials.Aggregates.random(0.3, [1e-4], STONE).spheres(WINDOW), "more than 20000"),
        (
            lambda: tl.materials.Aggregates.random(0.5, [(2e-3, 0.4), (5e-3, 0.6)], STONE).spheres(WINDOW),
            "cannot be filled by drawing stones one by one",
        ),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(make, words):
    with pytest.raises(tl.InputError) as refused:
        make()
    assert words in str(refused.value)


def test_a_packing_that_cannot_be_reached_tells_how_far_it_came_and_a_fraction_that_can():
    with pytest.raises(tl.InputError) as refused:
        tl.materials.Aggregates.random(0.6, [4e-3], STONE).spheres(WINDOW)
    told = str(refused.value)
    reached = float(told.split("a fraction of ")[1].split(",")[0])
    advised = float(told.split("lower the fraction to ")[1].split(",")[0])
    assert 0.2 < reached < 0.38
    assert 0.9 * reached < advised < reached
    tl.materials.Aggregates.random(advised, [4e-3], STONE).spheres(WINDOW)
