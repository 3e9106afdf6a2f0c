"""Modified power law: creep from one compliance to another over many decades of time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import ArrayLike

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.laplace import carson
from treadload.materials.elastic import Elastic
from treadload.materials.operational import Operational, check_times
from treadload.registry import MATERIALS
from treadload.units import Compliance, Number, Time

Powers = TypeVar("Powers", Array, ComplexArray)


@MATERIALS.register("power-law-creep")
@dataclass(frozen=True)
class PowerLawCreep(Operational):
    """Solid whose creep compliance is D(t) = D∞ + (D₀ - D∞) / (1 + (t/τ)ⁿ).

    instantaneous_compliance, long_term_compliance: D₀ and D∞, 1/Pa, 0 < D₀ < D∞.
    tau: τ > 0, s, at which half of the creep is complete. exponent: n, 0 < n < 1.
    poisson: Poisson's ratio, in (-1, 0.5], constant.
    Raises InputError.

    Source: the modified power law of asphalt, in the form of Levenberg's program ELLVA1; its complex modulus is
    that of the exact transform, no approximate interconversion.

    >>> mix = tl.materials.PowerLawCreep(0.05e-9, 5e-9, tau=10.0, exponent=0.4, poisson=0.35)
    >>> [round(1e-6 / float(mix.creep_compliance(t))) for t in (0.01, 1.0, 100.0)]  # creep stiffness, MPa
    [2909, 685, 279]
    """

    instantaneous_compliance: Compliance
    long_term_compliance: Compliance
    tau: Time
    exponent: Number
    poisson: Number

    def __post_init__(self) -> None:
        if not 0 < self.instantaneous_compliance < self.long_term_compliance < np.inf:
            raise InputError(
                "compliances must satisfy 0 < instantaneous_compliance < long_term_compliance, 1/Pa, got "
                f"{self.instantaneous_compliance:g} and {self.long_term_compliance:g}; asphalt is near 3e-11 at "
                "once"
            )
        if not 0 < self.exponent < 1:
            raise InputError(
                f"exponent must lie between 0 and 1, got {self.exponent:g}; asphalt is near 0.4, and a single "
                "retardation is Prony.from_creep"
            )
        positive("tau", self.tau, "s", "at the temperature meant")
        Elastic(1 / self.long_term_compliance, self.poisson)

    @property
    def glassy(self) -> Elastic:
        """The elastic limit of fast loading, with 1/D₀."""
        return Elastic(1 / self.instantaneous_compliance, self.poisson)

    @property
    def rubbery(self) -> Elastic:
        """The elastic limit of slow loading, with 1/D∞."""
        return Elastic(1 / self.long_term_compliance, self.poisson)

    def creep_compliance(self, time: ArrayLike) -> Array:
        """D(t), 1/Pa, at times t ≥ 0, s, after a step of stress; the shape of `time`. In closed form."""
        return np.asarray(self._creep((check_times(time) / self.tau) ** self.exponent))

    def operational_modulus(self, s: ArrayLike) -> ComplexArray:
        """The Laplace transform of the relaxation modulus times s, Pa; s complex, off the negative real axis."""
        n = self.exponent
        # The powers of u > 0 and of s apart: few of them are taken.
        return np.asarray(1 / carson(lambda u, s: self._creep(u**n * (s * self.tau) ** -n), s))

    def slowed(self, factor: float) -> PowerLawCreep:
        """The same material with its time τ multiplied by a factor > 0."""
        return replace(self, tau=self.tau * factor)

    def _creep(self, power: Powers) -> Powers:
        """D where (t/τ)ⁿ is `power`, real or complex."""
        return (self.instantaneous_compliance + self.long_term_compliance * power) / (1 + power)

    def __str__(self) -> str:
        return (
            f"modified power law, D = {self.instantaneous_compliance * 1e6:g} to "
            f"{self.long_term_compliance * 1e6:g} 1/MPa, τ = {self.tau:.4g} s, n = {self.exponent:g}, "
            f"ν = {self.poisson:g}"
        )
