"""Viscoelastic rolling against CONTACT's cylinders (Wang & Knothe 1993) and Hunter's (1961) closed form."""

import numpy as np
import pytest

from treadload.validation.viscoelastic import CYLINDERS, hunter, hunter_strip, polymer_cylinders

# The first row is CONTACT's tau_C = 0: material that has relaxed when it is loaded.
ROWS = {1e-9: (60.32, 2.50845, 80, 51, 1.378e-2), **CYLINDERS}
# Centre of pressure ahead of the axle, mm, of an earlier program of ours with dense matrices.
CENTRES = {1e-9: 0.0, 0.009: 1.222, 0.045: 0.595, 2.0: 0.028}


@pytest.mark.parametrize("retardation", ROWS)
def test_cylinders_of_contact_on_the_same_cells(retardation):
    peak, approach, contact, stick, creepage = ROWS[retardation]
    patch, (sunk, touching, stuck, crept) = polymer_cylinders(retardation)
    assert (touching, stuck) == (contact, stick)
    # Half a unit of the last digit printed; CONTACT integrates its coefficients with a relative tolerance of 1e-3
    # only, which its last digit shows: 85.31 where Hunter's closed form has 85.30.
    assert crept == pytest.approx(creepage, abs=0.6e-3 * 10 ** np.floor(np.log10(creepage)))
    assert sunk == pytest.approx(approach, rel=2e-5)
    assert patch.normal.pressure.max() / 1e6 == pytest.approx(peak, abs=0.006 if retardation < 1 else 0.012)
    pressure = patch.normal.pressure[0]
    centre = 1e3 * float((pressure * patch.x).sum() / pressure.sum())
    assert centre == pytest.approx(CENTRES[retardation], abs=6e-4)


@pytest.mark.parametrize(("retardation", "tolerance"), [(0.009, 2e-4), (0.045, 2e-4), (2.0, 2e-4)])
def test_the_closed_form_decides_between_the_programs(retardation, tolerance):
    patch, _ = polymer_cylinders(retardation)
    exact = hunter(600e3, 0.05, 1143e6 / 0.6, 1.0, retardation)
    # 28 cells to a half-width: the error of the peak is some 1e-4.
    assert patch.normal.pressure.max() == pytest.approx(exact.pressure(patch.x).max(), rel=tolerance)
    if retardation == 2.0:
        assert exact.pressure(np.linspace(-1e-4, 1e-4, 41)).max() / 1e6 == pytest.approx(85.30, abs=6e-3)


@pytest.mark.parametrize("length", [0.02, 0.5, 2.0, 20.0, 500.0])
def test_hunter(length):
    patch, exact = hunter_strip(100, length)
    pressure, expected = patch.normal.pressure[0], exact.pressure(patch.x)
    assert exact.pressure_centre > 0
    centre = float((pressure * patch.x).sum() / pressure.sum())
    # Memories below a cell (0.02) smear over it; long ones feel the finite length of the strip, by (c/1e4)².
    assert centre == pytest.approx(exact.pressure_centre, rel=2e-3)
    assert pressure.max() == pytest.approx(expected.max(), rel=1e-5)
    # At the edges pressure falls with infinite slope: one cell there holds a share √(1/100) of the peak at most.
    error = np.abs(pressure - expected) / expected.max()
    assert error.max() < 0.06
    assert np.sort(error)[:-4].max() < 4e-3


def test_hunter_falls_back_to_hertz():
    # Far slower and far faster than the material forgets: Hertz with the long-term and the instantaneous modulus.
    for length, share in ((1e-7, 1.5), (1e7, 0.0)):
        found = hunter(1.0, 100.0, 200.0, 1.5, length)
        assert found.half_width == pytest.approx(np.sqrt(4 * 100 * (1 + share) / (np.pi * 200)), rel=1e-5)
        assert found.pressure_centre == pytest.approx(0.0, abs=1e-6)
