"""Laws of the Indian guideline IRC:37-2018: fatigue of asphalt, rutting of the subgrade, cement-treated bases."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, overload

import numpy as np

from treadload.citations import COMMONLY_QUOTED
from treadload.damage.laws.american import check_volumes, mix_factor
from treadload.damage.laws.conditions import BY_MODULUS, LoadingConditions
from treadload.damage.laws.fatigue import PowerLaw
from treadload.damage.quantities import BOTTOM_EXTENSION, SUBGRADE_COMPRESSION, TENSION
from treadload.damage.quantity import Quantity
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.registry import CRITERIA
from treadload.units import Modulus, Share

_IRC = (
    "IRC:37-2018, clauses 3.6.1 to 3.6.3, as a public transcription of its worked designs and the program IndoPave37 "
    "(commit 2624b72) have it, secondary sources"
)
_ROADS = (
    f"by sections of Indian roads, {COMMONLY_QUOTED}; for uniform discs of 0.56 MPa and axles of 80 kN (clause 3.6.1)"
)
# Constants by reliability: of the fatigue of asphalt, of the rutting of the subgrade.
_FATIGUE: Mapping[float, float] = MappingProxyType({0.8: 1.6064e-4, 0.9: 0.5161e-4})
_RUTTING: Mapping[float, float] = MappingProxyType({0.8: 4.1656e-8, 0.9: 1.41e-8})
_FATIGUE_POWER, _MODULUS_POWER, _RUTTING_POWER = 3.89, 0.854, 4.5337
# log10 N = (top - σ/strength) / slope.
_TOP, _SLOPE = 0.972, 0.0825


@CRITERIA.register("irc-fatigue")
@dataclass(frozen=True)
class IrcFatigue(PowerLaw):
    """Passes to fatigue, N = 0.5161e-4 C ε^-3.89 E^-0.854 at 90 % reliability, 1.6064e-4 at 80 % (E in MPa).

    modulus: of the asphalt, Pa. air_voids, binder_volume: Va and Vb (the effective binder), shares of the mix's
    volume in (0, 1): C = 10^(4.84 (Vb/(Va+Vb) - 0.69)). reliability: 0.9 or 0.8. ε: largest horizontal strain at the
    bottom of the asphalt. Raises InputError.
    Source: IRC:37-2018; its example III.1 prints 53 million passes for 175 microstrain at 3000 MPa.

    >>> law = tl.damage.IrcFatigue(3e9, air_voids=0.035, binder_volume=0.115)
    >>> f"{law.allowable_passes(150e-6):.2g}"
    '9.8e+07'
    """

    modulus: Modulus
    air_voids: Share
    binder_volume: Share
    reliability: Share = 0.9

    reads = BOTTOM_EXTENSION
    source: ClassVar[str] = _IRC
    end_of_life: ClassVar[str] = "a fifth of the paved area is cracked by fatigue"
    calibrated: ClassVar[str] = _ROADS
    conditions: ClassVar[LoadingConditions] = BY_MODULUS
    includes_wander: ClassVar[bool] = True
    includes_weather: ClassVar[bool] = True

    def __post_init__(self) -> None:
        positive("modulus", self.modulus, "Pa", "asphalt is near 3e9 at 35 °C")
        if self.modulus < 1e6:
            raise InputError(f"modulus must be in Pa, got {self.modulus}; 3000 MPa is 3e9")
        check_volumes(self.air_voids, self.binder_volume)
        _constant(_FATIGUE, self.reliability)

    @property
    def at_a_million(self) -> float:
        """Strain that allows a million passes."""
        factor = _constant(_FATIGUE, self.reliability) * mix_factor(self.air_voids, self.binder_volume)
        return float((1e6 / (factor * (self.modulus / 1e6) ** -_MODULUS_POWER)) ** self.exponent)

    @property
    def exponent(self) -> float:
        """-1 / 3.89."""
        return -1 / _FATIGUE_POWER

    def __str__(self) -> str:
        return f"IRC:37, fatigue, E = {self.modulus / 1e6:g} MPa, reliability {100 * self.reliability:g} %"


@CRITERIA.register("irc-rutting")
@dataclass(frozen=True)
class IrcRutting(PowerLaw):
    """Passes to rutting, N = 1.41e-8 ε_z^-4.5337 at 90 % reliability, 4.1656e-8 at 80 %; compression is positive.

    reliability: 0.9 or 0.8. ε_z: vertical strain on top of the subgrade. Raises InputError.
    Source: IRC:37-2018; its example III.1 prints 187 million passes for 278 microstrain.

    >>> f"{tl.damage.IrcRutting().allowable_passes(300e-6):.2g}"
    '1.3e+08'
    """

    reliability: Share = 0.9

    reads = SUBGRADE_COMPRESSION
    source: ClassVar[str] = _IRC
    end_of_life: ClassVar[str] = "a rut of 20 mm"
    calibrated: ClassVar[str] = _ROADS
    includes_wander: ClassVar[bool] = True
    includes_weather: ClassVar[bool] = True

    def __post_init__(self) -> None:
        _constant(_RUTTING, self.reliability)

    @property
    def at_a_million(self) -> float:
        """Strain that allows a million passes."""
        return float((1e6 / _constant(_RUTTING, self.reliability)) ** self.exponent)

    @property
    def exponent(self) -> float:
        """-1 / 4.5337."""
        return -1 / _RUTTING_POWER

    def __str__(self) -> str:
        return f"IRC:37, rutting of the subgrade, reliability {100 * self.reliability:g} %"


@CRITERIA.register("irc-cement-treated")
@dataclass(frozen=True)
class IrcCementTreated:
    """Passes to cracking of a cement-treated base, log10 N = (0.972 - σ/M)/0.0825.

    strength: M, the flexural strength after 28 days, Pa. σ: largest horizontal tension, Pa, at the bottom of the
    base: `allowable_strain` returns Pa. Even a tension of next to nothing allows no more than 6e11 passes.
    Raises InputError. Source: IRC:37-2018, the relation of NCHRP 1-37A for cement-stabilised layers.

    >>> f"{tl.damage.IrcCementTreated(1.4e6).allowable_passes(0.7e6):.2g}"
    '5.3e+05'
    """

    strength: Modulus

    reads: ClassVar[Quantity] = TENSION
    noun: ClassVar[str] = "fatigue law"
    source: ClassVar[str] = _IRC
    end_of_life: ClassVar[str] = "the cement-treated base has cracked"
    calibrated: ClassVar[str] = "by beam tests; the guideline sums the passes of single, tandem and tridem axles"
    caveat: ClassVar[str] = "read in a secondary source, and no printed answer of it was at hand"
    verified: ClassVar[bool] = False
    includes_wander: ClassVar[bool] = False
    includes_weather: ClassVar[bool] = False

    def __post_init__(self) -> None:
        positive("strength", self.strength, "Pa", "1.4 MPa is 1.4e6")
        if self.strength < 1e3:
            raise InputError(f"strength must be in Pa, got {self.strength}; 1.4 MPa is 1.4e6")

    @property
    def validity(self) -> tuple[float, float]:
        """Tensions, Pa, that allow 10⁸ and 10⁴ passes: what tests have seen, not a source's bound."""
        return self.allowable_strain(1e8), self.allowable_strain(1e4)

    @overload
    def allowable_passes(self, strain: float) -> float: ...
    @overload
    def allowable_passes(self, strain: Array) -> Array: ...
    def allowable_passes(self, strain: float | Array) -> float | Array:
        """Passes that a tension, Pa, allows; inf where it is <= 0, NaN for NaN."""
        tension = np.asarray(strain, dtype=float)
        passes: Array = np.where(tension <= 0, np.inf, 10 ** ((_TOP - tension / self.strength) / _SLOPE))
        return passes if tension.ndim else float(passes)

    @overload
    def allowable_strain(self, passes: float) -> float: ...
    @overload
    def allowable_strain(self, passes: Array) -> Array: ...
    def allowable_strain(self, passes: float | Array) -> float | Array:
        """Tension, Pa, that allows this number of passes, > 0; InputError for passes that none allows."""
        repetitions = np.asarray(passes, dtype=float)
        most = 10 ** (_TOP / _SLOPE)
        if not ((repetitions > 0) & (repetitions < most)).all():
            raise InputError(
                f"passes must lie between 0 and {most:.2g}, which no tension allows by this law, got "
                f"{repetitions.min():g} to {repetitions.max():g}"
            )
        tension = self.strength * (_TOP - _SLOPE * np.log10(repetitions))
        return tension if repetitions.ndim else float(tension)

    def __str__(self) -> str:
        return f"IRC:37, cement-treated base, strength {self.strength / 1e6:g} MPa"


