"""Ribs with free sides in everything that takes a tire: what works on a belt works, or one sentence rejects it."""

import numpy as np
import pytest

import treadload as tl
from treadload.contact import (
    creep_curve,
    cross_obstacle,
    envelop,
    rolling_resistance,
    solve_indentation,
    solve_texture,
)
from treadload.contact.friction.laws import Anisotropic, Exponential, PressureDependent
from treadload.contact.solvers import coupling
from treadload.errors import InputError
from treadload.materials import ElastoPlastic, VonMises
from treadload.pavement import RoadStep
from treadload.response import roll_drum
from treadload.tire import TreadProfile
from treadload.tire.grooves import Groove

ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
NARROW = TreadProfile(
    0.5, 0.8, 0.12, grooves=(Groove(-0.02, 0.01, 0.015), Groove(0.02, 0.01, 0.015)), shoulder_radius=0.005
)
TIRE = tl.Tire.from_profile(
    NARROW,
    inflation_pressure=820e3,
    belt=tl.tire.Belt(tread=tl.Elastic(5.5e6, 0.495), bending=(80, 100, 150)),
    tread="ribs",
)
LOAD, CELL = 8e3, 8e-3
FREE = tl.Rolling(normal_load=LOAD, friction=0.6)


@pytest.fixture(scope="module")
def rolled():
    return tl.solve_contact(TIRE, ROAD, FREE, spacing=CELL)


@pytest.mark.parametrize(
    "law",
    [Exponential(0.8, 0.3, 0.1), Anisotropic(0.8, 0.4), PressureDependent(0.6, 8e5, 0.2)],
    ids=lambda law: type(law).__name__,
)
def test_friction_laws(law):
    wheel = tl.Rolling(normal_load=LOAD, friction=law, creepage_x=-0.01, creepage_y=0.004, speed=20.0)
    data = tl.solve_contact(TIRE, ROAD, wheel, spacing=CELL).dataset
    assert float(data.normal_load) == pytest.approx(LOAD, rel=1e-6)
    along, across = (0.8, 0.4) if isinstance(law, Anisotropic) else (1.0, 1.0)
    bound = 1.0 if isinstance(law, Anisotropic) else law.largest
    used = np.hypot(data.traction_x / along, data.traction_y / across) - bound * data.pressure
    assert float(used.max()) <= 1e-6 * float(data.pressure.max())
    assert float(data.lateral_force) < 0 or float(data.lateral_force) > 0


@pytest.mark.parametrize("aim", [1e-2, 1e-4, 1e-6])
def test_friction_that_falls_settles_from_any_first_round(aim, monkeypatch):
    # Slip spreads slowly from cell to cell where friction nearly holds; a tight first round follows it to its end.
    monkeypatch.setattr(coupling, "_FIRST_AIM", aim)
    wheel = tl.Rolling(
        normal_load=LOAD, friction=Exponential(0.8, 0.3, 0.1), creepage_x=-0.01, creepage_y=0.004, speed=20.0
    )
    data = tl.solve_contact(TIRE, ROAD, wheel, spacing=CELL).dataset
    # Two steady states: one in which a few cells more slide.
    assert float(data.lateral_force) == pytest.approx(-294.1, rel=3e-3)


def test_the_layers_of_a_road(rolled):
    soft = tl.Pavement([tl.Layer(tl.Elastic(5.4e9, 0.35), 0.05), tl.Layer(tl.Elastic(5e7, 0.4))])
    layered = tl.solve_contact(TIRE, soft, FREE, spacing=CELL, road_compliance="layers")
    assert layered.stats["layers_solved"]
    # A soft base lets the road sink a little more.
    assert 0 < float(layered.dataset.approach) - float(rolled.dataset.approach) < 1e-3
    response = tl.solve_response(layered, soft, depths=[0.0, 0.05])
    assert np.isfinite(response.dataset.strain_yy).all()


