"""Traffic and wander: how often which wheel passes where."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy

from treadload.contact.friction.laws import FrictionLaw
from treadload.contact.maneuver import STRAIGHT, Maneuver
from treadload.damage.frequency import LoadingFrequency
from treadload.damage.laws.equivalence import NO_GROWTH, STANDARD_AXLES, StandardAxle, growth_factor
from treadload.damage.shares import check_shares
from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.kernels.fft import irfft, next_fast_len, rfft
from treadload.tire import Tire
from treadload.units import Length, Share

# Wander is cut where 6e-7 of the wheels are left, and the rest scaled to one.
_SIGMAS = 5.0
GROWS = 40.0
"""Years from the opening for which a traffic grows, unless its design life is longer; a judgement of this package.

Counts are extrapolated no further than roads are designed for, 20 to 40 years: no lane can carry exponential growth
for centuries. From then on every year has the traffic of the last that grew; one that shrinks goes on shrinking.
"""


@dataclass(frozen=True)
class AxleClass:
    """One row of a traffic: wheels of a kind under one load that roll in one way.

    name: for tables. share: of all passes, in [0, 1]. wheel_load: N on each wheel. inflation_pressure: Pa.
    wheels: (x, y) of the wheels that act together, m, the wheel path at y = 0: one wheel, dual wheels, the duals
    of a tandem. maneuver: how they roll. friction: coefficient or law. speed: m/s, for viscoelastic roads.
    tire: its own; None for that of the traffic. mirrored: numbers of the wheels, from 0, whose tire is turned round,
    as that of one of dual wheels is: their contact is a mirror image, which shows where a tread is not symmetric.
    frequency: the rule by which the class reads moduli at its own speed; None for those of the road as it is given.
    Raises InputError.

    >>> tl.damage.AxleClass("bus", 1.0, wheel_load=35e3, inflation_pressure=8e5).wheel_load
    35000.0
    """

    name: str
    share: float
    wheel_load: float
    inflation_pressure: float
    wheels: tuple[tuple[float, float], ...] = ((0.0, 0.0),)
    maneuver: Maneuver = STRAIGHT
    friction: float | FrictionLaw = 0.7
    speed: float | None = None
    tire: Tire | None = None
    mirrored: tuple[int, ...] = ()
    frequency: LoadingFrequency | None = None

    def __post_init__(self) -> None:
        if not 0 <= self.share <= 1:
            raise InputError(f"the share of {self.name!r} must lie in [0, 1], got {self.share}; 30 % is 0.3")
        positive(f"wheel_load of {self.name!r}", self.wheel_load, "N", "a truck's wheel carries 20e3 to 60e3")
        positive(f"inflation_pressure of {self.name!r}", self.inflation_pressure, "Pa", "a truck is near 820e3")
        try:
            wheels = tuple((float(x), float(y)) for x, y in self.wheels)
        except (TypeError, ValueError) as error:
            raise InputError(f"wheels of {self.name!r} must be pairs (x, y) in m, got {self.wheels!r}") from error
        if not wheels or not np.isfinite(wheels).all():
            raise InputError(f"{self.name!r} needs at least one wheel at finite (x, y) in m, got {self.wheels!r}")
        object.__setattr__(self, "wheels", wheels)
        if self.frequency is not None and self.speed is None:
            raise InputError(f"the loading frequency of {self.name!r} follows from its speed: give it one in m/s")
        object.__setattr__(self, "mirrored", tuple(self.mirrored))
        stray = next((number for number in self.mirrored if number not in range(len(wheels))), None)
        if stray is not None:
            raise InputError(
                f"{self.name!r} has {len(wheels)} wheels, 0 to {len(wheels) - 1}; none is number {stray}"
            )

    __repr__ = as_call


@dataclass(frozen=True)
class Wander:
    """Where the wheels run across the road, as offsets from the middle of the wheel path.

    offsets: m, increasing. shares: of the passes at each offset, summing to 1; none at all for a normal law.
    deviation: standard deviation of a normal law, m, >= 0; 0 for wheels that never wander.
    Build it with none, normal or measured. Raises InputError.

    >>> tl.damage.Wander.normal(0.2)
    Wander(deviation=0.2, offsets=(), shares=())
    """

    deviation: Length = 0.0
    offsets: tuple[Length, ...] = ()
    shares: tuple[Share, ...] = ()

    def __post_init__(self) -> None:
        if not (math.isfinite(self.deviation) and self.deviation >= 0):
            raise InputError(f"the deviation of wander must be >= 0 m, got {self.deviation}; 0.25 is usual")
        if len(self.offsets) != len(self.shares):
            raise InputError(f"wander has {len(self.offsets)} offsets but {len(self.shares)} shares")
        if self.offsets:
            if self.deviation:
                raise InputError("wander is either normal or measured: give a deviation or offsets, not both")
            if not (np.diff(self.offsets) > 0).all():
                raise InputError(f"the offsets of wander must increase, got {list(self.offsets)} m")
            check_shares("wander", self.shares)

    @classmethod
    def none(cls) -> Wander:
        """Every wheel in the same track."""
        return cls()

    @classmethod
    def normal(cls, deviation: float) -> Wander:
        """Normally distributed tracks. deviation: standard deviation, m; 0.2 to 0.3 on motorways."""
        return cls(deviation)

    @classmethod
    def measured(cls, offsets: Sequence[float], shares: Sequence[float]) -> Wander:
        """A measured distribution. offsets: m, increasing. shares: of the passes at each, summing to 1."""
        return cls(0.0, tuple(float(o) for o in offsets), tuple(float(s) for s in shares))

    @property
    def reach(self) -> float:
        """Largest offset that has a share, m."""
        return _SIGMAS * self.deviation if not self.offsets else max(abs(o) for o in self.offsets)

    def weights(self, spacing: float) -> Array:
        """Shares (2 n + 1,) of the tracks -n..n, `spacing` m apart, summing to 1.

        A normal law is integrated over each track's width; a measured offset is shared between its neighbours so
        that its mean stays.
        """
        n = math.ceil(self.reach / spacing - 1e-9)
        tracks = np.arange(-n, n + 1) * spacing
        if self.offsets:
            shares = np.zeros(2 * n + 1)
            at = np.asarray(self.offsets) / spacing + n
            low = np.clip(np.floor(at).astype(int), 0, max(2 * n - 1, 0))
            part = np.minimum(at - low, 1.0) if n else np.zeros(len(at))
            np.add.at(shares, low, (1 - part) * self.shares)
            if n:
                np.add.at(shares, low + 1, part * self.shares)
        elif n:
            edges = np.append(tracks - spacing / 2, tracks[-1] + spacing / 2) / self.deviation
            shares = np.diff(scipy.special.ndtr(edges))
        else:
            shares = np.ones(1)
        weights: Array = shares / shares.sum()
        return weights

    def spread(self, damage: Array, spacing: float) -> Array:
        """Damage of wheels that wander, from that of wheels in one track.

        damage: (..., ny) on points `spacing` m apart, taken as zero beyond. Returns (..., ny + 2 n), n points more
        on both sides: the sum over y does not change.
        """
        weights = self.weights(spacing)
        if len(weights) == 1:
            return damage
        wide = damage.shape[-1] + len(weights) - 1
        n = next_fast_len(wide, real=True)
        # Round-off of the transforms leaves a little, or less than nothing, where there is none.
        spread: Array = np.maximum(irfft(rfft(damage, n) * rfft(weights, n), n)[..., :wide], 0.0)
        return spread

    def spread_at(self, damage: Array, spacing: float, column: int) -> Array:
        """One column of `spread`, (...); zero before the first and behind the last."""
        weights = self.weights(spacing)
        first, last = max(0, column - len(weights) + 1), min(column, damage.shape[-1] - 1)
        reached = np.arange(first, last + 1)
        here: Array = damage[..., reached] @ weights[column - reached]
        return here

    def __str__(self) -> str:
        if self.offsets:
            return f"measured wander at {len(self.offsets)} offsets, up to {self.reach * 1e3:g} mm"
        return f"normal wander of {self.deviation * 1e3:g} mm" if self.deviation else "no wander"


@dataclass(frozen=True)
class Traffic:
    """What passes: classes of wheels, how many per year, how that grows, and how it wanders.

    classes: rows whose shares sum to 1. passes_per_year: of all classes, in the first year, over the wheel path.
    growth: per year, > -1; kind: "geometric" or "arithmetic". wander: across the road. years: for which the road is
    designed, > 0, or None. standard_axle: in whose passes the traffic is stated. growth_years: for which it grows
    from the opening, >= 1, and stays as it is from then on; left out, `GROWS` or its design life, whichever is
    longer. Raises InputError.

    >>> bus = tl.damage.AxleClass("bus", 1.0, wheel_load=35e3, inflation_pressure=8e5)
    >>> tl.damage.Traffic((bus,), passes_per_year=1e5, growth=0.02).passes_per_year
    100000.0
    """

    classes: tuple[AxleClass, ...]
    passes_per_year: float
    growth: float = 0.0
    kind: Literal["geometric", "arithmetic"] = "geometric"
    wander: Wander = Wander()
    years: float | None = None
    standard_axle: StandardAxle = STANDARD_AXLES["french"]
    growth_years: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "classes", tuple(self.classes))
        if not self.classes:
            raise InputError("a traffic needs at least one class of axles, got none")
        names = [row.name for row in self.classes]
        twice = next((name for name in names if names.count(name) > 1), None)
        if twice is not None:
            raise InputError(f"two classes of axles have the name {twice!r}; give them different names")
        check_shares("traffic", [row.share for row in self.classes])
        if not (math.isfinite(self.passes_per_year) and self.passes_per_year >= 0):
            raise InputError(f"passes_per_year must be >= 0, got {self.passes_per_year}")
        if self.years is not None:
            positive("the design life", self.years, "years", "leave it out for none")
        if self.growth_years is not None and not (math.isfinite(self.growth_years) and self.growth_years >= 1):
            raise InputError(
                f"growth_years must be at least 1 year, got {self.growth_years:g}; leave it out for {GROWS:g} years "
                "or the design life, or give growth = 0"
            )
        growth_factor(self.years or 1.0, self.growth, self.kind)

    @property
    def grows_for(self) -> float:
        """Years from the opening for which it grows; inf for a traffic that shrinks or stays."""
        if self.growth <= NO_GROWTH:
            return math.inf
        return max(GROWS, self.years or 0.0) if self.growth_years is None else self.growth_years

    def growth_factor(self, years: float) -> float:
        """Passes over a number of years from the opening, over those of the first."""
        last = self.grows_for
        if years <= last:
            return growth_factor(years, self.growth, self.kind)
        return growth_factor(last, self.growth, self.kind) + (years - last) * self._last_year

    @property
    def _last_year(self) -> float:
        """Passes of the last year that grows over those of the first."""
        grown = self.growth * (self.grows_for - 1)
        return (1 + self.growth) ** (self.grows_for - 1) if self.kind == "geometric" else 1 + grown

    def passes(self, years: float) -> float:
        """Passes of all classes over a number of years from the opening."""
        return self.passes_per_year * self.growth_factor(years)

    def years_to(self, passes: float) -> float:
        """Years until so many passes; inf where a traffic that shrinks, or none, never makes them."""
        if not passes >= 0:
            raise InputError(f"passes must be >= 0, got {passes}")
        if passes == 0:
            return 0.0
        if self.passes_per_year == 0 or math.isinf(passes):
            return math.inf
        ratio, growth = passes / self.passes_per_year, self.growth
        if abs(growth) <= NO_GROWTH:
            return ratio
        if growth > 0 and (beyond := ratio - growth_factor(self.grows_for, growth, self.kind)) > 0:
            return self.grows_for + beyond / self._last_year
        if self.kind == "geometric":
            return math.log1p(ratio * growth) / math.log1p(growth) if ratio * growth > -1 else math.inf
        # growth/2 n² + (1 - growth/2) n = ratio, the root that grows out of n = 0.
        linear = 1 - growth / 2
        square = linear**2 + 2 * growth * ratio
        return 2 * ratio / (linear + math.sqrt(square)) if square >= 0 else math.inf

    __repr__ = as_call
