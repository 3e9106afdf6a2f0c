"""What the response to loads must obey: sums, places and mirrors, on one material and on layers."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import Bond, Layer, Pavement
from treadload.response import GridLoad, UniformDisc, UniformRectangle, axle, dual_wheels, solve_response

HALF_SPACE = Pavement.half_space(Elastic(2e9, 0.3))
LAYERS = Pavement([Layer(Elastic(2e9, 0.35), 0.06, bond=Bond(stiffness=1e10)), Layer(Elastic(1e8, 0.4))])
GRID = Grid(4, 3, 0.01, 0.012, -0.015, 0.02)
X, Y = np.array([-0.02, 0.003, 0.05]), np.array([0.0, 0.02, 0.037])
DEPTHS = [0.0, 0.02]
# Of loads of one: round-off of the closed forms; of the layers, round-off of 1e4 wavenumbers.
ROUND_OFF = 1e-11
NAMES = ("stress_xx", "stress_yy", "stress_zz", "stress_xy", "stress_xz", "stress_yz")
# Components that are odd in y.
ODD = np.array([1, 1, 1, -1, 1, -1])[:, None, None, None]

tractions = arrays(float, (3, *GRID.shape), elements=st.floats(0, 1))
interpolations = st.sampled_from(["constant", "bilinear"])
roads = pytest.mark.parametrize("road", [HALF_SPACE, LAYERS], ids=["half-space", "layers"])


def stress(loads, road, x=X, y=Y):
    data = solve_response(loads, road, depths=DEPTHS, x=x, y=y).dataset
    return np.stack([data[name] for name in NAMES])


def grid_load(values, interpolation):
    pressure, along, across = values
    return GridLoad(GRID, pressure, along - 0.5, across - 0.5, interpolation=interpolation)


@roads
@settings(max_examples=5, deadline=None)
@given(tractions, tractions, interpolations)
def test_a_sum_of_loads_is_the_load_of_the_sums(road, one, other, interpolation):
    first, second = grid_load(one, interpolation), grid_load(other, interpolation)
    pressure, along, across = first.array + second.array
    whole = replace(first, pressure=pressure, traction_x=along, traction_y=across)
    np.testing.assert_allclose(stress([first, second], road), stress(whole, road), atol=ROUND_OFF)


@roads
@settings(max_examples=5, deadline=None)
@given(tractions, interpolations, st.floats(-0.1, 0.1), st.floats(-0.1, 0.1))
def test_a_moved_load_moves_its_response(road, values, interpolation, x, y):
    load = grid_load(values, interpolation)
    moved = stress(load.moved(x, y), road, X + x, Y + y)
    # Coordinates of up to 0.2 m rounded near logarithms.
    np.testing.assert_allclose(moved, stress(load, road), atol=10 * ROUND_OFF)


@roads
@settings(max_examples=5, deadline=None)
@given(tractions, interpolations)
def test_a_mirrored_load_mirrors_its_response(road, values, interpolation):
    load = grid_load(values, interpolation)
    image = stress(load.mirrored(), road, X, -Y)
    np.testing.assert_allclose(image, ODD * stress(load, road), atol=ROUND_OFF)


@roads
def test_other_loads_move_and_mirror_alike(road):
    for load in (UniformDisc(0.031, 1.0, 0.01, 0.02), UniformRectangle(0.04, 0.03, 1.0, 0.01, 0.02, -0.4, 0.3)):
        alone = stress(load, road)
        np.testing.assert_allclose(stress(load.moved(0.3, -0.2), road, X + 0.3, Y - 0.2), alone, atol=1e-11)
        np.testing.assert_allclose(stress(load.mirrored(), road, X, -Y), ODD * alone, atol=ROUND_OFF)


@roads
def test_wheels_of_an_axle_add_up(road):
    wheel = GridLoad(
        GRID, np.arange(12.0).reshape(3, 4) / 12, traction_y=np.ones((3, 4)) / 3, interpolation="bilinear"
    )
    together = stress(axle(wheel, 0.4, 0.15), road)
    right = [stress(load.moved(y=0.2), road) for load in dual_wheels(wheel, 0.15)]
    left = [ODD * stress(load.moved(y=0.2), road, X, -Y) for load in dual_wheels(wheel, 0.15)]
    np.testing.assert_allclose(together, sum(right + left), atol=ROUND_OFF)


def test_bilinear_on_layers_of_one_material_is_the_half_space():
    """Two layers hardly different: the waves of the split against the closed form alone, at all depths."""
    load = grid_load(np.random.default_rng(1).random((3, *GRID.shape)), "bilinear")
    same = Pavement([Layer(Elastic(2e9, 0.3), 0.05), Layer(Elastic(2e9 * (1 + 1e-13), 0.3))])
    at = {"depths": [0.0, 0.004, 0.04, 0.05, 0.2], "x": X, "y": Y}
    layered, closed = (solve_response(load, road, **at) for road in (same, HALF_SPACE))
    assert layered.stats["method"].startswith("layered+")
    for name in (*NAMES, "displacement_x", "displacement_z"):
        size = float(abs(closed.dataset[name]).max())
        # The bound of the half-space limit, 1e-8 of the largest value.
        np.testing.assert_allclose(layered.dataset[name], closed.dataset[name], atol=1e-8 * size)


def test_bilinear_on_layers_is_the_average_of_uniform_cells_over_one():
    load = grid_load(np.random.default_rng(3).random((3, *GRID.shape)), "bilinear")
    t, w = np.polynomial.legendre.leggauss(10)
    x, y = 0.004, 0.03
    # One point in the top layer, where the closed form takes part, one below.
    at = {"depths": [0.02, 0.09]}
    found = solve_response(load, LAYERS, **at, x=x, y=y).dataset
    cells = solve_response(
        replace(load, interpolation="constant"), LAYERS, **at, x=x + GRID.dx * t / 2, y=y + GRID.dy * t / 2
    ).dataset
    for name in (*NAMES, "displacement_x", "displacement_y", "displacement_z"):
        mean = np.einsum("zji,j,i->z", cells[name], w / 2, w / 2)
        size = float(abs(cells[name]).max())
        # Round-off: ten points a side resolve a cell half as wide as the point is deep; 3e-13 measured.
        np.testing.assert_allclose(found[name].to_numpy().ravel(), mean, atol=1e-11 * size)
