"""solve_transient and turn_on_the_spot: what a user gives, gets and is refused."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.contact.friction.laws import Anisotropic, Exponential, PressureDependent
from treadload.contact.transient import solve_transient
from treadload.contact.turning import turn_on_the_spot
from treadload.errors import GeometryError, InputError
from treadload.variables import VARIABLES

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
SPACING, LOAD, MU = 0.012, 3000.0, 0.7


def height_map(nx=24, ny=26):
    x = SPACING * (np.arange(nx) - (nx - 1) / 2)
    y = SPACING * (np.arange(ny) - (ny - 1) / 2)
    return x[None, :] ** 2 / 0.7 + y[:, None] ** 2 / 0.9


# ν = 0.5 on a stiff road: pressure and shear hardly know each other. ν = 0.4: they do.
TIRE = tl.Tire.from_height_map(height_map(), SPACING, material=tl.Elastic(1e6, 0.5))
SOFT = tl.Tire.from_height_map(height_map(), SPACING, material=tl.Elastic(1e6, 0.4))


def wheel(**given):
    return tl.Rolling(normal_load=LOAD, friction=MU, **given)


def test_drive_off():
    lines = []
    found = solve_transient(
        TIRE, ROAD, wheel(creepage_x=-0.02), distances=SPACING * np.arange(1, 13), progress=lines.append
    )
    d = found.dataset
    assert d.sizes == {"step": 13}
    assert all(name in VARIABLES for name in (*d.data_vars, *d.coords))
    assert all("units" in d[name].attrs for name in d.variables)
    assert d.tractive_force[0] == pytest.approx(0, abs=1e-9 * LOAD)
    # Driving pulls the tire forward, more and more.
    assert (np.diff(d.tractive_force) > 0).all()
    assert float(d.tractive_force[-1]) < MU * LOAD
    assert np.isnan(d.creepage_x[0])
    np.testing.assert_allclose(d.creepage_x[1:], -0.02)
    np.testing.assert_allclose(d.shift_x[1:], -0.02 * SPACING, rtol=1e-9)
    np.testing.assert_allclose(d.normal_load, LOAD, rtol=1e-6)
    np.testing.assert_allclose(d.distance, SPACING * np.arange(13))
    assert "step 12 of 12" in lines
    assert "12 steps" in found.summary()
    assert "TransientResult" in repr(found)
    # The contact at the end is one like any other: the tire pushes the road backwards.
    contact = found.contact.dataset
    total = float(contact.traction_x.sum()) * SPACING**2
    assert total == pytest.approx(-float(d.tractive_force[-1]), rel=1e-9)
    slips = contact.state.values == 2
    along = (contact.traction_x * contact.slip_x + contact.traction_y * contact.slip_y).values
    assert (along[slips] > 0).all()
    response = tl.solve_response(found.contact, ROAD, depths=[0.02])
    assert float(response.dataset.principal_strain_1.max()) > 0


def test_fields_of_every_step():
    found = solve_transient(TIRE, ROAD, wheel(creepage_x=-0.02), distances=[0.004, 0.02], fields=True)
    d = found.dataset
    assert d.traction_x.dims == ("step", "y", "x")
    np.testing.assert_allclose(d.traction_x.sum(("y", "x")) * SPACING**2, -d.tractive_force, atol=1e-9 * LOAD)
    np.testing.assert_array_equal(d.state[-1], found.contact.dataset.state)
    np.testing.assert_array_equal(d.state > 0, d.pressure > 0)


def test_the_end_is_steady_rolling():
    given = wheel(tractive_force=900.0, lateral_force=-400.0)
    steady = tl.solve_contact(SOFT, ROAD, given).dataset
    found = solve_transient(SOFT, ROAD, given, distances=SPACING * np.arange(50))
    # 49 steps are four lengths of the contact; each forgets four fifths or more of what was.
    assert float(found.dataset.creepage_x[-1]) == pytest.approx(float(steady.creepage_x), rel=5e-3)
    assert float(found.dataset.creepage_y[-1]) == pytest.approx(float(steady.creepage_y), rel=5e-3)
    assert float(found.dataset.aligning_moment[-1]) == pytest.approx(float(steady.aligning_moment), rel=0.02)


def test_forces_shift_the_standing_wheel():
    found = solve_transient(TIRE, ROAD, wheel(tractive_force=800.0), distances=[0.0, 0.0, SPACING])
    d = found.dataset
    assert float(d.shift_x[1]) < 0
    assert float(d.shift_x[2]) == pytest.approx(0, abs=1e-5 * abs(float(d.shift_x[1])))
    assert np.isnan(d.creepage_x[:3]).all()
    assert float(d.creepage_x[3]) < 0
    np.testing.assert_allclose(d.tractive_force[1:], 800.0, rtol=1e-6)


def test_loads_and_forces_may_change_on_the_way():
    loads, forces = (2000.0, 3000.0, 2500.0), (0.0, 500.0, -500.0)
    way = [
        tl.Rolling(normal_load=p, friction=MU, tractive_force=q, spin=0.1) for p, q in zip(loads, forces, strict=True)
    ]
    d = solve_transient(SOFT, ROAD, way, distances=[0.01, 0.015, 0.03]).dataset
    np.testing.assert_allclose(d.normal_load, [2000.0, *loads], rtol=1e-6)
    np.testing.assert_allclose(d.tractive_force[1:], forces, atol=1e-5 * MU * max(loads))
    np.testing.assert_allclose(d.spin[1:], 0.1)


def test_turn_on_the_spot():
    angles = np.linspace(0.0, 0.35, 8)[1:]
    found = turn_on_the_spot(TIRE, ROAD, wheel(), angles=angles)
    d = found.dataset
    assert all(name in VARIABLES for name in (*d.data_vars, *d.coords))
    torque = d.steering_torque.values
    assert torque[0] == pytest.approx(0, abs=1e-6 * torque[-1])
    # Towards full sliding, ever flatter, and never beyond.
    assert (np.diff(torque) > 0).all()
    assert (np.diff(torque, 2) < 0).all()
    assert torque[-1] <= float(d.sliding_torque) * (1 + 1e-6)
    assert torque[-1] > 0.98 * float(d.sliding_torque)
    np.testing.assert_allclose(d.tractive_force, 0, atol=1e-6 * MU * LOAD)
    np.testing.assert_allclose(d.lateral_force, 0, atol=1e-6 * MU * LOAD)
    # A symmetric tread turns about its middle.
    np.testing.assert_allclose(d.pole_x[1:], 0, atol=1e-5)
    assert found.stiffness == pytest.approx(torque[1] / angles[0])
    assert "sliding" in found.summary()
    assert "N m" in repr(found)
    # To the right, seen from above with x ahead and y to the right: in front the tire drags the road to the right.
    front = found.contact.dataset.traction_y.sel(x=slice(0.02, None))
    assert float(front.sum()) > 0
    assert math.isnan(float(found.contact.dataset.creepage_x))
    assert np.isfinite(found.contact.dataset.slip_distance_x).all()


def test_turning_back_makes_a_loop():
    there = np.linspace(0, 0.2, 6)[1:]
    angles = np.concatenate([there, there[-2::-1], [0.0], -there, -there[-2::-1], [0.0], there])
    d = turn_on_the_spot(TIRE, ROAD, wheel(), angles=angles).dataset
    torque = d.steering_torque.values
    peak = torque[5]
    # After one turn to and fro the loop is closed, and odd.
    assert torque[15] == pytest.approx(-peak, rel=0.02)
    assert torque[-1] == pytest.approx(peak, rel=0.02)
    assert torque[10] < -0.2 * peak
    assert (d.friction_energy >= -1e-9).all()


def test_a_pivot_takes_a_force():
    pivot = (0.0, 0.1)
    d = turn_on_the_spot(TIRE, ROAD, wheel(), angles=[0.05, 0.1], pivot=pivot).dataset
    free = turn_on_the_spot(TIRE, ROAD, wheel(), angles=[0.05, 0.1]).dataset
    # Turned to the right about a point to its right, the tire goes ahead: the road holds it back.
    assert float(d.tractive_force[-1]) < 0
    assert float(d.steering_torque[-1]) > float(free.steering_torque[-1])
    assert float(d.steering_torque[-1]) < float(d.sliding_torque)
    np.testing.assert_allclose(d.pole_y[1:], 0.1)


def test_friction_laws_of_pressure_and_direction():
    angles = [0.1, 0.4]
    rubber = PressureDependent(MU, 100e3, 0.2)
    d = turn_on_the_spot(TIRE, ROAD, tl.Rolling(normal_load=LOAD, friction=rubber), angles=angles).dataset
    assert float(d.steering_torque[-1]) == pytest.approx(float(d.sliding_torque), rel=0.02)
    ellipse = Anisotropic(0.9, 0.5)
    d = turn_on_the_spot(TIRE, ROAD, tl.Rolling(normal_load=LOAD, friction=ellipse), angles=angles).dataset
    assert float(d.steering_torque[-1]) == pytest.approx(float(d.sliding_torque), rel=0.02)
    falling = tl.Rolling(normal_load=LOAD, friction=Exponential(0.8, 0.5, 1.0), speed=10.0)
    with pytest.raises(InputError, match="falls with slip"):
        turn_on_the_spot(TIRE, ROAD, falling, angles=angles)


def test_without_friction_nothing_holds():
    rolling = tl.Rolling(normal_load=LOAD, friction=0.0)
    assert not turn_on_the_spot(TIRE, ROAD, rolling, angles=[0.1]).dataset.steering_torque.any()
    slides = tl.Rolling(normal_load=LOAD, friction=0.0, creepage_x=-0.1)
    assert not solve_transient(TIRE, ROAD, slides, distances=[0.01]).dataset.tractive_force.any()


@pytest.mark.parametrize(
    ("distances", "match"),
    [([], "at least one"), ([0.01, np.nan], "finite"), ([0.02, 0.01], "ascend"), ([-0.01], "ascend")],
)
def test_distances_refused(distances, match):
    with pytest.raises(InputError, match=match):
        solve_transient(TIRE, ROAD, wheel(), distances=distances)


@pytest.mark.parametrize(
    ("angles", "match"),
    [([], "at least one"), ([np.inf], "finite"), ([30.0], "radians"), ([0.1, 0.1], "turns by nothing")],
)
def test_angles_refused(angles, match):
    with pytest.raises(InputError, match=match):
        turn_on_the_spot(TIRE, ROAD, wheel(), angles=angles)


def test_states_refused():
    with pytest.raises(InputError, match="does not roll"):
        turn_on_the_spot(TIRE, ROAD, wheel(spin=0.1), angles=[0.1])
    with pytest.raises(InputError, match="held pivot"):
        turn_on_the_spot(TIRE, ROAD, wheel(tractive_force=10.0), angles=[0.1], pivot=(0.0, 0.0))
    with pytest.raises(InputError, match="one for each"):
        solve_transient(TIRE, ROAD, [wheel()], distances=[0.01, 0.02])
    with pytest.raises(InputError, match="throughout"):
        solve_transient(TIRE, ROAD, [wheel(), tl.Rolling(approach=0.01, friction=MU)], distances=[0.01, 0.02])
    with pytest.raises(InputError, match="gross sliding"):
        solve_transient(TIRE, ROAD, wheel(tractive_force=2 * MU * LOAD), distances=[0.01])
    with pytest.raises(GeometryError, match="border"):
        solve_transient(TIRE, ROAD, tl.Rolling(normal_load=1e6, friction=MU), distances=[0.01])
