"""Fatigue of an aged surface: the line of old cores, a line with two slopes, and the strength of an old mix."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar, overload

import numpy as np

from treadload.damage.laws.conditions import LoadingConditions
from treadload.damage.laws.fatigue import USERS, FatigueLine, PowerLaw, check_slope, check_strain
from treadload.damage.laws.of_layer import OnLayer
from treadload.damage.quantities import EXTENSION
from treadload.damage.quantity import Quantity
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.materials.ageing import GlobalAging
from treadload.registry import CRITERIA
from treadload.units import Celsius, Length, Number, Share, Strain, Years

CORES = (
    "fitted to 33 cores of sea dikes, 22 to 48 years old (a public table of dense hydraulic asphalt, 6 to 7 % "
    "bitumen, no wearing course)"
)
"""Where the numbers of the aged line come from."""
CORE_EPSILON_6, CORE_SLOPE = 123e-6, -0.342
"""ε₆ and b of the old cores by strain (stress over initial stiffness); log₁₀ N scatters by 0.44 about this line."""
CORE_AGE, CORE_AIR = 32.0, 10.0
"""Median age of the cores, years, and the mean air of their coast, °C (assumed): where the hardening is 1."""
# At which hardening is compared, °C: the middle of what roads see.
_COMPARED = 20.0
# Strength of the cores in bending, Pa, without voids; its fall with voids, per unit of volume.
_STRENGTH, _BY_VOIDS = 10.3e6, 13.0
# Fall of the cores' initial stiffness with voids, per unit of volume.
_STIFFNESS_BY_VOIDS = 5.3
_FRESH_SLOPE = -0.2


@dataclass(frozen=True)
class AgedLine(PowerLaw):
    """Fatigue line between that of the young mix and that of old cores, by how far the binder has hardened.

    epsilon_6, slope: of the young mix, plain strain and b. hardening: 0 for the young mix, 1 for the cores, at most
    1.5. ln N is linear in it between the two lines, which is an assumption: cores of one age each cannot test it.
    The cores: ε₆ = 123 microstrain, b = -0.342, scatter 0.44 of log₁₀ N, in bending, stress over initial stiffness;
    as stress N = 10^4.20 (σ/MPa)^-2.36. b is -0.25 to -0.31 where strength or voids are held equal: weak cores were
    tested at small stresses. Raises InputError.

    >>> f"{tl.damage.AgedLine().allowable_passes(123e-6):.3g}"
    '1e+06'
    """

    epsilon_6: Strain = 100e-6
    slope: Number = _FRESH_SLOPE
    hardening: Number = 1.0
    reads: Quantity = EXTENSION

    noun: ClassVar[str] = "aged fatigue line"
    symbol: ClassVar[str] = "ε₆"
    source: ClassVar[str] = CORES
    end_of_life: ClassVar[str] = "the core has broken in cyclic bending"
    calibrated: ClassVar[str] = "by old cores in the laboratory: no shift to the road"
    conditions: ClassVar[LoadingConditions] = LoadingConditions(control="stress")

    def __post_init__(self) -> None:
        check_strain(self.epsilon_6)
        check_slope(self.slope)
        if not 0 <= self.hardening <= 1.5:
            raise InputError(
                f"hardening must lie in [0, 1.5], got {self.hardening:g}; 0 is the young mix, 1 the cores of 32 years"
            )

    @property
    def exponent(self) -> float:
        """Slope b."""
        return 1 / ((1 - self.hardening) / self.slope + self.hardening / CORE_SLOPE)

    @property
    def at_a_million(self) -> float:
        """ε₆, plain strain."""
        young = (1 - self.hardening) / self.slope * math.log(self.epsilon_6)
        return math.exp(self.exponent * (young + self.hardening / CORE_SLOPE * math.log(CORE_EPSILON_6)))

    @property
    def caveat(self) -> str:
        """What the cores do not show."""
        return (
            "its numbers are fitted to old cores of dikes, no road, and linear in the hardening between; its slope "
            "is no gain over -0.2 on cores unseen (1.5 standard errors)"
        )

    def __str__(self) -> str:
        return (
            f"aged fatigue line, hardening {self.hardening:.2g}: ε₆ = {self.at_a_million * 1e6:.3g} microstrain, "
            f"slope {self.exponent:.3g}"
        )


@dataclass(frozen=True)
class AgedSurface:
    """The top of an old asphalt: how far it has hardened, how stiff and strong it is, and its fatigue line.

    ageing: of the binder over age and depth. voids: of the mix in the road, a share of its volume. voids_of_table:
    those of the specimens behind the table of its moduli, from which stiffness is corrected.
    Sources: the binder by the Global Aging System (Mirza and Witczak, 1995); the falls of strength and stiffness with
    voids are fitted to 36 cores of dikes, 22 to 48 years old, 1.4 to 16 % of voids. Raises InputError.

    >>> top = tl.damage.AgedSurface(tl.materials.GlobalAging(age=15, mean_air=12.0, binder="PG 64-22"))
    >>> lives = [top.line(depth=depth).allowable_passes(150e-6) for depth in (0.0, 0.05)]
    >>> f"the surface allows {lives[0] / lives[1]:.1f} times the repetitions of 50 mm below it"
    'the surface allows 1.9 times the repetitions of 50 mm below it'
    """

    ageing: GlobalAging
    voids: Share = 0.06
    voids_of_table: Share = 0.06

    def __post_init__(self) -> None:
        for name in ("voids", "voids_of_table"):
            value = getattr(self, name)
            if not 0 <= value <= 0.2:
                raise InputError(f"{name} must lie in [0, 0.2], got {value:g}; 6 % is 0.06")

    def hardening(self, depth: float = 0.0) -> float:
        """Rise of log log viscosity at 20 °C and a depth, m, over that at the surface of a road of the cores' age."""
        old = GlobalAging(CORE_AGE, CORE_AIR, intercept=self.ageing.intercept, slope=self.ageing.slope)
        young = self.ageing.viscosity(_COMPARED)
        rise = self.ageing.aged_viscosity(_COMPARED, depth) - young
        return min(rise / (old.aged_viscosity(_COMPARED, 0.0) - young), 1.5)

    @property
    def stiffness_factor(self) -> float:
        """Of the modulus, by voids other than those of its table: exp(-5.3 Δ)."""
        return math.exp(-_STIFFNESS_BY_VOIDS * (self.voids - self.voids_of_table))

    @property
    def strength(self) -> float:
        """Strength in bending of an old mix, Pa: 10.3 MPa exp(-13 voids), ln scatter 0.27; at the cores' ages."""
        return _STRENGTH * math.exp(-_BY_VOIDS * self.voids)

    def line(self, epsilon_6: float = 100e-6, slope: float = _FRESH_SLOPE, *, depth: float = 0.0) -> AgedLine:
        """The fatigue line at a depth, m, of a mix whose young line is ε₆, plain strain, and b."""
        return AgedLine(epsilon_6, slope, self.hardening(depth))


