"""Linear viscoelasticity: what remembers how it was loaded.

Poisson's ratio does not depend on time, so that one function of time scales every component.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy
from numpy.typing import ArrayLike

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array, ComplexArray
from treadload.materials.elastic import Elastic
from treadload.registry import MATERIALS
from treadload.units import Modulus, Number, Time

Terms = tuple[tuple[float, float], ...]

# A relaxation of all of the modulus, but for round-off, leaves a fluid.
_ROUND_OFF = 1e-12


@MATERIALS.register("prony")
@dataclass(frozen=True)
class Prony:
    """Generalised Maxwell solid: springs and dashpots in parallel with a spring.

    E(t) = E₀ (1 - Σ gᵢ (1 - exp(-t/τᵢ))).
    modulus: E₀, Pa, > 0: instantaneous (glassy) Young's modulus.
    terms: (gᵢ, τᵢ): share 0 < gᵢ ≤ 1 of E₀ that relaxes with the time τᵢ > 0, s; all τᵢ different. The shares
    sum up to at most 1; a sum of 1 leaves no long-term modulus, as in a Maxwell element, which is a fluid.
    poisson: Poisson's ratio, in (-1, 0.5], constant.
    Raises InputError.

    Source: Park & Schapery (1999), Int. J. Solids Struct. 36, 1653-1675 (interconversion).

    >>> rubber = tl.materials.Prony(3e6, ((0.5, 0.1),), 0.49)
    >>> rubber.poisson
    0.49
    """

    modulus: Modulus
    terms: tuple[tuple[Number, Time], ...]
    poisson: Number

    def __post_init__(self) -> None:
        Elastic(self.modulus, self.poisson)
        object.__setattr__(self, "terms", _checked(self.terms, "the share of the modulus that relaxes"))
        total = sum(share for share, _ in self.terms)
        if total > 1 + _ROUND_OFF:
            raise InputError(
                f"the shares of a Prony series add up to {total:g}, more than 1: the modulus would become "
                "negative; shares are relative to the instantaneous modulus"
            )

    @classmethod
    def standard_linear_solid(cls, instantaneous: float, long_term: float, time: float, poisson: float) -> Prony:
        """Solid of two springs and a dashpot: one relaxation.

        instantaneous, long_term: Young's moduli at t = 0 and t = ∞, Pa, 0 < long_term < instantaneous.
        time: of relaxation at constant strain, s. Raises InputError.
        """
        if not 0 < long_term < instantaneous:
            raise InputError(
                f"long_term must lie between 0 and the instantaneous modulus {instantaneous:g} Pa, "
                f"got {long_term:g} Pa"
            )
        return cls(instantaneous, ((1 - long_term / instantaneous, time),), poisson)

    @classmethod
    def from_creep(cls, modulus: float, terms: Sequence[tuple[float, float]], poisson: float) -> Prony:
        """The solid whose creep compliance is J(t) = (1 + Σ fⱼ (1 - exp(-t/Tⱼ))) / E₀.

        modulus: E₀, Pa. terms: (fⱼ, Tⱼ): compliance, fⱼ > 0 relative to 1/E₀, that is retarded by Tⱼ > 0, s.
        Raises InputError.
        """
        Elastic(modulus, poisson)
        creep = _checked(terms, "the compliance of a term, relative to the instantaneous one,")
        return cls(modulus, tuple(sorted(_swapped(creep, -1.0), key=lambda term: term[1])), poisson)

    @property
    def long_term_modulus(self) -> float:
        """E(∞) = E₀ (1 - Σ gᵢ), Pa; zero for a fluid."""
        remains = 1 - sum(share for share, _ in self.terms)
        return self.modulus * remains if remains > _ROUND_OFF else 0.0

    @property
    def is_fluid(self) -> bool:
        """True if nothing remains of the modulus after a long time."""
        return self.long_term_modulus == 0

    @property
    def glassy(self) -> Elastic:
        """The elastic limit of fast loading, with E₀."""
        return Elastic(self.modulus, self.poisson)

    @property
    def rubbery(self) -> Elastic:
        """The elastic limit of slow loading, with E(∞). Raises InputError for a fluid, which has none."""
        if self.is_fluid:
            raise InputError(
                "a fluid has no elastic limit of slow loading: the shares of the Prony series add up to 1; "
                "keep a long-term modulus, e.g. 1 % of the instantaneous one, by lowering them to a sum of 0.99"
            )
        return Elastic(self.long_term_modulus, self.poisson)

    @cached_property
    def creep_terms(self) -> Terms:
        """(fⱼ, Tⱼ) of the creep compliance J(t) = (1 + Σ fⱼ (1 - exp(-t/Tⱼ)) + t φ) / E₀, shortest time first.

        φ is `fluidity`, zero for a solid. The times are the poles of 1/E in the Laplace domain: exact.
        """
        return _swapped(self.terms, 1.0)

    @property
    def fluidity(self) -> float:
        """φ: rate of steady creep, relative to the instantaneous compliance, 1/s; zero for a solid."""
        return 1 / sum(share * time for share, time in self.terms) if self.is_fluid else 0.0

    def relaxation_modulus(self, time: ArrayLike) -> Array:
        """E(t), Pa, at times t ≥ 0, s, after a step of strain; the shape of `time`."""
        t = np.asarray(time, dtype=float)
        return self.modulus * (1 + sum((g * np.expm1(-t / tau) for g, tau in self.terms), np.zeros_like(t)))

    def creep_compliance(self, time: ArrayLike) -> Array:
        """J(t), 1/Pa, at times t ≥ 0, s, after a step of stress; the shape of `time`."""
        t = np.asarray(time, dtype=float)
        retarded = sum((-f * np.expm1(-t / tau) for f, tau in self.creep_terms), np.zeros_like(t))
        return np.asarray((1 + retarded + self.fluidity * t) / self.modulus)

    def complex_modulus(self, omega: ArrayLike) -> ComplexArray:
        """E*(ω) = E' + iE'', Pa, at angular frequencies ω, rad/s, for motion as exp(iωt); the shape of `omega`."""
        w = np.asarray(omega, dtype=float)
        kept = sum((g * 1j * w * tau / (1 + 1j * w * tau) for g, tau in self.terms), np.zeros(w.shape, complex))
        return np.asarray(self.long_term_modulus + self.modulus * kept)

    def slowed(self, factor: float) -> Prony:
        """The same material with its times τᵢ multiplied by a factor > 0."""
        return replace(self, terms=tuple((share, time * factor) for share, time in self.terms))

    def __str__(self) -> str:
        return (
            f"Prony series, E = {self.modulus / 1e6:g} to {self.long_term_modulus / 1e6:g} MPa in "
            f"{len(self.terms)} term{'s'[: len(self.terms) != 1]}, ν = {self.poisson:g}"
        )

    __repr__ = as_call


