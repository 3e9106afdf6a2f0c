"""Before and after the layers part: Miner's sum in two phases, both roads side by side."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from treadload.contact.maneuver import Maneuver
from treadload.damage import Criterion, FatigueLine, InterfaceStrength, ShearFatigue
from treadload.damage.climate import Climate
from treadload.damage.miner import passes_in_two_phases
from treadload.damage.traffic import AxleClass, Traffic, Wander
from treadload.errors import InputError
from treadload.life.delamination import AFTER, BEFORE, PARTING, compare_bonds, solve_interfaces
from treadload.life.design import Design
from treadload.life.solve import solve_life
from treadload.materials import Elastic
from treadload.pavement import FRICTIONLESS, Bond, Layer, Pavement
from treadload.response import UniformRectangle, solve_response
from treadload.tire import Tire

TIRE = Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
ROAD = Pavement(
    [
        Layer(Elastic(7e9, 0.35), 0.06, name="wearing course"),
        Layer(Elastic(9e9, 0.35), 0.15, name="base"),
        Layer(Elastic(120e6, 0.35), name="soil"),
    ]
)
TRAFFIC = Traffic(
    (AxleClass("braking", 1.0, 32.5e3, 820e3, maneuver=Maneuver.braking(4.0)),),
    1e5,
    growth=0.02,
    wander=Wander.normal(0.2),
)
CLIMATE = Climate.constant(15.0)
LINE = FatigueLine(100e-6, -0.2)
BOND = Criterion.of_bond("upper bond", InterfaceStrength(1e6), ShearFatigue(-0.1))
CRITERIA = (
    Criterion("wearing course", LINE, 0),
    Criterion("base", LINE, 1),
    BOND,
    Criterion.of_bond("lower bond", InterfaceStrength(1e6), ShearFatigue(-0.1), 1),
)
COARSE = {"spacing": 12e-3}


@pytest.fixture(scope="module")
def compared():
    return compare_bonds(Design(TIRE, ROAD, TRAFFIC, CLIMATE, CRITERIA, **COARSE), workers=1)


@pytest.mark.parametrize(
    ("before", "after", "change", "wanted"),
    [
        # 2e5 of 1e6 passes are used when the rate becomes tenfold: 0.8 of 1e5 are left.
        (1e-6, 1e-5, 2e5, 2e5 + 0.8e5),
        # Used up before the change, at it, never changed, no damage before, none after, none at all.
        (1e-5, 1e-3, 2e5, 1e5),
        (1e-6, 1e-3, 1e6, 1e6),
        (1e-6, 1e-3, math.inf, 1e6),
        (0.0, 1e-4, 3e5, 3e5 + 1e4),
        (1e-6, 0.0, 2e5, math.inf),
        (0.0, 0.0, 2e5, math.inf),
        # A change at once leaves the second rate alone.
        (1e-6, 1e-4, 0.0, 1e4),
    ],
)
def test_two_phases_by_hand(before, after, change, wanted):
    found = passes_in_two_phases(np.array([before]), np.array([after]), change)
    assert found[0] == pytest.approx(wanted, rel=1e-12)


@settings(deadline=None, max_examples=100)
@given(st.floats(1e-9, 1e-3), st.floats(1e-9, 1e-3), st.floats(1.0, 1e9))
def test_two_phases_add_up_to_one_and_lie_between_their_lives(before, after, change):
    n = float(passes_in_two_phases(np.array([before]), np.array([after]), change)[0])
    first = min(n, change)
    assert first * before + (n - first) * after == pytest.approx(1.0, rel=1e-9)
    assert min(1 / before, 1 / after) * (1 - 1e-9) <= n <= max(1 / before, 1 / after) * (1 + 1e-9)


def test_both_lives_are_those_of_their_roads(compared):
    bonded = solve_life(Design(TIRE, ROAD, TRAFFIC, CLIMATE, CRITERIA, **COARSE), workers=1)
    free = Pavement([Layer(Elastic(7e9, 0.35), 0.06, bond=FRICTIONLESS), *ROAD.layers[1:]])
    parted = solve_life(Design(TIRE, free, TRAFFIC, CLIMATE, CRITERIA, **COARSE), workers=1)
    data = compared.dataset
    for state, life in ((BEFORE, bonded), (AFTER, parted)):
        for name in ("life_passes", "life_years", "largest_reading"):
            wanted = life.dataset[name].to_numpy()
            assert data[name].sel(state=state).to_numpy() == pytest.approx(wanted, rel=1e-12)
    assert (compared.interface, compared.criterion) == (0, "upper bond")
    assert float(data["parting_passes"]) == pytest.approx(float(bonded.dataset["life_passes"][2]), rel=1e-12)
    # Years follow the growth of the traffic.
    assert TRAFFIC.passes(float(data["parting_years"])) == pytest.approx(float(data["parting_passes"]), rel=1e-9)


def test_the_parted_road_bends_in_two_plates(compared):
    """The wearing course, compressed at its bottom while bonded, is pulled there once it bends alone."""
    data = compared.dataset
    readings = data["largest_reading"]
    assert float(readings.sel(state=AFTER, criterion="wearing course")) > 50e-6
    assert float(readings.sel(state=BEFORE, criterion="wearing course")) < 10e-6
    assert float(readings.sel(state=AFTER, criterion="base")) > float(readings.sel(state=BEFORE, criterion="base"))
    # No shear is left where nothing holds: the parted bond itself is no longer used.
    assert float(readings.sel(state=AFTER, criterion="upper bond")) == 0
    assert not any("upper bond" in text for text in compared.warnings)


def test_the_third_life_is_miners(compared):
    """At every y of the damage fields, by hand; it lies between both lives, and the bond's own is its parting."""
    data = compared.dataset
    n1 = float(data["parting_passes"])
    for name in ("wearing course", "base"):
        rates = [
            life.dataset["damage_per_year"].sel(criterion=name).to_numpy() / TRAFFIC.passes_per_year
            for life in (compared.bonded, compared.parted)
        ]
        by_hand = min(
            1 / d1 if d1 * n1 >= 1 else n1 + (1 - n1 * d1) / d2 for d1, d2 in zip(*rates, strict=True) if d2 > 0
        )
        found = data["life_passes"].sel(criterion=name)
        assert float(found.sel(state=PARTING)) == pytest.approx(by_hand, rel=1e-12)
        assert float(found.sel(state=AFTER)) <= float(found.sel(state=PARTING)) <= float(found.sel(state=BEFORE))
    assert float(data["life_passes"].sel(state=PARTING, criterion="upper bond")) == pytest.approx(n1, rel=1e-12)