@CRITERIA.register("aged-line")
def _aged_line(
    at: OnLayer,
    epsilon_6: Strain | None = None,
    slope: Number | None = None,
    hardening: Number | None = None,
    age: Years | None = None,
    mean_air: Celsius | None = None,
    binder: str | None = None,
    depth: Length | None = None,
) -> AgedLine:
    """Fatigue line of an aged mix, from its young line and the line of old cores.

    epsilon_6: of the young mix. slope: of the young mix; left out, both are those of the layer's mix. hardening: 0 of
    the young mix, 1 of cores of 32 years. age: in place of it, of the road. mean_air: of the air over the year, with
    the age. binder: a grade such as "60/70", with the age. depth: where the line is meant; left out, the surface.
    """
    arguments = at.with_layer_values({"epsilon_6": epsilon_6, "slope": slope}, "epsilon_6", "slope")
    at.needed(arguments, "epsilon_6", "slope")
    young, gradient = arguments["epsilon_6"], arguments["slope"]
    assert young is not None
    assert gradient is not None
    if (hardening is None) == (age is None):
        raise InputError(f"{at.name!r}: give hardening, or age with mean_air, one of both")
    if age is None:
        assert hardening is not None
        return AgedLine(young, gradient, hardening)
    if mean_air is None:
        raise InputError(f"{at.name!r}: age needs mean_air, the air's mean over the year in °C")
    surface = AgedSurface(GlobalAging(age, mean_air, binder))
    return surface.line(young, gradient, depth=depth or 0.0)


