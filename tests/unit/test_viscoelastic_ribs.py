"""Ribs of viscoelastic rubber that rolls steadily."""

from dataclasses import replace

import numpy as np
import pytest

import treadload as tl
from treadload.contact import (
    creep_curve,
    cross_obstacle,
    envelop,
    rolling_resistance,
    solve_indentation,
    solve_transient,
    turn_on_the_spot,
)
from treadload.contact.bodies.body import Rows, Strip
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.ribs import Ribs
from treadload.contact.bodies.viscoelastic import of_material
from treadload.errors import InputError
from treadload.kernels.gridding.strips import Strips
from treadload.materials import ElastoPlastic, Prony, VonMises
from treadload.pavement import RoadStep
from treadload.response import roll_drum
from treadload.tire import TreadProfile
from treadload.tire.grooves import Groove

NARROW = TreadProfile(
    0.5, 0.8, 0.12, grooves=(Groove(-0.02, 0.01, 0.015), Groove(0.02, 0.01, 0.015)), shoulder_radius=0.005
)
ROAD = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
PRONY = Prony(11e6, ((0.3, 2e-3), (0.2, 0.05)), 0.495)
CELL, LENGTH = 8e-3, 60


def tire(rubber):
    belt = tl.tire.Belt(tread=rubber, bending=(80, 100, 150))
    return tl.Tire.from_profile(NARROW, inflation_pressure=820e3, belt=belt, tread="ribs")


def strip_of(speed, rubber=PRONY) -> Strip:
    groups = tire(rubber).ribs

    def ribs(elastic):
        return Ribs(groups, elastic, HalfSpaces.of(elastic, None))

    body = of_material(rubber, ribs, is_tire=True, speed=speed)
    return body.strips(Rows(15, CELL, -7 * CELL))[0]


def kernel(strip, length=LENGTH):
    """Displacement of a middle cell's row (3, length) by pressure on one cell, wrapped."""
    block = strip.block(length, CELL)
    strips = Strips((strip.rows,), (block,), length)
    loads = np.zeros((1, int(strip.rows.max()) + 1, length))
    loads[0, strip.rows[1], 0] = 1.0
    return strips.displacement(loads, (2,), (0, 1, 2), length)[:, strip.rows[1]]


def test_limits_of_speed():
    """Slow rubber has its long-term modulus, fast rubber its instantaneous one: 1e-4 of V T over a cell."""
    slow, fast = kernel(strip_of(1e-6)), kernel(strip_of(1e7))
    rubbery, glassy = kernel(strip_of(None, PRONY.rubbery)), kernel(strip_of(None, PRONY.glassy))
    np.testing.assert_allclose(slow, rubbery, atol=1e-4 * np.abs(rubbery).max())
    np.testing.assert_allclose(fast, glassy, atol=1e-4 * np.abs(glassy).max())


@pytest.mark.parametrize("odd", [0, 201])
@pytest.mark.parametrize("speed", [0.5, 5.0, 50.0])
def test_what_fades_is_the_integral_of_what_was(speed, odd):
    """Against the integral of the elastic kernel over the past by itself, on cells an eighth as long."""
    fine, length = CELL / 8, 8 * LENGTH + odd
    elastic, rolling = strip_of(None, PRONY.glassy), strip_of(speed)
    reach = length // 2
    at_once = _row(elastic, length, fine)
    expected = at_once.copy()
    offset = np.arange(length) - reach
    for strength, time in PRONY.creep_terms:
        # ∫ exp(-s/L)/L A(X + s) ds, A linear between the cells.
        far = fine / (speed * time)
        kept = np.exp(-far)
        near = 1 - (1 - kept) / far
        faded = np.zeros_like(at_once)
        for n in range(offset.size - 2, -1, -1):
            passed = near * at_once[:, n] + (1 - kept - near) * at_once[:, n + 1]
            faded[:, n] = kept * faded[:, n + 1] + passed
        expected += strength * faded
    got = _row(rolling, length, fine)
    # Linear between cells of 1 mm under a load of 1 mm.
    np.testing.assert_allclose(got[:, 1:], expected[:, 1:], atol=0.01 * np.abs(expected).max())


