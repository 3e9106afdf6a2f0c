"""Stress of a restrained viscoelastic body over a temperature history."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from treadload.kernels.arrays import Array

# Gauss nodes per step: 1/aT varies as an exponential over a few degrees.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(5)
# Reduced time of a cycle over a time of relaxation, below which nothing relaxes within it: an error of this size.
_NEVER = 1e-6


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


def periodic_stress(strain: Array, reduced: Array, moduli: Array, times: Array, long_term: float) -> Array:
    """Stress of a generalised Maxwell body under a strain that comes back, cycle after cycle, in its steady state.

    strain: (nt, ...), at the starts of the steps of a cycle, linear in reduced time between, and back to the first.
    reduced: (nt, ...), steps of reduced time, the last back to the start. moduli, times, long_term: as in
    `restrained_stress`. What never relaxes, the long-term modulus as well, is free of stress in the mean of the cycle
    over reduced time, to which all that relaxes tends as its times grow. Returns (nt, ...), Pa.
    Per term s_{k+1} = s_k e^{-r_k} + E Δε_k (1 - e^{-r_k})/r_k, r = Δξ/τ, with s_nt = s_0.
    """
    rises = np.roll(strain, -1, axis=0) - strain
    middle = strain + 0.5 * rises
    total = reduced.sum(axis=0)
    apart = strain - (middle * reduced).sum(axis=0) / total
    stress: Array = long_term * apart
    for modulus, time in zip(moduli, times, strict=True):
        ratio = reduced / time
        gone = -np.expm1(-ratio)
        gain = rises * np.divide(gone, ratio, out=np.ones_like(gone), where=ratio > 0)
        within_step = np.zeros_like(strain)
        last = np.zeros(strain.shape[1:])
        for step in range(len(strain)):
            within_step[step] = last
            last = last * (1 - gone[step]) + gain[step]
        whole = total / time
        start = np.divide(last, -np.expm1(-whole), out=np.zeros_like(last), where=whole > 0)
        kept = np.exp(-np.concatenate([np.zeros((1, *last.shape)), np.cumsum(ratio, axis=0)[:-1]]))
        stress = stress + modulus * np.where(whole > _NEVER, within_step + start * kept, apart)
    return stress
