"""Coarser and finer versions of a field: what a mean keeps, and what lies between cells."""

import numpy as np
import pytest

from treadload.contact.solvers.levels import halve, interpolate, refine

SHAPES = [(6, 8), (7, 8), (6, 9), (5, 3), (1, 4)]


@pytest.mark.parametrize("shape", SHAPES)
def test_halving_what_was_doubled_gives_it_back(shape):
    coarse = np.random.default_rng(1).normal(size=(-(-shape[0] // 2), -(-shape[1] // 2)))
    fine = coarse.repeat(2, axis=0).repeat(2, axis=1)[: shape[0], : shape[1]]
    np.testing.assert_allclose(halve(fine), coarse, rtol=1e-15)


def test_a_mean_of_four_cells():
    field = np.arange(24.0).reshape(4, 6)
    # Means of a plane are its values in the middle of four cells.
    np.testing.assert_array_equal(halve(field), [[3.5, 5.5, 7.5], [15.5, 17.5, 19.5]])
    # Each component on its own.
    both = np.stack([field, -2 * field])
    np.testing.assert_array_equal(halve(both), np.stack([halve(field), -2 * halve(field)]))
    np.testing.assert_allclose(refine(both, (8, 12)), np.stack([refine(one, (8, 12)) for one in both]), rtol=1e-15)


def test_cells_without_material_do_not_count_in_a_mean():
    field = np.array([[1.0, np.nan, np.nan, np.nan], [3.0, np.nan, np.nan, np.nan]])
    np.testing.assert_array_equal(halve(field), [[2.0, np.nan]])
    # The last row and column of an odd grid stand for themselves.
    np.testing.assert_array_equal(halve(np.array([[1.0, 3.0, 7.0]])), [[2.0, 7.0]])


def test_between_cells_a_plane_stays_a_plane():
    y, x = np.mgrid[:5, :7]
    fine = interpolate(2.0 * x - 3.0 * y + 1.0, np.ones((5, 7), bool), (10, 14))
    # Centres of the fine cells lie a quarter of a coarse one beside its centre.
    j, i = np.mgrid[:10, :14]
    plane = 2.0 * (i / 2 - 0.25) - 3.0 * (j / 2 - 0.25) + 1.0
    np.testing.assert_allclose(fine[1:-1, 1:-1], plane[1:-1, 1:-1], atol=1e-13)
    # At the border there is no other neighbour: the value is the cell's own along that axis.
    np.testing.assert_allclose(fine[0, 1:-1], plane[0, 1:-1] - 3.0 * 0.25, atol=1e-13)


@pytest.mark.parametrize("shape", SHAPES)
def test_unknown_cells_are_not_looked_at(shape):
    known = np.zeros((-(-shape[0] // 2), -(-shape[1] // 2)), bool)
    known[:, :2] = True
    fine = interpolate(np.where(known, 7.0, 1e9), known, shape)
    assert fine.shape == shape
    # Next to known cells all weight is theirs; further away nothing is known.
    np.testing.assert_allclose(fine[:, :5], 7.0, rtol=1e-14)
    assert not fine[:, 5:].any()


@pytest.mark.parametrize("shape", SHAPES)
def test_refining_is_interpolation_between_cells_that_are_all_known(shape):
    coarse = np.random.default_rng(4).normal(size=(-(-shape[0] // 2), -(-shape[1] // 2)))
    np.testing.assert_allclose(
        refine(coarse, shape), interpolate(coarse, np.ones_like(coarse, bool), shape), atol=1e-15
    )
    assert refine(coarse.astype(np.float32), shape).dtype == np.float32
