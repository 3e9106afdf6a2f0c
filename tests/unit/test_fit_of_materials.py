"""Fits return what made the data, and say how far off they are on measured ones."""

from pathlib import Path

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.materials import (
    FrequencySweep,
    HuetSayegh,
    Model2S2P1D,
    PowerLawCreep,
    Prony,
    RelaxationTest,
    fit_2s2p1d,
    fit_huet_sayegh,
    fit_prony,
    master_curve,
    read_isotherms,
    read_master_curve,
)

DATA = Path(__file__).parents[1] / "data" / "viscoelastic"
SERIES = Prony(10e9, ((0.2, 1e-3), (0.3, 1e-2), (0.25, 1.0), (0.15, 10.0)), 0.35)
MIX = HuetSayegh(40995e6, 18e6, 2.356, 0.186, 0.515, 0.0329, 0.35)
FLOWING = Model2S2P1D(35e9, 80e6, 2.3, 0.2, 0.55, 500.0, 0.05, 0.35)
TIMES = np.logspace(-4, 3, 40)


def swept(material, omega=1 / TIMES):
    modulus = material.complex_modulus(omega)
    return FrequencySweep(omega, modulus.real, modulus.imag)


def relaxed(material):
    return RelaxationTest(TIMES, material.relaxation_modulus(TIMES))


@pytest.mark.parametrize("data", [swept(SERIES), relaxed(SERIES)], ids=["frequency", "time"])
def test_a_fit_of_a_prony_series_returns_it(data):
    tau = [time for _, time in SERIES.terms]
    found = fit_prony(data, poisson=0.35, times=tau).material
    np.testing.assert_allclose(found.terms, SERIES.terms, rtol=1e-9)
    assert found.modulus == pytest.approx(10e9, rel=1e-9)
    assert found.long_term_modulus == pytest.approx(1e9, rel=1e-9)
    # Not told the times: those of a grid of half decades, which holds them, and no others.
    grid = fit_prony(data, poisson=0.35)
    assert grid.max_error < 1e-9
    strong = [(share, time) for share, time in grid.material.terms if share > 1e-6]
    np.testing.assert_allclose(strong, SERIES.terms, rtol=1e-5)


@pytest.mark.parametrize("material", [MIX, FLOWING, PowerLawCreep(2.5e-11, 1e-8, 1e3, 0.35, 0.3)], ids=str)
def test_the_ripple_of_evenly_spaced_terms(material):
    errors = [fit_prony(swept(material), poisson=0.35, terms=9 * density + 1).max_error for density in (1, 2, 3)]
    # exp(-π²/h) for times h apart in ln: 1.4e-2, 1.9e-4, 2.6e-6; some three times that was measured.
    ripple = np.exp(-(np.pi**2) / (np.log(10) / np.array([1, 2, 3])))
    assert (np.array(errors) < 4 * ripple).all()
    assert fit_prony(swept(material), poisson=0.35).max_error == errors[1]


def test_measured_curves_and_their_errors():
    # Asphalt's cousins: a polymer over 31 decades of time, whose scatter is what remains.
    relaxation = read_master_curve(DATA / "time_user_master.csv")
    found = fit_prony(relaxation, poisson=0.4)
    again = np.abs(found.material.relaxation_modulus(relaxation.time) / relaxation.modulus - 1)
    assert found.max_error == pytest.approx(again.max())
    assert found.rms_error == pytest.approx(np.sqrt((again**2).mean()))
    # 0.10 % and 0.69 % were measured with two terms a decade.
    assert found.rms_error < 0.002
    assert found.max_error < 0.01
    isotherms = master_curve(read_isotherms(DATA / "freq_user_raw.csv"), 3.0)
    # Storage and loss of 21 specimens' temperatures in one series: 1.8 % rms was measured.
    assert fit_prony(isotherms.data, poisson=0.4).rms_error < 0.025


@pytest.mark.parametrize("make", [swept, relaxed])
def test_a_fit_of_huet_sayegh_returns_it(make):
    found = fit_huet_sayegh(make(MIX), poisson=0.35)
    assert found.max_error < 1e-5
    for name in MIX.__dataclass_fields__:
        # Least squares stop at 1e-8 of the cost; the parameters depend on each other.
        assert getattr(found.material, name) == pytest.approx(getattr(MIX, name), rel=1e-3)


def test_a_fit_of_2s2p1d_returns_it():
    found = fit_2s2p1d(swept(FLOWING), poisson=0.35)
    assert found.max_error < 1e-5
    for name in FLOWING.__dataclass_fields__:
        assert getattr(found.material, name) == pytest.approx(getattr(FLOWING, name), rel=5e-3)


def test_scatter_is_told():
    generator = np.random.default_rng(1)
    clean = swept(MIX)
    noisy = FrequencySweep(
        clean.omega,
        clean.storage * np.exp(0.03 * generator.standard_normal(clean.omega.size)),
        clean.loss * np.exp(0.03 * generator.standard_normal(clean.omega.size)),
    )
    found = fit_huet_sayegh(noisy, poisson=0.35)
    # 3 % on each part, less the six parameters.
    assert 0.015 < found.rms_error < 0.04
    # 80 numbers for six parameters: the scatter averages out of the curve, if not out of each parameter.
    np.testing.assert_allclose(np.abs(swept(found.material).modulus), np.abs(clean.modulus), rtol=0.03)


@pytest.mark.parametrize(
    ("build", "word"),
    [
        (lambda: fit_prony(swept(MIX), poisson=0.35, terms=0), "at least one term"),
        (lambda: fit_prony(swept(MIX), poisson=0.35, terms=3, times=[1.0]), "or their number"),
        (lambda: fit_prony(swept(MIX), poisson=0.35, times=[-1.0]), "positive times"),
        (lambda: fit_prony(swept(MIX), poisson=0.6), "poisson"),
        (lambda: fit_prony(RelaxationTest([1.0, 2.0], [1e9, 1e9]), poisson=0.3, times=[1e-9]), "Elastic"),
        (lambda: fit_huet_sayegh(RelaxationTest([1.0, 2.0], [2e9, 1e9]), poisson=0.3), "6 parameters"),
    ],
)
def test_bad_input(build, word):
    with pytest.raises(InputError, match=word):
        build()
