"""Fatigue laws: how many passes a strain or a stress allows. What they share, and Wöhler's line."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import ClassVar, Protocol, overload

import numpy as np

from treadload.damage.laws.conditions import UNSTATED, LoadingConditions
from treadload.damage.quantities import EXTENSION
from treadload.damage.quantity import Quantity
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.registry import CRITERIA
from treadload.units import Number, Strain

_MILLION = 1e6
USERS = "by the user's numbers: whatever shift from the test to the road they hold"
# No road material bears a million passes at one per cent: such a number is microstrain without its unit.
_LARGEST = 0.01
# Passes that laboratories and test roads have seen, and to which designs extrapolate them: a rule of this
# package, not of a source.
_SEEN = (1e4, 1e8)


class FatigueLaw(Protocol):
    """What every fatigue law provides.

    A law reads one quantity of a loading, positive where it does harm: an extension, a compression on the
    subgrade, a tensile stress.

    >>> law: tl.damage.FatigueLaw = tl.FatigueLine(epsilon_6=120e-6, slope=-0.2)
    >>> f"{law.allowable_strain(1e7) * 1e6:.0f} microstrain for 10 million load repetitions"
    '76 microstrain for 10 million load repetitions'
    """

    @property
    def reads(self) -> Quantity:
        """The quantity for which its numbers hold."""

    @property
    def source(self) -> str:
        """Where its numbers come from."""

    @property
    def caveat(self) -> str:
        """Which of its numbers have no source that could be read, in words; empty if none."""

    @property
    def verified(self) -> bool:
        """True if all its numbers were read in its source."""

    @property
    def end_of_life(self) -> str:
        """What has happened when Miner's sum is 1, in words."""

    @property
    def includes_wander(self) -> bool:
        """True if its numbers were fitted to roads whose traffic wanders, so that wander must not count again."""

    @property
    def validity(self) -> tuple[float, float]:
        """Smallest and largest reading that it takes without a warning, in the unit of what it reads."""

    @overload
    def allowable_passes(self, strain: float) -> float: ...
    @overload
    def allowable_passes(self, strain: Array) -> Array: ...
    def allowable_passes(self, strain: float | Array) -> float | Array:
        """Passes that a reading allows."""

    @overload
    def allowable_strain(self, passes: float) -> float: ...
    @overload
    def allowable_strain(self, passes: Array) -> Array: ...
    def allowable_strain(self, passes: float | Array) -> float | Array:
        """Reading that allows this number of passes."""


class PowerLaw(ABC):
    """A law N = 10⁶ (ε / ε₁)^(1/b) with ε₁ the reading that allows a million passes and b < 0.

    >>> law: tl.damage.PowerLaw = tl.FatigueLine(epsilon_6=120e-6, slope=-0.2)
    >>> f"{law.allowable_passes(0.9 * 120e-6) / 1e6:.2f} million"  # a strain lower by a tenth
    '1.69 million'
    """

    reads: Quantity
    # What sentences call it, and its reading of a million passes.
    noun: ClassVar[str] = "fatigue law"
    symbol: ClassVar[str] = "what allows a million load repetitions"
    source: ClassVar[str]
    end_of_life: ClassVar[str]
    includes_wander: ClassVar[bool] = False
    # Fitted to roads, whose days and nights load them below the traffic too.
    includes_weather: ClassVar[bool] = False
    # What ties it to roads, for `treadload criteria`.
    calibrated: ClassVar[str] = USERS
    # The loading of the tests behind its numbers, as far as its source states it.
    conditions: ClassVar[LoadingConditions] = UNSTATED

    @property
    @abstractmethod
    def at_a_million(self) -> float:
        """ε₁: strain, or stress in Pa, that allows a million passes."""

    @property
    @abstractmethod
    def exponent(self) -> float:
        """Slope b of ε = ε₁ (N / 10⁶)^b, negative."""

    @property
    def caveat(self) -> str:
        """Which of its numbers have no source that could be read, in words; empty if none."""
        return ""

    @property
    def verified(self) -> bool:
        """True if all its numbers were read in its source."""
        return not self.caveat

    @property
    def validity(self) -> tuple[float, float]:
        """Readings that allow 10⁸ and 10⁴ passes: what tests have seen, not a source's bound."""
        fewest, many = _SEEN
        return self.allowable_strain(many), self.allowable_strain(fewest)

    @overload
    def allowable_passes(self, strain: float) -> float: ...
    @overload
    def allowable_passes(self, strain: Array) -> Array: ...
    def allowable_passes(self, strain: float | Array) -> float | Array:
        """Passes N = 10⁶ (ε / ε₁)^(1/b) that a strain (a stress, Pa) allows; inf where it is ≤ 0, NaN for NaN."""
        strains = np.asarray(strain, dtype=float)
        harmful = np.where(strains <= 0, 1.0, strains)
        with np.errstate(over="ignore"):
            passes = _MILLION * (harmful / self.at_a_million) ** (1 / self.exponent)
        passes = np.where(strains <= 0, np.inf, passes)
        return passes if strains.ndim else float(passes)

    @overload
    def allowable_strain(self, passes: float) -> float: ...
    @overload
    def allowable_strain(self, passes: Array) -> Array: ...
    def allowable_strain(self, passes: float | Array) -> float | Array:
        """Strain (or stress, Pa) ε₁ (N / 10⁶)^b that allows this number of passes, > 0; InputError otherwise."""
        repetitions = np.asarray(passes, dtype=float)
        if not (repetitions > 0).all():
            raise InputError(f"passes must be positive, got {repetitions.min():g}")
        strain = self.at_a_million * (repetitions / _MILLION) ** self.exponent
        return strain if repetitions.ndim else float(strain)


