"""Checks of viscoelastic materials: a published mix, its Prony series, and creep against relaxation."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.catalogue import materials
from treadload.materials import (
    HuetSayegh,
    Model2S2P1D,
    PowerLawCreep,
    Prony,
    Thermorheological,
    as_prony,
)
from treadload.validation.check import Check, absolute

_TOLERANCE = 1e-4
_BINDER = Model2S2P1D(2e9, 1e6, 4.0, 0.21, 0.55, 300.0, 1e-4, 0.35)
_CREEPING = PowerLawCreep(2.5e-11, 1e-8, 1e3, 0.35, 0.3)


def rheology_checks() -> Iterator[Check]:
    """The mix of ViscoRoute at 15 °C and 10 Hz, series within their tolerance, ∫ E(t - s) J(s) ds = t."""
    simple = materials["ViscoRoute"].material
    assert isinstance(simple, Thermorheological)
    mix = simple.at(15.0)
    assert isinstance(mix, HuetSayegh)
    group, source = "Huet-Sayegh mix of ViscoRoute", "computed from the published parameters, to the digits given"
    modulus = complex(mix.complex_modulus(2 * math.pi * 10))
    yield absolute(group, "|E*| at 15 °C and 10 Hz, MPa", abs(modulus) / 1e6, 11356, 0.5, source)
    yield absolute(
        group, "its phase, degrees", math.degrees(math.atan2(modulus.imag, modulus.real)), 17.5, 0.05, source
    )
    omega = np.geomspace(1e-3, 1e5, 997)
    for name, material in (("Huet-Sayegh", mix), ("2S2P1D", _BINDER), ("power law", _CREEPING)):
        series = as_prony(material, 1e-3, 1e5, tolerance=_TOLERANCE)
        error = float(np.abs(series.complex_modulus(omega) / material.complex_modulus(omega) - 1).max())
        # The fit is held at 12 points per decade, between which the ripple may stand a little higher.
        what = f"{name}: as_prony to 1e-4 over 8 decades, error of E*"
        yield absolute("Prony series of a mix", what, error, 0, 1.1 * _TOLERANCE, "E* of the mix itself")
    solid = Prony(8e9, ((0.3, 0.002), (0.3, 0.02), (0.3, 0.3)), 0.35)
    for name, body in (("Prony", solid), ("Huet-Sayegh", mix), ("2S2P1D", _BINDER)):
        worst = max(abs(_convolved(body, t) / t - 1) for t in (1e-3, 0.1, 10.0))
        what = f"{name}: ∫ E(t - s) J(s) ds over t less 1, worst of 3 times"
        yield absolute("creep and relaxation", what, worst, 0, 1e-10, "E and J invert each other")


def _convolved(material: Prony | HuetSayegh | Model2S2P1D, t: float) -> float:
    """∫ E(t - s) J(s) ds from 0 to t, on panels graded to both ends, where powers of time begin."""
    grades = np.concatenate([[0.0], np.geomspace(1e-12, 0.5, 60)])
    nodes, weights = np.polynomial.legendre.leggauss(8)
    half = np.diff(grades) / 2
    part = (grades[:-1, None] + half[:, None] * (1 + nodes)).ravel() * t
    share = (half[:, None] * weights).ravel() * t
    late = t - part
    relaxed, crept = material.relaxation_modulus, material.creep_compliance
    return float(share @ (relaxed(late) * crept(part) + relaxed(part) * crept(late)))