def test_a_creep_curve():
    curve = creep_curve(TIRE, ROAD, FREE, [0.0, 0.002, 0.01, 0.5], along="y", spacing=CELL)
    force = np.abs(curve.dataset.lateral_force.values)
    assert (np.diff(force) > 0).all()
    assert force[0] <= 1e-6 * LOAD
    assert force[-1] == pytest.approx(0.6 * LOAD, rel=0.05)


def test_elastic_ribs_lose_no_energy_but_by_friction(rolled):
    finer = tl.solve_contact(TIRE, ROAD, FREE, spacing=CELL / 2)
    losses = [abs(rolling_resistance(contact, 0.5).material_loss) for contact in (rolled, finer)]
    # The step of rolling is of first order.
    assert losses[1] < losses[0] < 1e-4 * LOAD


def test_enveloping_and_texture(rolled):
    spread = envelop(rolled, 0.02)
    assert float(spread.dataset.normal_load) == pytest.approx(LOAD, rel=1e-6)
    patch = tl.pavement.texture.self_affine(
        0.05, 0.05 / 64, hurst=0.8, shortest=4e-3, roll_off=0.0125, rms_height=2e-4, seed=1
    )
    real = solve_texture(patch, tl.Elastic(5.5e6, 0.49), rolled)
    assert 0 < float(real.dataset.real_area) < rolled.area * 1.2


class Flat:
    """A road whose relief is none."""

    def height(self, x, y):
        return np.zeros((len(y), len(x)))


class Wavy:
    """Waves across travel, 1 mm high."""

    def height(self, x, y):
        return np.broadcast_to(1e-3 * np.cos(2 * np.pi * x / 0.08), (len(y), len(x)))


def test_the_relief_of_a_road(rolled):
    flat, wavy = (tl.solve_contact(TIRE, ROAD, FREE, spacing=CELL, relief=relief) for relief in (Flat(), Wavy()))
    assert np.array_equal(flat.dataset.pressure, rolled.dataset.pressure)
    assert float(wavy.dataset.pressure.max()) > 1.2 * float(flat.dataset.pressure.max())


@pytest.mark.parametrize("friction", [0.0, 0.6])
def test_crossing_a_step(friction):
    wheel = tl.Rolling(normal_load=LOAD, friction=friction)
    pressed = tl.solve_contact(TIRE, ROAD, tl.Rolling(normal_load=LOAD, friction=0.0), spacing=CELL)
    crossed = cross_obstacle(TIRE, ROAD, wheel, RoadStep(5e-3), positions=[-0.16, 0.0, 0.16], spacing=CELL).dataset
    # Clear of the step the pressure is that of the plane, without friction; the axle has risen by its height.
    plain = float(pressed.dataset.pressure.max())
    assert crossed.largest_pressure.values[[0, 2]] == pytest.approx(plain, rel=1e-4)
    assert float(crossed.approach[0] - crossed.approach[2]) == pytest.approx(5e-3, rel=1e-3)
    assert crossed.contact_area.values[[0, 2]] == pytest.approx(pressed.area, rel=1e-9)
    assert float(crossed.largest_pressure[1]) > 1.5 * plain


def test_a_road_that_is_dented():
    plastic = tl.Pavement.half_space(ElastoPlastic(tl.Elastic(2e8, 0.3), VonMises(5e5)))
    dented = solve_indentation(TIRE, plastic, [LOAD, 0.0], spacing=CELL).dataset
    assert float(dented.largest_plastic_strain[0]) > 1e-4
    # The dent stays when the tire is lifted.
    assert float(dented.residual_displacement_z[1].max()) > 1e-6
    with pytest.raises(InputError, match="fewer than 3 cells"):
        roll_drum(TIRE, plastic, LOAD, passes=1, spacing=(CELL, 0.015))


@pytest.mark.slow
def test_a_track_that_yields():
    plastic = tl.Pavement.half_space(ElastoPlastic(tl.Elastic(2e8, 0.3), VonMises(5e5)))
    rolled = roll_drum(TIRE, plastic, LOAD, passes=1, spacing=(CELL, CELL)).dataset
    assert float(rolled.rut_depth[0]) > 0
    assert float(rolled.rolling_resistance[0]) > 0