def granular_modulus(thickness: float, below: float) -> float:
    """Modulus, Pa, of a granular layer of a thickness, m, on a subgrade or platform of a modulus, Pa.

    0.2 h^0.45 times that below, h in mm. Raises InputError. Source: IRC:37-2018, equation 7.1.

    >>> f"{tl.damage.granular_modulus(0.45, 60e6) / 1e6:.0f} MPa"
    '188 MPa'
    """
    positive("thickness", thickness, "metres", "450 mm is 0.45")
    positive("the modulus below", below, "Pa", "a subgrade of CBR 10 has 77e6")
    return float(0.2 * (1e3 * thickness) ** 0.45 * below)


def subgrade_modulus(bearing_ratio: float) -> float:
    """Modulus, Pa, of a subgrade of a California bearing ratio, %: 10 CBR MPa up to 5, 17.6 CBR^0.64 MPa above.

    For design the guideline limits it to 100 MPa (clause 6.4.2), which is left to the user. Raises InputError.
    Source: IRC:37-2018, equations 6.1 and 6.2, as IndoPave37 (commit 2624b72) implements them.

    >>> f"{tl.damage.subgrade_modulus(5.0) / 1e6:.0f} MPa"
    '50 MPa'
    """
    positive("the bearing ratio", bearing_ratio, "%", "soils have 2 to 15")
    if not (math.isfinite(bearing_ratio) and bearing_ratio <= 100):
        raise InputError(f"the bearing ratio must be at most 100 %, got {bearing_ratio}")
    return float(1e6 * (10 * bearing_ratio if bearing_ratio <= 5 else 17.6 * bearing_ratio**0.64))


def _constant(constants: Mapping[float, float], reliability: float) -> float:
    if reliability not in constants:
        raise InputError(f"reliability must be 0.8 or 0.9, got {reliability}; the guideline has these two")
    return constants[reliability]
