"""Passes of one load by criterion: closed forms, the same laws in a life, and roads without laws."""

import math

import numpy as np
import pytest

from treadload.case import Case
from treadload.damage.climate import Climate, Season
from treadload.damage.laws.french import FrenchBituminous, FrenchHydraulic, FrenchSubgrade
from treadload.damage.traffic import AxleClass, Traffic, Wander
from treadload.grid import Grid
from treadload.life import solve_passages
from treadload.life.design import Design
from treadload.response import GridLoad, solve_response
from treadload.steps.allowed import criteria_of_layers, passes_allowed
from treadload.steps.loaded import Loaded, judge, load_case

FREE = {"normal_load": "32.5 kN", "friction": 0.7}
TIRE = {"profile": "315/80R22.5", "inflation_pressure": "8.2 bar"}


def case_on(pavement, **more):
    return Case.from_dict({"spacing": "6 mm", "tire": TIRE, "pavement": pavement, "rolling": FREE, **more})


def structure(text, temperature=15):
    return {"structure": text, "temperature": temperature}


def under_a_disc(case, radius, pressure, cell=0.002):
    """The road of a case under a uniform disc, made of cells that carry its whole load."""
    n = 2 * math.ceil(radius / cell) + 1
    grid = Grid(n, n, cell, cell, -cell * (n - 1) / 2, -cell * (n - 1) / 2)
    inside = np.hypot(*np.meshgrid(grid.x, grid.y)) <= radius
    level = pressure * math.pi * radius**2 / (inside.sum() * cell**2)
    load = GridLoad(grid, np.where(inside, level, 0.0))
    return Loaded(case, case.pavement.build(), None, None, load, [load], lambda text: None)


def test_the_soil_under_a_disc_is_the_closed_form():
    """Layers of one modulus are a half-space: ε_z on the axis of a uniform disc, integrated from Boussinesq.

    Cells of 2 mm make the disc: its second moment, on which the strain at this depth depends, is met within 0.5 %.
    """
    material = {"kind": "elastic", "modulus": "100 MPa", "poisson": 0.35}
    layers = [{"name": "fill", "thickness": "260 mm", "material": material}, {"name": "soil", "material": material}]
    load = under_a_disc(case_on({"layers": layers}), 0.125, 0.662e6)
    (soil,) = passes_allowed(load).rows
    z, nu, far = 0.26, 0.35, math.hypot(0.125, 0.26)
    strain = 1.35 * 0.662e6 / 100e6 * (1 - 2 * nu + 2 * nu * z / far - (z / far) ** 3)
    assert soil.reading == pytest.approx(strain, rel=5e-3)
    assert (soil.name, soil.layer, soil.place, soil.depth) == ("french-subgrade", "soil", "top", z)
    assert soil.passes == pytest.approx((soil.reading / 0.012) ** (-1 / 0.222), rel=1e-12)
    assert math.hypot(soil.x, soil.y) < 0.02


def test_readings_are_those_of_a_life_without_wander():
    """One class, one season, one wheel that never wanders: `solve_passages`, whose points are chosen otherwise.

    It reads between its points by cubics; here points a twentieth of the depth apart miss 1/3200 of a peak. The
    contact of a life rolls freely as this one does.
    """
    case = case_on(structure("6 BBSG3 / 15 GB3 / PF3"))
    load = load_case(case, lambda text: None)
    rows = passes_allowed(load).rows
    criteria, without = criteria_of_layers(case)
    assert [(one.name, one.layer) for one in rows] == [
        ("french-bituminous", "EB-BBSG3"), ("french-bituminous", "EB-GB3"), ("french-subgrade", "PF3"),
    ]  # fmt: skip
    assert not without
    wheel = AxleClass("wheel", 1.0, 32.5e3, 8.2e5)
    traffic = Traffic((wheel,), passes_per_year=1e5, wander=Wander.none())
    climate = Climate((Season("year", 1.0, 15.0),))
    tire = load.contact.tire
    solved = solve_passages(Design(tire, case.pavement.untempered(), traffic, climate, criteria, spacing=0.006))
    readings = solved.readings.to_numpy().max(axis=(1, 2, 3, 4))
    for one, reading in zip(rows, readings, strict=True):
        if one.layer == "EB-BBSG3":
            # In the middle of the asphalt the bottom is pressed. What is left lies on the border of the field around
            # one contact, and a life follows it further.
            assert 0 < one.reading < reading < 5e-6
        else:
            assert one.reading == pytest.approx(reading, rel=5e-3)


