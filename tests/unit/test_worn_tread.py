"""A worn tread: what wear takes off a profile, its grooves and its belt, and the contact that follows."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.errors import InputError
from treadload.steps import case_as_python
from treadload.tire import Belt, Groove, LateralGrooves, TreadProfile

PROFILE = {
    "rolling_radius": "500 mm", "crown_radius": "1.2 m", "width": "200 mm", "name": "two grooves",
    "grooves": [
        {"centre": "-33 mm", "width": "12 mm", "depth": "10 mm", "wall_angle": "10 deg"},
        {"centre": "33 mm", "width": "12 mm", "depth": "15 mm"},
    ],
}  # fmt: skip
TABLE = {
    "spacing": "12 mm",
    "tire": {
        "profile": PROFILE, "inflation_pressure": "8 bar", "tread": "ribs",
        "belt": {"tread": {"kind": "elastic", "modulus": "5.5 MPa", "poisson": 0.495}},
    },
    "pavement": {"layers": [{"material": {"kind": "elastic", "modulus": "5 GPa", "poisson": 0.35}}]},
    "rolling": {"normal_load": "25 kN", "friction": 0.7, "creepage_x": -0.01, "creepage_y": 0.02},
}  # fmt: skip


def case(**tire):
    return tl.Case.from_dict({**TABLE, "tire": TABLE["tire"] | tire})


def test_wear_moves_the_surface_and_leaves_floors_and_walls():
    new = TreadProfile.from_dict(PROFILE)
    old = new.worn("4 mm")
    assert old.rolling_radius == pytest.approx(0.496, abs=1e-12)
    assert (old.crown_radius, old.width) == (new.crown_radius, new.width)
    # Above the floors the meridian is as it was; the floors keep their radius.
    y = np.array([-0.09, -0.05, 0.0, 0.06])
    assert old.drop(y) == pytest.approx(new.drop(y), abs=1e-12)
    floors = np.array([-0.033, 0.033])
    assert old.rolling_radius - old.drop(floors) == pytest.approx(new.rolling_radius - new.drop(floors), abs=1e-12)
    # Walls at 10°: 4 mm lower they are 2 · 4 mm · tan 10° nearer.
    assert old.grooves[0].width == pytest.approx(0.012 - 0.008 * math.tan(math.radians(10)), abs=1e-12)
    assert old.grooves[1].width == new.grooves[1].width


def test_a_groove_that_is_worn_away_is_gone():
    old = TreadProfile.from_dict(PROFILE).worn(0.012)
    assert [groove.depth for groove in old.grooves] == [pytest.approx(0.003)]
    lugs = TreadProfile(0.5, 1.2, 0.2, lateral=(LateralGrooves(0.07, 0.008, 0.012),))
    assert lugs.worn(0.002).lateral[0].depth == pytest.approx(0.010)
    assert Groove(0.0, 0.01, 0.01).worn(0.01) is None


@pytest.mark.parametrize("wear", [-1e-3, 0.015, "20 mm"])
def test_more_wear_than_grooves_is_rejected(wear):
    with pytest.raises(InputError, match=r"less than 15 mm, the depth of the deepest groove"):
        TreadProfile.from_dict(PROFILE).worn(wear)
    with pytest.raises(InputError, match=r"wear must be at least 0 and (less than 15|at most 19) mm"):
        case(wear=wear).build_tire()


def test_wear_leaves_tread_on_the_belt():
    belt = Belt(tread_thickness=0.012, arm=0.009).worn("10 mm")
    assert (belt.tread_thickness, belt.arm) == (pytest.approx(0.002), 0.0)
    with pytest.raises(InputError, match=r"at most 11 mm, which leaves 1 mm of tread"):
        Belt(tread_thickness=0.012, arm=0.009).worn("11.5 mm")
    with pytest.raises(InputError, match=r"wear is worn off a profile; this tire is a scan"):
        tl.Case.from_dict({**TABLE, "tire": {"scan": "example", "wear": "2 mm", "inflation_pressure": "8 bar"}})


@pytest.mark.slow
def test_a_worn_case_is_the_case_of_the_worn_numbers():
    worn = tl.run(case(wear="4 mm")).contact.dataset
    profile = {**PROFILE, "rolling_radius": 0.496, "grooves": [
        {**PROFILE["grooves"][0], "depth": 0.006, "width": 0.012 - 0.008 * math.tan(math.radians(10))},
        {**PROFILE["grooves"][1], "depth": 0.011},
    ]}  # fmt: skip
    belt = {**TABLE["tire"]["belt"], "tread_thickness": "16 mm", "arm": "16 mm"}
    by_hand = tl.run(case(profile=profile, belt=belt)).contact.dataset
    np.testing.assert_allclose(worn.pressure, by_hand.pressure, rtol=1e-9, atol=1e-3)
    np.testing.assert_allclose(worn.traction_y, by_hand.traction_y, rtol=1e-9, atol=1e-3)
    # Shorter ribs are stiffer in shear.
    new = tl.run(case()).contact.dataset
    assert abs(float(worn.lateral_force)) > 1.05 * abs(float(new.lateral_force))


def test_an_undertread_stays_below_worn_grooves():
    part = case(wear="4 mm", undertread="5 mm").build_tire()
    assert part.carcass.belt.tread_thickness == pytest.approx(0.011 + 0.005)


def test_a_worn_case_as_python_gives_the_same_tire():
    script = case_as_python(case(wear="4 mm"))
    assert "'wear': 0.004" in script
    assert "case.build_tire()" in script