@CRITERIA.register("two-slope-line")
@dataclass(frozen=True)
class TwoSlopeLine:
    """Wöhler line with a second slope below a strain, or with an endurance limit.

    epsilon_6: strain that allows a million passes by the upper line, plain strain. slope: b of the upper line, in
    (-1, 0). knee: strain where the lower line begins, plain strain; left out, there is none. slope_below: b below
    the knee. endurance_limit: strain below which passes do no damage; left out, there is none. reads: left out, the
    tensile strain. Raises InputError.

    >>> law = tl.damage.TwoSlopeLine(120e-6, -0.2)
    >>> f"{law.allowable_passes(120e-6):.3g}"
    '1e+06'
    """

    epsilon_6: Strain
    slope: Number
    knee: Strain | None = None
    slope_below: Number | None = None
    endurance_limit: Strain | None = None
    reads: Quantity = EXTENSION

    source: ClassVar[str] = "Wöhler's line with a second slope, by the user's numbers"
    end_of_life: ClassVar[str] = FatigueLine.end_of_life
    calibrated: ClassVar[str] = USERS
    conditions: ClassVar[LoadingConditions] = FatigueLine.conditions
    caveat: ClassVar[str] = ""
    verified: ClassVar[bool] = True
    includes_wander: ClassVar[bool] = False

    def __post_init__(self) -> None:
        check_strain(self.epsilon_6)
        check_slope(self.slope)
        if (self.knee is None) != (self.slope_below is None):
            raise InputError("a second slope needs both knee and slope_below; give both, or neither")
        if self.slope_below is not None:
            check_slope(self.slope_below)
        for name in ("knee", "endurance_limit"):
            value = getattr(self, name)
            if value is not None:
                positive(name, value, remedy="50 microstrain is 50e-6")
        if self.knee is not None and self.endurance_limit is not None and self.endurance_limit >= self.knee:
            raise InputError(
                f"endurance_limit, {self.endurance_limit * 1e6:g} microstrain, must be below knee, "
                f"{self.knee * 1e6:g}; leave the knee out for a limit alone"
            )
        if self.reads.shown != "microstrain":
            raise InputError(f"epsilon_6 is a strain, but the line reads the {self.reads}; let it read a strain")

    @property
    def _upper(self) -> FatigueLine:
        return FatigueLine(self.epsilon_6, self.slope, self.reads)

    @property
    def _lower(self) -> FatigueLine:
        """The line below the knee, through it."""
        if self.knee is None or self.slope_below is None:
            return self._upper
        passes = self._upper.allowable_passes(self.knee)
        return FatigueLine(self.knee * (1e6 / passes) ** self.slope_below, self.slope_below, self.reads)

    @property
    def validity(self) -> tuple[float, float]:
        """Strains that allow 10⁸ and 10⁴ passes; of an endurance limit, from 0 on."""
        low = float(np.min(self.allowable_strain(1e8)))
        return 0.0 if self.endurance_limit is not None else low, float(self.allowable_strain(1e4))

    @overload
    def allowable_passes(self, strain: float) -> float: ...
    @overload
    def allowable_passes(self, strain: Array) -> Array: ...
    def allowable_passes(self, strain: float | Array) -> float | Array:
        """Passes that a strain allows; inf where it is <= 0 or below the endurance limit, NaN for NaN."""
        strains = np.asarray(strain, dtype=float)
        above = self.knee is None or strains >= self.knee
        passes = np.where(above, self._upper.allowable_passes(strains), self._lower.allowable_passes(strains))
        if self.endurance_limit is not None:
            passes = np.where(strains < self.endurance_limit, np.inf, passes)
        return passes if strains.ndim else float(passes)

    @overload
    def allowable_strain(self, passes: float) -> float: ...
    @overload
    def allowable_strain(self, passes: Array) -> Array: ...
    def allowable_strain(self, passes: float | Array) -> float | Array:
        """Strain that allows this number of passes, the endurance limit at least, > 0; InputError otherwise."""
        repetitions = np.asarray(passes, dtype=float)
        strain = np.asarray(self._upper.allowable_strain(repetitions))
        if self.knee is not None:
            strain = np.where(strain >= self.knee, strain, self._lower.allowable_strain(repetitions))
        if self.endurance_limit is not None:
            strain = np.maximum(strain, self.endurance_limit)
        return strain if repetitions.ndim else float(strain)

    def __str__(self) -> str:
        below = "" if self.knee is None else f", {self.slope_below:g} below {self.knee * 1e6:g} microstrain"
        limit = "" if self.endurance_limit is None else f", none below {self.endurance_limit * 1e6:g} microstrain"
        return f"fatigue line, ε₆ = {self.epsilon_6 * 1e6:g} microstrain, slope {self.slope:g}{below}{limit}"
