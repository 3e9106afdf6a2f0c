"""solve_normal: prescribed load or approach, missing material, starts, and what it raises."""

import numpy as np
import pytest

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import solve_normal
from treadload.errors import ConvergenceError, GeometryError
from treadload.kernels.half_space.rectangle import CombinedElasticity

BODIES = CombinedElasticity(1e6, 0.4, 0.0)
N, DX = 40, 2e-3
X = DX * (np.arange(N) - (N - 1) / 2)
INFLUENCE = Influence((N, N), DX, DX, HalfSpaces(BODIES))
DOME = (X[None, :] ** 2 + X[:, None] ** 2) / (2 * 0.3)
LOAD = 200.0


def test_load_and_approach_are_two_ways_to_ask_the_same():
    by_load = solve_normal(INFLUENCE, DOME, load=LOAD, tolerance=1e-9)
    assert by_load.pressure.sum() * DX**2 == pytest.approx(LOAD, rel=1e-12)
    by_approach = solve_normal(INFLUENCE, DOME, approach=by_load.approach, tolerance=1e-9)
    np.testing.assert_allclose(by_approach.pressure, by_load.pressure, atol=1e-6 * by_load.pressure.max())
    assert by_approach.approach == by_load.approach


def test_the_gap_after_loading_is_that_of_the_pressure():
    found = solve_normal(INFLUENCE, DOME, load=LOAD)
    expected = DOME + INFLUENCE.normal(found.pressure) - found.approach
    np.testing.assert_allclose(found.gap, expected, atol=1e-12)
    assert found.residual <= 1e-6


def test_a_gap_counts_from_any_level():
    one = solve_normal(INFLUENCE, DOME, load=LOAD, tolerance=1e-9)
    two = solve_normal(INFLUENCE, DOME + 0.7, load=LOAD, tolerance=1e-9)
    assert two.approach - one.approach == pytest.approx(0.7, abs=1e-9)
    np.testing.assert_allclose(two.pressure, one.pressure, atol=1e-6 * one.pressure.max())


def test_cells_without_material_carry_no_pressure_and_have_no_gap():
    gap = DOME.copy()
    gap[15:20, 10:30] = np.nan
    found = solve_normal(INFLUENCE, gap, load=LOAD)
    assert (found.pressure[np.isnan(gap)] == 0).all()
    np.testing.assert_array_equal(np.isnan(found.gap), np.isnan(gap))
    assert found.pressure.sum() * DX**2 == pytest.approx(LOAD, rel=1e-12)
    assert found.approach > solve_normal(INFLUENCE, DOME, load=LOAD).approach


@pytest.mark.parametrize("start", [np.ones((N, N)), np.zeros((N, N)), np.eye(N)])
def test_any_start_leads_to_the_same(start):
    nested = solve_normal(INFLUENCE, DOME, load=LOAD, tolerance=1e-9)
    found = solve_normal(INFLUENCE, DOME, load=LOAD, start=start, tolerance=1e-9)
    np.testing.assert_allclose(found.pressure, nested.pressure, atol=1e-6 * nested.pressure.max())


@pytest.mark.parametrize("shape", [(1, 1), (1, 30), (30, 1), (2, 3), (25, 49), (61, 24)])
def test_any_shape_of_grid(shape):
    ny, nx = shape
    x, y = DX * (np.arange(nx) - (nx - 1) / 2), DX * (np.arange(ny) - (ny - 1) / 2)
    found = solve_normal(
        Influence(shape, DX, DX, HalfSpaces(BODIES)), (x[None] ** 2 + y[:, None] ** 2) / 0.6, load=10.0
    )
    assert found.pressure.shape == shape
    assert found.pressure.sum() * DX**2 == pytest.approx(10.0, rel=1e-12)


def test_a_flat_punch_touches_everywhere_and_peaks_at_its_edge():
    flat = np.full((N, N), np.nan)
    flat[10:30, 10:30] = 0.0
    found = solve_normal(INFLUENCE, flat, load=LOAD)
    inside = found.pressure[10:30, 10:30]
    assert (inside > 0).all()
    assert inside.argmax() in (0, 19, 380, 399)
    assert inside.min() == inside[9:11, 9:11].min()


def test_nothing_to_press_with():
    with pytest.raises(GeometryError, match="no cell of the height map has material"):
        solve_normal(INFLUENCE, np.full((N, N), np.nan), load=1.0)


def test_it_says_how_far_it_came():
    # 1e-18 of the approach is below round-off: no solver gets there.
    with pytest.raises(ConvergenceError, match="residual") as caught:
        solve_normal(INFLUENCE, DOME, load=LOAD, tolerance=1e-18)
    assert 0 < caught.value.residual < 1e-9
    assert f"{caught.value.residual:.2e}" in str(caught.value)


def test_the_residual_is_that_of_a_product_in_double_precision():
    """Corrections are found in single precision, which alone would end near 1e-7 of the approach."""
    for tolerance in (1e-6, 1e-9):
        found = solve_normal(INFLUENCE, DOME, load=LOAD, tolerance=tolerance)
        gap = DOME + INFLUENCE.normal(found.pressure) - found.approach
        violation = max(np.abs(gap[found.pressure > 0]).max(), -gap.min(), 0.0)
        assert violation / (found.approach - DOME.min()) == pytest.approx(found.residual, rel=1e-3, abs=1e-14)
        assert found.residual <= tolerance


def test_a_start_that_lacks_a_contact_far_away_finds_it():
    """The search is confined to where contact is; what a start does not know must widen it."""
    two = np.minimum(DOME, (X[None, :] - 0.025) ** 2 / 0.02 + (X[:, None] + 0.03) ** 2 / 0.02 + 2e-4)
    alone = solve_normal(INFLUENCE, DOME, load=LOAD, tolerance=1e-9).pressure
    found = solve_normal(INFLUENCE, two, load=LOAD, start=alone, tolerance=1e-9)
    nested = solve_normal(INFLUENCE, two, load=LOAD, tolerance=1e-9)
    assert (found.pressure[X < -0.025, :][:, X > 0.02] > 0).any()
    np.testing.assert_allclose(found.pressure, nested.pressure, atol=1e-6 * nested.pressure.max())


def test_a_grid_larger_than_the_contact_changes_nothing():
    large = Influence((3 * N, 2 * N), DX, DX, HalfSpaces(BODIES))
    gap = np.full(large.shape, np.nan)
    gap[N : 2 * N, N // 2 : N // 2 + N] = DOME
    found, alone = (solve_normal(at, h, load=LOAD, tolerance=1e-9) for at, h in ((large, gap), (INFLUENCE, DOME)))
    assert found.approach == pytest.approx(alone.approach, rel=1e-8)
    inside = found.pressure[N : 2 * N, N // 2 : N // 2 + N]
    np.testing.assert_allclose(inside, alone.pressure, atol=1e-6 * alone.pressure.max())