def test_the_summary_says_both_lives(compared):
    text = compared.summary()
    assert "upper bond fails after" in text
    assert f"{compared.governing} governs" in text
    assert "frictionless" in text
    assert compared.governing in ("wearing course", "base")


def test_a_strong_bond_never_changes_the_life():
    strong = Criterion.of_bond("strong", InterfaceStrength(1e12), ShearFatigue(-0.1))
    glued = Pavement([Layer(Elastic(7e9, 0.35), 0.06), Layer(Elastic(120e6, 0.35))])
    criteria = (Criterion("base", LINE), strong)
    found = compare_bonds(Design(TIRE, glued, TRAFFIC, CLIMATE, criteria, **COARSE), bond=Bond(1e10), workers=1)
    lives = found.dataset["life_passes"].sel(criterion="base")
    # The same sum, divided another way: round-off.
    assert float(lives.sel(state=PARTING)) == pytest.approx(float(lives.sel(state=BEFORE)), rel=1e-13)
    assert float(lives.sel(state=AFTER)) < float(lives.sel(state=BEFORE))


def test_the_user_can_choose_the_interface():
    found = compare_bonds(Design(TIRE, ROAD, TRAFFIC, CLIMATE, CRITERIA, **COARSE), interface=-1, workers=1)
    assert (found.interface, found.criterion) == (1, "lower bond")
    with pytest.raises(InputError, match="the criterion of a bond of interface 1"):
        compare_bonds(Design(TIRE, ROAD, TRAFFIC, CLIMATE, CRITERIA[:3], **COARSE), interface=1, workers=1)
    with pytest.raises(InputError, match="needs the criterion of a bond"):
        compare_bonds(Design(TIRE, ROAD, TRAFFIC, CLIMATE, CRITERIA[:2], **COARSE), workers=1)
    with pytest.raises(InputError, match="2 interface"):
        compare_bonds(Design(TIRE, ROAD, TRAFFIC, CLIMATE, CRITERIA, **COARSE), interface=2, workers=1)


def test_interfaces_are_solved_on_both_sides():
    load = UniformRectangle(0.2, 0.2, 0.8e6, traction_x=0.4e6)
    x = np.linspace(-0.1, 0.1, 3)
    sprung = Pavement([Layer(Elastic(7e9, 0.35), 0.06, bond=Bond(1e9)), *ROAD.layers[1:]])
    fields = solve_interfaces(load, sprung, x=x, y=x)
    above, below = (
        solve_response(load, sprung, depths=[0.06], x=x, y=x, side=side).dataset["displacement_x"].to_numpy()[0]
        for side in ("above", "below")
    )
    jump = fields["jump_x"].isel(interface=0).to_numpy()
    # Two depths at once and one alone are cut at other wavenumbers: 1e-9 of the displacement.
    assert jump == pytest.approx(below - above, abs=1e-9 * np.abs(above).max())
    assert not solve_interfaces(load, ROAD, x=x, y=x)["jump_x"].any()
    free = Pavement([Layer(Elastic(7e9, 0.35), 0.06, bond=FRICTIONLESS), *ROAD.layers[1:]])
    told = solve_interfaces(load, free, x=x, y=x)
    assert "net shear force" in told.attrs["warnings"]
    with pytest.raises(InputError, match="no interfaces"):
        solve_interfaces(load, Pavement.half_space(Elastic(1e9, 0.3)), x=x, y=x)
