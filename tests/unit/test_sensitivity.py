"""Elasticities of a life: those that closed forms know, and what was solved for them."""

import math
from dataclasses import replace

import pytest

from treadload.damage import AxleClass, Climate, Criterion, FatigueLine, Traffic, Wander
from treadload.errors import InputError
from treadload.life import life_sensitivity, solve_life
from treadload.life.design import Design
from treadload.life.sensitivity import TEMPERATURE
from treadload.materials import Prony
from treadload.pavement import Layer, Pavement
from treadload.tire import Tire

TIRE = Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
ROAD = Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
BASE = Criterion("base", FatigueLine(90e-6, -0.2), 1)
COARSE = {"spacing": 12e-3}
LIGHT, HEAVY = AxleClass("light", 0.6, 15e3, 700e3), AxleClass("heavy", 0.4, 32.5e3, 850e3)


def elasticities(traffic, climate, road=ROAD, criteria=(BASE,), **asked):
    design = Design(TIRE, road, traffic, climate, criteria, **COARSE)
    found = life_sensitivity(replace(design, contacts=None), solve_life(design, workers=1), workers=1, **asked)
    return found, dict(zip(found.dataset["input"].to_numpy(), found.dataset["elasticity"].to_numpy(), strict=True))


@pytest.fixture(scope="module")
def plain():
    return elasticities(Traffic((LIGHT, HEAVY), 1e5), Climate.constant(15.0))


def test_strain_scales_with_all_moduli_together(plain):
    """Strain goes like load over modulus on layers of one geometry: the moduli's elasticities add up to -1/b."""
    _, found = plain
    total = sum(value for name, value in found.items() if name.startswith("modulus"))
    # ln(1.05 / 0.95) in place of the derivative leaves 1e-3 of it.
    assert total == pytest.approx(5, rel=5e-3)


def test_the_laws_strain_and_the_passes(plain):
    """Without growth life goes like 1 / passes and like ε₆ to the power -1/b."""
    _, found = plain
    # Of single numbers.
    assert found["strength of base"] == pytest.approx(5, rel=1e-5)
    assert found["passes"] == pytest.approx(-1, rel=1e-9)
    assert "wander" not in found


def test_signs_are_those_of_a_road(plain):
    _, found = plain
    assert found["thickness of EB-GB3"] > found["thickness of EB-BBSG3"] > 0
    assert found["wheel load"] < -1
    assert found[TEMPERATURE] < 0
    # At 210 mm the shear of free rolling is not felt.
    assert abs(found["friction"]) < 0.05


def test_only_what_does_the_damage_is_solved_again(plain):
    """The heavy class alone does more than 80 %: nine inputs twice, six contacts."""
    sensitivity, _ = plain
    assert (sensitivity.contacts, sensitivity.responses) == (7, 18)
    assert 0.8 < sensitivity.coverage < 1
    assert "7 contacts and 18 responses" in sensitivity.summary()
    weights = [
        abs(float(value)) * (1 if name == TEMPERATURE else 0.05)
        for name, value in zip(*(sensitivity.dataset[v].to_numpy() for v in ("input", "elasticity")), strict=True)
    ]
    assert weights == sorted(weights, reverse=True)


def test_growth_shortens_what_an_input_gains():
    """d ln(years) / d ln(passes) = (1 - (1+t)^-n) / (n ln(1+t)) of a geometric growth t over n years."""
    traffic = Traffic((AxleClass("heavy", 1.0, 32.5e3, 850e3),), 1e5, growth=0.05, wander=Wander.normal(0.2))
    design = Design(TIRE, ROAD, traffic, Climate.constant(15.0), (BASE,), **COARSE)
    life = solve_life(design, workers=1)
    found = life_sensitivity(design, life, workers=1).dataset["elasticity"]
    years = life.years("base")
    expected = (1 - 1.05**-years) / (years * math.log(1.05))
    # A central difference of 5 % errs by its square.
    assert found.sel(input="passes").item() == pytest.approx(-expected, rel=5e-3)
    assert found.sel(input="wander").item() > 0


@pytest.mark.slow
def test_what_cannot_be_changed_is_said():
    layers = [Layer(Prony(9e9, [(0.3, 0.05)], 0.35), 0.2, "asphalt"), *ROAD.layers[2:]]
    traffic = Traffic((AxleClass("one", 1.0, 32.5e3, 820e3, speed=20.0),), 1e5)
    base = Criterion("base", FatigueLine(90e-6, -0.2), 0)
    sensitivity, found = elasticities(traffic, Climate.constant(15.0), Pavement(layers), (base,))
    assert "modulus of asphalt" not in found
    assert any("viscoelastic" in text for text in sensitivity.skipped)
    assert TEMPERATURE not in found


def test_a_life_without_end_has_no_sensitivity():
    traffic = Traffic((AxleClass("one", 1.0, 32.5e3, 850e3),), 0.0)
    design = Design(TIRE, ROAD, traffic, Climate.constant(15.0), (BASE,), **COARSE)
    life = solve_life(design, workers=1)
    with pytest.raises(InputError, match="ever fails"):
        life_sensitivity(design, life)
    with pytest.raises(InputError, match="coverage"):
        life_sensitivity(design, life, coverage=0.0)
