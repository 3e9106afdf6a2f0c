"""Computed contact against uniform loads: same force, closed forms of the disc, and what only a tread shows."""

import math

import numpy as np
import pytest

from treadload.contact import Rolling, solve_contact
from treadload.damage.uniform import COMPUTED, DISC, RECTANGLE, compare_uniform
from treadload.errors import InputError
from treadload.materials import Elastic
from treadload.pavement import Layer, Pavement
from treadload.plots.uniform import uniform_comparison
from treadload.tire import Tire

TIRE = Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
ROAD = Pavement([Layer(Elastic(7e9, 0.35), 0.06), Layer(Elastic(9e9, 0.35), 0.15), Layer(Elastic(1.2e8, 0.35))])


@pytest.fixture(scope="module")
def driving():
    wheel = Rolling(normal_load=32.5e3, tractive_force=10e3, friction=0.7)
    return solve_contact(TIRE, ROAD, wheel, spacing=12e-3)


@pytest.fixture(scope="module")
def compared(driving):
    return compare_uniform(driving, ROAD, depths=[0.0, 0.02, 0.21])


def test_the_uniform_loads_carry_the_same_force(compared):
    data = compared.dataset
    assert float(data["uniform_pressure"] * data["uniform_area"]) == pytest.approx(32.5e3, rel=1e-6)


def test_the_disc_is_boussinesqs(driving):
    """On a half-space the axis of a uniform disc has a closed form (Ahlvin & Ulery 1962)."""
    poisson, modulus, z = 0.35, 5.4e9, 0.1
    road = Pavement.half_space(Elastic(modulus, poisson))
    found = compare_uniform(driving, road, depths=[z]).dataset.sel(load=DISC)
    radius, p = math.sqrt(32.5e3 / 820e3 / math.pi), 820e3
    root = math.hypot(radius, z)
    stress = p * (1 - (z / root) ** 3)
    radial = p / 2 * ((1 + 2 * poisson) - 2 * (1 + poisson) * z / root + (z / root) ** 3)
    exact = (stress - 2 * poisson * radial) / modulus
    # The largest on points 20 mm apart, one within 10 mm of the axis: 1 %.
    assert found["largest_vertical_compression"].item() == pytest.approx(exact, rel=1e-2)


def test_only_loads_with_shear_shear_the_surface(driving):
    compared = compare_uniform(driving, ROAD, depths=[0.0], mean_over=None)
    shear = compared.dataset["largest_vertical_shear"].isel(depth=0)
    assert shear.sel(load=DISC).item() == pytest.approx(0, abs=1e-12)
    # γ = |q| / G of the evenly spread shear.
    area = compared.dataset["uniform_area"].item()
    assert shear.sel(load=RECTANGLE).item() == pytest.approx(10e3 / area / (7e9 / 2.7), rel=1e-3)
    assert shear.sel(load=COMPUTED).item() > 1.5 * shear.sel(load=RECTANGLE).item()


def test_a_driving_tire_stretches_the_surface_more_than_the_disc_of_design(compared, driving):
    points = compare_uniform(driving, ROAD, depths=[0.0], mean_over=None)
    assert points.ratio("largest_extension").isel(depth=0).item() > 1.5
    assert compared.ratio("largest_extension").isel(depth=0).item() > 1.2
    # Where the layers meet, only the force counts.
    assert compared.ratio("largest_in_plane_extension").isel(depth=-1).item() == pytest.approx(1, abs=0.15)


def test_near_the_surface_means_are_read(compared, driving):
    points = compare_uniform(driving, ROAD, depths=[0.0, 0.02, 0.21], mean_over=None)
    assert "means over 10 mm" in compared.summary()
    assert "at points" in points.summary()
    ratio = compared.dataset["largest_extension"] / points.dataset["largest_extension"]
    assert float(ratio.sel(load=COMPUTED).isel(depth=0)) < 0.9
    # From two lengths down the points are read.
    assert float(abs(ratio.isel(depth=slice(1, None)) - 1).max()) < 1e-12


def test_the_summary_and_the_figure_hold_every_load(compared):
    assert all(name in compared.summary() for name in (COMPUTED, DISC, RECTANGLE))
    axes = uniform_comparison(compared).axes
    assert [line.get_label() for line in axes[0].lines] == [COMPUTED, DISC, RECTANGLE]
    values = compared.dataset["largest_extension"].sel(load=COMPUTED).to_numpy()
    assert np.asarray(axes[0].lines[0].get_xdata()) == pytest.approx(1e6 * values)


@pytest.mark.slow
def test_default_depths_hold_the_surface_and_the_interfaces(driving):
    at = compare_uniform(driving, ROAD).dataset["depth"].to_numpy()
    assert at[0] == 0
    assert 0.06 in at
    assert (at[1:] >= 0.006).all()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"pressure": -1.0}, "pressure must be a positive number of Pa, got -1; left out, it is the inflation"),
        ({"slenderness": 0.0}, "slenderness must be a positive number, got 0; 1 is a square"),
    ],
)
def test_bad_input_is_named(driving, change, words):
    with pytest.raises(InputError, match=words):
        compare_uniform(driving, ROAD, **change)


def test_a_tire_without_pressure_needs_one():
    gap = 0.5 * (np.hypot(*np.meshgrid(np.arange(20) - 9.5, np.arange(20) - 9.5)) * 0.01) ** 2 / 0.5
    tire = Tire.from_height_map(gap, 0.01, material=Elastic(3e6, 0.5))
    contact = solve_contact(tire, ROAD, Rolling(normal_load=1e3, friction=0.7))
    with pytest.raises(InputError, match="inflation pressure"):
        compare_uniform(contact, ROAD)
