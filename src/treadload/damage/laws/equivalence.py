"""Axles of one kind for all that pass: aggressiveness, growth, and their sum over the design life.

Tables of NF P98-086, as a public program codes them; see `damage.laws.french`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from treadload.errors import InputError, positive
from treadload.units import Force, Length, Pressure

_DAYS = 365
# Annual growth that changes no sum over years; far below it the quotient loses its digits.
NO_GROWTH = 1e-15
# Eleven times as many passes in each next year: no traffic does.
_MOST_GROWTH = 10.0

AGGRESSIVENESS: Mapping[str, Mapping[str, float]] = {
    "bituminous": {"T5": 0.3, "T4": 0.3, "T3-": 0.4, "T3+": 0.5, "T2": 0.5, "T1": 0.5, "T0": 0.5, "motorway": 0.8},
    "hydraulic": {"T5": 0.4, "T4": 0.5, "T3-": 0.6, "T3+": 0.6, "T2": 0.8, "T1": 0.8, "T0": 0.8, "motorway": 1.3},
    "treated soil": {"T5": 0.4, "T4": 0.5, "T3-": 0.7, "T3+": 0.7, "T2": 0.8, "T1": 0.8, "T0": 0.8},
    "subgrade": {"T5": 0.4, "T4": 0.5, "T3-": 0.6, "T3+": 0.75, "T2": 1.0, "T1": 1.0, "T0": 1.0, "motorway": 1.0},
}
"""Mean aggressiveness CAM of a heavy vehicle, in axles of 130 kN, by what it wears and class of traffic."""

GROUP_FACTORS: Mapping[str, Mapping[int, float]] = {
    "bituminous": {1: 1.0, 2: 0.75, 3: 1.1},
    "hydraulic": {1: 1.0, 2: 12.0, 3: 113.0},
}
"""K of one axle by the number of axles in its group and the kind of layer; as commonly quoted, not checked against
the source, LCPC and SETRA (1994), technical guide of pavement structures."""


@dataclass(frozen=True)
class StandardAxle:
    """The axle in whose passes a traffic is stated: dual wheels at each end, each a uniform disc.

    load: of the whole axle, N. pressure: of each of its four discs, Pa. spacing: between the centres of two duals, m.

    The defaults are those of the French method. Raises InputError.
    """

    load: Force = 130e3
    pressure: Pressure = 0.662e6
    spacing: Length = 0.375

    def __post_init__(self) -> None:
        positive("the load of the standard axle", self.load, "N", "the French one has 130e3, most others 80e3")
        positive("the pressure of the standard axle", self.pressure, "Pa", "the French one has 0.662e6")
        positive("the spacing of the standard axle", self.spacing, "m", "0.31 to 0.375 is usual")
        if self.spacing < 2 * self.radius:
            raise InputError(
                f"discs of radius {1e3 * self.radius:.0f} mm overlap at a spacing of {1e3 * self.spacing:.0f} mm; "
                f"give a spacing of at least {2e3 * self.radius:.0f} mm, or more pressure"
            )

    @property
    def radius(self) -> float:
        """Of each disc, m."""
        return math.sqrt(self.load / 4 / (math.pi * self.pressure))

    def __str__(self) -> str:
        return (
            f"{self.load / 1e3:g} kN on dual discs of {self.pressure / 1e6:g} MPa, {1e3 * self.spacing:g} mm between "
            "their centres"
        )


STANDARD_AXLES: Mapping[str, StandardAxle] = {
    "french": StandardAxle(),
    "irc37": StandardAxle(80e3, 0.56e6, 0.31),
}
"""Standard axles by name: of NF P98-086, and of IRC:37-2018 (dual wheels of 20 kN, 0.56 MPa, 310 mm apart)."""


def aggressiveness(
    axles: Sequence[tuple[float, float, float]],
    *,
    vehicles: float,
    power: float,
    reference: float = 130e3,
) -> float:
    """CAM = Σ K n (P / P₀)^α / N: axles of the reference load that do the damage of one heavy vehicle.

    axles: (load P of one axle, N; number n of such axles; K of its group). K is 1 for a single axle; in a tandem
    0.75 and in a tridem 1.1 for bituminous layers, 12 and 113 for hydraulic ones. vehicles: N, heavy vehicles
    weighed. power: α, 5 for bituminous layers, 12 for hydraulic ones. reference: P₀, N.
    α and K are as commonly quoted, not checked against the source. Raises InputError.

    >>> axles = [(80e3, 40, 1.0), (130e3, 10, 1.0), (80e3, 30, 0.75)]
    >>> f"{tl.damage.aggressiveness(axles, vehicles=20, power=5):.2f} axles of 130 kN per heavy vehicle"
    '0.78 axles of 130 kN per heavy vehicle'
    """
    positive("vehicles", vehicles, remedy="count the vehicles that were weighed")
    positive("reference", reference, "N", "the French axle has 130e3")
    if not len(axles):
        raise InputError("axles is empty; give (load in N, number, K) of at least one kind of axle")
    for load, number, group in axles:
        if not (load > 0 and number >= 0 and group > 0):
            raise InputError(f"an axle needs a load > 0 N, a number >= 0 and K > 0, got {(load, number, group)}")
    return float(sum(group * number * (load / reference) ** power for load, number, group in axles) / vehicles)


def equivalent_axles(
    vehicles_per_day: float,
    years: float,
    aggressiveness: float,
    *,
    growth: float = 0.0,
    kind: Literal["geometric", "arithmetic"] = "geometric",
) -> float:
    """NE = 365 MJA C CAM: reference axles over the design life.

    vehicles_per_day: MJA, heavy vehicles per day and direction in the first year. years: n. aggressiveness: CAM,
    as in `AGGRESSIVENESS`, or of axles that were weighed, see the function `aggressiveness`.
    growth: t, per year. kind: C = ((1+t)^n - 1)/t "geometric", or n (1 + (n-1) t/2) "arithmetic". Raises InputError.

    >>> axles = tl.damage.equivalent_axles(750, years=20, aggressiveness=0.8, growth=0.02)
    >>> f"{axles / 1e6:.1f} million axles of 130 kN"
    '5.3 million axles of 130 kN'
    """
    for name, value in {
        "vehicles_per_day": vehicles_per_day,
        "years": years,
        "aggressiveness": aggressiveness,
    }.items():
        positive(name, value, remedy="leave out a traffic that does not run")
    total = growth_factor(years, growth, kind)
    return _DAYS * vehicles_per_day * total * aggressiveness


def growth_factor(years: float, growth: float, kind: Literal["geometric", "arithmetic"] = "geometric") -> float:
    """C: passes over years n, > 0, over those of the first year, for an annual growth t.

    kind: ((1+t)^n - 1)/t "geometric", or n (1 + (n-1) t/2) "arithmetic". Raises InputError.
    """
    if not growth > -1:
        raise InputError(f"growth must be above -1 per year, got {growth}; 2 % per year is 0.02")
    if growth > _MOST_GROWTH:
        raise InputError(f"growth must be at most {_MOST_GROWTH:g} per year, got {growth:g}; 2 % per year is 0.02")
    if kind == "geometric":
        try:
            total = math.expm1(years * math.log1p(growth)) / growth if abs(growth) > NO_GROWTH else years
        except OverflowError as error:
            raise InputError(
                f"a growth of {growth:g} per year over {years:g} years makes more passes than a number can hold; "
                'give fewer years, less growth, or kind="arithmetic"'
            ) from error
    elif kind == "arithmetic":
        total = years * (1 + (years - 1) * growth / 2)
    else:
        raise InputError(f'kind must be "geometric" or "arithmetic", got {kind!r}')
    if not total > 0:
        raise InputError(f"a growth of {growth:g} per year leaves no traffic over {years:g} years")
    return total
