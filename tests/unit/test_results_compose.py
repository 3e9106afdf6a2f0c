"""Every verb takes what every verb gives."""

import numpy as np
import pytest

import treadload as tl
from treadload.composing import dataset_of
from treadload.damage import tension_behind
from treadload.damage.history import residual_after

ROAD = tl.Pavement([tl.Layer(tl.Elastic(5.4e9, 0.35), 0.08, name="asphalt"), tl.Layer(tl.Elastic(2e8, 0.35))])
LINE = tl.FatigueLine(epsilon_6=120e-6, slope=-0.2)
DISC = tl.UniformDisc(0.12, 7e5)
AT = np.linspace(-0.3, 0.3, 13)


@pytest.fixture(scope="module")
def response():
    return tl.solve_response([DISC], ROAD, depths=[0.0, 0.02], x=AT, y=AT)


def test_thermal_stress_gives_a_response_that_can_be_assessed(response):
    cold = tl.damage.add_thermal_stress(response, [2e6, 1e6])
    assert isinstance(cold, tl.response.Response)
    assert cold.restrained == (2e6, 1e6)
    added = cold.dataset.stress_xx - response.dataset.stress_xx
    np.testing.assert_allclose(added.mean(("y", "x")), [2e6, 1e6], rtol=1e-9)
    warm, verdict = (tl.assess(one, LINE) for one in (response, cold))
    # The cold opens what the wheel squeezes: all that extends is read, under the wheel as well.
    assert verdict.dataset.worst_strain >= warm.dataset.worst_strain
    assert float(verdict.dataset.worst_strain) == pytest.approx(
        float(verdict.dataset.extension_by_depth.max()), rel=0.05
    )
    twice = tl.damage.add_thermal_stress(tl.damage.add_thermal_stress(response, [1e6, 0.0]), 1e6)
    assert twice.restrained == (2e6, 1e6)
    # Two sums in another order: round-off.
    np.testing.assert_allclose(twice.dataset.stress_xx, cold.dataset.stress_xx, rtol=1e-9, atol=1e-3)


@pytest.mark.parametrize(
    "ask",
    [
        lambda one: tl.assess(one, LINE, depth=0.02).dataset.extension_strain,
        lambda one: tl.damage.crack_rose(tl.assess(one, LINE, depth=0.02)).trace_share,
        lambda one: tl.damage.compute_quantities(one).horizontal_tension,
        lambda one: tl.damage.envelope(one).extension_strain,
        lambda one: tension_behind(one).tension_behind,
        lambda one: residual_after(one, spacing=0.1, passes=2).residual_tension,
        lambda one: dataset_of(tl.damage.add_thermal_stress(one, 1e6)).stress_xx,
    ],
)
def test_a_verb_takes_a_result_and_its_dataset(response, ask):
    cold = tl.damage.add_thermal_stress(response, 1e6)
    np.testing.assert_array_equal(ask(cold), ask(cold.dataset))


def test_bonds_are_assessed_on_a_response():
    response = tl.solve_response([DISC], ROAD, depths=ROAD.interfaces, x=AT, y=AT)
    strength = tl.damage.InterfaceStrength(cohesion=3e5, friction_angle=0.6)
    verdict = tl.damage.assess_bonds(response, strength)
    expected = tl.damage.assess_bonds(tl.damage.interface_fields(response), strength)
    np.testing.assert_array_equal(verdict.dataset.utilisation, expected.dataset.utilisation)


def test_what_is_no_result_is_refused_in_a_sentence():
    with pytest.raises(tl.InputError, match="got list; give what a verb"):
        tl.assess([1, 2], LINE)
