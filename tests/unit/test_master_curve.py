"""Master curves from isotherms: shift factors of known and of measured materials."""

import itertools
from pathlib import Path

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.materials import (
    WLF,
    FrequencySweep,
    HuetSayegh,
    QuadraticShift,
    RelaxationTest,
    Thermorheological,
    master_curve,
    read_isotherms,
    read_shift_factors,
)

DATA = Path(__file__).parents[1] / "data" / "viscoelastic"
MIX = HuetSayegh(40995e6, 18e6, 2.356, 0.186, 0.515, 0.0329, 0.35)
LAW = WLF(20.0, 150.0, 15.0)
TEMPERATURES = np.arange(-10.0, 51.0, 5.0)


def isotherms(kind, points):
    simple = Thermorheological(MIX, LAW)
    found = []
    for temperature in TEMPERATURES:
        material = simple.at(temperature)
        if kind == "frequency":
            omega = 2 * np.pi * np.geomspace(0.1, 25.0, points)
            modulus = material.complex_modulus(omega)
            found.append(FrequencySweep(omega, modulus.real, modulus.imag, temperature))
        else:
            time = np.geomspace(0.1, 100.0, points)
            found.append(RelaxationTest(time, material.relaxation_modulus(time), temperature))
    return found


@pytest.mark.parametrize("kind", ["frequency", "time"])
def test_shifts_of_a_known_material_are_found(kind):
    curve = master_curve(isotherms(kind, 7)[::-1], 15.0)
    exact = np.log10(LAW.factor(TEMPERATURES))
    # Cubics between seven points: a thousandth of a decade over the 16 decades of the master curve.
    np.testing.assert_allclose(curve.log_factors, exact, atol=2e-3)
    assert curve.mismatch < 1e-3
    found = WLF.fit(curve.temperatures, curve.log_factors, curve.reference)
    assert found.factor(40.0) == pytest.approx(float(LAW.factor(40.0)), rel=5e-3)
    # All points lie on the material's own curve.
    if kind == "frequency":
        error = np.abs(curve.data.modulus / MIX.complex_modulus(curve.data.omega) - 1)
    else:
        error = np.abs(curve.data.modulus / MIX.relaxation_modulus(curve.data.time) - 1)
    assert error.max() < 3e-3


def test_the_error_falls_with_the_cube_of_the_spacing_or_faster():
    exact = np.log10(LAW.factor(TEMPERATURES))
    errors = [np.abs(master_curve(isotherms("time", n), 15.0).log_factors - exact).max() for n in (4, 7, 13)]
    for coarse, fine in itertools.pairwise(errors):
        # Monotone cubics between a halved spacing: their slopes are of second to third order.
        assert fine < coarse / 4


def test_the_reference_need_not_be_a_temperature_of_the_test():
    curve = master_curve(isotherms("frequency", 13), 17.0)
    found = np.array(curve.log_factors) + float(np.log10(LAW.factor(17.0)))
    # The interpolation of log aT over 5 K adds its own error.
    np.testing.assert_allclose(found, np.log10(LAW.factor(TEMPERATURES)), atol=3e-3)


def test_a_polymer_against_the_factors_that_came_with_it():
    data = read_isotherms(DATA / "time_user_raw.csv")
    curve = master_curve(data, 3.0)
    temperatures, given = read_shift_factors(DATA / "time_user_raw__shift_factors.csv")
    nominal = np.array(given[::-1])
    # 28.6 decades in 20 steps of 0.7 to 2. The glassy isotherms are flat and scatter by 1 %, so that a step is
    # known to some 0.1: they add up to 0.84 decades at -50 °C, and 0.43 on the warm side.
    np.testing.assert_allclose(curve.log_factors, nominal, atol=0.9)
    # Ours bring neighbours closer together than the given ones do.
    assert mismatch(data, curve.log_factors) < 0.85 * mismatch(data, nominal)
    assert curve.mismatch < 0.01
    assert len(temperatures) == len(data)


def mismatch(data, logs):
    """Rms of ln E between neighbours where they overlap, by straight interpolation."""
    squares = []
    for (cold, warm), (a, b) in zip(itertools.pairwise(data), itertools.pairwise(logs), strict=True):
        first, second = np.log(cold.time) - a * np.log(10), np.log(warm.time) - b * np.log(10)
        common = np.linspace(max(first[0], second[0]), min(first[-1], second[-1]), 40)
        gap = np.interp(common, first, np.log(cold.modulus)) - np.interp(common, second, np.log(warm.modulus))
        squares.append(np.mean(gap**2))
    return np.sqrt(np.mean(squares))


def test_the_factors_are_a_law():
    curve = master_curve(isotherms("frequency", 7), 15.0)
    assert float(curve.shift.factor(15.0)) == pytest.approx(1.0)
    assert "master curve at 15 °C of 13 isotherms" in str(curve)
    quadratic = QuadraticShift.fit(curve.temperatures, curve.log_factors, 15.0)
    assert np.log10(quadratic.factor(TEMPERATURES)) == pytest.approx(curve.log_factors, abs=0.15)


def test_what_cannot_be_shifted_is_refused():
    data = isotherms("frequency", 7)
    with pytest.raises(InputError, match="share no modulus"):
        master_curve([data[0], data[-1]], 15.0)
    with pytest.raises(InputError, match="reference must lie"):
        master_curve(data, 80.0)
    with pytest.raises(InputError, match="two or more"):
        master_curve(data[:1], 15.0)
    with pytest.raises(InputError, match="of FrequencySweep, RelaxationTest"):
        master_curve([data[0], isotherms("time", 7)[1]], 0.0)
    with pytest.raises(InputError, match="put their points together"):
        master_curve([data[0], data[0]], -10.0)
    with pytest.raises(InputError, match="needs its temperature"):
        master_curve([data[0], FrequencySweep(data[1].omega, data[1].storage, data[1].loss)], -10.0)
