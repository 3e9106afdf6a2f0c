"""Bounds of the response: extents, sentences and cells, each against what they stand for."""

import json
import re

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.response import GridLoad, UniformDisc
from treadload.response.fields import layer_in_words
from treadload.response.moving import _cells_of_disc, _hats
from treadload.response.superposition import merged

THIN = Pavement([Layer(Elastic(5e9, 0.35), 1e-3), Layer(Elastic(1e8, 0.35))])


@pytest.mark.parametrize(
    "load", [UniformDisc(0.1, 8e5), GridLoad(Grid.centred(0.2, 0.2, 0.02), np.full((10, 10), 8e5))]
)
def test_a_refusal_of_too_many_wavenumbers_tells_more_than_the_most(load):
    with pytest.raises(InputError, match="wavenumbers, more than") as raised:
        tl.solve_response(load, THIN, depths=[1e-3], x=[0.0, 400.0], y=[0.0, 400.0])
    needed, most = re.search(r"needs ([\d.e+x ]+) wavenumbers, more than ([\d.e+]+)", str(raised.value)).groups()
    product = float(np.prod([float(part) for part in needed.split("x")]))
    assert product > float(most)
    # The points are 400 m from a load that ends within 0.15 m of them all.
    reach = float(re.search(r"points up to ([\d.]+) m", str(raised.value)).group(1))
    assert reach == pytest.approx(400.1, abs=0.2)


def test_a_uniform_load_fills_its_extent():
    """Force = pressure times the area between the ends; a bilinear one falls to nothing a cell beyond its centres."""
    grid = Grid(4, 3, 0.02, 0.03, 0.1, -0.2)
    load = GridLoad(grid, np.full(grid.shape, 5e5))
    (x0, x1), (y0, y1) = load.extent_x, load.extent_y
    assert load.normal_load == pytest.approx(5e5 * (x1 - x0) * (y1 - y0), rel=1e-12)
    assert (x0 + x1, y0 + y1) == pytest.approx((grid.x[0] + grid.x[-1], grid.y[0] + grid.y[-1]), rel=1e-12)
    hats = GridLoad(grid, np.full(grid.shape, 5e5), interpolation="bilinear")
    assert hats.extent_x == pytest.approx((grid.x[0] - 0.02, grid.x[-1] + 0.02), rel=1e-12)
    assert hats.extent_y == pytest.approx((grid.y[0] - 0.03, grid.y[-1] + 0.03), rel=1e-12)


@pytest.mark.parametrize(
    ("layer", "depth", "names", "words"),
    [
        (0, 0.1, ["wearing course", "base", ""], "bottom of wearing course"),
        (1, 0.1, ["wearing course", "base", ""], "top of base"),
        (2, 0.3, ["wearing course", "base", ""], "top of layer 3"),
        (2, 0.3, ["wearing course"], "top of layer 3"),
        (0, 0.05, ["wearing course"], ""),
    ],
)
def test_sides_of_interfaces_in_words(layer, depth, names, words):
    plane = xr.Dataset(coords={"depth": depth, "layer": layer})
    plane.attrs = {"interfaces": [0.1, 0.3], "layer_names": json.dumps(names)}
    assert layer_in_words(plane) == words


@pytest.mark.parametrize("first", [0.0, 0.003, 0.0071, -0.2])
@pytest.mark.parametrize("step", [0.004, 0.05])
def test_a_disc_on_cells_keeps_its_force_and_its_middle(first, step):
    """Wherever the rows of cells lie, the disc's first moments are its own, and no rim is cut off."""
    disc = UniformDisc(0.15, 8e5, 0.02, -0.01)
    cells = _cells_of_disc(disc, first + step * np.arange(5))
    p = cells.load[0]
    rows, columns = (np.arange(n) for n in p.shape)
    y, x = cells.y0 + cells.dy * rows, cells.x0 + cells.dx * columns
    area = cells.dx * cells.dy
    assert p.sum() * area == pytest.approx(disc.normal_load, rel=1e-12)
    # Gauss's rule on chords with their root at the rim: 1e-4 of the radius.
    assert (p.sum(axis=1) @ y) / p.sum() == pytest.approx(-0.01, abs=1.5e-5)
    assert (p.sum(axis=0) @ x) / p.sum() == pytest.approx(0.02, abs=1e-12)
    # Second moment of a disc: R²/4, and the cells' own, dy²/12, less than what they are made of.
    spread = (p.sum(axis=1) @ (y + 0.01) ** 2) / p.sum()
    assert spread == pytest.approx(0.15**2 / 4, abs=0.1 * cells.dy**2 + 1e-5 * 0.15**2)


def test_parts_of_a_bilinear_load_keep_its_force_and_its_middle():
    """Hats are shares: what the parts of the cells bear is what the centres bear."""
    hats = _hats(5, 4)
    assert (hats >= 0).all()
    np.testing.assert_allclose(hats.sum(axis=0) / 4, 1.0, rtol=1e-12)
    places = (np.arange(24) + 0.5) / 4 - 1
    np.testing.assert_allclose(places @ hats / 4, np.arange(5), atol=1e-12)


def test_loads_on_one_lattice_and_apart_from_it():
    """The same cells told as one load or as two give one load back; half a cell aside they stay two."""
    grid = Grid(3, 2, 0.02, 0.03, 0.1, -0.2)
    one = GridLoad(grid, np.arange(6.0).reshape(2, 3))
    both = merged([one, one.moved(x=0.04, y=-0.03)])
    assert len(both) == 1
    assert both[0].normal_load == pytest.approx(2 * one.normal_load, rel=1e-12)
    assert both[0].pressure.shape == (3, 5)
    np.testing.assert_array_equal(both[0].pressure, [[0, 0, 0, 1, 2], [0, 1, 2 + 3, 4, 5], [3, 4, 5, 0, 0]])
    assert len(merged([one, one.moved(x=0.01)])) == 2
    assert len(merged([one])) == 1