@CRITERIA.register("fatigue-line")
@dataclass(frozen=True)
class FatigueLine(PowerLaw):
    """Wöhler line ε = ε₆ (N / 10⁶)^b of a material under repeated extension.

    epsilon_6: strain that allows a million passes, plain strain (120 microstrain is 120e-6), > 0.
    slope: b, in (-1, 0); near -0.2 for bituminous mixes. reads: the strain that the line was measured for; left out,
    the extension.
    A line measured in a laboratory carries no shift to the road: temperature, frequency, healing and
    scatter are the user's to include in epsilon_6.

    >>> line = tl.FatigueLine(epsilon_6=120e-6, slope=-0.2)
    >>> f"{line.allowable_passes(60e-6):.3g}"
    '3.2e+07'
    """

    epsilon_6: Strain
    slope: Number
    reads: Quantity = EXTENSION
    tested_under: LoadingConditions | None = field(default=None, init=False, compare=False, repr=False)
    """The tests behind its numbers where they are those of a mix of the catalogue, see `under`."""

    noun: ClassVar[str] = "fatigue line"
    symbol: ClassVar[str] = "ε₆"
    source: ClassVar[str] = "Wöhler's line with the user's numbers"
    end_of_life: ClassVar[str] = "what the laboratory's test called failure, by convention half the stiffness lost"

    def __post_init__(self) -> None:
        check_strain(self.epsilon_6)
        check_slope(self.slope)
        if self.reads.shown != "microstrain":
            raise InputError(
                f"epsilon_6 is a strain, but the line reads the {self.reads}; take PowerLine, in a case the law "
                '"power-law", whose number has the unit of what it reads'
            )

    def under(self, conditions: LoadingConditions) -> FatigueLine:
        """The same line, with the tests behind its numbers."""
        line = FatigueLine(self.epsilon_6, self.slope, self.reads)
        object.__setattr__(line, "tested_under", conditions)
        return line

    @property
    def at_a_million(self) -> float:
        """ε₆."""
        return self.epsilon_6

    @property
    def exponent(self) -> float:
        """Slope b."""
        return self.slope

    def __str__(self) -> str:
        of = "" if self.reads == EXTENSION else f" of the {self.reads}"
        return f"fatigue line{of}, ε₆ = {self.epsilon_6 * 1e6:g} microstrain, slope {self.slope:g}"


@CRITERIA.register("power-law")
@dataclass(frozen=True)
class PowerLine(PowerLaw):
    """Passes N = 10⁶ (r / r₆)^(1/b) that a reading r of any quantity allows, by the user's numbers.

    reads: the quantity, in a case its word. reading_6: r₆, the reading that allows a million passes, > 0, in its SI
    unit; text carries its own, "0.4 MPa". slope: b, in (-1, 0). Raises InputError.

    >>> stress = tl.damage.OctahedralShear()
    >>> law = tl.damage.PowerLine(stress, 0.4e6, -0.1)
    >>> f"{law.allowable_passes(0.3e6):.3g}"
    '1.78e+07'
    """

    reads: Quantity
    reading_6: float | str
    slope: Number

    source: ClassVar[str] = "a power law with the user's numbers"
    end_of_life: ClassVar[str] = "what the test behind its numbers called failure"

    def __post_init__(self) -> None:
        object.__setattr__(self, "reading_6", self.reads.number(self.reading_6))
        positive(f"reading_6, of the {self.reads},", self.at_a_million, remedy="it allows a million load repetitions")
        check_slope(self.slope)

    @property
    def at_a_million(self) -> float:
        """r₆."""
        return float(self.reading_6)

    @property
    def exponent(self) -> float:
        """Slope b."""
        return self.slope

    def __str__(self) -> str:
        return f"power law of the {self.reads}, {self.reads.in_words(self.at_a_million)}, slope {self.slope:g}"


def check_strain(epsilon_6: float) -> None:
    """Raise InputError unless epsilon_6 is a plain strain that a road material can bear a million times."""
    positive("epsilon_6", epsilon_6, remedy="120 microstrain is 120e-6")
    if epsilon_6 > _LARGEST:
        raise InputError(
            f"epsilon_6 must be a plain strain below {_LARGEST}, got {epsilon_6}; write "
            f'{epsilon_6:g}e-6 or "{epsilon_6:g} microstrain" if that is what you mean'
        )


def check_slope(slope: float) -> None:
    """Raise InputError unless a fatigue line falls with this slope."""
    if not -1 < slope < 0:
        raise InputError(f"slope must lie in (-1, 0), got {slope}; -0.2 is usual for bituminous mixes")
