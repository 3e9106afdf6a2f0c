"""Stress of the wheels before and of the cold, against closed forms and quadrature."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import quad

import treadload as tl
from treadload import variables
from treadload.damage.history import add_thermal_stress, residual_after, thermal_stress
from treadload.errors import InputError
from treadload.kernels import tensors
from treadload.response.fields import response_dataset

SOLID = tl.materials.Prony(3e10, ((0.3, 1.0), (0.4, 100.0), (0.29, 1e4)), 0.35)


class Constant:
    """A shift that no temperature changes."""

    reference = 10.0

    def factor(self, temperature):
        return np.full(np.shape(temperature), 2.0)


class Exponential:
    """log₁₀ aT = -0.1 (T - 10)."""

    reference = 10.0

    def factor(self, temperature):
        return 10 ** (-0.1 * (np.asarray(temperature) - 10))


def tail(x, length, depth=0.0):
    """A response whose stresses fade behind the wheel as exp(x / length), and differ by component."""
    shape = np.exp(np.minimum(x, 0.0) / length)
    stress = np.arange(1.0, 7)[:, None, None, None] * 1e5 * shape
    return SimpleNamespace(dataset=response_dataset(stress, stress / 1e10, np.array([depth]), np.array([0.0]), x))


def test_passes_before_leave_a_geometric_series():
    x, length, spacing, passes = np.linspace(-30, 0, 1201), 4.0, 5.0, 5
    found = residual_after(tail(x, length), spacing=spacing, passes=passes)
    places = found["x"].to_numpy()
    assert places[0] == pytest.approx(-5.0)
    q = math.exp(-spacing / length)
    known = 2e5 * np.exp(places / length) * q * (1 - q**passes) / (1 - q)
    # Cubic spline on a spacing of 1/160 of the decay: (1/160)⁴ of a few 1e-2.
    np.testing.assert_allclose(found["residual_stress_yy"].squeeze(), known, rtol=1e-10)
    assert found.attrs["last_pass"] == pytest.approx(q ** (passes - 1) * (1 - q) / (1 - q**passes), rel=1e-9)
    # Both tensions from stresses proportional to (1, 2, 3, 4, 5, 6).
    unit = 1.5 + math.hypot(0.5, 4)
    np.testing.assert_allclose(found["residual_tension"].squeeze(), known / 2 * unit, rtol=1e-9)
    own = 1e5 * np.exp(places / length)
    np.testing.assert_allclose(found["total_tension"].squeeze(), (known / 2 + own) * unit, rtol=1e-9)
    assert set(found.data_vars) <= set(variables.VARIABLES)


def test_residual_converges_with_the_fourth_order_of_the_spacing():
    def error(n):
        x = np.linspace(-12, 0, n)
        found = residual_after(tail(x, 1.0), spacing=math.pi, passes=1)
        known = 1e5 * np.exp(found["x"].to_numpy() - math.pi)
        return abs(found["residual_stress_xx"].to_numpy().squeeze() - known).max()

    rates = np.log2([error(61) / error(121), error(121) / error(241)])
    assert rates.min() > 3.5


def test_a_wheel_on_an_elastic_road_leaves_nothing_but_its_distant_weight():
    road = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
    x = np.linspace(-60, 1, 245)
    response = tl.solve_response(tl.UniformDisc(0.15, 8e5), road, depths=[0.1], x=x, y=[0.0])
    near, far = (residual_after(response, spacing=spacing, passes=2) for spacing in (10.0, 20.0))
    # Boussinesq's stresses on a line at this depth fall with the square of the distance r, but for parts of depth/r.
    two, one = (abs(float(found["residual_stress_xx"].sel(x=0).squeeze())) for found in (near, far))
    assert 3.6 < two / one < 4
    assert float(abs(far["residual_stress_xx"]).max()) < 1e-4 * float(abs(response.dataset["stress_xx"]).max())


def test_linear_cooling_at_a_constant_shift_in_closed_form():
    time, rate, alpha = np.linspace(0, 7200, 50), -10 / 3600, 2.5e-5
    found = thermal_stress(SOLID, Constant(), time, 20 + rate * time, expansion=alpha, restraint="line")
    # σ = -α r (E∞ t + Σ Eᵢ aT τᵢ (1 - exp(-t/(aT τᵢ)))), times longer by the shift; round-off of fifty steps.
    known = SOLID.long_term_modulus * time
    for share, tau in SOLID.terms:
        known = known - 3e10 * share * 2 * tau * np.expm1(-time / (2 * tau))
    np.testing.assert_allclose(found, -alpha * rate * known, rtol=1e-12)
    plane = thermal_stress(SOLID, Constant(), time, 20 + rate * time, expansion=alpha)
    np.testing.assert_allclose(plane, found / 0.65, rtol=1e-14)


def test_a_jump_too_fast_to_relax_and_a_rest_that_lets_go():
    found = thermal_stress(SOLID, Constant(), [0.0, 1e-9, 1e9], [10.0, 0.0, 0.0], expansion=2e-5, restraint="line")
    # 1e-9 s is 5e-10 of the shortest time; 1e9 s is all of the longest.
    assert found[1] == pytest.approx(2e-4 * 3e10, rel=1e-8)
    assert found[2] == pytest.approx(2e-4 * SOLID.long_term_modulus, rel=1e-8)


def temperature_of(t):
    return 5 - 15 * np.sin(2 * np.pi * t / 86400)


def hereditary(t, alpha=2.5e-5):
    """-α ∫ E(ξ(t) - ξ(t')) dT by adaptive quadrature, ξ by its own."""
    rate = 15 * 2 * np.pi / 86400

    def reduced(a, b):
        return quad(lambda s: 10 ** (0.1 * (temperature_of(s) - 10)), a, b, epsabs=0, epsrel=1e-11)[0]

    def integrand(s):
        return float(SOLID.relaxation_modulus(reduced(s, t))) * rate * math.cos(2 * np.pi * s / 86400)

    return alpha * quad(integrand, 0, t, epsabs=0, epsrel=1e-9, limit=400, points=[0.9 * t, 0.99 * t])[0]


def test_a_nights_cooling_against_quadrature_and_its_order():
    end = 21600.0
    known = hereditary(end)

    def error(n):
        time = np.linspace(0, end, n)
        found = thermal_stress(SOLID, Exponential(), time, temperature_of(time), expansion=2.5e-5, restraint="line")
        return abs(found[-1] / known - 1)

    errors = [error(n) for n in (41, 81, 161)]
    assert errors[-1] < 1e-4
    # Second order in the step.
    assert np.log2(np.array(errors[:-1]) / errors[1:]).min() > 1.8


def test_depths_go_together():
    time = np.linspace(0, 3600, 20)
    cooling = 10 - np.outer(time / 3600, [10.0, 5.0, 0.0])
    found = thermal_stress(SOLID, Exponential(), time, cooling, expansion=2e-5)
    assert found.shape == (20, 3)
    np.testing.assert_array_equal(found[:, 2], 0)
    for column in range(3):
        alone = thermal_stress(SOLID, Exponential(), time, cooling[:, column], expansion=2e-5)
        np.testing.assert_allclose(found[:, column], alone, rtol=1e-14)
    # What cools is pulled, and colder is stiffer: more than in proportion.
    assert found[-1, 0] > 2 * found[-1, 1] > 0


def test_thermal_stress_adds_to_that_of_the_traffic():
    road = tl.Pavement.half_space(tl.Elastic(5e9, 0.35))
    response = tl.solve_response(tl.UniformDisc(0.1, 8e5), road, depths=[0.0, 0.1], x=[0.0, 0.2], y=[0.0])
    added = add_thermal_stress(response, [2e6, 1e6]).dataset
    before = response.dataset
    for name, change in {"xx": [2e6, 1e6], "yy": [2e6, 1e6], "zz": [0, 0], "xy": [0, 0]}.items():
        expected = before[f"stress_{name}"].to_numpy() + np.array(change)[:, None, None]
        np.testing.assert_array_equal(added[f"stress_{name}"], expected)
    stress = np.stack([added[f"stress_{c}"].to_numpy() for c in ("xx", "yy", "zz", "xy", "xz", "yz")])
    np.testing.assert_allclose(added["mean_stress"], tensors.mean(stress), rtol=1e-14)
    np.testing.assert_allclose(added["von_mises_stress"], tensors.von_mises(stress), rtol=1e-14)
    np.testing.assert_array_equal(added["strain_xx"], before["strain_xx"])
    assert added.attrs == before.attrs
    assert added["stress_xx"].attrs["units"] == "Pa"


COOLING = {"time": [0.0, 3600.0], "temperature": [10.0, 0.0], "expansion": 2e-5}


def thermal(**changed):
    given = COOLING | changed
    return thermal_stress(SOLID, Constant(), given.pop("time"), given.pop("temperature"), **given)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: residual_after(tail(np.linspace(-3, 0, 9), 1.0), spacing=0, passes=1), "spacing must be a positive"),
        (lambda: residual_after(tail(np.linspace(-3, 0, 9), 1.0), spacing=1, passes=0), "at least 1, got 0"),
        (
            lambda: residual_after(tail(np.linspace(-3, 0, 9), 1.0), spacing=2, passes=2),
            "reaches 4 m behind the wheel, its x span 3 m",
        ),
        (lambda: thermal(time=[0.0, 0.0]), "two increasing numbers of s"),
        (lambda: thermal(temperature=[10.0]), r"for each of 2 times, got shape \(1,\)"),
        (lambda: thermal(temperature=[10.0, math.nan]), "finite number of °C"),
        (lambda: thermal(expansion=25.0), "mixes are near 2.5e-5"),
        (
            lambda: thermal_stress(tl.Elastic(1e9, 0.3), Constant(), [0, 1], [1, 0], expansion=0),
            "needs a Prony series, got Elastic; make one with as_prony",
        ),
        (lambda: thermal(restraint="none"), '"plane" or "line", got \'none\''),
        (
            lambda: add_thermal_stress(tail(np.linspace(-3, 0, 9), 1.0), [1e6, 2e6]),
            r"each of 1 depths, got shape \(2,\)",
        ),
    ],
)
def test_refusals(make, message):
    with pytest.raises(InputError, match=message):
        make()
