"""The French rational method: allowable strain and stress with their probability of failure.

NF P98-086. The standard itself was not at hand: formulas and tables are those that a public program codes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Literal, get_args

import scipy

from treadload.damage.laws.conditions import CATALOGUE, LoadingConditions
from treadload.damage.laws.fatigue import PowerLaw, check_slope, check_strain
from treadload.damage.quantities import BOTTOM_EXTENSION, SUBGRADE_COMPRESSION, TENSION
from treadload.errors import InputError, positive
from treadload.materials import HydraulicMix, Mix, Unbound

_SOURCE = (
    "NF P98-086 (2019), as coded in the public program UI_ChausseeNeuve (romeoolouro, commit f00e26e), "
    "a secondary source"
)
_FAILS = "the layer has failed structurally with the probability given by the law's risk"
_BY_ROADS = "by French roads through k_c, for readings under uniform discs of 0.662 MPa at an equivalent temperature"
# Strain lost per length of missing thickness, decades of strain per m: 0.02 per cm.
_PER_THICKNESS = 2.0
# Sh of treated layers, m.
_TREATED_SCATTER = 0.03
# Platform modulus, Pa, below which k_s holds.
_PLATFORM = ((50e6, 1 / 1.2), (80e6, 1 / 1.1), (120e6, 1 / 1.065))
TrafficClass = Literal["T5", "T4", "T3", "T2", "T1", "T0", "TS", "TEX"]
_CLASSES = get_args(TrafficClass)
RISK: Mapping[str, Mapping[str, float]] = {
    "bituminous": dict(zip(_CLASSES, (0.30, 0.30, 0.25, 0.12, 0.05, 0.02, 0.01, 0.01), strict=True)),
    "hydraulic": dict(zip(_CLASSES, (0.25, 0.25, 0.12, 0.075, 0.05, 0.025, 0.01, 0.01), strict=True)),
}
"""Probability of failure over the design life by kind of base and class of traffic."""


@dataclass(frozen=True)
class FrenchBituminous(PowerLaw):
    """Allowable extension of bituminous layers, ε_adm = ε₆ k_θ (NE/10⁶)^b k_r k_c k_s.

    epsilon_6: strain of a million cycles at 10 °C and 25 Hz, plain strain. slope: b, near -0.2.
    scatter: SN, of the logarithm of the fatigue life. thickness: of all bituminous layers, m, the wearing course
    and every lift included, see `bituminous_thickness`; it gives the scatter Sh of the thickness. risk: probability
    of failure over the design life, in (0, 1); `RISK` has what the method accepts.
    calibration: k_c, 1.3 for base course asphalt GB, 1.1 for BBSG, 1.0 for EME.
    modulus_ratio: E(10 °C) / E(θ_eq), both at 10 Hz; k_θ is its root. platform_modulus: of what lies below, Pa;
    left out, k_s = 1. thickness_scatter: Sh, m, in place of the rule for it.
    The passes are those of the axle that the strain belongs to, by convention 130 kN on twin wheels.
    Source: NF P98-086 (2019) by a secondary source.

    >>> law = tl.damage.FrenchBituminous.of(tl.catalogue.mixes["GB3"], thickness=0.2, risk=0.05)
    >>> f"{law.allowable_strain(5e6) * 1e6:.0f} microstrain for 5 million axles of 130 kN"
    '72 microstrain for 5 million axles of 130 kN'
    """

    epsilon_6: float
    slope: float
    scatter: float
    thickness: float
    risk: float
    calibration: float
    modulus_ratio: float = 1.0
    platform_modulus: float | None = None
    thickness_scatter: float | None = None

    reads = BOTTOM_EXTENSION
    source: ClassVar[str] = _SOURCE
    end_of_life: ClassVar[str] = _FAILS
    calibrated: ClassVar[str] = _BY_ROADS
    conditions: ClassVar[LoadingConditions] = replace(
        CATALOGUE,
        frequency="25 Hz for ε₆, 10 Hz for the moduli that take it to other temperatures",
        temperature="10 °C for ε₆",
    )
    includes_wander: ClassVar[bool] = True
    includes_weather: ClassVar[bool] = True

    def __post_init__(self) -> None:
        check_strain(self.epsilon_6)
        check_slope(self.slope)
        positive("scatter", self.scatter, remedy="SN is 0.25 to 0.3 for bituminous mixes")
        positive("thickness", self.thickness, "metres", "20 cm is 0.2")
        positive("calibration", self.calibration, remedy="k_c is 1 to 1.3")
        positive("modulus_ratio", self.modulus_ratio, remedy="E(10 °C)/E(15 °C) is near 1.3")
        _check_rest(self.risk, self.platform_modulus, self.thickness_scatter)

    @classmethod
    def of(
        cls,
        mix: Mix,
        *,
        thickness: float,
        risk: float,
        temperature: float = 15.0,
        platform_modulus: float | None = None,
        thickness_scatter: float | None = None,
    ) -> FrenchBituminous:
        """The law of a mix of the catalogue at its equivalent temperature, °C; the rest as above.

        Raises InputError for a mix without a fatigue line and a temperature outside its table.
        """
        if mix.epsilon_6 is None or mix.slope is None or mix.scatter is None or mix.calibration is None:
            raise InputError(f"mix {mix.name!r} has no fatigue line; give epsilon_6, slope, scatter and calibration")
        ratio = mix.modulus_ratio(temperature)
        numbers = mix.epsilon_6, mix.slope, mix.scatter, thickness, risk, mix.calibration, ratio
        return cls(*numbers, platform_modulus, thickness_scatter)

    @property
    def spread(self) -> float:
        """Sh: standard deviation of the thickness, m."""
        return thickness_scatter(self.thickness) if self.thickness_scatter is None else self.thickness_scatter

    @property
    def risk_factor(self) -> float:
        """k_r."""
        return risk_factor(self.risk, self.slope, self.scatter, self.spread)

    @property
    def temperature_factor(self) -> float:
        """k_θ = √(E(10 °C) / E(θ_eq))."""
        return math.sqrt(self.modulus_ratio)

    @property
    def platform_factor(self) -> float:
        """k_s."""
        return platform_factor(self.platform_modulus)

    @property
    def at_a_million(self) -> float:
        """ε₆ k_θ k_r k_c k_s."""
        factors = self.temperature_factor * self.risk_factor * self.calibration * self.platform_factor
        return self.epsilon_6 * factors

    @property
    def exponent(self) -> float:
        """Slope b."""
        return self.slope

    def __str__(self) -> str:
        return (
            f"French method, bituminous, ε₆ = {self.epsilon_6 * 1e6:g} microstrain, slope {self.slope:.4g}, "
            f"risk {self.risk * 100:g} %"
        )


@dataclass(frozen=True)
class FrenchHydraulic(PowerLaw):
    """Allowable tension of layers treated with a hydraulic binder, σ_adm = σ₆ (NE/10⁶)^b k_r k_d k_c k_s.

    sigma_6: stress of a million cycles, Pa. slope: b, near -1/15. scatter: SN, 1 as a rule. risk: probability of
    failure over the design life, in (0, 1). calibration: k_c. joints: k_d, below 1 where the layer is cracked or
    jointed. platform_modulus: of what lies below, Pa; left out, k_s = 1. thickness_scatter: Sh, m.
    What it reads is a stress: `allowable_strain` returns Pa.
    Source: NF P98-086 (2019) by a secondary source.

    >>> law = tl.damage.FrenchHydraulic(0.75e6, -1 / 15, scatter=1.0, risk=0.05, calibration=1.4)
    >>> f"{law.allowable_strain(5e6) / 1e6:.2f} MPa of tension for 5 million axles of 130 kN"
    '0.67 MPa of tension for 5 million axles of 130 kN'
    """

    sigma_6: float
    slope: float
    scatter: float
    risk: float
    calibration: float
    joints: float = 1.0
    platform_modulus: float | None = None
    thickness_scatter: float = _TREATED_SCATTER

    reads = TENSION
    source: ClassVar[str] = _SOURCE
    end_of_life: ClassVar[str] = _FAILS
    calibrated: ClassVar[str] = _BY_ROADS
    includes_wander: ClassVar[bool] = True
    includes_weather: ClassVar[bool] = True

    @classmethod
    def of(
        cls,
        mix: HydraulicMix,
        *,
        risk: float,
        platform_modulus: float | None = None,
        joints: float | None = None,
        thickness_scatter: float | None = None,
    ) -> FrenchHydraulic:
        """The law of a treated material of the catalogue; joints and thickness_scatter in place of its own.

        Raises InputError where neither the material nor the caller gives the joints or the scatter.
        """
        k_d = mix.joints if joints is None else joints
        spread = mix.thickness_scatter if thickness_scatter is None else thickness_scatter
        if k_d is None or spread is None:
            missing = "joints" if k_d is None else "thickness_scatter"
            raise InputError(f"{missing} of {mix.name!r} depends on the structure; give {missing}=")
        return cls(mix.sigma_6, mix.slope, mix.scatter, risk, mix.calibration, k_d, platform_modulus, spread)

    def __post_init__(self) -> None:
        positive("sigma_6", self.sigma_6, "Pa", "0.75 MPa is 0.75e6")
        check_slope(self.slope)
        positive("scatter", self.scatter, remedy="SN is 1 for treated layers")
        positive("calibration", self.calibration, remedy="k_c is 1.3 to 1.5")
        positive("joints", self.joints, remedy="k_d is 0.8 or 1")
        _check_rest(self.risk, self.platform_modulus, self.thickness_scatter)

    @property
    def risk_factor(self) -> float:
        """k_r."""
        return risk_factor(self.risk, self.slope, self.scatter, self.thickness_scatter)

    @property
    def at_a_million(self) -> float:
        """σ₆ k_r k_d k_c k_s, Pa."""
        factors = self.risk_factor * self.joints * self.calibration * platform_factor(self.platform_modulus)
        return self.sigma_6 * factors

    @property
    def exponent(self) -> float:
        """Slope b."""
        return self.slope

    def __str__(self) -> str:
        return (
            f"French method, hydraulic, σ₆ = {self.sigma_6 / 1e6:g} MPa, slope {self.slope:.4g}, "
            f"risk {self.risk * 100:g} %"
        )


@dataclass(frozen=True)
class FrenchSubgrade(PowerLaw):
    """Allowable compression of soil and unbound layers, ε_z = A NE^b; compression counts positive.

    constant: A, plain strain of one pass: 0.012 for medium and heavy traffic, 0.016 for light traffic, 0.0144 for
    the unbound layer of an inverted structure. slope: b.
    Source: NF P98-086 (2019) by a secondary source.

    >>> f"{tl.damage.FrenchSubgrade().allowable_passes(500e-6):.2g}"
    '1.6e+06'
    """

    constant: float = 0.012
    slope: float = -0.222

    reads = SUBGRADE_COMPRESSION
    source: ClassVar[str] = _SOURCE
    end_of_life: ClassVar[str] = "the rut that the method accepts; the source gives no depth"
    calibrated: ClassVar[str] = "by French roads, for the strain under uniform discs"
    includes_wander: ClassVar[bool] = True
    includes_weather: ClassVar[bool] = True

    def __post_init__(self) -> None:
        positive("constant", self.constant, remedy="12000 microstrain is 0.012")
        if self.constant > 1:
            raise InputError(f"constant must be a plain strain, got {self.constant}; 12000 microstrain is 0.012")
        check_slope(self.slope)

    @classmethod
    def of(cls, soil: Unbound, traffic: Literal["heavy", "light", "inverted"] = "heavy") -> FrenchSubgrade:
        """The law of an unbound material or platform of the catalogue.

        traffic: "light" or "heavy", which is medium too; "inverted" for the unbound layer of an inverted structure.
        Raises InputError.
        """
        constants = {"heavy": soil.constant, "light": soil.constant_light, "inverted": soil.constant_inverted}
        constant = constants.get(traffic)
        if constant is None:
            classes_listed = ", ".join(name for name, value in constants.items() if value is not None)
            raise InputError(f"{soil.name!r} has a law for the traffic {classes_listed}, got {traffic!r}")
        return cls(constant, soil.slope)

    @property
    def at_a_million(self) -> float:
        """A (10⁶)^b."""
        return float(self.constant * 1e6**self.exponent)

    @property
    def exponent(self) -> float:
        """Slope b."""
        return self.slope

    def __str__(self) -> str:
        return f"French method, subgrade, {self.constant * 1e6:g} microstrain x N^{self.exponent:g}"


def risk_factor(risk: float, slope: float, scatter: float, thickness_scatter: float) -> float:
    """k_r = 10^(-|b| u δ) with δ = √(SN² + (c Sh/|b|)²), c = 0.02 per cm and u the quantile that risk exceeds.

    risk: in (0, 1). slope: b. scatter: SN. thickness_scatter: Sh, m. Above 1 for a risk of more than a half.
    """
    spread = math.hypot(scatter, _PER_THICKNESS * thickness_scatter / abs(slope))
    return float(10 ** (abs(slope) * float(scipy.special.ndtri(risk)) * spread))


def thickness_scatter(thickness: float) -> float:
    """Sh of bituminous layers, m: 10 mm up to 0.10 m, 25 mm from 0.15 m, linear between.

    thickness: of all bituminous layers together, m. The source draws Sh over the "structural thickness of bituminous
    material" and asks for the "total thickness"; a second program's run, 6 cm of BBSG on 10 cm of GB3, has the Sh of
    16 cm. Source: NF P98-086 by the public program UI_ChausseeNeuve, window on the scatter of the thickness.
    """
    return min(max(0.01 + 0.3 * (thickness - 0.10), 0.01), 0.025)


def platform_factor(modulus: float | None) -> float:
    """k_s: reduction for a soft layer of this modulus, Pa, below the layer that fatigues; 1 for None."""
    if modulus is None:
        return 1.0
    return next((factor for bound, factor in _PLATFORM if modulus < bound), 1.0)


def _check_rest(risk: float, platform_modulus: float | None, spread: float | None) -> None:
    if not 0 < risk < 1:
        raise InputError(f"risk must lie in (0, 1), got {risk}; 5 % is 0.05")
    if platform_modulus is not None:
        positive("platform_modulus", platform_modulus, "Pa", "a platform PF3 has 120e6")
    if spread is not None and not (math.isfinite(spread) and 0 <= spread < 0.5):
        raise InputError(f"thickness_scatter must lie in [0, 0.5) m, got {spread}; 25 mm is 0.025")
