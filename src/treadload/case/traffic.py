"""Traffic in a case: classes of axles, maneuvers, wander."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import model_validator

from treadload.case.choices import FRICTION_OR_NUMBER, Friction, ManeuverTable, maneuver_of
from treadload.case.tire import TirePart
from treadload.damage import AxleClass, Traffic, Wander
from treadload.damage.frequency import LoadingFrequency
from treadload.damage.laws.equivalence import STANDARD_AXLES, StandardAxle
from treadload.errors import InputError, nearest, positive
from treadload.read import As, Table
from treadload.units import Force, Length, PerYear, Pressure, Share, Speed, Years

WANDER = As(Wander)
STANDARD_AXLE = As(Literal["french", "irc37"] | StandardAxle)
# Axles of a group, and wheels side by side on one end of an axle.
GEARS = {
    "single": (1, 1),
    "dual": (1, 2),
    "tandem": (2, 1),
    "tandem-dual": (2, 2),
    "tridem": (3, 1),
    "tridem-dual": (3, 2),
}


class AxlePart(Table):
    """`[[traffic.classes]]`: a kind of axle under one load.

    name: for tables. share: of all passes. axle_load: of one axle on level ground, over its wheels; or wheel_load.
    wheel_load: of each wheel. inflation_pressure: of its tires. gear: "single", "dual", "tandem", "tandem-dual",
    "tridem" or "tridem-dual"; or wheels. dual_spacing: between the middles of dual wheels. wheelbase: between axles
    of a group. wheels: [[x, y], ...] in place of a gear, the wheel path at y = 0. maneuver: how they roll; left out,
    straight on. maneuvers: several with their shares. friction: with the road. speed: for viscoelastic roads. tire:
    of this class, as [tire]; left out, that of the case. Of dual wheels the left one, at y < 0, has its tire turned
    round, as on the right of a vehicle; it matters only for treads that are not symmetric.
    """

    one_of: ClassVar = ("axle_load", "wheel_load")

    name: str
    share: Share
    axle_load: Force | None = None
    wheel_load: Force | None = None
    inflation_pressure: Pressure
    gear: str = "single"
    dual_spacing: Length = 0.34
    wheelbase: Length = 1.31
    wheels: tuple[tuple[Length, Length], ...] | None = None
    maneuver: ManeuverTable = "straight"
    maneuvers: tuple[ManeuverTable, ...] | None = None
    friction: Friction = 0.7
    speed: Speed | None = None
    tire: TirePart | None = None

    @model_validator(mode="after")
    def _consistent(self) -> AxlePart:
        if self.gear not in GEARS:
            raise ValueError(f"no gear {self.gear!r}; {nearest(self.gear, GEARS)}")
        if (self.axle_load is None) == (self.wheel_load is None):
            raise ValueError(f"{self.name!r} needs either axle_load or wheel_load")
        if self.axle_load is not None:
            # Its wheels' load is checked later, in a sentence about a key that the table does not give.
            positive(f"axle_load of {self.name!r}", self.axle_load, "N", "a truck's axle carries 40e3 to 130e3")
        if self.wheels is not None:
            stray = {"gear", "dual_spacing", "wheelbase"} & self.model_fields_set
            if stray:
                raise ValueError(f"{self.name!r} gives its wheels; leave out {sorted(stray)[0]}")
            if self.axle_load is not None:
                raise ValueError(f"{self.name!r} gives its wheels; give the wheel_load in place of the axle_load")
        if "maneuver" in self.model_fields_set and self.maneuvers is not None:
            raise ValueError(f"{self.name!r} needs either a maneuver or maneuvers, got both")
        if self.maneuvers is not None:
            shares = [maneuver_of(maneuver)[2] for maneuver in self.maneuvers]
            if any(share is None for share in shares):
                raise ValueError(f"every one of the maneuvers of {self.name!r} needs its share")
            total = sum(share for share in shares if share is not None)
            if abs(total - 1) > 1e-6:
                raise ValueError(f"the shares of the maneuvers of {self.name!r} must sum to 1, got {total:.6g}")
        return self

    def build(self, folder: Path) -> list[AxleClass]:
        """A class for each maneuver."""
        axles, side_by_side = GEARS[self.gear]
        places = self.wheels or tuple(
            ((k - (axles - 1) / 2) * self.wheelbase, (j - (side_by_side - 1) / 2) * self.dual_spacing)
            for k in range(axles)
            for j in range(side_by_side)
        )
        load = self.wheel_load
        if load is None:
            assert self.axle_load is not None
            load = self.axle_load / (2 * side_by_side)
        friction = FRICTION_OR_NUMBER.build(self.friction, folder)
        tire = None if self.tire is None else self.tire.build(folder)
        # The left one of each pair, unless the wheels are given one by one.
        duals = self.wheels is None and side_by_side > 1
        mirrored = tuple(range(0, len(places), side_by_side)) if duals else ()
        several = self.maneuvers or (self.maneuver,)
        rows = []
        for table in several:
            maneuver, words, part = maneuver_of(table)
            name = self.name if len(several) == 1 else f"{self.name}, {words}"
            share = self.share * (1.0 if part is None else part)
            rows.append(
                AxleClass(
                    name, share, load, self.inflation_pressure, places, maneuver, friction, self.speed, tire, mirrored
                )
            )
        return rows


class TrafficPart(Table):
    """`[traffic]`: what passes over the wheel path, how that grows, and for how long.

    passes_per_year: of all classes, in the first year. growth: per year. kind: of growth, "geometric" or
    "arithmetic". growth_years: for which it grows, and stays as it is from then on; left out, 40 years, or the design
    life where that is longer. years: for which the road is designed. wander: of the wheels across the road; left out,
    none.
    frequency: the rule by which each class reads moduli at its own speed and depth, "mepdg" or "brown"; left out, the
    one frequency of the road, 10 Hz, for which French laws are made. angular: True for f = 1/(2πt), False for 1/t;
    left out, as the source of the rule has it. standard_axle: in whose passes the traffic is stated: "french", 130 kN
    on dual discs of 0.662 MPa, 375 mm apart, which it is if left out; "irc37", 80 kN, 0.56 MPa, 310 mm; or a table.
    classes: of axles, whose shares sum to 1.
    """

    passes_per_year: PerYear
    growth: Share = 0.0
    kind: Literal["geometric", "arithmetic"] = "geometric"
    growth_years: Years | None = None
    years: Years | None = None
    wander: Annotated[Any, WANDER] = None
    frequency: Literal["mepdg", "brown"] | None = None
    angular: bool | None = None
    standard_axle: Annotated[Any, STANDARD_AXLE] = "french"
    classes: tuple[AxlePart, ...]

    def build(self, folder: Path) -> Traffic:
        """The traffic."""
        rows = [row for axle_class in self.classes for row in axle_class.build(folder)]
        if self.frequency is not None:
            rule = LoadingFrequency(self.frequency, self.angular)
            rows = [replace(row, frequency=rule) for row in rows]
        elif self.angular is not None:
            raise InputError('angular belongs to a frequency, "mepdg" or "brown"; give one, or leave it out')
        wander = Wander.none() if self.wander is None else WANDER.build(self.wander)
        axle = STANDARD_AXLES.get(self.standard_axle) if isinstance(self.standard_axle, str) else None
        axle = axle or STANDARD_AXLE.build(self.standard_axle)
        return Traffic(
            tuple(rows), self.passes_per_year, self.growth, self.kind, wander, self.years, axle, self.growth_years
        )