def _checked(terms: Sequence[tuple[float, float]], strength: str) -> Terms:
    """Terms (strength, time) as floats, in the order of their times. Raises InputError."""
    try:
        pairs = tuple(sorted(((float(s), float(t)) for s, t in terms), key=lambda term: term[1]))
    except (TypeError, ValueError) as error:
        raise InputError(f"terms must be pairs (share, time in s), got {terms!r}") from error
    if not pairs:
        raise InputError("a viscoelastic material needs at least one term, got none; use Elastic instead")
    for share, time in pairs:
        positive(strength, share, remedy="leave out terms of no strength")
        positive("the time of a term", time, "s", "1 ms is 0.001")
    for (_, before), (_, after) in itertools.pairwise(pairs):
        if not after > before * (1 + _ROUND_OFF):
            raise InputError(f"two terms have the time {after:g} s; combine them into one")
    return pairs


def _swapped(terms: Terms, sign: float) -> Terms:
    """Creep terms of relaxation terms (sign 1), or the other way round (sign -1), shortest time first.

    In the Laplace domain 1 ∓ Σ gᵢ aᵢ/(p + aᵢ), rates aᵢ = 1/τᵢ, inverts to 1 ± Σ fⱼ rⱼ/(p + rⱼ): rⱼ are the zeros at
    p = -rⱼ, one between neighbouring aᵢ and one beyond the last, below for relaxation and above for creep.
    """
    rates = np.array(sorted(1 / time for _, time in terms))
    strengths = np.array([share for share, _ in reversed(terms)])
    remains = 1 - strengths.sum()

    def secular(log_rate: float) -> float:
        return float(1 - sign * (strengths * rates / (rates - math.exp(log_rate))).sum())

    if sign > 0:
        # The slowest retardation lies above rate · remains; a fluid flows instead.
        fluid = remains <= _ROUND_OFF
        ends = rates if fluid else np.concatenate([[0.5 * rates[0] * remains], rates])
    else:
        ends = np.concatenate([rates, [2 * rates[-1] * (1 + strengths.sum())]])
    swapped: list[tuple[float, float]] = []
    for low, high in itertools.pairwise(np.log(ends)):
        # One digit off the poles at the ends.
        a, b = low + 2e-15 * (1 + abs(low)), high - 2e-15 * (1 + abs(high))
        rate = math.exp(scipy.optimize.brentq(secular, a, b, xtol=1e-15, rtol=1e-15))
        swapped.append((1 / (rate * float((strengths * rates / (rates - rate) ** 2).sum())), 1 / rate))
    return tuple(reversed(swapped))
