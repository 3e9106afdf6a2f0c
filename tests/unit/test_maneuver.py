"""Maneuvers: statics of the vehicle against its balance of forces, and what the wheel then does to the road."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import treadload as tl
from treadload.contact.friction.laws import Anisotropic
from treadload.contact.maneuver import GRAVITY

SPACING, LOAD, MU = 0.012, 3000.0, 0.7
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))


@pytest.fixture(scope="module")
def tire():
    x, y = (SPACING * (np.arange(n) - (n - 1) / 2) for n in (24, 26))
    gap = x[None, :] ** 2 / 0.7 + y[:, None] ** 2 / 0.9
    return tl.Tire.from_height_map(gap, SPACING, material=tl.Elastic(1e6, 0.5))


def balance(pull, crossfall, height, track):
    """Outer and inner load and side force over the weight, from the balance of a rigid vehicle in a turn."""
    angle = math.atan(crossfall)
    # Towards the centre and up: the normal leans inwards, the side force points inwards and down.
    normal, along = (math.sin(angle), math.cos(angle)), (math.cos(angle), -math.sin(angle))
    balance_of = [
        [normal[0], normal[0], along[0]],  # sideways: V²/(gR) of the weight
        [normal[1], normal[1], along[1]],  # upwards: the weight
        # About the centre of gravity: the outer wheel's load lifts the outer side, the side force presses on it.
        [track / 2, -track / 2, -height],
    ]
    return np.linalg.solve(balance_of, [pull, 1.0, 0.0])


@given(
    st.floats(5, 200), st.floats(0.01, 0.35), st.floats(-0.06, 0.06), st.floats(0.5, 2.0), st.floats(1.6, 2.2),
)  # fmt: skip
def test_leaning_is_the_balance_of_a_rigid_vehicle(radius, pull, crossfall, height, track):
    speed = math.sqrt(pull * GRAVITY * radius)
    outer, inner = (
        tl.contact.Maneuver.turning(
            -radius, speed, crossfall=crossfall, track=track, centre_of_gravity=height, wheel=wheel
        )
        for wheel in ("outer", "inner")
    )
    on_outer, on_inner, side = balance(pull, crossfall, height, track)
    # Each wheel's load on level ground is half the weight; round-off of a few operations.
    assert outer.load_ratio == pytest.approx(2 * on_outer, rel=1e-12)
    assert inner.load_ratio == pytest.approx(2 * on_inner, rel=1e-12)
    # All wheels together hold the vehicle on its path, to the left here.
    held = 0.5 * (outer.lateral * outer.load_ratio + inner.lateral * inner.load_ratio)
    assert held == pytest.approx(-side, rel=1e-12, abs=1e-12)


def test_the_outer_wheel_by_hand():
    # A fifth of g, h/t = 0.9: 2 x 0.2 x 0.9 = 0.36 of the load changes sides.
    turn = tl.contact.Maneuver.turning(20.0, math.sqrt(0.2 * GRAVITY * 20), track=2.0, centre_of_gravity=1.8)
    state = turn.rolling(25e3, MU)
    assert state.normal_load == pytest.approx(1.36 * 25e3, rel=1e-12)
    assert state.forces == pytest.approx((0.0, 0.2 * 1.36 * 25e3), rel=1e-12)
    assert state.spin == 1 / 20
    assert str(turn).endswith("outer wheel")


def test_without_a_vehicle_the_load_stays():
    assert tl.contact.Maneuver.turning(12.0, 6.0, crossfall=0.025).rolling(25e3, MU).normal_load == 25e3
    assert tl.contact.STRAIGHT.rolling(25e3, MU) == tl.Rolling(
        normal_load=25e3, friction=MU, tractive_force=0.0, lateral_force=0.0
    )


@given(st.floats(5, 300), st.floats(0.1, 1.0), st.floats(-0.06, 0.06))
def test_friction_carries_a_turn_up_to_its_speed(radius, friction, crossfall):
    # V² = g R (μ + c) / (1 - μ c): the side force then reaches μ times the load.
    fastest = math.sqrt(GRAVITY * radius * (friction + crossfall) / (1 - friction * crossfall))
    assert tl.contact.Maneuver.turning(radius, 0.999 * fastest, crossfall=crossfall).rolling(LOAD, friction)
    with pytest.raises(tl.InputError, match=r"turning, R = .*lower the speed, or take a wider circle"):
        tl.contact.Maneuver.turning(radius, 1.001 * fastest, crossfall=crossfall).rolling(LOAD, friction)


def test_friction_of_the_direction_decides():
    # 0.4 along travel and 0.8 across it carry a side force of 0.6.
    turn = tl.contact.Maneuver("turn", lateral=0.6)
    assert turn.rolling(LOAD, Anisotropic(0.4, 0.8))
    with pytest.raises(tl.InputError, match="lower the speed"):
        turn.rolling(LOAD, Anisotropic(0.8, 0.4))


def test_a_braked_wheel_up_to_a_locked_one(tire):
    firm = tl.contact.Maneuver.braking(0.8 * MU * GRAVITY)
    braked, locked = (
        tl.solve_contact(tire, ROAD, m.rolling(LOAD, MU)) for m in (firm, tl.contact.Maneuver.braking())
    )
    # The tolerance of the solver.
    assert float(braked.dataset.tractive_force) == pytest.approx(-0.8 * MU * LOAD, rel=1e-5)
    assert 0 < float(braked.dataset.creepage_x) < 1
    assert braked.slip_fraction < 1
    assert locked.slip_fraction == 1
    # All of μp, but for the part that the tire's own deformation turns aside: its share is second order.
    assert float(locked.dataset.tractive_force) == pytest.approx(-MU * LOAD, rel=1e-3)
    # The road feels the wheel drag it along.
    assert float(locked.dataset.traction_x.sum()) > 0


def test_the_contact_of_a_turn_carries_its_forces(tire):
    turn = tl.contact.Maneuver.turning(12.0, 6.0, track=2.0, centre_of_gravity=1.8)
    data = tl.solve_contact(tire, ROAD, turn.rolling(LOAD, MU)).dataset
    load = LOAD * (1 + 2 * 0.9 * 36 / (12 * GRAVITY))
    # The tolerance of the solver.
    assert float(data.normal_load) == pytest.approx(load, rel=1e-5)
    assert float(data.lateral_force) == pytest.approx(36 / (12 * GRAVITY) * load, rel=1e-5)
    assert float(data.spin) == pytest.approx(1 / 12)


def test_a_parking_turn_twists_the_road(tire):
    angles = np.radians([5.0, 15.0, 30.0])
    turn = tl.contact.turn_on_the_spot(tire, ROAD, tl.Rolling(normal_load=LOAD, friction=MU), angles=angles)
    data = tl.solve_response(turn.contact, ROAD, depths=[0.0]).dataset.isel(depth=0)
    # At the surface stress_xz = -traction_x: the torque that turns the wheel arrives in the road.
    twist = -(data.x * data.stress_yz - data.y * data.stress_xz).sum() * SPACING**2
    assert float(twist) == pytest.approx(float(turn.dataset.steering_torque[-1]), rel=1e-9)
    standing = tl.solve_contact(tire, ROAD, tl.contact.STRAIGHT.rolling(LOAD, MU))
    before = tl.solve_response(standing, ROAD, depths=[0.0]).dataset
    assert float(data.principal_strain_1.max()) > 3 * float(before.principal_strain_1.max())


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: tl.contact.Maneuver.turning(12, 5, track=2.0), "give centre_of_gravity too"),
        (lambda: tl.contact.Maneuver.turning(12, 5, centre_of_gravity=2.0), "give track too"),
        (
            lambda: tl.contact.Maneuver.turning(12, 5, track=-2.0, centre_of_gravity=2.0),
            "track must be a positive number of metres, got -2",
        ),
        (
            lambda: tl.contact.Maneuver.turning(12, 5, track=2.0, centre_of_gravity=0.0),
            "centre_of_gravity must be a positive",
        ),
        (
            lambda: tl.contact.Maneuver.turning(12, 10, track=2.0, centre_of_gravity=2.0),
            "tips: a side force of 0.849",
        ),
        (lambda: tl.contact.Maneuver.turning(12, 5, wheel="left"), '"outer" or "inner"'),
        (lambda: tl.contact.Maneuver.turning(12, -5), "speed must be >= 0"),
        (lambda: tl.contact.Maneuver.turning(12, 5, crossfall=2.5), "2.5 % is 0.025"),
        (lambda: tl.contact.Maneuver("x", load_ratio=0), "load_ratio of the maneuver 'x' must be a positive number"),
        (lambda: tl.contact.Maneuver.braking(8.0).rolling(LOAD, MU), r"braking at 8 m/s².*lock the wheel"),
        (lambda: tl.contact.Maneuver.uphill(0.2, 0.25).rolling(LOAD, MU), "more of the weight on driven axles"),
    ],
)
def test_bad_input_is_named(make, words):
    with pytest.raises(tl.InputError, match=words):
        make()


@pytest.mark.parametrize(
    ("radius", "speed", "crossfall", "words"),
    [
        (12.0, 1e300, 0.0, "by inf of its weight, which no road with a crossfall of 0 can hold"),
        # The road falls away at the very angle at which the pull leaves it: once a division by zero.
        (10.0, math.sqrt(40 * GRAVITY), -0.25, "by 4 of its weight, .* crossfall of -0.25 can hold"),
        (5e-324, 0.0, 0.0, "radius must be a number of metres"),
    ],
)
def test_a_turn_beyond_all_roads_is_refused(radius, speed, crossfall, words):
    with pytest.raises(tl.InputError, match=words):
        tl.contact.Maneuver.turning(radius, speed, crossfall=crossfall)
