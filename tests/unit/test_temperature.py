"""Shift laws and materials that are thermorheologically simple."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from treadload.errors import InputError
from treadload.materials import (
    WLF,
    Arrhenius,
    HuetSayegh,
    PowerLawCreep,
    Prony,
    QuadraticShift,
    TabulatedShift,
    TemperatureDependent,
    Thermorheological,
)

# As its parameters are published: ln τ = A₀ + A₁ T + A₂ T², τ in s, T in °C.
MIX = Thermorheological(
    HuetSayegh(40995e6, 18e6, 2.356, 0.186, 0.515, math.exp(2.2387), 0.35),
    QuadraticShift(-0.3996, 0.00152),
    (-10.0, 40.0),
)
LAWS = [WLF(17.44, 51.6, 20.0), Arrhenius(2e5, 20.0), QuadraticShift(-0.4, 0.0015, 20.0),
        TabulatedShift((0.0, 20.0, 60.0), (3.0, 0.0, -4.0), 20.0)]  # fmt: skip


def test_wlf_as_printed():
    # The universal constants: at Tᵣ + 50 K -17.44 · 50 / 101.6 decades, by hand.
    assert math.log10(WLF(17.44, 51.6, 20.0).factor(70.0)) == pytest.approx(-8.582677, abs=1e-6)


def test_arrhenius_as_printed():
    # 200 kJ/mol from 20 to 30 °C: 24054.47 K · (1/303.15 - 1/293.15) / K = -24054.47 · 10 / 88868.4225, by hand.
    assert float(Arrhenius(2e5, 20.0).factor(30.0)) == pytest.approx(math.exp(-2.706751), rel=2e-6)


def test_the_quadratic_law_is_that_of_huet_and_sayegh():
    # ln τ = A₀ + A₁ T + A₂ T², with the published set, at 15 °C.
    mix = MIX.at(15.0)
    assert isinstance(mix, HuetSayegh)
    assert mix.tau == pytest.approx(math.exp(2.2387 - 0.3996 * 15 + 0.00152 * 225), rel=1e-14)
    modulus = mix.complex_modulus(2 * math.pi * 10)
    # Computed from the set for the reference tables, to the digits given there.
    assert abs(modulus) / 1e6 == pytest.approx(11356, abs=0.5)
    assert np.degrees(np.angle(modulus)) == pytest.approx(17.5, abs=0.05)


@pytest.mark.parametrize("law", LAWS, ids=str)
def test_laws_are_one_at_the_reference_and_fall(law):
    assert float(law.factor(law.reference)) == pytest.approx(1.0, rel=1e-14)
    factors = law.factor(np.linspace(1.0, 59.0, 30))
    assert (np.diff(factors) < 0).all()
    assert law.factor([[20.0, 30.0]]).shape == (1, 2)


@pytest.mark.parametrize("law", LAWS[:3], ids=str)
def test_a_fit_of_a_law_returns_it(law):
    temperatures = np.linspace(5.0, 60.0, 8)
    found = type(law).fit(temperatures, np.log10(law.factor(temperatures)), law.reference)
    for name in law.__dataclass_fields__:
        # Exact data; the search of WLF's constants stops at 1e-8.
        assert getattr(found, name) == pytest.approx(getattr(law, name), rel=1e-6)


@given(st.floats(10.0, 100.0), st.floats(5.0, 30.0), st.floats(60.0, 200.0))
def test_wlf_is_the_same_law_from_any_reference(temperature, c1, c2):
    # c₂' = c₂ + δ, c₁' = c₁ c₂ / c₂' for a reference δ higher (Ferry, eq. 11-26).
    law, other = WLF(c1, c2, 20.0), WLF(c1 * c2 / (c2 + 15), c2 + 15, 35.0)
    both = np.log(law.factor(temperature) / law.factor(35.0))
    assert both == pytest.approx(float(np.log(other.factor(temperature))), abs=1e-10)


def test_a_table_passes_through_its_points_and_keeps_its_fall():
    table = TabulatedShift((60.0, 0.0, 20.0), (-4.0, 3.0, 0.0), 0.0)
    np.testing.assert_allclose(np.log10(table.factor([0.0, 20.0, 60.0])), [0.0, -3.0, -7.0], atol=1e-12)
    assert (np.diff(table.factor(np.linspace(0, 60, 50))) < 0).all()


@pytest.mark.parametrize(
    "material",
    [HuetSayegh(3e10, 1e7, 2.0, 0.2, 0.6, 1e-2, 0.35), PowerLawCreep(2.5e-11, 1e-8, 1e3, 0.35, 0.3),
     Prony(1e9, ((0.5, 1.0), (0.3, 10.0)), 0.4)],
    ids=str,
)  # fmt: skip
def test_warmth_and_frequency_are_exchanged(material):
    simple = Thermorheological(material, LAWS[0])
    assert isinstance(simple, TemperatureDependent)
    warm = simple.at(40.0)
    assert type(warm) is type(material)
    factor = float(LAWS[0].factor(40.0))
    omega = np.logspace(-2, 3, 6)
    np.testing.assert_allclose(warm.complex_modulus(omega), material.complex_modulus(omega * factor), rtol=1e-12)
    assert simple.at(20.0).complex_modulus(1.0) == pytest.approx(complex(material.complex_modulus(1.0)))


def test_untested_temperatures_are_refused_unless_asked_for():
    with pytest.raises(InputError, match=r"-10 to 40 °C, got 45 °C.*extrapolate"):
        MIX.at(45.0)
    assert MIX.at(45.0, extrapolate=True).glassy == MIX.at(0.0).glassy
    with pytest.raises(InputError, match="nan"):
        MIX.at(float("nan"))
    with pytest.raises(InputError, match="kelvin"):
        Thermorheological(MIX.material, LAWS[0]).at(298.15)


@pytest.mark.parametrize(
    ("build", "word"),
    [
        (lambda: WLF(-1.0, 50.0, 20.0), "c1"),
        (lambda: WLF(10.0, 0.0, 20.0), "c2"),
        (lambda: WLF(10.0, 50.0, -300.0), "reference"),
        (lambda: WLF(10.0, 50.0, 20.0).factor(-30.0), "above -30 °C"),
        (lambda: WLF(10.0, 50.0, 20.0).factor(-29.9), "decades"),
        (lambda: Arrhenius(0.0, 20.0), "activation_energy"),
        (lambda: Arrhenius(2e5, 20.0).factor(-273.15), "absolute zero"),
        (lambda: QuadraticShift(0.1, 0.0), "all temperatures"),
        (lambda: QuadraticShift(-0.4, 0.002).factor(100.0), "turns at 100 °C"),
        (lambda: TabulatedShift((0.0, 10.0), (1.0, 2.0), 5.0), "fall"),
        (lambda: TabulatedShift((0.0, 0.0), (1.0, 2.0), 0.0), "once"),
        (lambda: TabulatedShift((0.0, 5e-324), (1.0, 0.0), 0.0), "must differ by 1e-06 K"),
        (lambda: TabulatedShift((0.0, 10.0, 1.7e308), (1.0, 0.0, -1.0), 0.0), "at most 1000, got 1.7e.308"),
        (lambda: TabulatedShift((0.0, 10.0), (1.7e308, -1.7e308), 0.0), "1.7e\\+308 decades"),
        (lambda: WLF(1.7e308, 120.0, 15.0).factor(90.0), "inf decades"),
        (lambda: QuadraticShift(-1.7e308, -1e308).factor(90.0), "decades"),
        (lambda: TabulatedShift((0.0,), (1.0,), 0.0), "at least 2"),
        (lambda: TabulatedShift((0.0, 10.0), (1.0, 0.0), 15.0), "0 to 10 °C, got 15"),
        (lambda: LAWS[3].factor([5.0, 61.0]), "got 61"),
        (lambda: WLF.fit([1.0, 2.0], [0.0, 1.0], 0.0), "at least 3"),
        (lambda: WLF.fit([0.0, 10.0, 20.0], [0.0, 1.0, 2.0], 0.0), "no WLF law"),
        (lambda: Thermorheological(MIX.material, LAWS[0], (30.0, 10.0)), "tested"),
    ],
)
def test_bad_input(build, word):
    with pytest.raises(InputError, match=word):
        build()
