"""Materials from measured curves: a Prony series, Huet-Sayegh or 2S2P1D nearest to them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np
import scipy

from treadload.errors import ConvergenceError, InputError
from treadload.kernels.arrays import Array, ComplexArray
from treadload.materials.huet_sayegh import HuetSayegh, Model2S2P1D
from treadload.materials.measured import FrequencySweep, Measured
from treadload.materials.operational import Operational
from treadload.materials.series import frequency_rows, prony_of, solve_non_negative
from treadload.materials.viscoelastic import Prony

M = TypeVar("M", Prony, HuetSayegh, Model2S2P1D)


@dataclass(frozen=True)
class MaterialFit(Generic[M]):
    """A material and how well it fits the data.

    rms_error, max_error: of |E*fit - E*| / |E*|, or of E(t) likewise, over the points.

    >>> data = tl.materials.RelaxationTest([0.01, 0.1, 1.0, 10.0], [8e9, 5e9, 4e9, 2.2e9])
    >>> fit = tl.materials.fit_prony(data, poisson=0.35, terms=2)
    >>> f"E(t) within {fit.max_error:.0%}"
    'E(t) within 8%'
    """

    material: M
    rms_error: float
    max_error: float

    def __str__(self) -> str:
        return f"{self.material}; relative error {self.rms_error:.2%} (rms), {self.max_error:.2%} (largest)"


def fit_prony(
    data: Measured, *, poisson: float, terms: int | None = None, times: Sequence[float] | None = None
) -> MaterialFit[Prony]:
    """The Prony series nearest to a curve, by non-negative least squares of the relative error.

    data: of one temperature. poisson: Poisson's ratio, constant. terms: number of times, evenly spaced in log over
    the range of the data, and a decade past its ends for a sweep, whose loss modulus shows what relaxes nearby; two
    per decade if left out: one leaves a ripple of 3 %, two of 0.05 %. times: (m,), s, instead. Terms that come out
    with no strength are left out. What relaxes further away goes to the ends: the two limits hold for the range
    measured, and a curve that falls to zero gives a fluid. Returns a MaterialFit. Raises InputError. Source:
    Baumgaertel & Winter (1989), Rheol. Acta 28, 511-519 (the spectrum from data); Lawson & Hanson (1974), Solving
    Least Squares Problems, chapter 23 (the method).

    >>> rubber = tl.materials.Prony(3e6, ((0.5, 0.1),), 0.49)
    >>> values = [complex(rubber.complex_modulus(omega)) for omega in (1, 3, 10, 30, 100)]
    >>> data = tl.materials.FrequencySweep([1, 3, 10, 30, 100], [e.real for e in values], [e.imag for e in values])
    >>> [round(share, 6) for share, time in tl.materials.fit_prony(data, poisson=0.49, times=[0.1]).material.terms]
    [0.5]
    """
    tau = _times(data, terms, times)
    rows, spring, values = _rows(data, tau)
    strengths = solve_non_negative(np.column_stack([rows, spring]), values)
    return _judged(prony_of(strengths[:-1], tau, float(strengths[-1]), poisson), data)


def fit_huet_sayegh(data: Measured, *, poisson: float) -> MaterialFit[HuetSayegh]:
    """The Huet-Sayegh model nearest to a curve, by least squares of the logarithm of the modulus.

    data: of one temperature, best several decades. poisson: Poisson's ratio. Of several starts the best is kept.
    Returns a MaterialFit. Raises InputError for fewer points than parameters, ConvergenceError if no start
    converges.

    >>> data = tl.materials.FrequencySweep([6.3, 63.0], [4e9, 8e9], [3e9, 2e9], temperature=15.0)
    >>> tl.materials.fit_huet_sayegh(data, poisson=0.35)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: 6 parameters need more data, got 2 moduli from 6.3 to 63 rad/s at 15 °C
    """
    return _judged(_huet_sayegh(_nearest(data, _huet_sayegh, poisson), poisson), data)


def fit_2s2p1d(data: Measured, *, poisson: float) -> MaterialFit[Model2S2P1D]:
    """The 2S2P1D model nearest to a curve, by least squares of the logarithm of the modulus.

    As fit_huet_sayegh, whose result is one of the starts. β is known only as far as the data reach slow flow.

    >>> data = tl.materials.FrequencySweep([6.3, 63.0], [4e9, 8e9], [3e9, 2e9], temperature=15.0)
    >>> tl.materials.fit_2s2p1d(data, poisson=0.35)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: 6 parameters need more data, got 2 moduli from 6.3 to 63 rad/s at 15 °C
    """
    simple = np.append(_nearest(data, _huet_sayegh, poisson), _BETA[1] / 2)
    return _judged(_2s2p1d(_nearest(data, _2s2p1d, poisson, math.log(300.0), start=simple), poisson), data)


# Bounds on ln δ and ln β, and on the exponents: k, and h as its place between k and 1.
_DELTA, _BETA, _PART = (-4.0, 5.0), (-3.0, 25.0), (0.01, 0.99)


def _huet_sayegh(p: Array, poisson: float) -> HuetSayegh:
    """The model of ln E∞, ln E₀, ln δ, ln τ, k and (h - k)/(1 - k): whatever the search does, it is one."""
    glassy, static, delta, tau = (float(value) for value in np.exp(p[:4]))
    k, part = float(p[4]), float(p[5])
    return HuetSayegh(glassy, min(static, 0.999999 * glassy), delta, k, k + part * (1 - k), tau, poisson)


def _2s2p1d(p: Array, poisson: float) -> Model2S2P1D:
    """The model of the same numbers and ln β."""
    m = _huet_sayegh(p, poisson)
    return Model2S2P1D(m.glassy_modulus, m.static_modulus, m.delta, m.k, m.h, math.exp(p[6]), m.tau, poisson)


def _nearest(
    data: Measured,
    build: Callable[[Array, float], Operational],
    poisson: float,
    *more: float,
    start: Array | None = None,
) -> Array:
    """Parameters of smallest misfit. more: values to start those from that Huet-Sayegh has not. start: one known."""
    measured = data.modulus
    count = 6 + len(more)
    if measured.size * (2 if np.iscomplexobj(measured) else 1) < count:
        raise InputError(f"{count} parameters need more data, got {data}")
    high, low = math.log(np.abs(measured).max()), math.log(np.abs(measured).min())
    reach = _reach(data)

    def misfit(p: Array) -> Array:
        ratio = np.log(_modulus_of(build(p, poisson), data) / measured)
        return np.concatenate([ratio.real, ratio.imag]) if np.iscomplexobj(ratio) else ratio

    lower = [high, low - 12.0, _DELTA[0], math.log(reach[0]) - 20, _PART[0], _PART[0], *[_BETA[0] for _ in more]]
    upper = [high + 5.0, high, _DELTA[1], math.log(reach[1]) + 20, _PART[1], _PART[1], *[_BETA[1] for _ in more]]
    starts = [
        np.array([high + 0.4, low - 0.5, math.log(2.0), math.log(tau), 0.2, 0.45, *more])
        for tau in np.geomspace(*reach, max(2, round(math.log10(reach[1] / reach[0])) + 1))
    ]
    # The starts of smallest misfit are refined; the others lie on flat ground.
    starts.sort(key=lambda p: float((misfit(p) ** 2).sum()))
    tried = [
        scipy.optimize.least_squares(misfit, np.clip(p, lower, upper), bounds=(lower, upper), x_scale="jac")
        for p in (starts[:2] if start is None else [*starts[:2], start])
    ]
    best = min(tried, key=lambda result: float(result.cost))
    if not best.success:
        raise ConvergenceError(
            f"the fit stopped at a misfit of {math.sqrt(2 * best.cost / measured.size):.2g}; give data over more "
            "decades, or use fit_prony",
            math.sqrt(2 * best.cost / measured.size),
        )
    return np.asarray(best.x)


def _judged(material: M, data: Measured) -> MaterialFit[M]:
    measured = data.modulus
    error = np.abs(_modulus_of(material, data) / measured - 1)
    return MaterialFit(material, float(np.sqrt((error**2).mean())), float(error.max()))


def _modulus_of(material: Prony | Operational, data: Measured) -> Array | ComplexArray:
    if isinstance(data, FrequencySweep):
        return material.complex_modulus(data.omega)
    return material.relaxation_modulus(data.time)


def _reach(data: Measured) -> tuple[float, float]:
    """Shortest and longest time that the data cover, s."""
    if isinstance(data, FrequencySweep):
        return 1 / float(data.omega[-1]), 1 / float(data.omega[0])
    return float(data.time[0]), float(data.time[-1])


def _times(data: Measured, terms: int | None, times: Sequence[float] | None) -> Array:
    first, last = _reach(data)
    if isinstance(data, FrequencySweep):
        first, last = first / 10, last * 10
    if times is not None:
        tau = np.unique(np.asarray(times, dtype=float))
        if terms is not None or tau.size == 0 or not (np.isfinite(tau) & (tau > 0)).all():
            raise InputError(f"give positive times of the terms, s, or their number, got {times!r} and {terms!r}")
        return tau
    count = max(1, round(2 * math.log10(last / first))) + 1 if terms is None else terms
    if count < 1:
        raise InputError(f"a Prony series needs at least one term, got {count}")
    return np.geomspace(first, last, count) if count > 1 else np.array([math.sqrt(first * last)])


def _rows(data: Measured, tau: Array) -> tuple[Array, Array, Array]:
    """Equations of relaxation: of a unit strength at each time, of a unit spring, and the data, all over |data|."""
    if isinstance(data, FrequencySweep):
        return frequency_rows(data.omega, data.modulus, tau)
    scale = 1 / data.modulus
    return scale[:, None] * np.exp(-data.time[:, None] / tau), scale, np.ones_like(scale)
