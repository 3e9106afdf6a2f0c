"""What the stress of any load must obey: superposition, mirrors, quarter turns, equilibrium."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from half_space import stress_at_points, stress_on_cells

SHAPE = (5, 4)
# Sums of twenty loads of up to one: round-off.
ROUND_OFF = {"rtol": 0, "atol": 1e-12}

loads = arrays(float, (3, *SHAPE), elements=st.floats(-1, 1))
depths = st.sampled_from([0.0, 0.01, 0.5, 3.0])
ratios = st.floats(0, 0.5)
spacings = st.floats(0.3, 3)


def field(load, depth, ratio, dx=1.0, dy=1.0):
    return stress_on_cells(load, dx, dy, np.array([depth]), ratio)[0]


@settings(max_examples=50, deadline=None)
@given(loads, loads, st.floats(-3, 3), depths, ratios, spacings)
def test_superposition(one, other, factor, depth, ratio, dy):
    whole = field(one + factor * other, depth, ratio, dy=dy)
    parts = field(one, depth, ratio, dy=dy) + factor * field(other, depth, ratio, dy=dy)
    np.testing.assert_allclose(whole, parts, **ROUND_OFF)


@settings(max_examples=50, deadline=None)
@given(loads, depths, ratios, spacings)
def test_mirror_along_x(load, depth, ratio, dy):
    mirrored = load[:, :, ::-1] * np.array([1, -1, 1])[:, None, None]
    sign = np.array([1, 1, 1, -1, -1, 1])[:, None, None]
    expected = field(load, depth, ratio, dy=dy)[:, :, ::-1] * sign
    np.testing.assert_allclose(field(mirrored, depth, ratio, dy=dy), expected, **ROUND_OFF)


@settings(max_examples=50, deadline=None)
@given(loads, depths, ratios, spacings)
def test_mirror_along_y(load, depth, ratio, dy):
    mirrored = load[:, ::-1] * np.array([1, 1, -1])[:, None, None]
    sign = np.array([1, 1, 1, -1, 1, -1])[:, None, None]
    expected = field(load, depth, ratio, dy=dy)[:, ::-1] * sign
    np.testing.assert_allclose(field(mirrored, depth, ratio, dy=dy), expected, **ROUND_OFF)


@settings(max_examples=50, deadline=None)
@given(loads, depths, ratios, spacings)
def test_swap_of_x_and_y(load, depth, ratio, dy):
    swapped = load[[0, 2, 1]].transpose(0, 2, 1)
    expected = field(load, depth, ratio, dx=1.0, dy=dy)[[1, 0, 2, 3, 5, 4]].transpose(0, 2, 1)
    np.testing.assert_allclose(field(swapped, depth, ratio, dx=dy, dy=1.0), expected, **ROUND_OFF)


@settings(max_examples=50, deadline=None)
@given(loads, depths, ratios, spacings)
def test_quarter_turn(load, depth, ratio, dy):
    # From x to y: the new x axis is the old -y; a vector (a, b) becomes (-b, a).
    turned = np.stack([load[0].T, -load[2].T, load[1].T])[:, :, ::-1]
    xx, yy, zz, xy, xz, yz = field(load, depth, ratio, dx=1.0, dy=dy)
    expected = np.stack([yy.T, xx.T, zz.T, -xy.T, -yz.T, xz.T])[:, :, ::-1]
    np.testing.assert_allclose(field(turned, depth, ratio, dx=dy, dy=1.0), expected, **ROUND_OFF)


@settings(max_examples=25, deadline=None)
@given(loads, ratios, st.floats(0.5, 2))
def test_equilibrium_inside(load, ratio, depth):
    # Central differences on a stencil of step h around a point between the cells.
    h = 1e-3
    stress = stress_at_stencil(load, depth, ratio, h)
    d_x, d_y, d_z = ((stress[k, 1] - stress[k, 0]) / (2 * h) for k in range(3))
    force = [d_x[0] + d_y[3] + d_z[4], d_x[3] + d_y[1] + d_z[5], d_x[4] + d_y[5] + d_z[2]]
    # h² / 6 times third derivatives, which half a cell below the surface stay under 100 for twenty loads of one.
    np.testing.assert_allclose(force, 0, atol=2e-5)


def stress_at_stencil(load, depth, ratio, h):
    """(3 axes, 2 sides, 6)."""
    x, y = 1.3, 2.2
    at = np.array([depth - h, depth, depth + h])
    field = stress_at_points(
        load, 1.0, 1.0, at, ratio, x + h * np.array([-1, 1, 0, 0, 0]), y + h * np.array([0, 0, -1, 1, 0])
    )
    return np.array([field[1, :, [0, 1]], field[1, :, [2, 3]], field[[0, 2], :, 4]])
