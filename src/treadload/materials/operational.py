"""Viscoelastic solids known by their operational modulus: E*(ω) with s in the place of iω."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from treadload.errors import InputError
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.laplace import inverse_carson
from treadload.materials.elastic import Elastic


class Operational(ABC):
    """What follows from one complex function: modulus in the frequency domain, relaxation and creep in time.

    Poisson's ratio does not depend on time.
    """

    @property
    @abstractmethod
    def glassy(self) -> Elastic:
        """The elastic limit of fast loading."""

    @property
    @abstractmethod
    def rubbery(self) -> Elastic:
        """The elastic limit of slow loading. Raises InputError if nothing remains of the modulus."""

    @abstractmethod
    def operational_modulus(self, s: ArrayLike) -> ComplexArray:
        """The Laplace transform of the relaxation modulus times s, Pa; the shape of `s`.

        s: complex, 1/s, not on the negative real axis. At s = iω it is the complex modulus.
        """

    def complex_modulus(self, omega: ArrayLike) -> ComplexArray:
        """E*(ω) = E' + iE'', Pa, at angular frequencies ω > 0, rad/s, for motion as exp(iωt); shape of `omega`.

        Raises InputError for other frequencies; the limits are `rubbery` and `glassy`.
        """
        w = np.asarray(omega, dtype=float)
        if not (np.isfinite(w) & (w > 0)).all():
            raise InputError(
                "angular frequencies must be positive and finite, rad/s, got "
                f"{w[~(np.isfinite(w) & (w > 0))].flat[0]:g}; the limits are .rubbery and .glassy"
            )
        return self.operational_modulus(1j * w)

    def relaxation_modulus(self, time: ArrayLike) -> Array:
        """E(t), Pa, at times t ≥ 0, s, after a step of strain; the shape of `time`."""
        return _in_time(self.operational_modulus, self.glassy.modulus, time)

    def creep_compliance(self, time: ArrayLike) -> Array:
        """J(t), 1/Pa, at times t ≥ 0, s, after a step of stress; the shape of `time`."""
        return _in_time(lambda s: 1 / self.operational_modulus(s), 1 / self.glassy.modulus, time)


def check_times(time: ArrayLike) -> Array:
    """Times as an array. Raises InputError unless all are finite and ≥ 0, s."""
    t = np.asarray(time, dtype=float)
    if not (np.isfinite(t) & (t >= 0)).all():
        raise InputError(
            f"times must be finite and not negative, s, got {t[~(np.isfinite(t) & (t >= 0))].flat[0]:g}; "
            "the limit of long times is .rubbery"
        )
    return t


def _in_time(transform: Callable[[ComplexArray], ComplexArray], at_once: float, time: ArrayLike) -> Array:
    t = check_times(time)
    values = np.full(t.shape, at_once)
    later = t > 0
    values[later] = inverse_carson(transform, t[later])
    return values
