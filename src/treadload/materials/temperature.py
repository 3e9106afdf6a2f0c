"""Temperature: one factor on all times of a material, and the laws it follows.

Log is to base 10 for WLF and tables, as they are printed; natural for the others. Temperatures are in °C.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
import scipy
from numpy.typing import ArrayLike
from typing_extensions import Protocol, runtime_checkable

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.materials.celsius import check_celsius
from treadload.materials.kinds import Viscoelastic
from treadload.registry import SHIFTS
from treadload.units import Celsius, Kelvin, MolarEnergy, Number, PerDegree, PerDegreeSquared

_KELVIN = 273.15
_GAS = 8.31446261815324  # J/(mol K), exact since 2019.
_DECADE = math.log(10)
# Factors that a float can hold, in decades.
_DECADES = 300.0
# Where no road and no rubber holds together, °C.
_HOTTEST = 1000.0
# Temperatures of a table that no thermometer tells apart, K.
_NEXT = 1e-6


@runtime_checkable
class ShiftLaw(Protocol):
    """How the times of a material depend on temperature."""

    @property
    def reference(self) -> float:
        """Temperature at which the factor is 1, °C."""

    def factor(self, temperature: ArrayLike) -> Array:
        """The factor aT at temperatures, °C: all times are this much longer than at the reference."""


SHIFTS.makes(ShiftLaw)


class Shiftable(Viscoelastic, Protocol):
    """A viscoelastic material all of whose times can be multiplied by a factor."""

    def slowed(self, factor: float) -> Self:
        """The same material with its times multiplied by a factor > 0."""


@SHIFTS.register("wlf")
@dataclass(frozen=True)
class WLF:
    """log aT = -c₁ (T - Tᵣ) / (c₂ + T - Tᵣ), log to base 10.

    c1: C₁ > 0. c2: C₂ > 0, K. reference: Tᵣ, °C. It holds above Tᵣ - C₂, and is meant for temperatures above
    that of the glass transition.
    Raises InputError.

    Source: Williams, Landel & Ferry (1955), J. Am. Chem. Soc. 77, 3701-3707.

    >>> shift = tl.materials.WLF(c1=19.0, c2=150.0, reference=15.0)
    >>> f"{shift.factor(25.0):.3g}"
    '0.0649'
    """

    c1: Number
    c2: Kelvin
    reference: Celsius

    def __post_init__(self) -> None:
        positive("c1", self.c1, remedy="mixes are near 15")
        positive("c2", self.c2, "K", "mixes are near 120")
        _celsius(self.reference, "reference")

    @classmethod
    def fit(cls, temperatures: Sequence[float], log_factors: Sequence[float], reference: float) -> WLF:
        """The law nearest to measured log₁₀ aT, by least squares.

        temperatures: (n,), °C, n ≥ 3. log_factors: (n,). reference: °C, where it is 0.
        Raises InputError for too few data, and where the nearest law has no C₁, C₂ > 0.
        """
        t, y = _measured(temperatures, log_factors, 3)
        rise = t - reference
        # y C₂ + rise C₁ = -y rise is linear in the two: a start. C₂ must keep all of the data in its range.
        start = np.linalg.lstsq(np.column_stack([rise, y]), -y * rise, rcond=None)[0]
        least = max(0.0, -float(rise.min()))
        c1, c2 = max(float(start[0]), 1e-3), max(float(start[1]), 1.05 * least + 1e-3)
        constants = scipy.optimize.least_squares(
            lambda p: p[0] * rise / (p[1] + rise) + y, (c1, c2), bounds=((0, least), np.inf), x_scale=(c1, c2)
        ).x
        if not (constants[0] > 1e-6 and least * (1 + 1e-6) < constants[1] < 1e5):
            raise InputError(
                f"these shift factors follow no WLF law (C₁ = {constants[0]:g}, C₂ = {constants[1]:g} K); leave out "
                "temperatures below the glass transition, or use Arrhenius.fit or TabulatedShift"
            )
        return cls(float(constants[0]), float(constants[1]), reference)

    def factor(self, temperature: ArrayLike) -> Array:
        """The factor aT at temperatures, °C. Raises InputError at and below Tᵣ - C₂, where the law ends."""
        rise = _celsius(temperature) - self.reference
        if (rise <= -self.c2).any():
            raise InputError(
                f"WLF holds above {self.reference - self.c2:g} °C (its reference less C₂), "
                f"got {rise.min() + self.reference:g} °C"
            )
        with np.errstate(over="ignore"):
            return _power(-self.c1 * rise / (self.c2 + rise))

    def __str__(self) -> str:
        return f"WLF, C₁ = {self.c1:.4g}, C₂ = {self.c2:.4g} K from {self.reference:g} °C"


@SHIFTS.register("arrhenius")
@dataclass(frozen=True)
class Arrhenius:
    """ln aT = Eₐ/R (1/T - 1/Tᵣ), with absolute temperatures.

    activation_energy: Eₐ, J/mol, > 0. reference: Tᵣ, °C. Raises InputError.

    >>> shift = tl.materials.Arrhenius(200e3, reference=15.0)
    >>> f"{shift.factor(25.0):.3g}"
    '0.0608'
    """

    activation_energy: MolarEnergy
    reference: Celsius

    def __post_init__(self) -> None:
        positive("activation_energy", self.activation_energy, "J/mol", "mixes are near 2e5")
        _celsius(self.reference, "reference")

    @classmethod
    def fit(cls, temperatures: Sequence[float], log_factors: Sequence[float], reference: float) -> Arrhenius:
        """The law nearest to measured log₁₀ aT, by least squares.

        temperatures: (n,), °C, n ≥ 2. log_factors: (n,). reference: °C, where it is 0. Raises InputError.
        """
        t, y = _measured(temperatures, log_factors, 2)
        x = (1 / (t + _KELVIN) - 1 / (reference + _KELVIN)) / _GAS
        return cls(float(x @ y / (x @ x) * _DECADE), reference)

    def factor(self, temperature: ArrayLike) -> Array:
        """The factor aT at temperatures, °C, above absolute zero."""
        kelvin = _celsius(temperature) + _KELVIN
        return _power(self.activation_energy / _GAS * (1 / kelvin - 1 / (self.reference + _KELVIN)) / _DECADE)

    def __str__(self) -> str:
        return f"Arrhenius, {self.activation_energy / 1e3:.4g} kJ/mol from {self.reference:g} °C"


@SHIFTS.register("quadratic")
@dataclass(frozen=True)
class QuadraticShift:
    """ln aT = a₁ (T - Tᵣ) + a₂ (T² - Tᵣ²): the law of Huet and Sayegh, ln τ = A₀ + A₁ T + A₂ T².

    a1: A₁, 1/°C. a2: A₂, 1/°C². reference: Tᵣ, °C; at 0 °C τ = exp(A₀). It holds where times fall with rising
    temperature, that is where a₁ + 2 a₂ T < 0.
    Raises InputError.

    >>> shift = tl.materials.QuadraticShift(a1=-0.3996, a2=0.00152)
    >>> f"{shift.factor(15.0) / shift.factor(25.0):.0f} times slower at 15 °C than at 25 °C"
    '30 times slower at 15 °C than at 25 °C'
    """

    a1: PerDegree
    a2: PerDegreeSquared
    reference: Celsius = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.a1) and math.isfinite(self.a2)):
            raise InputError(f"a1 and a2 must be finite, got {self.a1:g} and {self.a2:g}")
        self._check(_celsius(self.reference, "reference"))

    @classmethod
    def fit(cls, temperatures: Sequence[float], log_factors: Sequence[float], reference: float) -> QuadraticShift:
        """The law nearest to measured log₁₀ aT, by least squares.

        temperatures: (n,), °C, n ≥ 3. log_factors: (n,). reference: °C, where it is 0. Raises InputError.
        """
        t, y = _measured(temperatures, log_factors, 3)
        columns = np.column_stack([t - reference, t**2 - reference**2])
        a1, a2 = np.linalg.lstsq(columns, y * _DECADE, rcond=None)[0]
        return cls(float(a1), float(a2), reference)

    def factor(self, temperature: ArrayLike) -> Array:
        """The factor aT at temperatures, °C. Raises InputError where the parabola has turned and times would rise."""
        t = _celsius(temperature)
        self._check(t)
        with np.errstate(over="ignore", invalid="ignore"):
            return _power((self.a1 * (t - self.reference) + self.a2 * (t**2 - self.reference**2)) / _DECADE)

    def _check(self, t: Array) -> None:
        with np.errstate(over="ignore", invalid="ignore"):
            turned = t[self.a1 + 2 * self.a2 * t >= 0]
        if turned.size:
            where = f"{-self.a1 / (2 * self.a2):g} °C" if self.a2 else "all temperatures"
            raise InputError(
                f"times must fall with rising temperature: the law a1 = {self.a1:g}, a2 = {self.a2:g} turns at "
                f"{where}, got {turned.flat[0]:g} °C; stay on its falling side"
            )

    def __str__(self) -> str:
        return f"ln aT = {self.a1:g} T + {self.a2:g} T², from {self.reference:g} °C"


@SHIFTS.register("table")
@dataclass(frozen=True)
class TabulatedShift:
    """Measured log₁₀ aT, interpolated over temperature by a monotone cubic.

    temperatures: (n,), °C, n ≥ 2, increasing or decreasing. log_factors: (n,), log₁₀ aT, falling with rising
    temperature. reference: °C, inside the table; factors are relative to it. Raises InputError.
    Source: Fritsch & Carlson (1980), SIAM J. Numer. Anal. 17, 238-246 (the interpolant).

    >>> shift = tl.materials.TabulatedShift((5, 15, 25), (1.4, 0, -1.2), reference=15)
    >>> f"{shift.factor(20.0):.2f}"
    '0.24'
    """

    temperatures: tuple[Celsius, ...]
    log_factors: tuple[Number, ...]
    reference: Celsius

    def __post_init__(self) -> None:
        t, y = _measured(self.temperatures, self.log_factors, 2)
        _check_decades(y)
        order = np.argsort(t)
        t, y = t[order], y[order]
        if not (np.diff(t) > 0).all():
            raise InputError("a table of shift factors needs each temperature once")
        if np.diff(t).min() < _NEXT:
            near = int(np.argmin(np.diff(t)))
            raise InputError(
                f"temperatures of a table of shift factors must differ by {_NEXT:g} K or more, got {t[near]:.9g} and "
                f"{t[near + 1]:.9g} °C; leave one out"
            )
        if not (np.diff(y) < 0).all():
            worst = int(np.argmax(np.diff(y)))
            raise InputError(
                f"shift factors must fall with rising temperature, got log aT = {y[worst]:g} at {t[worst]:g} °C and "
                f"{y[worst + 1]:g} at {t[worst + 1]:g} °C"
            )
        object.__setattr__(self, "temperatures", tuple(t.tolist()))
        object.__setattr__(self, "log_factors", tuple(y.tolist()))
        self._check(_celsius(self.reference, "reference"))

    @cached_property
    def _curve(self) -> scipy.interpolate.PchipInterpolator:
        return scipy.interpolate.PchipInterpolator(self.temperatures, self.log_factors)

    def factor(self, temperature: ArrayLike) -> Array:
        """The factor aT at temperatures, °C. Raises InputError outside the table."""
        t = _celsius(temperature)
        self._check(t)
        return _power(self._curve(t) - float(self._curve(self.reference)))

    def _check(self, t: Array) -> None:
        outside = t[(t < self.temperatures[0]) | (t > self.temperatures[-1])]
        if outside.size:
            raise InputError(
                f"the table of shift factors covers {self.temperatures[0]:g} to {self.temperatures[-1]:g} °C, got "
                f"{outside.flat[0]:g} °C; fit a law to it to go further, e.g. WLF.fit"
            )

    def __str__(self) -> str:
        return (
            f"table of {len(self.temperatures)} shift factors, {self.temperatures[0]:g} to "
            f"{self.temperatures[-1]:g} °C, from {self.reference:g} °C"
        )


@dataclass(frozen=True)
class Thermorheological:
    """A thermorheologically simple material: temperature changes all of its times alike, and nothing else.

    material: at the reference temperature of the shift: Prony, HuetSayegh, Model2S2P1D, PowerLawCreep, or any
    Viscoelastic with `slowed`. shift: WLF, Arrhenius, QuadraticShift or TabulatedShift.
    tested: (lowest, highest) temperature of the tests behind them, °C; None if unknown, then all are allowed.
    Raises InputError.

    >>> series = tl.materials.Prony(15e9, ((0.5, 0.01), (0.4, 1.0)), 0.35)
    >>> mix = tl.materials.Thermorheological(series, tl.materials.Arrhenius(200e3, reference=15.0))
    >>> [round(abs(complex(mix.at(t).complex_modulus(62.8))) / 1e9, 1) for t in (0, 15, 30)]  # |E*|, GPa, at 10 Hz
    [15.0, 10.2, 5.5]
    """

    material: Shiftable
    shift: ShiftLaw
    tested: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        if self.tested is not None:
            low, high = (float(t) for t in self.tested)
            if not -_KELVIN < low < high < math.inf:
                raise InputError(f"tested must be (lowest, highest) temperature, °C, got {low:g} and {high:g}")
            object.__setattr__(self, "tested", (low, high))

    def at(self, temperature: float, *, extrapolate: bool = False) -> Viscoelastic:
        """The material at a temperature, °C: of the same kind, its times multiplied by aT.

        Raises InputError outside the tested temperatures unless asked to extrapolate, and outside of the shift's law.
        """
        if self.tested is None:
            temperature = check_celsius(temperature)
        elif not (extrapolate or self.tested[0] <= temperature <= self.tested[1]):
            raise InputError(
                f"the material was tested from {self.tested[0]:g} to {self.tested[1]:g} °C, got {temperature:g} °C; "
                "to use its law outside, set extrapolate=True"
            )
        return self.material.slowed(float(self.shift.factor(temperature)))

    def __str__(self) -> str:
        tested = f", tested from {self.tested[0]:g} to {self.tested[1]:g} °C" if self.tested else ""
        return f"{self.material}; {self.shift}{tested}"


def _celsius(temperature: ArrayLike, name: str = "a temperature") -> Array:
    t = np.asarray(temperature, dtype=float)
    bad = t[~(np.isfinite(t) & (t > -_KELVIN))]
    if bad.size:
        raise InputError(f"{name} must be in °C, above absolute zero at -273.15, got {bad.flat[0]:g}")
    if t.size and t.max() > _HOTTEST:
        raise InputError(f"{name} must be in °C, at most {_HOTTEST:g}, got {t.max():g}")
    return t


def _power(log: Array) -> Array:
    _check_decades(log)
    return np.asarray(10.0**log)


def _check_decades(log: Array) -> None:
    # What is not a number is refused, too.
    if not (np.abs(log) <= _DECADES).all():
        raise InputError(
            f"the shift reaches {np.abs(log).max():.4g} decades of time, more than {_DECADES:.0f}; "
            "check its constants and the temperature"
        )


def _measured(temperatures: Sequence[float], log_factors: Sequence[float], least: int) -> tuple[Array, Array]:
    t, y = _celsius(temperatures, "temperatures"), np.asarray(log_factors, dtype=float)
    if t.ndim != 1 or t.shape != y.shape or t.size < least or not np.isfinite(y).all():
        raise InputError(
            f"shift factors need at least {least} temperatures and as many finite log factors, got {t.size} and "
            f"{y.size}"
        )
    return t, y
