"""solve_transient and turn_on_the_spot: what a user gives, gets and is refused."""

import math

import numpy as np
import pytest

import treadload as tl
from treadload.contact.friction.laws import Anisotropic, Exponential, PressureDependent
from treadload.contact.transient import solve_transient
from treadload.contact.turning import turn_on_the_spot
from treadload.errors import GeometryError, InputError
from treadload.rows import blocks_of, table_of
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


def test_a_wheel_beside_the_origin_turns_about_its_own_middle():
    """What happens does not depend on where the axes have their origin; the pole moves along."""
    shift, angles = (3, -2), [0.02, 0.1, 0.05]
    moved = np.roll(height_map(), (shift[1], shift[0]), axis=(0, 1))
    aside = tl.Tire.from_height_map(moved, SPACING, material=TIRE.material)
    light = tl.Rolling(normal_load=1000.0, friction=MU)
    one, other = (turn_on_the_spot(tire, ROAD, light, angles=angles).dataset for tire in (TIRE, aside))
    np.testing.assert_allclose(other.steering_torque, one.steering_torque, rtol=1e-4, atol=1e-4 * MU * LOAD * SPACING)
    np.testing.assert_allclose(other.slip_fraction, one.slip_fraction, atol=1e-12)
    # Also in the first increment, and on the way back.
    np.testing.assert_allclose(other.pole_x[1:], SPACING * shift[0], atol=1e-5)
    np.testing.assert_allclose(other.pole_y[1:], SPACING * shift[1], atol=1e-5)
    assert np.isnan(other.pole_x[0])
    assert np.isnan(other.pole_y[0])
    # To the first order a turn about that pole is a turn about the origin and a shift.
    np.testing.assert_allclose(other.shift_x[1:], SPACING * shift[1] * np.diff([0, *angles]), atol=1e-6)
    np.testing.assert_allclose(other.shift_y[1:], -SPACING * shift[0] * np.diff([0, *angles]), atol=1e-6)


def rows(result):
    """(steps, keys) the numbers as the table of the summary shows them."""
    (block,) = [block for block in blocks_of(result.rows()) if len(block) > 1]
    return np.array([[np.nan if cell == "–" else float(cell) for cell in line[1:]] for line in table_of(block)[1:]])


def test_the_summary_of_a_turn_is_that_of_its_increments():
    angles = np.linspace(0, 0.3, 13)[1:]
    found = turn_on_the_spot(TIRE, ROAD, wheel(), angles=angles)
    table = rows(found)
    d = found.dataset
    assert len(table) == 9
    np.testing.assert_allclose(table[[0, -1], 0], [0.0, math.degrees(0.3)], atol=5e-3)
    told = np.searchsorted(np.degrees(d.turn_angle.to_numpy()), table[:, 0] - 0.01)
    assert (np.diff(told) > 0).all()
    np.testing.assert_allclose(table[:, 1], d.steering_torque[told], atol=0.05)
    np.testing.assert_allclose(table[:, 2], 100 * d.slip_fraction[told], atol=0.05)
    assert f"torque of full sliding  {float(d.sliding_torque):.1f} N m" in found.summary()
    assert f"{math.radians(found.stiffness):.1f} N m/°" in found.summary()
    assert f"{float(d.friction_energy.sum()):.3f} J" in found.summary()
    assert f"{table[-1, 1]:.1f} N m at {table[-1, 0]:.2f}°" in repr(found)
    assert found.stats["increments"] == 12
    assert found.stats["cells"] == 24 * 26
    assert 0 < found.stats["seconds"] < 600
    assert found.stats["newton_iterations"] >= 12


def test_the_summary_of_a_history_is_that_of_its_steps():
    found = solve_transient(
        TIRE, ROAD, wheel(creepage_x=-0.02, lateral_force=300.0), distances=SPACING * np.arange(1, 12)
    )
    table = rows(found)
    d = found.dataset
    assert len(table) == 8
    told = np.round(table[:, 0] / (1e3 * SPACING)).astype(int)
    assert told[0] == 0
    assert told[-1] == 11
    np.testing.assert_allclose(table[:, 0], 1e3 * d.distance[told], atol=0.05)
    np.testing.assert_allclose(table[:, 1], d.tractive_force[told], atol=0.05)
    np.testing.assert_allclose(table[:, 2], d.lateral_force[told], atol=0.05)
    np.testing.assert_allclose(table[:, 3], d.creepage_x[told], atol=5e-6)
    np.testing.assert_allclose(table[:, 4], d.creepage_y[told], atol=5e-6)
    np.testing.assert_allclose(table[:, 5], 100 * d.slip_fraction[told], atol=0.05)
    assert f"{1e3 * 11 * SPACING:.1f} mm, 11 steps" in found.summary()
    assert f"{1e3 * 11 * SPACING:.1f} mm in 11 steps" in repr(found)
    assert f"{float(d.friction_energy.sum()):.3f} J" in found.summary()
    assert (found.stats["steps"], found.stats["cells"]) == (11, 24 * 26)
    assert 0 < found.stats["seconds"] < 600


