"""Contacts of wheels with a side force are solved on halved cells where their damage could move the years."""

from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.damage.climate import Climate
from treadload.life.halving import as_solved, needs_halved_cells, on_halved_cells
from treadload.life.wheels import across, state, wheels_of

TIRE = tl.Tire.from_profile(tl.tire.TreadProfile(0.5, 1.0, 0.25), inflation_pressure=8e5)
ROAD = tl.Pavement([tl.Layer(tl.Elastic(5.4e9, 0.35), 0.06), tl.Layer(tl.Elastic(1.2e8, 0.35))])
LINE = tl.FatigueLine(120e-6, -0.2)
TOP = tl.damage.Criterion("surface", LINE, place="top")
BOTTOM = tl.damage.Criterion("base", LINE, 0, "bottom")
PUSHED = tl.damage.AxleClass("pushed", 0.5, 20e3, 8e5, maneuver=tl.contact.Maneuver(lateral=0.2))
STRAIGHT = tl.damage.AxleClass("straight", 0.5, 20e3, 8e5)
Y = np.linspace(-0.3, 0.3, 61)


def solved(by_class, criteria=(TOP,), wander=0.0, **parts):
    """A design and its life, where classes do damage (axle_class, y) as strain to the fifth power."""
    scatter = tl.damage.Wander.normal(wander) if wander else tl.damage.Wander.none()
    traffic = tl.damage.Traffic((STRAIGHT, PUSHED), 1e5, wander=scatter)
    design = tl.Design(TIRE, ROAD, traffic, Climate.constant(15.0), criteria, **parts)
    readings = 50e-6 * np.array(by_class)[None, :, None] ** 0.2 * np.ones((len(criteria), 1, 1, 1))
    return design, tl.damage.miner(readings, criteria, traffic, design.climate, y=Y)


def at(place, much=1.0):
    """Damage at one of y only."""
    return np.where(np.abs(Y - place) < 5e-3, much, 0.0)


# A side force's damage may be 13 % off, and a life accepts 2.5 %: 19 % of the damage at the worst place.
@pytest.mark.parametrize(("share", "expected"), [(0.0, False), (0.15, False), (0.25, True), (1.0, True)])
def test_the_share_of_side_forces_at_the_worst_place_decides(share, expected):
    assert needs_halved_cells(*solved([at(0.0, 1 - share), at(0.0, share)])) == expected


@pytest.mark.parametrize(("much", "expected"), [(0.88, False), (0.92, True)])
def test_so_does_a_place_that_could_become_the_worst(much, expected):
    """Beside a worst place without side forces: 0.92 times 1.13 is 4 % more than it, 0.88 times 1.13 less."""
    assert needs_halved_cells(*solved([at(0.0), at(0.1, much)])) == expected


def test_wander_counts():
    """Two places 0.1 m apart become one, where side forces do nearly half, under a wander of 0.25 m."""
    side_by_side = [at(0.0), at(0.1, 0.85)]
    assert not needs_halved_cells(*solved(side_by_side))
    assert needs_halved_cells(*solved(side_by_side, wander=0.25))


@pytest.mark.parametrize("spacing", [1.5e-3, 2e-3, 6e-3])
def test_other_cells_are_kept(spacing):
    assert not needs_halved_cells(*solved([at(0.0), at(0.0)], spacing=spacing))


def test_the_bottom_of_a_layer_needs_none():
    assert not needs_halved_cells(*solved([at(0.0), at(0.0)], criteria=(BOTTOM,)))


def test_halved_contacts_are_those_with_a_side_force_beside_the_coarse_ones():
    design, life = solved([at(0.0), at(0.0)])
    halved = on_halved_cells(design)
    assert not needs_halved_cells(halved, life)
    straight, pushed = (state(row) for row in (STRAIGHT, PUSHED))
    assert [member.halved for member in halved.contacts.missing([straight, pushed])] == [False, True]
    assert not any(member.halved for member in design.contacts.missing([straight, pushed]))
    # One store: what one design solves the others know.
    design.contacts.solved[pushed] = "coarse"
    halved.contacts.solved[pushed._replace(halved=True)] = "fine"
    assert (design.contacts.of(pushed), halved.contacts.of(pushed)) == ("coarse", "fine")
    # Another road keeps the cells; a life names those that it was solved on.
    assert halved.on_road(ROAD).contacts.halved
    assert not as_solved(design, life).contacts.halved
    assert as_solved(design, replace(life, stats={"halved_cells": True})).contacts.halved


@pytest.mark.parametrize("spacing", [2.5e-3, 3e-3, 4e-3])
def test_wheels_on_halved_cells_stand_on_the_lines_of_the_others(spacing):
    road, rolling = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=5e3, friction=0.7)
    half, whole = (tl.solve_contact(TIRE, road, rolling, spacing=size) for size in (spacing / 2, spacing))
    y = across([whole], [STRAIGHT], 0.3)
    assert np.diff(y) == pytest.approx(spacing / 2)
    for contact in (half, whole):
        (load,) = wheels_of([contact], STRAIGHT, y).loads
        assert np.abs(y[:, None] - load.grid.y).min(axis=0).max() < 1e-9
