"""Gross sliding: pole and torque of patches whose answer is known, and laws of the ellipse."""

import numpy as np
import pytest

from sliding import sliding_shear
from treadload.contact.solvers.rolling import rigid_slip
from treadload.contact.solvers.sliding import sliding_pole, sliding_torque

X, Y = np.linspace(-0.3, 0.5, 81), np.linspace(-0.2, 0.4, 61)


def disc(x0, y0, radius):
    return np.where(np.hypot(X[None] - x0, Y[:, None] - y0) < radius, 1e5, 0.0)


@pytest.mark.parametrize("axes", [(1.0, 1.0), (1.25, 0.8)])
@pytest.mark.parametrize("centre", [(0.0, 0.0), (0.2, 0.1), (-0.1, 0.15)])
def test_a_symmetric_patch_turns_about_its_middle_wherever_it_stands(centre, axes):
    pole = sliding_pole(disc(*centre, 0.1523), X, Y, axes)
    # No cell lies on the rim, so that the sum is symmetric: to the tolerance of the iteration.
    assert pole == pytest.approx(centre, abs=1e-6)


def test_the_pole_of_two_unequal_patches_lies_in_the_larger():
    """A weighted median: with more than half of all friction in one small place, no other point does better."""
    bound = np.zeros((Y.size, X.size))
    bound[20, 30], bound[50, 70] = 3.0, 1.0
    pole = sliding_pole(bound, X, Y)
    # Under the pole the arm has half a cell's length at least: a cell away at most.
    assert pole == pytest.approx((X[30], Y[20]), abs=0.01)


def test_the_pole_takes_the_least_torque():
    bound = disc(0.2, 0.1, 0.1) + 2.0 * disc(-0.1, 0.0, 0.12)
    for axes in ((1.0, 1.0), (1.4, 1 / 1.4)):
        x0, y0 = sliding_pole(bound, X, Y, axes)
        least = sliding_torque(bound, X, Y, 1e-4, (x0, y0), axes)
        for angle in np.linspace(0, 2 * np.pi, 8, endpoint=False):
            other = (x0 + 0.03 * np.cos(angle), y0 + 0.03 * np.sin(angle))
            assert sliding_torque(bound, X, Y, 1e-4, other, axes) > least


def test_the_torque_is_what_the_shear_of_a_turn_gives():
    bound, pole, area = disc(0.1, 0.05, 0.15), (0.02, -0.03), 1e-4
    for axes in ((1.0, 1.0), (1.25, 0.8)):
        arm = np.stack(np.broadcast_arrays(pole[1] - Y[:, None], X[None] - pole[0]))
        shear = sliding_shear(bound, arm, axes)
        # Shear opposes the slip in every cell, and fills the ellipse.
        assert (shear * arm).sum(0).max() <= 0
        size = np.hypot(shear[0] / axes[0], shear[1] / axes[1])
        np.testing.assert_allclose(size[bound > 0], bound[bound > 0], rtol=1e-12)
        moment = ((X[None] - pole[0]) * shear[1] - (Y[:, None] - pole[1]) * shear[0]).sum() * area
        assert sliding_torque(bound, X, Y, area, pole, axes) == pytest.approx(-moment, rel=1e-12)


def test_slip_on_the_ellipse_is_its_normal():
    """The associated rule: of all shears that friction allows, the one that opposes slip takes the most power."""
    axes, slip = (1.5, 1 / 1.5), np.array([0.3, -0.8]).reshape(2, 1, 1)
    power = float((sliding_shear(np.full((1, 1), 2.0), slip, axes) * slip).sum())
    angle = np.linspace(0, 2 * np.pi, 3601)
    every = 2.0 * (axes[0] * np.cos(angle) * slip[0, 0, 0] + axes[1] * np.sin(angle) * slip[1, 0, 0])
    # The nearest of 3600 directions is within (π/3600)²/2 of the best.
    assert power == pytest.approx(every.min(), rel=1e-6)


def test_nothing_slides_without_friction():
    assert sliding_pole(np.zeros((Y.size, X.size)), X, Y) == (0.0, 0.0)
    assert not sliding_shear(np.ones((2, 2)), np.zeros((2, 2, 2))).any()


def test_one_row_of_cells_has_a_pole():
    assert sliding_pole(np.ones((1, X.size)), X, np.zeros(1)) == pytest.approx((X.mean(), 0.0), abs=1e-6)


def test_rigid_slip_is_that_of_a_turning_body():
    """Rolling with creepage and spin is a turn about one point: there slip vanishes, and it grows with distance."""
    x, y, dx, spin = X, Y, 0.01, 0.4
    slip = rigid_slip(x, y, dx, (0.02, -0.03), spin)
    # Velocity of a body that turns about z (down): (-ω y, ω x); spin is taken a sixth of a cell ahead.
    pole = (0.03 / spin - dx / 6, 0.02 / spin)
    distance = np.hypot(x[None] - pole[0], y[:, None] - pole[1])
    np.testing.assert_allclose(np.hypot(*slip), spin * distance, rtol=1e-12)
    turn = (x[None] - pole[0]) * slip[1] - (y[:, None] - pole[1]) * slip[0]
    assert (turn > 0).all()