def test_each_layer_has_the_law_of_its_mix():
    """Numbers of the catalogue at the risk of T1, the modulus at the layer's own temperature."""
    case = case_on(structure("2.5 BBTM / 6 BBSG3 / 15 GB3 / 20 GC-T3 / PF3", 20))
    road = case.pavement.untempered()
    load = under_a_disc(case, 0.125, 0.662e6, cell=0.005)
    allowed = passes_allowed(load)
    assert [one.name for one in allowed.rows] == [
        "french-bituminous", "french-bituminous", "french-hydraulic", "french-subgrade",
    ]  # fmt: skip
    base, treated, soil = (allowed.rows[k] for k in (1, 2, 3))
    mix = road.layers[2].material
    assert base.law == FrenchBituminous.of(mix, thickness=0.235, risk=0.05, temperature=20.0)
    assert treated.law == FrenchHydraulic.of(road.layers[3].material, risk=0.05, platform_modulus=120e6)
    assert soil.law == FrenchSubgrade.of(road.layers[4].material)
    assert [one.depth for one in allowed.rows] == pytest.approx([0.085, 0.235, 0.435, 0.435])
    # Read at every cell instead of a twentieth of the depth apart.
    data = solve_response(load.wheels, load.road, depths=[0.435], x=load.grid.x, y=load.grid.y).dataset
    assert treated.reading == pytest.approx(
        max(float(data["stress_xx"].max()), float(data["stress_yy"].max())), rel=1e-3
    )
    missing = "BBTM: epsilon_6 is missing, and the layer does not provide it; give it in the criterion."
    assert allowed.without == (missing,)


def test_a_layer_of_which_only_the_modulus_is_known_is_told():
    stiff = {"kind": "elastic", "modulus": "9 GPa", "poisson": 0.35}
    layers = [{"name": "base", "thickness": "200 mm", "material": stiff}, {"name": "soil", "material": stiff}]
    load = under_a_disc(case_on({"layers": layers}), 0.1, 1e6, cell=0.01)
    allowed = passes_allowed(load)
    assert [one.layer for one in allowed.rows] == ["soil"]
    assert allowed.without[0].startswith("No law for base, of which only the modulus is known: choose a mix")


def test_a_half_space_has_its_verdict_alone():
    material = {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}
    fatigue = {"epsilon_6": "120 microstrain", "slope": -0.2}
    case = case_on({"layers": [{"name": "road", "material": material}]}, damage={"fatigue": fatigue})
    load = load_case(case, lambda text: None)
    verdict = judge(load, load.solve(case.response.depths))
    (own,) = passes_allowed(load, verdict).rows
    assert own.passes == float(verdict.dataset["worst_passes"])
    assert own.reading == float(verdict.dataset["worst_strain"])
    assert not passes_allowed(load).rows


def test_a_concrete_slab_needs_its_joints():
    """k_d of BC5 depends on the structure: the catalogue has none, and none is assumed."""
    case = case_on({"layers": [{"mix": "BC5", "thickness": "250 mm"}, {"mix": "PF3"}]})
    found, without = criteria_of_layers(case)
    assert [one.name for one in found] == ["french-subgrade"]
    assert without == ["BC5: joints, k_d, depend on the structure; give them on the life page."]
