"""Laws of the United States and of Shell: regressions in psi and inches, converted at their edge.

NCHRP 1-37A with its sums of cracking, the Asphalt Institute, Shell.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from treadload.citations import COMMONLY_QUOTED
from treadload.damage.laws.conditions import BY_MODULUS, LoadingConditions
from treadload.damage.laws.fatigue import PowerLaw
from treadload.damage.quantities import BOTTOM_EXTENSION, SUBGRADE_COMPRESSION, SURFACE_EXTENSION
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.registry import CRITERIA
from treadload.units import PSI, Length, Modulus, Number, Share

_INCH = 0.0254
_MILE, _FOOT = 1609.344, 0.3048
_MEPDG = (
    "NCHRP 1-37A (2004), part 3 chapter 3 and appendix II eq. 27, as coded in the public program ProductOneME "
    "(MartinScavone, commit c89fe2b), a secondary source"
)
_LTPP = "by LTPP sections and other test sections of the United States (Singh 2024, Michigan State University)"
_LEAPS = "the program LEAPS (University of Illinois, course CEE 406, commit 48f210d)"


@dataclass(frozen=True)
class _Regression(PowerLaw):
    """N = k ε^(1/b) E^-m with E in psi."""

    modulus: Modulus

    conditions: ClassVar[LoadingConditions] = BY_MODULUS

    def __post_init__(self) -> None:
        positive("modulus", self.modulus, "Pa", "asphalt is near 5.4e9")
        if self.modulus < 1e6:
            raise InputError(f"modulus must be in Pa, got {self.modulus}; 5400 MPa is 5.4e9")

    def _at_a_million(self, constant: float, power: float) -> float:
        """Strain of a million passes from k = constant and m = power."""
        return float((1e6 / (constant * (self.modulus / PSI) ** -power)) ** self.exponent)


@dataclass(frozen=True)
class _Mepdg(_Regression):
    thickness: Length
    air_voids: Share
    binder_volume: Share
    calibration: Number = 1.0

    source: ClassVar[str] = _MEPDG

    def __post_init__(self) -> None:
        super().__post_init__()
        positive("thickness", self.thickness, "metres", "6 inches are 0.1524")
        positive("calibration", self.calibration, remedy="1 is the law as published")
        check_volumes(self.air_voids, self.binder_volume)

    @property
    @abstractmethod
    def thickness_factor(self) -> float:
        """k₁."""

    @property
    def at_a_million(self) -> float:
        """Strain that allows a million passes."""
        constant = 0.00432 * mix_factor(self.air_voids, self.binder_volume) * self.thickness_factor
        return self._at_a_million(constant * self.calibration, 1.281)

    @property
    def exponent(self) -> float:
        """-1 / 3.9492."""
        return -1 / 3.9492


@CRITERIA.register("mepdg-bottom-up")
@dataclass(frozen=True)
class MepdgBottomUp(_Mepdg):
    """Passes to bottom-up cracking, N = 0.00432 C k₁ ε^-3.9492 E^-1.281 (E in psi).

    modulus: dynamic modulus of the asphalt, Pa. thickness: h of all asphalt layers together, m, see
    `bituminous_thickness`. air_voids, binder_volume: Va and Vb, shares of the mix's volume in (0, 1): 7 % is 0.07;
    Vb is the effective binder, without what the stones absorb. calibration: local factor on the passes.
    C = 10^(4.84 (Vb/(Va+Vb) - 0.69)); k₁ = 1/(0.000398 + 0.003602/(1 + exp(11.02 - 3.49 h))), h in inches.
    Source: NCHRP 1-37A (2004) as coded in ProductOneME.

    >>> law = tl.damage.MepdgBottomUp(5e9, 0.15, air_voids=0.06, binder_volume=0.11)
    >>> f"{law.allowable_passes(100e-6):.2g}"
    '1.3e+08'
    """

    reads = BOTTOM_EXTENSION
    end_of_life: ClassVar[str] = "half of the lane's area is cracked, see `bottom_up_cracking`"
    calibrated: ClassVar[str] = f"{_LTPP}; locally by `calibration`"
    includes_weather: ClassVar[bool] = True

    @property
    def thickness_factor(self) -> float:
        """k₁."""
        return float(1 / (0.000398 + 0.003602 * _sigmoid(3.49 * self.thickness / _INCH - 11.02)))

    def __str__(self) -> str:
        return f"MEPDG bottom-up, E = {self.modulus / 1e6:g} MPa, {self.thickness * 1e3:g} mm of asphalt"


@CRITERIA.register("mepdg-top-down")
@dataclass(frozen=True)
class MepdgTopDown(_Mepdg):
    """Passes to top-down cracking, N = 0.00432 C k₁ ε^-3.9492 E^-1.281 (E in psi), ε at the surface.

    modulus: of the asphalt, Pa. thickness: of all asphalt layers together, m. air_voids, binder_volume: shares of the
    mix's volume. calibration: local factor on the passes. C as in `MepdgBottomUp`; k₁ = 1/(0.01 + 12/(1 + exp(15.676
    - 2.8186 h))), h in inches. Source: NCHRP 1-37A (2004), appendix II eq. 27, as coded in ProductOneME: part 3 of
    the guide misprints k₁.

    >>> law = tl.damage.MepdgTopDown(3e9, thickness=0.15, air_voids=0.07, binder_volume=0.11)
    >>> f"{law.allowable_passes(100e-6):.2g} load repetitions at 100 microstrain"
    '7.7e+04 load repetitions at 100 microstrain'
    """

    reads = SURFACE_EXTENSION
    end_of_life: ClassVar[str] = "a metre of crack along each metre of lane, see `top_down_cracking`"
    calibrated: ClassVar[str] = f"{_LTPP}, for strain at points under uniform discs"
    includes_weather: ClassVar[bool] = True

    @property
    def thickness_factor(self) -> float:
        """k₁."""
        return float(1 / (0.01 + 12.0 * _sigmoid(2.8186 * self.thickness / _INCH - 15.676)))

    def __str__(self) -> str:
        return f"MEPDG top-down, E = {self.modulus / 1e6:g} MPa, {self.thickness * 1e3:g} mm of asphalt"


@CRITERIA.register("asphalt-institute")
@dataclass(frozen=True)
class AsphaltInstitute(_Regression):
    """Passes to fatigue of a fifth of the lane, N = 0.0796 C ε^-3.291 E^-0.854 (E in psi).

    modulus: of the asphalt, Pa. air_voids, binder_volume: Va and Vb (the effective binder), shares of the mix's
    volume in (0, 1), both or none: C = 10^(4.84 (Vb/(Va+Vb) - 0.69)), 1 if left out.
    Not verified: the exponents and C are in U.S. Army CRREL Special Report 96-21 (1996), page 12; the constant 0.0796
    is as the program LEAPS (University of Illinois, course CEE 406, commit 48f210d) implements it, which prints
    1.03e6 passes for 237.7 microstrain at 3000 MPa. The manual itself, Asphalt Institute MS-1 (1982), was not read.

    >>> f"{tl.damage.AsphaltInstitute(5e9).allowable_passes(100e-6):.2g}"
    '1.1e+07'
    """

    air_voids: Share | None = None
    binder_volume: Share | None = None

    reads = BOTTOM_EXTENSION
    source: ClassVar[str] = "Asphalt Institute (1982), Manual Series MS-1; exponents in CRREL Special Report 96-21"
    end_of_life: ClassVar[str] = "a fifth of the lane is cracked by fatigue"
    calibrated: ClassVar[str] = f"by sections of the AASHO road test, {COMMONLY_QUOTED}"
    includes_weather: ClassVar[bool] = True

    def __post_init__(self) -> None:
        super().__post_init__()
        if (self.air_voids is None) != (self.binder_volume is None):
            raise InputError(
                f"give both air_voids and binder_volume or none, got {self.air_voids} and {self.binder_volume}"
            )
        if self.air_voids is not None and self.binder_volume is not None:
            check_volumes(self.air_voids, self.binder_volume)

    @property
    def caveat(self) -> str:
        """The constant."""
        return f"the constant 0.0796 is as {_LEAPS} implements it; the original was not read"

    @property
    def at_a_million(self) -> float:
        """Strain that allows a million passes."""
        if self.air_voids is None or self.binder_volume is None:
            return self._at_a_million(0.0796, 0.854)
        return self._at_a_million(0.0796 * mix_factor(self.air_voids, self.binder_volume), 0.854)

    @property
    def exponent(self) -> float:
        """-1 / 3.291."""
        return -1 / 3.291

    def __str__(self) -> str:
        return f"Asphalt Institute, fatigue, E = {self.modulus / 1e6:g} MPa"


@CRITERIA.register("asphalt-institute-subgrade")
@dataclass(frozen=True)
class AsphaltInstituteSubgrade(PowerLaw):
    """Passes to a rut of 12.7 mm, N = 1.365e-9 ε_z^-4.477; compression counts positive.

    Not verified: as the program LEAPS (University of Illinois, course CEE 406, commit 48f210d) implements it, which
    prints 4.36e6 passes for 344.2 microstrain; the manual, Asphalt Institute MS-1 (1982), was not read. U.S. Army
    CRREL Special Report 96-21 (1996), page 12, has two other constants under the name of the same manual, 0.25 and
    2.8e-2: as N = (0.028/ε_z)^4 they allow 9 times as many passes at 300 microstrain.

    >>> f"{tl.damage.AsphaltInstituteSubgrade().allowable_passes(300e-6):.2g}"
    '8.1e+06'
    """

    reads = SUBGRADE_COMPRESSION
    source: ClassVar[str] = "Asphalt Institute (1982), Manual Series MS-1"
    end_of_life: ClassVar[str] = "a rut of 12.7 mm"
    calibrated: ClassVar[str] = f"by the AASHO road test and roads of California, {COMMONLY_QUOTED}"
    includes_weather: ClassVar[bool] = True

    @property
    def caveat(self) -> str:
        """All of it."""
        return (
            f"its numbers are as {_LEAPS} implements them, the original was not read, and CRREL Special Report 96-21 "
            "has other constants under the name of the same manual"
        )

    @property
    def at_a_million(self) -> float:
        """Strain that allows a million passes."""
        return float((1e6 / 1.365e-9) ** self.exponent)

    @property
    def exponent(self) -> float:
        """-1 / 4.477."""
        return -1 / 4.477

    def __str__(self) -> str:
        return "Asphalt Institute, subgrade"


@CRITERIA.register("shell")
@dataclass(frozen=True)
class ShellFatigue(_Regression):
    """Passes to fatigue, N = 0.0685 ε^-5.671 E^-2.363 (E in psi).

    modulus: of the asphalt, Pa. Not verified: the numbers are as commonly quoted, not checked against the source.

    >>> f"{tl.damage.ShellFatigue(5e9).allowable_passes(100e-6):.2g}"
    '4.7e+07'
    """

    reads = BOTTOM_EXTENSION
    source: ClassVar[str] = "Shell Pavement Design Manual (1978), as commonly quoted"
    end_of_life: ClassVar[str] = "fatigue of the asphalt; how much of it cracks was found in no source"
    calibrated: ClassVar[str] = f"by beam tests of Shell, {COMMONLY_QUOTED}"

    @property
    def caveat(self) -> str:
        """All of it."""
        return f"its numbers are {COMMONLY_QUOTED}"

    @property
    def at_a_million(self) -> float:
        """Strain that allows a million passes."""
        return self._at_a_million(0.0685, 2.363)

    @property
    def exponent(self) -> float:
        """-1 / 5.671."""
        return -1 / 5.671

    def __str__(self) -> str:
        return f"Shell, fatigue, E = {self.modulus / 1e6:g} MPa"


def mix_factor(air_voids: float, binder_volume: float) -> float:
    """C = 10^(4.84 (Vb/(Va+Vb) - 0.69)) of the volumes of air and effective binder, shares of the mix."""
    return float(10 ** (4.84 * (binder_volume / (air_voids + binder_volume) - 0.69)))


def bottom_up_cracking(damage: float | Array, thickness: float) -> Array:
    """Share of the lane's area that is cracked from below, in [0, 1], after NCHRP 1-37A.

    FC = 1/(1 + exp(C₂ (log₁₀(100 D) - 2))), C₂ = -2.40874 - 39.748 (1 + h)^-2.856, h in inches.
    damage: D, Miner's sum, ≥ 0, any shape. thickness: of the asphalt, m. Raises InputError.
    Source: NCHRP 1-37A (2004); constants agree in two public programs.
    """
    positive("thickness", thickness, "metres", "6 inches are 0.1524")
    slope = -2.40874 - 39.748 * (1 + thickness / _INCH) ** -2.856
    return _sigmoid(-slope * _decades(damage))


def top_down_cracking(damage: float | Array) -> Array:
    """Length of longitudinal cracks from the surface per length of lane, m/m, at most 2, after NCHRP 1-37A.

    FC = 10560/(1 + exp(7 - 3.5 log₁₀(100 D))) feet per mile. damage: D, Miner's sum, ≥ 0, any shape.
    Raises InputError. Source: NCHRP 1-37A (2004) as coded in ProductOneME (commit c89fe2b, a part that it leaves
    out of its runs); the guide itself was not read.
    """
    return 10560 * _FOOT / _MILE * _sigmoid(3.5 * _decades(damage))


def _decades(damage: float | Array) -> Array:
    """log₁₀ D = log₁₀(100 D) - 2, -∞ where there is no damage."""
    shares = np.asarray(damage, dtype=float)
    if not (shares >= 0).all():
        raise InputError(f"damage must be ≥ 0, got {shares.min():g}; 1 is the end of life")
    with np.errstate(divide="ignore"):
        return np.asarray(np.log10(shares))


def _sigmoid(value: float | Array) -> Array:
    """1 / (1 + exp(-value)) without overflow."""
    return np.asarray(0.5 * (1 + np.tanh(0.5 * np.asarray(value))))


def check_volumes(air_voids: float, binder_volume: float) -> None:
    """Raise InputError unless the volumes of air and effective binder are shares of the mix in (0, 1)."""
    for name, value, usual in (
        ("air_voids", air_voids, "7 % is 0.07"),
        ("binder_volume, of the effective binder,", binder_volume, "11 % is 0.11"),
    ):
        if not (math.isfinite(value) and 0 < value < 1):
            raise InputError(f"{name} must be a share of the volume in (0, 1), got {value}; {usual}")
