"""Stress of a restrained viscoelastic body over a temperature history."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from treadload.kernels.arrays import Array

# Gauss nodes per step: 1/aT varies as an exponential over a few degrees.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)


def reduced_steps(time: Array, temperature: Array, factor: Callable[[Array], Array]) -> Array:
    """Steps of reduced time, ∫ dt / aT, over intervals in which temperature is linear in time.

    time: (nt,), s. temperature: (nt, ...), °C. factor: aT of temperatures. Returns (nt - 1, ...), s.
    """
    lower, rise = temperature[:-1], np.diff(temperature, axis=0)
    steps = np.diff(time).reshape(-1, *([1] * (temperature.ndim - 1)))
    total = np.zeros(rise.shape)
    for node, weight in zip(0.5 * (1 + _NODES), 0.5 * _WEIGHTS, strict=True):
        total += weight / factor(lower + node * rise)
    return total * steps


def restrained_stress(strain_steps: Array, reduced: Array, moduli: Array, times: Array, long_term: float) -> Array:
    """Stress Σᵢ sᵢ + E∞ ε of a generalised Maxwell body, ε linear in reduced time over each step.

    strain_steps, reduced: (nt - 1, ...). moduli, times: (m,) of the terms, Pa and s. long_term: E∞, Pa.
    sᵢ ← sᵢ e^{-Δξ/τᵢ} + Eᵢ Δε (1 - e^{-Δξ/τᵢ}) τᵢ/Δξ, which neither grows nor cancels for any step.
    Returns (nt, ...), Pa, zero at first.
    """
    shape = strain_steps.shape[1:]
    terms = np.zeros((len(moduli), *shape))
    stress = np.zeros((len(strain_steps) + 1, *shape))
    spread = (slice(None), *[None] * len(shape))
    for step, (strain, passed) in enumerate(zip(strain_steps, reduced, strict=True), start=1):
        ratio = passed / times[spread]
        gone = -np.expm1(-ratio)
        # (1 - e^-r)/r at r → 0.
        mean = np.divide(gone, ratio, out=np.ones_like(gone), where=ratio > 0)
        terms = terms * (1 - gone) + moduli[spread] * strain * mean
        stress[step] = terms.sum(axis=0)
    total: Array = stress
    total[1:] += long_term * np.cumsum(strain_steps, axis=0)
    return total
