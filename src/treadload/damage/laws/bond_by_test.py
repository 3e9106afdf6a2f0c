"""Strength of a bond by temperature and rate, from shear tests, and the rate at which a wheel shears it.

An exponential of temperature times a power of the rate is what time-temperature superposition makes of a power law;
Canestrari, Ferrotti and Graziani (2016), Mech. Time-Depend. Mater. 20, 405-419, found both laws of the rate, power
and logarithm, within 0.06 to 0.13 MPa of tests from 0 to 30 °C and 0.5 to 9 mm/min, superposition, and a sigmoid over
more decades (abstract read; its constants were not).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
import scipy
from numpy.typing import ArrayLike

from treadload.damage.laws.bond import BondStrength, BondUtilisation, InterfaceStrength
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.registry import QUANTITIES
from treadload.units import Angle, Celsius, Length, Number, PerDegree, Pressure, Speed

LEUTNER_RATE = 50e-3 / 60
"""Of Leutner's test, 50 mm/min, m/s."""
_TEST_TEMPERATURE = 20.0
QUOTED_SOFTENING = 0.053
"""Loss of strength with temperature, 1/K, from 10 to 60 °C, as commonly quoted, not checked against the source.

Of West, Zhang and Moore (2005), NCAT Report 05-08: bonds at 10 °C carried 2.3 times as much as at 25 °C, at 60 °C a
sixth of that, which is 0.056 and 0.051 per kelvin. That an exponential of temperature fits shear tests of tack coats
is the finding of Du (2015), Journal of Civil Engineering and Management 21, 571-577 (abstract read).
"""
_SLIP = 2e-3
_ANY, _ANY_RATE = (-math.inf, math.inf), (0.0, math.inf)
_FEWEST = 3


