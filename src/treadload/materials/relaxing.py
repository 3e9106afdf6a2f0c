"""How a mix relaxes that is tabulated over temperature and frequency: a model with its shift, from the table."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.materials.huet_sayegh import HuetSayegh
from treadload.materials.mixture import Mix
from treadload.materials.temperature import Arrhenius, Thermorheological

# Static modulus of the model, Pa: published mixes have 10 to 50 MPa, which no table reaches.
_STATIC = 20e6
_REFERENCE = 10.0
# ln E∞ above the largest tabulated, ln δ, ln τ in s, k, h as its place between k and 1, ln of Eₐ in J/mol.
_LOWER = np.array([0.02, math.log(0.5), -18.0, 0.05, 0.05, math.log(1e5)])
_UPPER = np.array([1.5, 3.0, 6.0, 0.6, 0.95, math.log(4e5)])
_START = np.array([0.4, 0.8, -3.0, 0.2, 0.4, math.log(2e5)])


@dataclass(frozen=True)
class Relaxation:
    """How a mix relaxes. material: with its shift. misfit: rms of ln |E*| of the model less that of the table."""

    material: Thermorheological
    misfit: float


def silent_on_time(mix: Mix) -> str:
    """Why the table of a mix has no relaxation, in words; empty where `relaxation_of` finds one."""
    if len(mix.frequencies) > 1:
        return ""
    return f"mix {mix.name!r} is tabulated at {mix.frequencies[0]:g} Hz only, which does not define how it relaxes"


@lru_cache(maxsize=64)
def relaxation_of(mix: Mix) -> Relaxation:
    """The Huet-Sayegh model and the Arrhenius shift nearest to a mix's table over temperature and frequency.

    Of six numbers by least squares of ln |E*|; the static modulus is 20 MPa. What happens in hours is that of 10 Hz
    at some 30 °C more, so that a table to 40 °C reaches the daily course of temperatures to 10 °C and no further.
    Raises InputError for a mix tabulated at one frequency, which states nothing about time.
    """
    silent = silent_on_time(mix)
    if silent:
        raise InputError(f"{silent}; name a viscoelastic material with a shift that does, in a case relaxation")
    measured = np.log(np.array(mix.moduli))
    warmth = np.broadcast_to(np.array(mix.temperatures), measured.shape)
    omega = 2 * math.pi * np.array(mix.frequencies)[:, None]

    def misfit(p: Array) -> Array:
        model = _model(p, float(measured.max()), mix.poisson)
        reduced = omega * model.shift.factor(warmth)
        result: Array = (np.log(np.abs(model.material.complex_modulus(reduced))) - measured).ravel()
        return result

    best = scipy.optimize.least_squares(misfit, _START, bounds=(_LOWER, _UPPER), x_scale="jac")
    return Relaxation(_model(best.x, float(measured.max()), mix.poisson), float(np.sqrt(np.mean(best.fun**2))))


def _model(p: Array, highest: float, poisson: float) -> Thermorheological:
    glassy, delta, tau, energy = math.exp(highest + p[0]), math.exp(p[1]), math.exp(p[2]), math.exp(p[5])
    k = float(p[3])
    material = HuetSayegh(glassy, _STATIC, delta, k, k + float(p[4]) * (1 - k), tau, poisson)
    return Thermorheological(material, Arrhenius(energy, _REFERENCE))
