"""Damage against what must hold whatever it reads: directions, sums, places, and what a bound still takes."""

import math

import numpy as np
import pytest
import xarray as xr

import treadload as tl
from treadload.damage import add_thermal_stress
from treadload.damage.cracks import crack_plane
from treadload.damage.energies import DissipatedEnergy
from treadload.damage.fields import peak
from treadload.damage.invariants import MazarsStrain
from treadload.damage.laws.energy_ratio import EnergyRatio
from treadload.damage.quantities import HorizontalTension
from treadload.damage.quantity import Where
from treadload.damage.worst_point import _between
from treadload.response.fields import response_dataset

WHEEL = tl.UniformDisc(0.15, 8e5)
HALF = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))


def turned(tensor, degrees):
    """Components (6, 1, 1, 1) of a tensor of the horizontal plane, turned from travel towards the right."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turn = np.array([[c, -s], [s, c]])
    plane = turn @ np.asarray(tensor, dtype=float) @ turn.T
    return np.array([plane[0, 0], plane[1, 1], -1.0, plane[0, 1], 0.0, 0.0]).reshape(6, 1, 1, 1)


@pytest.mark.parametrize("degrees", [0, 20, 45, 90, -30])
@pytest.mark.parametrize("quantity", [HorizontalTension(), MazarsStrain()])
def test_a_crack_lies_across_what_pulls_it(quantity, degrees):
    """Its trace is a quarter of a turn from the pull, wherever that points, and its plane upright."""
    pull = turned([[3.0, 0.0], [0.0, 1.0]], degrees)
    data = response_dataset(1e6 * pull, 1e-4 * pull, np.array([0.0]), np.array([0.0]), np.array([0.0]))
    angle, dip = (float(part.item()) for part in crack_plane(quantity.crack(data)))
    apart = (math.degrees(angle) - degrees - 90 + 90) % 180 - 90
    assert apart == pytest.approx(0, abs=1e-6)
    assert dip == pytest.approx(math.pi / 2)


def test_energy_of_a_passage_is_the_same_all_along_x():
    energy = np.array([[3.0, 5.0], [7.0, 11.0]])
    stress = np.zeros((6, 2, 2, 4))
    data = response_dataset(stress, stress, np.array([0.0, 0.1]), np.array([0.0, 0.2]), np.arange(4.0))
    data["dissipated_energy"] = (("depth", "y"), energy)
    read = DissipatedEnergy().values(data)
    assert read.shape == (2, 2, 4)
    for column in range(4):
        np.testing.assert_array_equal(read[..., column], energy)
    assert DissipatedEnergy().crack(data) is None
    # So at one depth, as criteria read it, and at one x.
    np.testing.assert_array_equal(DissipatedEnergy().values(data.isel(depth=1)), np.repeat(energy[1][:, None], 4, 1))
    np.testing.assert_array_equal(DissipatedEnergy().values(data.isel(depth=1, x=2)), energy[1])


def test_thermal_stresses_of_two_nights_add_up():
    response = tl.solve_response(WHEEL, HALF, depths=[0.0, 0.02], x=[0.0, 0.1], y=[0.0])
    first = add_thermal_stress(response, [1e6, 4e5])
    both = add_thermal_stress(first, [5e5, -1e5])
    at_once = add_thermal_stress(response, [1.5e6, 3e5])
    for name in ("stress_xx", "stress_yy", "stress_zz", "mean_stress"):
        np.testing.assert_allclose(both.dataset[name], at_once.dataset[name], rtol=1e-12, atol=1e-3)
    # The road is solved again with what holds it back.
    assert both.restrained == at_once.restrained == (1.5e6, 3e5)


def test_the_deepest_depth_still_counts():
    values = xr.DataArray([[[1.0]], [[2.0]], [[4.0]]], dims=("depth", "y", "x"), name="a").assign_coords(
        depth=[0.0, 0.05, 0.051], y=[0.3], x=[0.2]
    )
    found = peak(values.to_dataset(), "a", deepest=0.05)
    assert found == {"value": 2.0, "depth": 0.05, "y": 0.3, "x": 0.2}
    assert peak(values.to_dataset(), "a")["value"] == 4.0


@pytest.mark.parametrize(
    ("where", "surface", "bottom"),
    [
        (Where(("top",), 0, only=True), True, False),
        (Where(("top",), 0), False, False),
        (Where(("top",), 1, only=True), False, False),
        (Where(("bottom",), 0, only=True), False, True),
        (Where(("bottom", "top"), 0, only=True), False, False),
        (Where(("bottom", "top")), False, False),
    ],
)
def test_where_a_quantity_is_read(where, surface, bottom):
    assert (where.at_surface, where.at_bottom) == (surface, bottom)


@pytest.mark.parametrize("k", [1, 2])
def test_between_a_point_and_its_neighbours_is_even_and_on_both_sides(k):
    at = np.array([0.1, 0.13, 0.16, 0.19])
    fine = _between(at, k)
    np.testing.assert_allclose(fine + fine[::-1], 2 * at[k], rtol=1e-12)
    np.testing.assert_allclose(np.diff(fine), fine[1] - fine[0], rtol=1e-9)
    # The neighbours are known: up to them, without them.
    assert at[k - 1] < fine[0] < at[k - 1] + (fine[1] - fine[0]) * 1.01
    assert len(fine) > 3
    assert at[k] == pytest.approx(fine[len(fine) // 2], rel=1e-12)
    assert len(_between(at[:1], 0)) == 1


def test_the_faintest_tension_needs_something():
    """What a mix must bear rises with tension from nothing; none needs nothing."""
    law = EnergyRatio(1e-10, 0.5, 2e6, 3000.0, 1e10)
    needed = law.needed(np.array([-1.0, 0.0, 0.5, 10.0, 1e3, 1e5, 1e6]))
    assert (needed[:2] == 0).all()
    assert (np.diff(needed[1:]) > 0).all()
    assert np.isinf(law.ratio(np.array([-1.0, 0.0]))).all()
    assert np.isfinite(law.ratio(np.array([0.5])))
