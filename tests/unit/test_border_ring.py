"""No larger value hides between the end of a map and the basin: random wheels on random roads, point by point.

The witness evaluates every 6 mm from 0.1 m before the loads to 0.1 m behind them, without the border rule.
"""

import numpy as np
import pytest

from treadload import assess
from treadload.damage import Criterion, FatigueLine
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad, solve_response

LINE = FatigueLine(100e-6, -0.2)
SURFACE = Criterion("surface", LINE, place="top")
CELL, BESIDE, CUBE = 12e-3, 0.1, 10e-3


def random_road(draw):
    """One material, or one or two courses on a soil."""
    layers = [
        Layer(Elastic(draw.uniform(1.5e9, 12e9), draw.uniform(0.2, 0.4)), draw.uniform(0.04, 0.12))
        for _ in range(draw.integers(3))
    ]
    modulus = draw.uniform(40e6, 400e6) if layers else draw.uniform(1e9, 8e9)
    return Pavement([*layers, Layer(Elastic(modulus, draw.uniform(0.25, 0.45)))])


def random_wheel(draw):
    """Flat, smooth or ribbed, pushed any way by up to 0.7 of its pressure and sheared outward by up to 0.3."""
    count_x, count_y = draw.integers(10, 16), draw.integers(10, 18)
    grid = Grid(count_x, count_y, CELL, CELL, -(count_x - 1) / 2 * CELL, -(count_y - 1) / 2 * CELL)
    x, y = np.meshgrid(grid.x, grid.y)
    empty = draw.integers(3)
    half_x, half_y = (count_x / 2 - empty) * CELL, (count_y / 2 - empty) * CELL
    kind = draw.integers(3)
    if kind == 0:
        pressure = ((np.abs(x) < half_x) & (np.abs(y) < half_y)).astype(float)
    else:
        pressure = np.maximum(1 - (x / half_x) ** 4, 0) * np.maximum(1 - (y / half_y) ** 4, 0)
    if kind == 2:
        pressure *= np.arange(count_y)[:, None] % draw.integers(3, 6) > 0
    pressure *= draw.uniform(0.5e6, 1.2e6)
    share, angle, outward = draw.uniform(0, 0.7), draw.uniform(0, 2 * np.pi), draw.uniform(0, 0.3)
    aside = share * np.sin(angle) + outward * np.sin(np.pi * y / half_y / draw.uniform(0.5, 1))
    return GridLoad(grid, pressure, share * np.cos(angle) * pressure, aside * pressure)


def random_map(draw, grid):
    """Of which each end lies 30 mm inside the cells to 60 mm beyond them."""
    step, ends = draw.uniform(6e-3, CUBE), draw.uniform(-0.03, 0.06, 4)
    return (
        np.arange(grid.x[0] - ends[0], grid.x[-1] + ends[1], step),
        np.arange(grid.y[0] - ends[2], grid.y[-1] + ends[3], step),
    )


def evaluated(loads, road, x, y):
    """The largest value of a field without the border rule."""
    return float(SURFACE.read(solve_response(loads, road, depths=[0.0], x=x, y=y, mean_over=CUBE).dataset).max())


def compare(loads, road, x, y):
    verdict = assess(solve_response(loads, road, depths=[0.0], x=x, y=y), LINE).dataset
    strain = float(verdict["worst_strain"])
    lattice = [
        np.arange(
            min(float(getattr(load.grid, axis)[0]) for load in loads) - BESIDE,
            max(float(getattr(load.grid, axis)[-1]) for load in loads) + BESIDE,
            CELL / 2,
        )
        for axis in ("x", "y")
    ]
    assert strain >= 0.99 * evaluated(loads, road, *lattice)
    # And it is a value of the field, not of an interpolation.
    place = (np.array([float(verdict[name])]) for name in ("worst_x", "worst_y"))
    assert strain == pytest.approx(evaluated(loads, road, *place), rel=1e-3)


def seeds(first, fast, last):
    """Some in every run of the tests, the others among the slow ones."""
    slow = [pytest.param(number, marks=pytest.mark.slow) for number in range(first + fast, last)]
    return [*range(first, first + fast), *slow]


@pytest.mark.parametrize("seed", seeds(0, 5, 60))
def test_a_map_hides_no_larger_value_around_its_wheel(seed):
    draw = np.random.default_rng(seed)
    road, wheel = random_road(draw), random_wheel(draw)
    compare([wheel], road, *random_map(draw, wheel.grid))


@pytest.mark.parametrize("seed", seeds(100, 1, 115))
def test_a_map_around_a_wheel_does_not_hide_its_neighbour(seed):
    draw = np.random.default_rng(seed)
    road, wheel, neighbour = random_road(draw), random_wheel(draw), random_wheel(draw)
    apart = wheel.grid.y[-1] - neighbour.grid.y[0] + draw.uniform(0.02, 0.25)
    further = draw.uniform(-0.1, 0.1)
    placed = neighbour.moved(x=CELL * round(further / CELL), y=CELL * round(apart / CELL))
    compare([wheel, placed], road, *random_map(draw, wheel.grid))