def _row(strip, length, dx):
    block = strip.block(length, dx)
    strips = Strips((strip.rows,), (block,), length)
    loads = np.zeros((1, int(strip.rows.max()) + 1, length))
    loads[0, strip.rows[1], length // 2] = 1.0
    return strips.displacement(loads, (2,), (0, 1, 2), length)[:, strip.rows[1]]


def test_the_limit_of_slow_rolling_and_resistance():
    wheel = tl.Rolling(normal_load=8e3, friction=0.6, speed=5.0)
    slow = tl.solve_contact(tire(PRONY), ROAD, replace(wheel, speed=1e-6), spacing=CELL).dataset
    rubbery = tl.solve_contact(tire(PRONY.rubbery), ROAD, wheel, spacing=CELL).dataset
    # Memory of 5e-8 m on cells of 8 mm: what is left are the tolerances of two solvers.
    assert float(np.abs(slow.pressure - rubbery.pressure).max()) <= 1e-3 * float(rubbery.pressure.max())
    rolling = tl.solve_contact(tire(PRONY), ROAD, wheel, spacing=CELL)
    # Elastic ribs lose 0.8 N at most, see `test_ribs_everywhere.py`.
    assert rolling_resistance(rolling, 0.5).material_loss > 2.0
    assert float(rolling.dataset.approach) < float(rubbery.approach)


@pytest.mark.slow
def test_a_tread_without_grooves_is_the_viscoelastic_layer():
    """As elastic ones are: the free sides at the shoulders are all that differs, and the shoulders are round."""
    smooth = replace(NARROW, grooves=(), shoulder_radius=0.03)
    belt = tl.tire.Belt(tread=replace(PRONY, poisson=0.47), bending=(80, 100, 150))
    wheel = tl.Rolling(normal_load=8e3, friction=0.7, speed=5.0)
    ribs, layer = (
        tl.solve_contact(
            tl.Tire.from_profile(smooth, inflation_pressure=820e3, belt=belt, tread=tread), ROAD, wheel, spacing=4e-3
        )
        for tread in ("ribs", "layer")
    )
    print(
        float(ribs.dataset.approach) / float(layer.dataset.approach),
        rolling_resistance(ribs, 0.5).material_loss / rolling_resistance(layer, 0.5).material_loss,
    )
    assert float(ribs.dataset.approach) == pytest.approx(float(layer.dataset.approach), rel=0.01)
    assert rolling_resistance(ribs, 0.5).material_loss == pytest.approx(
        rolling_resistance(layer, 0.5).material_loss, rel=0.01
    )


def test_forces_and_coulomb():
    wheel = tl.Rolling(normal_load=8e3, friction=0.6, tractive_force=1e3, lateral_force=1e3, spin=0.1, speed=5.0)
    data = tl.solve_contact(tire(PRONY), ROAD, wheel, spacing=CELL).dataset
    assert float(data.tractive_force) == pytest.approx(1e3, rel=1e-6)
    assert float(data.lateral_force) == pytest.approx(1e3, rel=1e-6)
    excess = np.hypot(data.traction_x, data.traction_y) - 0.6 * data.pressure
    assert float(excess.max()) <= 1e-6 * float(data.pressure.max())


def test_histories_take_elastic_ribs():
    wheel = tl.Rolling(normal_load=8e3, friction=0.6, speed=5.0)
    with pytest.raises(InputError, match="rubbery"):
        turn_on_the_spot(tire(PRONY), ROAD, wheel, angles=np.radians([1.0]), spacing=CELL)
    with pytest.raises(InputError, match="rubbery"):
        solve_transient(tire(PRONY), ROAD, wheel, distances=[0.01], spacing=CELL)


def test_what_takes_ribs_that_remember():
    wheel = tl.Rolling(normal_load=8e3, friction=0.6, speed=5.0)
    curve = creep_curve(tire(PRONY), ROAD, wheel, [0.0, 0.005, 0.5], along="y", spacing=CELL)
    force = np.abs(curve.dataset.lateral_force.values)
    assert force[0] < 1e-6 * force[1] < 1e-6 * force[2]
    spread = envelop(curve.contacts[0], 0.02)
    assert float(spread.dataset.normal_load) == pytest.approx(8e3, rel=1e-6)
    cornering = tl.Rolling(normal_load=8e3, friction=0.6, spin=0.5, creepage_y=0.03, speed=5.0)
    assert abs(float(tl.solve_contact(tire(PRONY), ROAD, cornering, spacing=CELL).dataset.aligning_moment)) > 1.0


def test_what_takes_elastic_ribs_says_so():
    wheel = tl.Rolling(normal_load=8e3, friction=0.6, speed=5.0)
    plastic = tl.Pavement.half_space(ElastoPlastic(tl.Elastic(2e8, 0.3), VonMises(5e5)))
    with pytest.raises(InputError, match="rubbery"):
        cross_obstacle(tire(PRONY), ROAD, wheel, RoadStep(5e-3), positions=[0.0], spacing=CELL)
    with pytest.raises(InputError, match="rubbery"):
        solve_indentation(tire(PRONY), plastic, [8e3], spacing=CELL)
    with pytest.raises(InputError, match="rubbery"):
        roll_drum(tire(PRONY), plastic, 8e3, passes=1)