@dataclass(frozen=True)
class TimedStrength(BondStrength):
    """Strength of a bond by temperature and rate: τ ≤ c + σ_n tan φ with c = c₀ e^(-a (T - T₀)) (v / v₀)^m.

    cohesion: c₀, Pa, > 0, at the temperature T₀, °C, and the rate v₀ of the test's halves, m/s. softening: a, 1/K,
    >= 0. rate_exponent: m, in [0, 1). friction_angle: φ, rad, in [0, π/2). tensile_strength: Pa, at T₀ and v₀, and
    with c elsewhere; left out, where Coulomb's line ends. slip: displacement at which a test fails, m.
    temperatures, rates: (least, most) of the tests, °C and m/s. Beyond them the law stays on the safe side and states
    so: where strength would rise, colder and faster, it is held; where it falls it goes on falling.
    scatter: relative standard deviation of tests about the law. caveat: which numbers have no source that was read.
    Raises InputError.

    >>> bond = tl.damage.TimedStrength(cohesion=1.0e6, softening=0.05, rate_exponent=0.1)
    >>> [f"{bond.at(temperature).utilisation(400e3, -200e3):.2f}" for temperature in (20.0, 40.0)]  # fails at 1
    ['0.40', '1.09']
    """

    cohesion: float
    softening: float
    rate_exponent: float = 0.0
    temperature: float = _TEST_TEMPERATURE
    rate: float = LEUTNER_RATE
    friction_angle: float = 0.0
    tensile_strength: float | None = None
    slip: float = _SLIP
    temperatures: tuple[float, float] = _ANY
    rates: tuple[float, float] = _ANY_RATE
    scatter: float = 0.0
    caveat: str = ""

    def __post_init__(self) -> None:
        positive("the cohesion of a bond", self.cohesion, "Pa", "0.85 MPa is 0.85e6")
        if not (math.isfinite(self.softening) and self.softening >= 0):
            raise InputError(f"softening must be >= 0 per kelvin, got {self.softening}; 0.05 is usual")
        if not 0 <= self.rate_exponent < 1:
            raise InputError(
                f"rate_exponent must lie in [0, 1), got {self.rate_exponent}; 0 is no effect of the rate"
            )
        positive("the rate of a shear test", self.rate, "m/s", "50 mm/min is 0.83e-3")
        positive("slip, at which a shear test fails,", self.slip, "metres", "2 mm is 0.002")
        for name, (low, high) in (("temperatures", self.temperatures), ("rates", self.rates)):
            if not low <= high:
                raise InputError(f"{name} must be (least, most) of the tests, got {(low, high)}; turn them round")
        _ = self._law

    @classmethod
    def leutner_minimum(cls, place: str, *, rate_exponent: float = 0.0, friction_angle: float = 0.0) -> Self:
        """A core that just passes Leutner's test at 20 °C, softening as West's cores do; its numbers are as commonly
        quoted, not checked against the source.

        place: as for `InterfaceStrength.leutner_minimum`. rate_exponent, friction_angle: 0 counts on no help.
        """
        least = InterfaceStrength.leutner_minimum(place)
        return cls(
            float(least.shear_strength(0.0)),
            QUOTED_SOFTENING,
            rate_exponent,
            friction_angle=friction_angle,
            temperatures=(10.0, 60.0),
            caveat=f"{least.caveat}; so is its softening of {QUOTED_SOFTENING:g} per kelvin",
        )

    @classmethod
    def fit(
        cls,
        strength: ArrayLike,
        temperature: ArrayLike,
        *,
        rate: ArrayLike = LEUTNER_RATE,
        normal: ArrayLike = 0.0,
        slip: float = _SLIP,
    ) -> Self:
        """The law through shear tests, by least squares of the relative error.

        strength: largest shear stress of each test, Pa, > 0. temperature: °C. rate: m/s. normal: stress that pressed
        the halves together, Pa, >= 0. One number for all, or one for each test. What does not vary is not fitted: no
        softening, no effect of the rate, no friction. T₀ and v₀ are the tests' means.
        Raises InputError for too few tests, and for strengths that rise with temperature.
        """
        values = [np.asarray(array, dtype=float) for array in (strength, temperature, rate, normal)]
        try:
            bears, warm, fast, pressed = np.broadcast_arrays(*values)
        except ValueError as error:
            raise InputError(
                f"tests need one number each of strength, temperature, rate and normal, got shapes "
                f"{', '.join(str(array.shape) for array in values)}"
            ) from error
        if not all(np.isfinite(array).all() for array in values) or not (bears > 0).all() or not (fast > 0).all():
            raise InputError("tests need finite numbers, strengths and rates > 0; leave out the tests that lack one")
        varies = [float(np.ptp(array)) > 0 for array in (warm, fast, pressed)]
        if bears.size < max(_FEWEST, 1 + sum(varies)):
            raise InputError(f"a law of a bond needs {max(_FEWEST, 1 + sum(varies))} tests or more, got {bears.size}")
        middle, usual = float(warm.mean()), float(np.exp(np.log(fast).mean()))

        def law(free: Array) -> Array:
            a, m, tangent = (part if vary else 0.0 for part, vary in zip(free[1:], varies, strict=True))
            strength: Array = np.exp(free[0] - a * (warm - middle)) * (fast / usual) ** m + pressed * tangent
            return strength

        start = np.array([math.log(float(bears.mean())), 0.05, 0.1, 0.5])
        low, high = [-np.inf, -1.0, -0.5, 0.0], [np.inf, 1.0, 0.999, 5.0]
        solved = scipy.optimize.least_squares(
            lambda free: law(free) / bears - 1, start, bounds=(low, high), x_scale=[1, 0.01, 0.1, 0.5]
        )
        log, a, m, tangent = (
            float(value) if vary else 0.0 for value, vary in zip(solved.x, [True, *varies], strict=True)
        )
        if a < 0 or m < 0:
            raise InputError(
                f"these tests bear more where it is {'warmer' if a < 0 else 'slower'}, by "
                f"{abs(a if a < 0 else m):.3g}; look for a column that was exchanged, or for one test that stands out"
            )
        free = bears.size - 1 - sum(varies)
        scatter = math.sqrt(2 * solved.cost / free) if free else 0.0
        return cls(
            math.exp(log),
            a,
            m,
            middle,
            usual,
            math.atan(tangent),
            slip=slip,
            temperatures=(float(warm.min()), float(warm.max())),
            rates=(float(fast.min()), float(fast.max())),
            scatter=scatter,
        )

    @property
    def _law(self) -> InterfaceStrength:
        return InterfaceStrength(self.cohesion, self.friction_angle, self.tensile_strength)

    @property
    def tension_limit(self) -> float:
        """Tension at which the bond fails without shear, Pa; infinite where the law has no limit in tension."""
        return self._law.tension_limit

    def at(self, temperature: float) -> Self:
        """The strength at a temperature, °C, and the same rate."""
        if not math.isfinite(temperature):
            raise InputError(f"the temperature of a bond must be finite, got {temperature} °C")
        low, high = self.temperatures
        beyond = ""
        if temperature < low:
            beyond = f"its strength below {low:g} °C, the coldest test, is held at that of {low:g} °C"
        elif temperature > high:
            beyond = f"its strength above {high:g} °C, the warmest test, is extrapolated"
        share = math.exp(-self.softening * (max(temperature, low) - self.temperature))
        return self._scaled(share, beyond, temperature=max(temperature, low))

    def at_rate(self, rate: float) -> Self:
        """The strength at a rate, m/s, > 0, and the same temperature."""
        positive("the rate at which a bond is sheared", rate, "m/s", "50 mm/min is 0.83e-3")
        low, high = self.rates
        beyond = ""
        if self.rate_exponent and rate > high:
            beyond = f"wheels shear it faster than {high * 60e3:.3g} mm/min, the fastest test, whose strength is kept"
        elif self.rate_exponent and rate < low:
            beyond = f"its strength below {low * 60e3:.3g} mm/min, the slowest test, is extrapolated"
        return self._scaled((min(rate, high) / self.rate) ** self.rate_exponent, beyond, rate=min(rate, high))

    def passing(self, speed: float | None, depth: float, length: float) -> Self:
        """The strength as a wheel rolls by, see `passage_rate`."""
        if not self.rate_exponent:
            return self
        if speed is None:
            return self._with_caveat(
                f"its class has no speed, so that its strength is that of {self.rate * 60e3:.3g} mm/min, of the test"
            )
        return self.at_rate(passage_rate(speed, depth, length, self.slip))

    def utilisation(self, shear: float | Array, normal: float | Array) -> Array:
        """As `InterfaceStrength.utilisation`, at its temperature and rate."""
        return self._law.utilisation(shear, normal)

    def _scaled(self, share: float, beyond: str, **changed: float) -> Self:
        tensile = None if self.tensile_strength is None else share * self.tensile_strength
        # The law goes through its own point: another one of it is the same law.
        moved = replace(self, cohesion=share * self.cohesion, tensile_strength=tensile, **changed)  # type: ignore[arg-type]
        return moved._with_caveat(beyond)

    def _with_caveat(self, text: str) -> Self:
        return replace(self, caveat="; ".join(filter(None, (self.caveat, text)))) if text not in self.caveat else self

    def __str__(self) -> str:
        rate = f" and {self.rate * 60e3:.3g} mm/min" if self.rate_exponent else ""
        angle = f", φ = {math.degrees(self.friction_angle):.3g}°" if self.friction_angle else ""
        return f"bond with c = {self.cohesion / 1e6:.3g} MPa at {self.temperature:.3g} °C{rate}{angle}"


