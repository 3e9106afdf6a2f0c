"""as_prony: any viscoelastic solid as exponential terms within a tolerance."""

import numpy as np
import pytest

from treadload.errors import InputError
from treadload.materials import Elastic, HuetSayegh, Model2S2P1D, PowerLawCreep, Prony, as_prony

MIX = HuetSayegh(40995e6, 18e6, 2.356, 0.186, 0.515, 0.0329, 0.35)
MATERIALS = [
    MIX,
    HuetSayegh(3e10, 0.0, 2.0, 0.2, 0.6, 1e-3, 0.35),
    # Exponents near their bounds.
    HuetSayegh(3e10, 1e7, 2.0, 0.05, 0.9, 1e-3, 0.35),
    Model2S2P1D(3e10, 3e7, 2.3, 0.2, 0.55, 300.0, 0.01, 0.35),
    Model2S2P1D(2e9, 0.0, 4.0, 0.21, 0.55, 300.0, 1e-4, 0.35),
    PowerLawCreep(2.5e-11, 1e-8, 1e3, 0.35, 0.3),
]


@pytest.mark.parametrize("material", MATERIALS, ids=str)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-8])
def test_the_tolerance_holds_in_the_range(material, tolerance):
    series = as_prony(material, 1e-3, 1e5, tolerance=tolerance)
    omega = np.geomspace(1e-3, 1e5, 997)
    error = np.abs(series.complex_modulus(omega) / material.complex_modulus(omega) - 1).max()
    # The check inside reads 12 points a decade, between which the ripple may stand a little higher.
    assert error < 1.1 * tolerance
    assert series.glassy.modulus == pytest.approx(material.glassy.modulus, rel=tolerance)
    assert series.poisson == material.poisson
    assert all(share > 0 for share, _ in series.terms)
    # Evenly spaced times leave 2 exp(-π²/ln(spacing)); twice as many for exponents near their bounds.
    enough = {1e-2: 4, 1e-4: 7, 1e-8: 11}[tolerance]
    assert len(series.terms) < enough * 8


def test_a_mix_in_few_terms():
    # 7 decades, 1e-4: near three terms a decade.
    assert len(as_prony(MIX, 1e-2, 1e5).terms) < 30


def test_the_rubbery_limit_is_exact():
    series = as_prony(MIX, 1.0, 1e4)
    assert series.rubbery.modulus == pytest.approx(18e6, rel=1e-9)
    assert as_prony(MATERIALS[1], 1.0, 1e4).is_fluid


def test_creep_follows():
    series = as_prony(MIX, 1e-3, 1e5, tolerance=1e-5)
    time = np.geomspace(1e-4, 1e2, 50)
    # Of the same order as the tolerance in frequency, a decade inside the range.
    np.testing.assert_allclose(series.creep_compliance(time), MIX.creep_compliance(time), rtol=2e-5)


def test_a_prony_series_is_returned_as_it_is():
    series = Prony(1e9, ((0.5, 1.0),), 0.35)
    assert as_prony(series, 1.0, 10.0) is series


class Resonant:
    """No solid: its modulus has a resonance, which no sum of decaying terms has."""

    poisson = 0.3
    glassy = Elastic(2e9, 0.3)
    rubbery = Elastic(1e9, 0.3)

    def complex_modulus(self, omega):
        w = np.asarray(omega)
        return 1e9 + 1e9 * w**2 / (w**2 - 1.0 - 0.1j * w)


def test_what_is_no_relaxation_is_refused():
    with pytest.raises(InputError, match="is reached"):
        as_prony(Resonant(), 0.1, 10.0, tolerance=1e-2)


@pytest.mark.parametrize(("lowest", "highest"), [(0.0, 1.0), (2.0, 1.0), (1.0, float("inf")), (float("nan"), 1.0)])
def test_bad_ranges(lowest, highest):
    with pytest.raises(InputError, match="lowest < highest"):
        as_prony(MIX, lowest, highest)
