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
from treadload.response.input_caveats import overlapping, road_caveats
from treadload.response.moving import _cells_of_disc, _hats
from treadload.response.superposition import merged

THIN = Pavement([Layer(Elastic(5e9, 0.35), 1e-3), Layer(Elastic(1e8, 0.35))])


@pytest.mark.parametrize(
    "load", [UniformDisc(0.1, 8e5), GridLoad(Grid.centred(0.2, 0.2, 0.02), np.full((10, 10), 8e5))]
)
@pytest.mark.slow
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
        (3, 0.1, ["wearing course", "base", ""], ""),
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


@pytest.mark.parametrize(
    ("text", "options", "message"),
    [
        ("x,y,pressure\n0,0,1\n1,0,nan\n0,1,1\n1,1,1\n", {}, "line 3: pressure is missing"),
        ("x,y,pressure\n0,0,1\n1,0,1\n0,1,-5\n1,1,1\n", {}, "line 4: pressure is negative, -5 Pa"),
        ("1,nan\n3,4\n5,6\n", {"spacing": 0.01}, "line 1: pressure is missing"),
        ("1,2\n3,-4\n5,6\n", {"spacing": 0.01}, "line 2: pressure is negative, -4 Pa"),
        ("# a comment\n\n1,2\n3,-4\n5,6\n", {"spacing": 0.01}, "line 4: pressure is negative, -4 Pa"),
        ("x,y,pressure\n0,0,1\n1,0,1\n2.7,0,1\n4,0,1\n", {"spacing": 1.0}, r"line 4: x = 2\.7 m is .* of 1 m"),
    ],
)
def test_a_wrong_number_is_told_with_its_line_wherever_it_stands(tmp_path, text, options, message):
    path = tmp_path / "stress.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=message):
        GridLoad.from_csv(path, **options)


def test_footprints_reach_into_each_other_by_their_sizes():
    """Two wheels of 300 x 200 mm, 250 mm and 150 mm apart, share 50 mm by 50 mm."""
    wheel = tl.UniformRectangle(0.3, 0.2, 8e5)
    (said,) = overlapping([wheel, wheel.moved(x=0.25, y=0.15)])
    assert re.search("wheels 1 and 2 .* by 50 mm along travel and 50 mm across", said)
    assert "their centres are 250 and 150 mm apart" in said
    assert overlapping([wheel, wheel.moved(x=0.31)]) == ()
    assert overlapping([wheel, wheel.moved(y=0.21)]) == ()
    # One above the other is one wheel in parts; a wheel that does not press stands nowhere.
    assert overlapping([wheel, wheel]) == ()
    assert overlapping([wheel, tl.UniformRectangle(0.3, 0.2, 0.0, y=0.1)]) == ()
    (said,) = overlapping([tl.UniformRectangle(0.3, 0.2, 0.0), wheel, wheel.moved(y=0.1)])
    assert "wheels 2 and 3" in said
    disc = UniformDisc(0.1, 8e5)
    (said,) = overlapping([disc, disc.moved(y=0.16)])
    assert "by 200 mm along travel and 40 mm across" in said


def test_a_footprint_reaches_as_far_as_anything_presses():
    """A cross of cells is as long and as wide as its arms, and not as the rows that are pressed from end to end."""
    pressed = np.zeros((9, 9))
    pressed[4, 1:8] = pressed[1:8, 4] = 7e5
    cross = GridLoad(Grid.centred(0.18, 0.18, 0.02), pressed)
    (said,) = overlapping([cross, cross.moved(y=0.08)])
    assert "by 140 mm along travel and 60 mm across" in said
    assert overlapping([cross, cross.moved(y=0.14)]) == ()


@pytest.mark.parametrize(("stiffness", "told"), [(1e3, True), (1e10, False), (0.0, False), (np.inf, False)])
def test_a_bond_is_doubted_that_neither_holds_nor_slides(stiffness, told):
    bond = (
        tl.pavement.FRICTIONLESS
        if stiffness == 0
        else tl.pavement.BONDED
        if stiffness == np.inf
        else tl.pavement.Bond(stiffness=stiffness)
    )
    road = Pavement([Layer(Elastic(5e9, 0.35), 0.1, bond=bond), Layer(Elastic(1e8, 0.35))])
    assert any("bond" in text for text in road_caveats(road)) == told


def test_a_pair_stands_beside_where_its_wheel_stood():
    """Also of a footprint that is not centred, and that is not its own mirror image."""
    grid = Grid(3, 4, 0.02, 0.03, 0.5, 0.2)
    one = GridLoad(grid, np.arange(12.0).reshape(4, 3) * 1e4)
    left, right = tl.response.dual_wheels(one, 0.34)
    middle = sum(one.extent_y) / 2
    assert sum(left.extent_y) / 2 == pytest.approx(middle - 0.17)
    assert sum(right.extent_y) / 2 == pytest.approx(middle + 0.17)
    np.testing.assert_array_equal(left.pressure, one.pressure[::-1])
    np.testing.assert_array_equal(right.pressure, one.pressure)


def test_a_chord_of_a_disc_is_as_long_as_geometry_says():
    disc = UniformDisc(0.15, 8e5)
    cells = _cells_of_disc(disc, np.array([0.0]))
    y = cells.y0 + cells.dy * np.arange(cells.load.shape[1])
    chords = cells.load[0].sum(axis=1) / 8e5 * cells.dx
    inside = np.abs(y) < 0.14
    # Means over rows of a hundred and twentieth of the diameter: the chord's own bend over them.
    np.testing.assert_allclose(chords[inside], 2 * np.sqrt(0.15**2 - y[inside] ** 2), rtol=2e-3)