def passage_rate(speed: float, depth: float, length: float, slip: float = _SLIP) -> float:
    """Rate of a shear test, m/s, that loads a bond in the time in which a wheel that rolls by does.

    speed: of the wheel, m/s, > 0. depth: of the bond, m, >= 0. length: of the footprint, m, > 0. slip: at which the
    test fails, m. Shear rises over half the footprint, spread by its depth at 45°: in (length / 2 + depth) / speed.
    The rule is the one by which depth lengthens the pulse of a modulus; no test of bonds behind it was found.

    >>> f"{tl.damage.passage_rate(20.0, depth=0.06, length=0.2):.2f} m/s"  # 300 times that of a Leutner test
    '0.25 m/s'
    """
    positive("the speed of a wheel", speed, "m/s", "60 km/h is 16.7")
    positive("the length of a footprint", length, "metres", "200 mm is 0.2")
    if not depth >= 0:
        raise InputError(f"the depth of a bond must be >= 0 m, got {depth}; depth counts downwards")
    return slip * speed / (0.5 * length + depth)


@QUANTITIES.register("utilisation")
def utilisation_of(
    cohesion: Pressure,
    friction_angle: Angle = 0.0,
    tensile_strength: Pressure | None = None,
    softening: PerDegree | None = None,
    rate_exponent: Number | None = None,
    temperature: Celsius = _TEST_TEMPERATURE,
    rate: Speed = LEUTNER_RATE,
    slip: Length = _SLIP,
    temperatures: tuple[Celsius, Celsius] | None = None,
    rates: tuple[Speed, Speed] | None = None,
) -> BondUtilisation:
    """Utilisation by a load of a bond with Coulomb's strength, see `InterfaceStrength` and `TimedStrength`.

    cohesion: c; with softening or rate_exponent, that of the test. friction_angle: φ. tensile_strength: left out,
    where Coulomb's line ends. softening: loss of c with the temperature of the layer above. rate_exponent: power of
    the rate of shear. temperature: of the test. rate: of the test. slip: at which a test fails. temperatures: least
    and most that were tested. rates: least and most that were tested. Raises InputError.
    """
    if softening is None and rate_exponent is None:
        return BondUtilisation(InterfaceStrength(cohesion, friction_angle, tensile_strength))
    return BondUtilisation(
        TimedStrength(
            cohesion,
            softening or 0.0,
            rate_exponent or 0.0,
            temperature,
            rate,
            friction_angle,
            tensile_strength,
            slip,
            _ANY if temperatures is None else temperatures,
            _ANY_RATE if rates is None else rates,
        )
    )