def test_work_of_a_slide_is_force_times_way():
    """A wheel that is dragged with all of its contact sliding loses μP a metre."""
    way = [0.05, 0.056, 0.062]
    found = solve_transient(TIRE, ROAD, wheel(creepage_x=1.0), distances=way)
    d = found.dataset
    # Pressure moves the tread aside by a hundredth of the way, and its square counts.
    np.testing.assert_allclose(d.tractive_force[1:], -MU * LOAD, rtol=2e-4)
    # What a particle gives way on entering it takes back on leaving, but for a per cent with steps this long.
    np.testing.assert_allclose(d.friction_energy[2:], MU * LOAD * np.diff(way), rtol=0.012)
    # In the first step, from rest, the tread follows as far as it bends.
    assert 0 < float(d.friction_energy[1]) < MU * LOAD * 0.05
    assert float(d.friction_energy[0]) == 0
    np.testing.assert_array_equal(d.slip_fraction[1:], 1.0)
    last = found.contact.dataset
    touching = last.pressure.to_numpy() > 0
    assert float((last.slip_x * last.pressure).sum() / last.pressure.sum()) == pytest.approx(1.0, rel=0.012)
    np.testing.assert_allclose(last.slip_distance_x, 0.006 * last.slip_x, rtol=1e-12)
    np.testing.assert_allclose(last.slip_distance_y, 0.006 * last.slip_y, rtol=1e-12)
    np.testing.assert_allclose(last.friction_coefficient.to_numpy()[touching], MU, rtol=1e-12)
    assert not last.friction_coefficient.to_numpy()[~touching].any()
    assert float(last.friction) == pytest.approx(MU, rel=1e-12)


def test_an_approach_that_does_not_touch_is_refused_in_its_step():
    tire = tl.Tire.from_height_map(height_map() + 0.01, SPACING, material=TIRE.material)
    touching = tl.Rolling(approach=2e-3, friction=MU)
    assert float(solve_transient(tire, ROAD, touching, distances=[SPACING]).dataset.normal_load[-1]) > 0
    with pytest.raises(InputError, match=r"approach here|normal_load here"):
        solve_transient(tire, ROAD, [touching, wheel()], distances=[SPACING, 2 * SPACING])


def test_what_runs_back_is_named_with_where_it_was():
    for distances, got in (([0.01, 0.03, 0.02], "got 0.02 m after 0.03 m"), ([-0.01], "got -0.01 m after 0 m")):
        with pytest.raises(InputError, match=got):
            solve_transient(TIRE, ROAD, wheel(), distances=distances)
    with pytest.raises(InputError, match="increment 3 turns by nothing"):
        turn_on_the_spot(TIRE, ROAD, wheel(), angles=[0.1, 0.2, 0.2, 0.3])
    with pytest.raises(InputError, match=r"got 3\.2; for degrees"):
        turn_on_the_spot(TIRE, ROAD, wheel(), angles=[0.1, -3.2])
    with pytest.raises(InputError, match="list of finite numbers in rad"):
        turn_on_the_spot(TIRE, ROAD, wheel(), angles=[[0.1, 0.2], [0.3, 0.4]])
    with pytest.raises(InputError, match="list of finite numbers in m"):
        solve_transient(TIRE, ROAD, wheel(), distances=[[0.1, 0.2], [0.3, 0.4]])
    with pytest.raises(InputError, match="one for each of the 2 distances; got 3"):
        solve_transient(TIRE, ROAD, [wheel()] * 3, distances=[0.1, 0.2])


def test_where_nothing_rolls_nothing_creeps():
    """The wheel that stands, and a step of no distance, have no creepage and no spin, whatever is prescribed."""
    d = solve_transient(TIRE, ROAD, wheel(creepage_x=-0.02, spin=0.1), distances=[0.0, SPACING, SPACING]).dataset
    for name, value in (("creepage_x", -0.02), ("creepage_y", 0.0), ("spin", 0.1)):
        assert np.isnan(d[name].to_numpy()[[0, 1, 3]]).all(), name
        if name != "creepage_y":
            assert float(d[name][2]) == value
    # Nothing moves there, and no work is lost.
    for step in (0, 1, 3):
        assert float(d.shift_x[step]) == pytest.approx(0, abs=1e-12)
        assert float(d.friction_energy[step]) == pytest.approx(0, abs=1e-9)
