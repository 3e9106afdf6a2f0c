"""Checks of stress-dependent layers: printed moduli, a linear law, finite elements, finer sublayers."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from treadload.catalogue import mixes
from treadload.materials import Bilinear, Elastic, KTheta, StressDependent, Uzan
from treadload.pavement import Layer, Pavement
from treadload.response import UniformDisc, settle, solve_response
from treadload.units import PSI
from treadload.validation.check import Check, relative

_INCH = 0.0254
_GROUP = "stress-dependent layers"
# Bulk stresses and moduli as printed, psi.
_PRINTED = {
    "FDOT limerock": {11: 13083, 40: 27482},
    "FDOT stabilised subgrade": {18: 18553},
    "FDOT embankment": {9: 11539},
}
# Of the base in the printed run of GT-PAVE: inches below its top, and modulus, psi.
_MODULI = {0.65: 46848.88, 3.25: 33941.29, 5.85: 25751.39}
_SETTLEMENT, _STRAIN = 0.0178, 325.08e-6
# Share of tension and the reading of the soil's law are fitted to this run.
_FITTED = "GT-PAVE, a printed run; tension and the subgrade are fitted to it"
_PLATE = UniformDisc(4.55 * _INCH, 100 * PSI)


def stress_dependent_checks() -> Iterator[Check]:
    """Printed moduli of three materials; linear layers; a base of finite elements; sublayers half as thick."""
    report = "Florida Department of Transportation (2013)"
    for name, table in _PRINTED.items():
        material = mixes[name]
        assert isinstance(material, StressDependent)
        for bulk, modulus in table.items():
            read = float(material.moduli(bulk * PSI, 0.0)[0]) / PSI
            yield relative(_GROUP, f"{name} at {bulk} psi: M, psi", read, modulus, 2e-3, report)
    linear, by_law = (
        _centre(Pavement([Layer(Elastic(3e9, 0.35), 0.1), Layer(base, 0.3), Layer(Elastic(60e6, 0.4))]))
        for base in (Elastic(150e6, 0.3), StressDependent(KTheta(150e6, 0.0), 0.3))
    )
    yield relative(_GROUP, "a law with exponent 0: deflection, m", by_law, linear, 1e-10, "linear layers")
    usual, fine = (_centre(_k_theta(sublayer)) for sublayer in (None, 0.015))
    yield relative(_GROUP, "sublayers half as thick: deflection, m", usual, fine, 0.01, "sublayers of 15 mm")
    road = _gt_pave()
    state, printed = settle(_PLATE, road), _FITTED
    base = [k for k, number in enumerate(state.sublayers.parts) if state.sublayers.owner[number] == 1]
    depths, moduli = state.sublayers.depths[base] / _INCH - 3.5, state.moduli[base] / PSI
    for depth, value in _MODULI.items():
        below = float(np.interp(depth, depths, moduli))
        yield relative(_GROUP, f"Uzan base, {depth:g} in below its top: M, psi", below, value, 0.2, printed)
    data = solve_response(_PLATE, road, depths=[1.65 * _INCH, 3.4 * _INCH], points=[[0, 0]]).dataset
    settlement, strain = float(data["displacement_z"][0, 0]) / _INCH, float(data["strain_xx"][1, 0])
    yield relative(_GROUP, "Uzan base: deflection, in", settlement, _SETTLEMENT, 0.1, printed)
    yield relative(_GROUP, "Uzan base: radial strain in the asphalt", strain, _STRAIN, 0.15, printed)


def _centre(road: Pavement) -> float:
    """Deflection under the centre of a plate, m."""
    data = solve_response(UniformDisc(0.15, 700e3), road, depths=[0.0], points=[[0, 0]]).dataset
    return float(data["displacement_z"][0, 0])


def _k_theta(sublayer: float | None) -> Pavement:
    base = StressDependent(KTheta(60e6, 0.5), sublayer=sublayer)
    return Pavement([Layer(Elastic(3e9, 0.35), 0.08), Layer(base, 0.25), Layer(Elastic(60e6, 0.4))])


def _gt_pave() -> Pavement:
    """The road of the printed run; its soil's law is read so that the printed settlement comes out: a fit."""
    base = StressDependent(Uzan(7446.494 * PSI, 0.417, 0.122, PSI), 0.08, 0.6, 0.0804 * PSI / _INCH)
    law = Bilinear(11640 * PSI, 2.5 * PSI, 5900, 0, largest=40e3 * PSI)
    soil = StressDependent(law, 0.40, 0.82, 0.0607 * PSI / _INCH)
    layers = [
        Layer(Elastic(250e3 * PSI, 0.35), 3.5 * _INCH),
        Layer(base, 8 * _INCH),
        Layer(soil, 50 * _INCH),
    ]
    return Pavement(layers, rigid_base=True)
