"""Creep curves, starts from earlier contacts, and strongly coupled bodies."""

from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.contact import creep_curve

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
TIRE = tl.Tire.from_profile("315/80R22.5", material=tl.Elastic(3e6, 0.5))
STATE = tl.Rolling(normal_load=32.5e3, friction=0.7)
CREEPAGES = [-0.3, -0.05, -0.02, -0.005, 0.0, 0.005, 0.02]


@pytest.fixture(scope="module")
def curve():
    return creep_curve(TIRE, ROAD, STATE, CREEPAGES, spacing=12e-3)


def test_every_point_is_the_contact_of_its_creepage(curve):
    alone = tl.solve_contact(TIRE, ROAD, replace(STATE, creepage_x=-0.05), spacing=12e-3)
    row = curve.dataset.sel(creepage=-0.05)
    # Two ways to one solution, each to 1e-6 of μp.
    assert float(row.tractive_force) == pytest.approx(float(alone.dataset.tractive_force), rel=1e-5)
    assert float(row.creepage_x) == -0.05
    assert list(curve.dataset.creepage.values) == CREEPAGES


def test_it_rises_to_gross_sliding_and_is_odd(curve):
    force = curve.dataset.tractive_force.values / (0.7 * 32.5e3)
    assert (np.diff(force) < 0).all()
    # Like bodies but for β = 1.5e-4, which shifts the curve by as much.
    np.testing.assert_allclose(force[2:4], -force[[6, 5]], atol=1e-3)
    assert 0.99 < force[0] <= 1
    slips = curve.dataset.slip_fraction.values[:5]
    assert (np.diff(slips) <= 0).all()
    assert slips[0] == pytest.approx(1.0)


def test_the_summary_has_a_line_a_creepage(curve):
    assert len(curve.summary().splitlines()) == 2 + len(CREEPAGES)
    assert "-0.05000" in str(curve)


def test_cornering_turns_the_tire_against_its_slip():
    curve = creep_curve(TIRE, ROAD, STATE, [0.0, 0.01, 0.03], along="y", spacing=12e-3)
    lateral, moment = curve.dataset.lateral_force.values, curve.dataset.aligning_moment.values
    assert (np.diff(lateral) < 0).all()
    # Shear gathers behind the middle: the moment turns the wheel back towards its path.
    assert moment[1] * lateral[1] < 0
    assert abs(moment[0]) < 1e-3 * abs(moment[1])


@pytest.mark.parametrize("wrong", [[], [0.1, 0.1], [np.nan], [[0.1]]])
def test_creepages_that_are_none(wrong):
    with pytest.raises(tl.InputError, match="creepages"):
        creep_curve(TIRE, ROAD, STATE, wrong)


def test_along_is_x_or_y():
    with pytest.raises(tl.InputError, match="along"):
        creep_curve(TIRE, ROAD, STATE, [0.0], along="z")


def test_a_start_brings_its_grid_and_not_its_creepage():
    driving = tl.solve_contact(TIRE, ROAD, replace(STATE, tractive_force=5e3), spacing=12e-3)
    again = tl.solve_contact(TIRE, ROAD, replace(STATE, creepage_x=-0.01), start=driving)
    alone = tl.solve_contact(TIRE, ROAD, replace(STATE, creepage_x=-0.01), spacing=12e-3)
    assert float(again.dataset.creepage_x) == -0.01
    assert again.dataset.x.equals(driving.dataset.x)
    assert float(again.dataset.tractive_force) == pytest.approx(float(alone.dataset.tractive_force), rel=1e-5)
    with pytest.raises(tl.InputError, match="start has cells of 12 mm"):
        tl.solve_contact(TIRE, ROAD, STATE, start=driving, spacing=3e-3)


@pytest.mark.parametrize("friction", [1.0, 2.0])
def test_the_strongest_coupling_settles(friction):
    """ν = 0 on a hard road: Dundurs' β = 0.5, where plain alternation circles for μ = 2."""
    smooth = replace(tl.catalogue.tires["315/80R22.5"], grooves=())
    tire = tl.Tire.from_profile(smooth, material=tl.Elastic(3e6, 0.0))
    state = tl.Rolling(normal_load=32.5e3, friction=friction, tractive_force=10e3)
    contact = tl.solve_contact(tire, ROAD, state, spacing=12e-3)
    assert contact.stats["dundurs"] == pytest.approx(0.5, abs=1e-3)
    assert contact.stats["coupling_rounds"] <= 20
    data = contact.dataset
    assert float(data.tractive_force) == pytest.approx(10e3, rel=1e-6)
    gap = data.gap.values[data.pressure.values > 0]
    assert np.abs(gap).max() <= 1e-6 * float(data.approach)


def test_coupling_below_the_tolerance_is_left_out():
    contact = tl.solve_contact(TIRE, ROAD, replace(STATE, tractive_force=5e3), spacing=12e-3, tolerance=1e-3)
    assert abs(contact.stats["dundurs"]) < 1e-3
    assert contact.stats["coupling_rounds"] == 1
