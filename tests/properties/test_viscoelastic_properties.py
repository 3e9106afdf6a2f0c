"""What must hold for a viscoelastic tire whatever its tread, rubber, speed and force."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import treadload as tl
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.bodies.viscoelastic import rolling_pair
from treadload.errors import InputError
from treadload.materials import Prony

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
RUBBER = Prony(10e6, ((0.3, 1e-3), (0.4, 2e-2)), 0.45)
SOLID = Prony.standard_linear_solid(10e6, 3e6, 0.01, 0.45)
CELL, LOAD = 0.012, 10e3


def tread(seed, grooved=True):
    """A round tread with random grooves, lugs and roughness; 32 x 28 cells."""
    rng = np.random.default_rng(seed)
    x, y = (np.arange(32) - 15.5) * CELL, (np.arange(28) - 13.5) * CELL
    gap = x[None, :] ** 2 / 1.0 + y[:, None] ** 2 / 1.2 + 5e-4 * rng.random((28, 32))
    if grooved:
        gap[rng.random(28) < 0.15] += 0.02
        gap[:, rng.random(32) < 0.1] += 0.02
    return gap


def solve(material, speed, gap, tractive=2e3, **rolling):
    tire = tl.Tire.from_height_map(gap, CELL, material=material)
    wheel = tl.Rolling(normal_load=LOAD, friction=0.7, tractive_force=tractive, speed=speed, **rolling)
    return tl.solve_contact(tire, ROAD, wheel)


def smooth_tire(speed):
    x = (np.arange(30) - 14.5) * CELL
    return solve(SOLID, speed, x[None, :] ** 2 + x[:, None] ** 2 / 1.2)


@pytest.mark.slow
@given(
    seed=st.integers(0, 10**6),
    speed=st.floats(-3, 3).map(lambda e: 10**e),
    force=st.floats(-0.9, 0.9).map(lambda share: share * 0.7 * LOAD),
    poisson=st.sampled_from([0.45, 0.5]),
    spin=st.sampled_from([0.0, 0.05]),
)
@settings(max_examples=15, deadline=None)
def test_conditions_of_contact_and_energy(seed, speed, force, poisson, spin):
    contact = solve(Prony(10e6, ((0.3, 1e-3), (0.4, 2e-2)), poisson), speed, tread(seed), force, spin=spin)
    d = contact.dataset
    pressure, gap = d.pressure.values, d.gap.values
    scale = float(d.approach)
    assert (pressure >= 0).all()
    assert np.nanmin(gap) >= -1e-6 * scale
    assert np.abs(gap[pressure > 0]).max() <= 1e-6 * scale
    assert float(d.normal_load) == pytest.approx(LOAD, rel=1e-9)
    shear = np.hypot(d.traction_x, d.traction_y).values
    assert (shear <= 0.7 * pressure * (1 + 1e-9)).all()
    assert float(d.tractive_force) == pytest.approx(force, abs=1e-6 * LOAD)
    # Heat only ever comes out, of slip and of the material.
    assert float(d.friction_work.min()) >= 0
    assert work_on_the_material(contact) >= -1e-6 * LOAD


def work_on_the_material(contact):
    """Work of the tractions on the deforming bodies per metre, N: from the fields, not from the moment.

    By differences u(x) - u(x + dx) ahead of every cell, the operator that is monotone on the cells as well.
    """
    d, dx = contact.dataset, contact.dataset.attrs["dx"]
    ny, nx = d.pressure.shape
    tire, road = contact.tire.carcass, contact.road.surface_material
    influence = Influence((ny, nx + 1), dx, d.attrs["dy"], rolling_pair(tire, road, contact.rolling.speed))
    loads = np.stack([-d.traction_x.values, -d.traction_y.values, d.pressure.values])
    wide = np.pad(loads, [(0, 0), (0, 0), (0, 1)])
    u = influence.displacement(wide[2], wide[:2])
    return float((loads * (u[..., :-1] - u[..., 1:])).sum()) * contact.cell_area / dx


def test_slow_and_fast_rolling_are_elastic():
    gap = tread(3, grooved=False)
    for speed, limit in ((1e-7, RUBBER.rubbery), (1e9, RUBBER.glassy)):
        found, exact = (solve(material, speed, gap).dataset for material in (RUBBER, limit))
        # Memory over patch is 1e-8; patch over memory 1e-7, times the logarithm of that, as a rut fades like 1/r.
        # What remains is the tolerance of the solves.
        np.testing.assert_allclose(found.pressure, exact.pressure, atol=3e-5 * float(exact.pressure.max()))
        np.testing.assert_allclose(found.traction_x, exact.traction_x, atol=1e-4 * float(exact.pressure.max()))
        assert float(found.approach) == pytest.approx(float(exact.approach), rel=1e-5)
        assert float(found.creepage_x) == pytest.approx(float(exact.creepage_x), rel=1e-4)


def test_pressure_moves_ahead_and_rolling_costs_work():
    previous = None
    for speed in (0.3, 3.0, 30.0):
        resistance = tl.contact.rolling_resistance(smooth_tire(speed), 0.5)
        assert resistance.pressure_centre_x > 1e-3
        assert resistance.force > 0
        # Driven: creep in the rubber costs more than the pressure alone.
        assert resistance.material_loss > resistance.force * 0.99
        assert resistance.material_power == pytest.approx(resistance.material_loss * speed)
        assert resistance != previous
        previous = resistance


def test_an_elastic_tire_loses_nothing_but_the_error_of_its_cells():
    x = {}
    for spacing in (0.012, 0.006):
        n = round(0.36 / spacing)
        c = (np.arange(n) - (n - 1) / 2) * spacing
        tire = tl.Tire.from_height_map(
            c[None, :] ** 2 + c[:, None] ** 2 / 1.2, spacing, material=tl.Elastic(3e6, 0.45)
        )
        wheel = tl.Rolling(normal_load=LOAD, friction=0.7, tractive_force=-3e3)
        x[spacing] = tl.contact.rolling_resistance(tl.solve_contact(tire, ROAD, wheel), 0.5)
    # Here R = 0.5 m is that of the tread. The slip operator is upwind: first order.
    assert x[0.006].material_loss == pytest.approx(0.5 * x[0.012].material_loss, rel=0.15)
    assert abs(x[0.006].material_loss) < 5e-3 * LOAD
    assert x[0.006].material_power is None


def test_mirror_in_y():
    gap = tread(5)
    one = solve(RUBBER, 5.0, gap, spin=0.05, lateral_force=1e3).dataset
    other = solve(RUBBER, 5.0, gap[::-1], spin=-0.05, lateral_force=-1e3).dataset
    peak = float(one.pressure.max())
    np.testing.assert_allclose(one.pressure, other.pressure[::-1], atol=2e-5 * peak)
    np.testing.assert_allclose(one.traction_y, -other.traction_y[::-1], atol=2e-4 * peak)


def test_only_speed_times_memory_counts():
    gap = tread(7)
    slow = Prony(RUBBER.modulus, tuple((g, 10 * t) for g, t in RUBBER.terms), RUBBER.poisson)
    one, other = solve(RUBBER, 20.0, gap).dataset, solve(slow, 2.0, gap).dataset
    np.testing.assert_allclose(one.pressure, other.pressure, atol=1e-6 * float(one.pressure.max()))


def test_operators_of_a_solid_without_memory_are_the_elastic_ones():
    shape, dx, dy = (6, 9), 0.01, 0.02
    tire = Prony(3e6, ((1e-12, 1.0),), 0.4)
    found = Influence(shape, dx, dy, rolling_pair(tire, ROAD.surface_material, 1.0))
    exact = Influence(shape, dx, dy, HalfSpaces.of(tire.glassy, ROAD.surface_material))
    rng = np.random.default_rng(0)
    p, q = rng.random(shape), rng.normal(size=(2, *shape))
    for mine, theirs in (
        (found.normal(p), exact.normal(p)),
        (found.displacement(p, q), exact.displacement(p, q)),
        (found.gap_by_shear(q), exact.gap_by_shear(q)),
        (found.slip_by_pressure(p), exact.slip_by_pressure(p)),
    ):
        np.testing.assert_allclose(mine, theirs, atol=1e-10 * np.abs(theirs).max())
    for rolls in (False, True):
        assert found.self_influence(rolls=rolls) == pytest.approx(exact.self_influence(rolls=rolls), rel=1e-10)
    np.testing.assert_allclose(found.normal_stiffness, exact.normal_stiffness, rtol=1e-9)
    np.testing.assert_allclose(found.tangential_stiffness_on(shape), exact.tangential_stiffness_on(shape), rtol=1e-9)


def test_two_viscoelastic_bodies_are_softer_than_one():
    shape, dx, dy = (4, 5), 0.01, 0.01
    one = Influence(shape, dx, dy, rolling_pair(RUBBER, RUBBER, 1.0))
    half = Influence(shape, dx, dy, rolling_pair(RUBBER, tl.Elastic(1e30, 0.3), 1.0))
    p = np.random.default_rng(1).random(shape)
    np.testing.assert_allclose(one.normal(p), 2 * half.normal(p), rtol=1e-10)
    assert not one.coupled


@pytest.mark.parametrize(
    ("material", "speed", "word"),
    [
        (RUBBER, None, "speed"),
        (Prony(3e6, ((1.0, 0.1),), 0.5), 10.0, "rut"),
    ],
)
def test_refused(material, speed, word):
    with pytest.raises(InputError, match=word):
        solve(material, speed, tread(1))
    with pytest.raises(InputError, match="elastic"):
        _ = tl.Tire.from_height_map(tread(1), CELL, material=material).elastic


def test_speed_must_be_positive():
    for speed in (0.0, -3.0, float("nan")):
        with pytest.raises(InputError, match="speed"):
            Influence((3, 3), 0.01, 0.01, rolling_pair(RUBBER, ROAD.surface_material, speed))
    with pytest.raises(InputError, match="radius"):
        tl.contact.rolling_resistance(smooth_tire(3.0), 0.0)
