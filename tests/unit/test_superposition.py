"""Loads on one lattice as one load: the same response, and only where little ground lies between."""

import numpy as np
import pytest

from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad, UniformDisc, dual_wheels, solve_response, tandem
from treadload.response.superposition import common_grid, merged

CELL = 0.01
LAYERS = Pavement([Layer(Elastic(3e9, 0.35), 0.05), Layer(Elastic(1e8, 0.4))])


def wheel(interpolation="constant", seed=0):
    pressure, along, across = np.random.default_rng(seed).random((3, 9, 12))
    return GridLoad(Grid(12, 9, CELL, CELL, -0.055, -0.04), pressure, along, across - 0.5, interpolation)


def test_dual_wheels_become_one_load():
    wheels = dual_wheels(wheel(), 12 * CELL)
    (one,) = merged(wheels)
    assert one.grid.shape == (21, 12)
    assert one.grid == common_grid(wheels)
    np.testing.assert_array_equal(one.array[:, :9], wheel().array)
    np.testing.assert_array_equal(one.array[:, 12:], wheel().array)
    assert not one.array[:, 9:12].any()


def test_loads_on_each_other_add_up():
    (one,) = merged([wheel(), wheel(seed=1).moved(-2 * CELL, CELL)])
    assert one.grid.shape == (10, 14)
    assert one.grid.x0 == pytest.approx(-0.075)
    assert one.normal_load == pytest.approx(wheel().normal_load + wheel(seed=1).normal_load)
    assert one.array[1, 5, 6] == wheel().array[1, 5, 4] + wheel(seed=1).array[1, 4, 6]


@pytest.mark.parametrize(
    "loads",
    [
        tandem(wheel(), 1.35),
        dual_wheels(wheel(), 12.4 * CELL),
        [wheel(), wheel("bilinear")],
        [wheel(), GridLoad(Grid(6, 9, 2 * CELL, CELL, -0.055, -0.04), np.ones((9, 6)))],
        [wheel(), UniformDisc(0.1, 7e5)],
    ],
    ids=["far", "between cells", "other interpolation", "other cells", "a disc"],
)
def test_others_stay_apart(loads):
    kept = merged(loads)
    assert len(kept) == 2
    assert {id(load) for load in kept} == {id(load) for load in loads}


@pytest.mark.parametrize("road", [Pavement.half_space(Elastic(2e9, 0.35)), LAYERS], ids=["half-space", "layers"])
@pytest.mark.parametrize("interpolation", ["constant", "bilinear"])
def test_the_response_is_the_sum_of_the_wheels_own(road, interpolation):
    x, y, depths = np.array([-0.03, 0.013, 0.2]), np.array([-0.06, 0.0171]), [0.0, 0.02, 0.08]
    wheels = dual_wheels(wheel(interpolation), 12 * CELL)
    whole = solve_response(wheels, road, depths=depths, x=x, y=y).dataset
    parts = [solve_response(one, road, depths=depths, x=x, y=y).dataset for one in wheels]
    for name in ("stress_xx", "stress_xz", "strain_yy", "strain_xy", "displacement_z", "displacement_x"):
        total = sum(part[name] for part in parts)
        # Waves and interpolation; the issue asks for 1e-8 of the largest value.
        np.testing.assert_allclose(whole[name], total, atol=1e-8 * float(np.abs(total).max()), rtol=0)
