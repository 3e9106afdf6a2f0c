"""Rates at which the surface stress of cells approaches that of smooth shear: one at centres, two between them."""

import numpy as np
import pytest

from half_space import stress_on_grid

CELLS = (20, 40, 80)


def strip(n, between):
    """Position, shear, found and exact surface stress_xx for q_x = (1 - x²)^(3/2) on a strip long in y.

    Plane strain: stress_xx = -(2/π) PV ∫ q(s)/(x - s) ds = -(3 x - 2 x³) inside, by Chebyshev polynomials.
    """
    dx = 2 / n
    centres = -1 + dx * (np.arange(n) + 0.5)
    t, weight = np.polynomial.legendre.leggauss(20)
    points = centres[:, None] + dx / 2 * t
    load = np.zeros((3, 1, n))
    load[1, 0] = ((1 - points**2) ** 1.5 * weight / 2).sum(axis=1)
    x = centres[:-1] + dx / 2 if between else centres
    # A strip 10⁴ long: the far ends change the field by 1e-8.
    stress, _ = stress_on_grid(load, dx, 1e4, np.array([0.0]), 0.35, x - centres[0], np.array([0.0]))
    return x, load[1, 0], stress[0, :, 0], -(3 * x - 2 * x**3)


@pytest.mark.parametrize(("between", "rate"), [(False, 1), (True, 2)])
def test_rate_of_the_surface_stress(between, rate):
    errors = []
    for n in CELLS:
        _, _, stress, exact = strip(n, between)
        errors.append(np.abs(stress[0] - exact).max())
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    # 0.2 for the ends of the strip, where the third derivative of the load is unbounded.
    assert np.abs(rates - rate).max() < 0.2


def test_the_first_order_error_is_the_documented_one():
    n = 80
    x, shear, stress, exact = strip(n, between=False)
    step = np.gradient(shear)
    inner = np.abs(x) < 0.8
    error = (stress[0] - exact)[inner]
    # The rest is of second order: measured 3 % of the first-order error at 80 cells.
    np.testing.assert_allclose(error, -2 / np.pi * np.log(2) * step[inner], atol=0.04 * np.abs(error).max())


def test_the_shear_itself_is_exact_at_centres():
    _, shear, stress, _ = strip(20, between=False)
    np.testing.assert_array_equal(stress[4], -shear)
