"""Grid: its cells, its middle, its refusals."""

import math

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.grid import Grid


@pytest.mark.parametrize(
    ("length", "width", "dx", "dy"), [(0.1, 0.2, 3e-3, None), (0.012, 0.012, 3e-3, 4e-3), (1, 1, 3, 3)]
)
def test_centred_covers_with_the_fewest_cells(length, width, dx, dy):
    grid = Grid.centred(length, width, dx, dy)
    dy = dx if dy is None else dy
    assert grid.nx * dx >= length * (1 - 1e-8) > (grid.nx - 1) * dx
    assert grid.ny * dy >= width * (1 - 1e-8) > (grid.ny - 1) * dy
    assert grid.x.mean() == pytest.approx(0, abs=1e-15)
    assert grid.y.mean() == pytest.approx(0, abs=1e-15)
    assert grid.shape == (grid.y.size, grid.x.size)
    assert grid.cell_area == pytest.approx(dx * dy)


def test_grids_on_the_lattice_share_their_places():
    small, large = Grid.on_lattice(0.101, 0.05, 3e-3), Grid.on_lattice(0.32, 0.061, 3e-3, 1e-3)
    for grid, length, width in ((small, 0.101, 0.05), (large, 0.32, 0.061)):
        # Two cells more than the smallest grid would be one too many on each side.
        assert grid.nx * grid.dx >= length > (grid.nx - 2) * grid.dx
        assert grid.ny * grid.dy >= width > (grid.ny - 2) * grid.dy
        for places, step in ((grid.x, grid.dx), (grid.y, grid.dy)):
            # To the last digit: mirror images and equal places are the same numbers.
            assert places[places.size // 2] == 0.0
            assert (places == -places[::-1]).all()
            assert (places == step * np.arange(-(places.size // 2), places.size // 2 + 1)).all()
    assert set(small.x) <= set(large.x)


def test_a_lattice_survives_sums_and_only_a_lattice_is_snapped():
    at = Grid.on_lattice(0.3, 0.3, 3e-3)
    moved = Grid(at.nx, at.ny, at.dx, at.dy, at.x0 + 0.1 + 0.2 - 0.3, 0.1 + 0.2 - 0.3)
    assert (moved.x == at.x).all()
    off = Grid(4, 4, 3e-3, 3e-3, 1e-3, 1e-3)
    assert (off.x == 1e-3 + 3e-3 * np.arange(4)).all()


def test_coordinates_are_cell_centres():
    grid = Grid(3, 2, 0.5, 0.25, -1.0, 2.0)
    np.testing.assert_allclose(grid.x, [-1.0, -0.5, 0.0])
    np.testing.assert_allclose(grid.y, [2.0, 2.25])
    assert str(grid) == "3 x 2 cells of 500 x 250 mm"
    assert grid == Grid(3, 2, 0.5, 0.25, -1.0, 2.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((0, 2, 1.0, 1.0, 0.0, 0.0), "at least one cell"),
        ((2, -1, 1.0, 1.0, 0.0, 0.0), "at least one cell"),
        ((2, 2, 0.0, 1.0, 0.0, 0.0), "dx"),
        ((2, 2, 1.0, math.nan, 0.0, 0.0), "dy"),
        ((2, 2, 1.0, 1.0, math.inf, 0.0), "origin"),
    ],
)
def test_refusals(arguments, message):
    with pytest.raises(InputError, match=message):
        Grid(*arguments)


@pytest.mark.parametrize("arguments", [(0.0, 1.0, 0.1), (1.0, -1.0, 0.1), (1.0, 1.0, 0.0), (1.0, math.nan, 0.1)])
def test_centred_refusals(arguments):
    with pytest.raises(InputError, match="positive"):
        Grid.centred(*arguments)
