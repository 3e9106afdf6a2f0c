"""Models of bituminous mixes with parabolic dashpots: Huet-Sayegh and 2S2P1D."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from treadload.errors import InputError, positive
from treadload.kernels.arrays import ComplexArray
from treadload.materials.elastic import Elastic
from treadload.materials.operational import Operational
from treadload.registry import MATERIALS
from treadload.units import Modulus, Number, Time


@MATERIALS.register("huet-sayegh")
@dataclass(frozen=True)
class HuetSayegh(Operational):
    """A spring in parallel with a spring and two parabolic dashpots in series.

    E*(ω) = E₀ + (E∞ - E₀) / (1 + δ (iωτ)⁻ᵏ + (iωτ)⁻ʰ).
    glassy_modulus: E∞, Pa. static_modulus: E₀, Pa, 0 ≤ E₀ < E∞; 0 is Huet's model.
    delta: δ > 0. k, h: exponents, 0 < k < h < 1. tau: τ > 0, s, at the temperature meant.
    poisson: Poisson's ratio, in (-1, 0.5], constant.
    Raises InputError.

    Source: Huet (1963), Annales des Ponts et Chaussées 6, 373-429; Sayegh (1967), Proc. 2nd Int. Conf. Structural
    Design of Asphalt Pavements, Ann Arbor, 743-755.

    >>> mix = tl.materials.HuetSayegh(30e9, 50e6, delta=2.3, k=0.22, h=0.65, tau=0.2, poisson=0.35)
    >>> [round(abs(complex(mix.complex_modulus(6.283 * f))) / 1e9, 1) for f in (1, 10)]  # |E*|, GPa, at 1 and 10 Hz
    [7.9, 12.4]
    """

    glassy_modulus: Modulus
    static_modulus: Modulus
    delta: Number
    k: Number
    h: Number
    tau: Time
    poisson: Number

    def __post_init__(self) -> None:
        Elastic(self.glassy_modulus, self.poisson)
        if not 0 <= self.static_modulus < self.glassy_modulus:
            raise InputError(
                f"static_modulus must lie between 0 and the glassy modulus {self.glassy_modulus:g} Pa, "
                f"got {self.static_modulus:g} Pa"
            )
        if not 0 < self.k < self.h < 1:
            raise InputError(
                f"the exponents must satisfy 0 < k < h < 1, got k = {self.k:g} and h = {self.h:g}; "
                "mixes are near 0.2 and 0.6"
            )
        positive("delta", self.delta, remedy="mixes are near 2")
        positive("tau", self.tau, "s", "at the temperature meant")

    @property
    def glassy(self) -> Elastic:
        """The elastic limit of fast loading, with E∞."""
        return Elastic(self.glassy_modulus, self.poisson)

    @property
    def rubbery(self) -> Elastic:
        """The elastic limit of slow loading, with E₀. Raises InputError if E₀ = 0."""
        if self.static_modulus == 0:
            raise InputError(
                "a mix of static modulus 0 has no elastic limit of slow loading; give it a static_modulus, "
                "e.g. 1e7 Pa"
            )
        return Elastic(self.static_modulus, self.poisson)

    def operational_modulus(self, s: ArrayLike) -> ComplexArray:
        """The Laplace transform of the relaxation modulus times s, Pa; s complex, off the negative real axis."""
        st = np.asarray(s, dtype=complex) * self.tau
        span = self.glassy_modulus - self.static_modulus
        return np.asarray(self.static_modulus + span / (1 + self.delta * st**-self.k + st**-self.h))

    def slowed(self, factor: float) -> HuetSayegh:
        """The same material with its time τ multiplied by a factor > 0."""
        return replace(self, tau=self.tau * factor)

    def __str__(self) -> str:
        return f"Huet-Sayegh, {_summary(self)}"


@MATERIALS.register("2s2p1d")
@dataclass(frozen=True)
class Model2S2P1D(Operational):
    """Two springs, two parabolic dashpots and one dashpot: Huet-Sayegh's model with a viscous dashpot in that series.

    E*(ω) = E₀ + (E∞ - E₀) / (1 + δ (iωτ)⁻ᵏ + (iωτ)⁻ʰ + (iωβτ)⁻¹).
    glassy_modulus: E∞, Pa. static_modulus: E₀, Pa, 0 ≤ E₀ < E∞. delta: δ > 0. k, h: exponents, 0 < k < h < 1.
    tau: τ > 0, s. poisson: Poisson's ratio, constant.
    beta: β > 0; the dashpot's viscosity is η = (E∞ - E₀) β τ. The rest as for HuetSayegh; for a binder E₀ is 0
    or nearly so, and then it is a fluid.
    Raises InputError.

    Source: Olard & Di Benedetto (2003), Road Materials and Pavement Design 4, 185-224.

    >>> binder = tl.materials.Model2S2P1D(2e9, 0.0, delta=3.0, k=0.22, h=0.6, beta=300, tau=1e-4, poisson=0.35)
    >>> [round(abs(complex(binder.complex_modulus(6.283 * f))) / 1e6, 1) for f in (1, 10)]  # |E*|, MPa, at 1, 10 Hz
    [19.8, 66.5]
    """

    glassy_modulus: Modulus
    static_modulus: Modulus
    delta: Number
    k: Number
    h: Number
    beta: Number
    tau: Time
    poisson: Number

    def __post_init__(self) -> None:
        _ = self._without_dashpot
        positive("beta", self.beta, remedy="mixes are near 100 to 1000; use HuetSayegh for no dashpot")

    @property
    def _without_dashpot(self) -> HuetSayegh:
        return HuetSayegh(
            self.glassy_modulus, self.static_modulus, self.delta, self.k, self.h, self.tau, self.poisson
        )

    @property
    def glassy(self) -> Elastic:
        """The elastic limit of fast loading, with E∞."""
        return self._without_dashpot.glassy

    @property
    def rubbery(self) -> Elastic:
        """The elastic limit of slow loading, with E₀. Raises InputError if E₀ = 0."""
        return self._without_dashpot.rubbery

    def operational_modulus(self, s: ArrayLike) -> ComplexArray:
        """The Laplace transform of the relaxation modulus times s, Pa; s complex, off the negative real axis."""
        st = np.asarray(s, dtype=complex) * self.tau
        span = self.glassy_modulus - self.static_modulus
        flow = 1 / (self.beta * st)
        return np.asarray(self.static_modulus + span / (1 + self.delta * st**-self.k + st**-self.h + flow))

    def slowed(self, factor: float) -> Model2S2P1D:
        """The same material with its time τ multiplied by a factor > 0."""
        return replace(self, tau=self.tau * factor)

    def __str__(self) -> str:
        return f"2S2P1D, {_summary(self)}, β = {self.beta:g}"


def _summary(material: HuetSayegh | Model2S2P1D) -> str:
    return (
        f"E = {material.glassy_modulus / 1e6:g} to {material.static_modulus / 1e6:g} MPa, δ = {material.delta:g}, "
        f"k = {material.k:g}, h = {material.h:g}, τ = {material.tau:.4g} s, ν = {material.poisson:g}"
    )
