"""Surface strain of a road under ribs and grooves, against plane-strain and extended-load closed forms."""

import numpy as np
import pytest

from treadload.grid import Grid
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.response import GridLoad, solve_response

MODULUS, POISSON, PRESSURE = 5.4e9, 0.35, 0.7e6
ROAD = Pavement.half_space(Elastic(MODULUS, POISSON))


def strain_at(load, x, y):
    data = solve_response(load, ROAD, depths=0.0, x=x, y=y).dataset
    return [float(data[f"strain_{c}"].squeeze()) for c in ("xx", "yy", "zz")]


def test_under_a_long_rib():
    load = GridLoad(Grid(1, 1, 1000.0, 0.05, 0.0, 0.0), np.full((1, 1), PRESSURE))
    expected = -(1 + POISSON) * (1 - 2 * POISSON) * PRESSURE / MODULUS
    _, yy, zz = strain_at(load, 0.0, 0.01)
    # The ends, 10⁴ widths away, change it by their share, 1e-4.
    assert yy == pytest.approx(expected, rel=1e-4)
    assert zz == pytest.approx(expected, rel=1e-4)


def test_inside_an_extended_load():
    load = GridLoad(Grid(1, 1, 1.0, 1.0, 0.0, 0.0), np.full((1, 1), PRESSURE))
    expected = -(1 + POISSON) * (1 - 2 * POISSON) * PRESSURE / (2 * MODULUS)
    # Exact at the centre of a square.
    np.testing.assert_allclose(strain_at(load, 0.0, 0.0)[:2], expected, rtol=1e-12)


def test_in_a_groove_the_road_is_stretched_across():
    groove, length = 0.002, 1.0
    rib = (length - groove) / 2
    centre = (groove + rib) / 2
    ribs = [GridLoad(Grid(1, 1, length, rib, 0.0, side * centre), np.full((1, 1), PRESSURE)) for side in (-1, 1)]
    expected = (1 + POISSON) * (1 - 2 * POISSON) * PRESSURE / (2 * MODULUS)
    xx, yy, _ = strain_at(ribs, 0.0, 0.0)
    # The groove is 1/500 of the load's length; the field at its middle changes by that part.
    assert yy == pytest.approx(expected, rel=5e-3)
    assert xx == pytest.approx(-expected, rel=5e-3)
    data = solve_response(ribs, ROAD, depths=0.0, x=0.0, y=0.0).dataset
    # 26 microstrain for 0.7 MPa on asphalt, across travel.
    assert float(data["principal_strain_1"].squeeze()) == pytest.approx(26.25e-6, rel=5e-3)
    assert abs(float(data["in_plane_angle_1"].squeeze())) == pytest.approx(np.pi / 2, abs=1e-6)


@pytest.mark.parametrize("poisson", [0.0, 0.5])
def test_extreme_poisson_ratios(poisson):
    road = Pavement.half_space(Elastic(MODULUS, poisson))
    load = GridLoad(Grid(1, 1, 1.0, 1.0, 0.0, 0.0), np.full((1, 1), PRESSURE), np.full((1, 1), 1e5))
    data = solve_response(load, road, depths=[0.0, 0.1], x=[-0.2, 0.1], y=[0.0, 0.3]).dataset
    volume = data["strain_xx"] + data["strain_yy"] + data["strain_zz"]
    assert all(np.isfinite(data[name]).all() for name in data.data_vars)
    mean = data["mean_stress"]
    # Round-off of strain near 1e-4.
    np.testing.assert_allclose(volume, 3 * (1 - 2 * poisson) / MODULUS * mean, atol=1e-18)


def test_rubber_road_takes_no_strain_under_an_extended_load():
    road = Pavement.half_space(Elastic(MODULUS, 0.5))
    load = GridLoad(Grid(1, 1, 1.0, 1.0, 0.0, 0.0), np.full((1, 1), PRESSURE))
    data = solve_response(load, road, depths=0.0, x=0.0, y=0.0).dataset
    # (1 - 2ν) = 0: all that is left is round-off of 1e-4.
    assert abs(float(data["principal_strain_1"].squeeze())) < 1e-18
