"""Traffic and climate in a case: classes of axles, maneuvers, wander, and the temperatures of the year."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, model_validator

from treadload.case.fields import (
    Acceleration,
    Celsius,
    Curvature,
    Force,
    Length,
    Number,
    Part,
    PerYear,
    Pressure,
    Radius,
    Share,
    Speed,
    Unit,
    Years,
)
from treadload.case.friction import Friction, law
from treadload.case.tire import TirePart
from treadload.contact import STRAIGHT, Maneuver
from treadload.damage import AxleClass, Climate, Season, Traffic, Wander
from treadload.units import quantity

_MONTHS = ("January", "February", "March", "April", "May", "June", "July", "August", "September", "October",
           "November", "December")  # fmt: skip
# Axles of a group, and wheels side by side on one end of an axle.
GEARS = {
    "single": (1, 1),
    "dual": (1, 2),
    "tandem": (2, 1),
    "tandem-dual": (2, 2),
    "tridem": (3, 1),
    "tridem-dual": (3, 2),
}
# Keys that each kind of maneuver takes; those in capitals it needs.
_MANEUVERS: dict[str, tuple[str, ...]] = {
    "straight": (),
    "braking": ("DECELERATION",),
    "locked": (),
    "uphill": ("GRADE", "DRIVEN_SHARE"),
    "turning": ("RADIUS", "SPEED", "crossfall", "track", "centre_of_gravity", "wheel"),
    "forces": ("tractive", "lateral", "spin"),
}


def _one_of(value: str, names: Any, noun: str) -> str:
    if value not in names:
        near = difflib.get_close_matches(value, list(names), n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(names)}"
        raise ValueError(f"no {noun} {value!r}; {hint}")
    return value


class ManeuverPart(Part):
    """`maneuver = "straight"`, or `{ kind = "braking", deceleration = 3 }`, m/s².

    kind: "straight", "braking", "locked", "uphill" (grade, driven_share), "turning" (radius, speed, crossfall, ...)
    or "forces" (tractive and lateral over the load, spin). share: of the class's passes, in a list of maneuvers.
    """

    kind: str
    name: str = ""
    share: Share | None = None
    deceleration: Acceleration | None = None
    grade: Share | None = None
    driven_share: Share | None = None
    radius: Radius | None = None
    speed: Speed | None = None
    crossfall: Share | None = None
    track: Length | None = None
    centre_of_gravity: Length | None = None
    wheel: Literal["outer", "inner"] | None = None
    tractive: Number | None = None
    lateral: Number | None = None
    spin: Curvature | None = None

    @model_validator(mode="after")
    def _known(self) -> ManeuverPart:
        keys = _MANEUVERS[_one_of(self.kind, _MANEUVERS, "maneuver")]
        given = {name for name, value in dict(self).items() if value is not None} - {"kind", "name", "share"}
        stray = sorted(given - {key.lower() for key in keys})
        if stray:
            takes = ", ".join(key.lower() for key in keys) or "no key"
            raise ValueError(f"{stray[0]} is no key of the maneuver {self.kind!r}; it takes {takes}")
        missing = [key.lower() for key in keys if key.isupper() and key.lower() not in given]
        if missing:
            raise ValueError(f"the maneuver {self.kind!r} needs {missing[0]}")
        return self

    def build(self) -> Maneuver:
        """The maneuver."""
        own = {key.lower(): getattr(self, key.lower()) for key in _MANEUVERS[self.kind]}
        told = {key: value for key, value in own.items() if value is not None}
        makers: dict[str, Any] = {
            "straight": lambda: STRAIGHT,
            "braking": Maneuver.braking,
            "locked": Maneuver.braking,
            "uphill": Maneuver.uphill,
            "turning": Maneuver.turning,
            "forces": lambda **forces: Maneuver(self.name or "forces", **forces),
        }
        made: Maneuver = makers[self.kind](**told)
        return made


_Maneuver = Annotated[ManeuverPart, BeforeValidator(lambda v: {"kind": v} if isinstance(v, str) else v)]


class AxlePart(Part):
    """`[[traffic.classes]]`: a kind of axle under one load.

    share: of all passes. axle_load: of one axle on level ground, N, over its wheels; or wheel_load, of each wheel.
    gear: "single", "dual", "tandem", "tandem-dual", "tridem", "tridem-dual", with dual_spacing and wheelbase; or
    wheels = [[x, y], ...], the wheel path at y = 0. maneuver: one, or maneuvers: several with their shares.
    tire: of this class, as [tire]; left out, that of the case. Of dual wheels the left one, at y < 0, has its tire
    turned round, as on the right of a vehicle; only treads that are not symmetric feel it.
    """

    name: str
    share: Share
    axle_load: Force | None = None
    wheel_load: Force | None = None
    inflation_pressure: Pressure
    gear: str = "single"
    dual_spacing: Length = 0.34
    wheelbase: Length = 1.31
    wheels: tuple[tuple[Length, Length], ...] | None = None
    maneuver: _Maneuver | None = None
    maneuvers: tuple[_Maneuver, ...] | None = None
    friction: Friction = 0.7
    speed: Speed | None = None
    tire: TirePart | None = None

    @model_validator(mode="after")
    def _consistent(self) -> AxlePart:
        _one_of(self.gear, GEARS, "gear")
        if (self.axle_load is None) == (self.wheel_load is None):
            raise ValueError(f"{self.name!r} needs either axle_load or wheel_load")
        if self.wheels is not None:
            stray = {"gear", "dual_spacing", "wheelbase"} & self.model_fields_set
            if stray:
                raise ValueError(f"{self.name!r} gives its wheels; leave out {sorted(stray)[0]}")
            if self.axle_load is not None:
                raise ValueError(f"{self.name!r} gives its wheels; give the wheel_load in place of the axle_load")
        if self.maneuver is not None and self.maneuvers is not None:
            raise ValueError(f"{self.name!r} needs either a maneuver or maneuvers, got both")
        if self.maneuvers is not None:
            shares = [one.share for one in self.maneuvers]
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
        friction = self.friction if isinstance(self.friction, float) else law(self.friction, folder)
        assert friction is not None
        tire = None if self.tire is None else self.tire.build(folder)
        # The left one of each pair, unless the wheels are given one by one.
        duals = self.wheels is None and side_by_side > 1
        mirrored = tuple(range(0, len(places), side_by_side)) if duals else ()
        several = self.maneuvers or (self.maneuver or ManeuverPart(kind="straight"),)
        rows = []
        for one in several:
            made = one.build()
            name = self.name if len(several) == 1 else f"{self.name}, {one.name or made.name}"
            share = self.share * (1.0 if one.share is None else one.share)
            rows.append(
                AxleClass(
                    name, share, load, self.inflation_pressure, places, made, friction, self.speed, tire, mirrored
                )
            )
        return rows


class WanderPart(Part):
    """`wander = { deviation = "250 mm" }`, or `{ offsets = [...], shares = [...] }` as measured."""

    deviation: Length | None = None
    offsets: tuple[Length, ...] | None = None
    shares: tuple[Share, ...] | None = None

    def build(self) -> Wander:
        """The wander."""
        if self.offsets is None and self.shares is None:
            return Wander.normal(self.deviation or 0.0)
        return Wander(self.deviation or 0.0, self.offsets or (), self.shares or ())


class TrafficPart(Part):
    """`[traffic]`: passes_per_year in the wheel path, growth a year, years of design, wander, and classes."""

    passes_per_year: PerYear
    growth: Share = 0.0
    kind: Literal["geometric", "arithmetic"] = "geometric"
    years: Years | None = None
    wander: WanderPart = WanderPart()
    classes: tuple[AxlePart, ...]

    def build(self, folder: Path) -> Traffic:
        """The traffic."""
        rows = [row for one in self.classes for row in one.build(folder)]
        return Traffic(tuple(rows), self.passes_per_year, self.growth, self.kind, self.wander.build(), self.years)


def _one_or_several(value: Any) -> float | tuple[float, ...]:
    if isinstance(value, list | tuple):
        return tuple(quantity(one, "degC") for one in value)
    return quantity(value, "degC")


class SeasonPart(Part):
    """`[[climate.seasons]]`: name, share of the passes, temperature: °C, one, or one a layer."""

    name: str
    share: Share
    temperature: Annotated[float | tuple[float, ...], Unit("degC"), BeforeValidator(_one_or_several)]


class ClimatePart(Part):
    """`[climate]`: temperature = 15, or months = [12 of them], or seasons, in °C."""

    temperature: Celsius | None = None
    months: tuple[Celsius, ...] | None = None
    seasons: tuple[SeasonPart, ...] | None = None

    @model_validator(mode="after")
    def _one_kind(self) -> ClimatePart:
        given = [name for name in ("temperature", "months", "seasons") if getattr(self, name) is not None]
        if len(given) != 1:
            got = " and ".join(given) or "none of them"
            raise ValueError(f"give exactly one of temperature, months and seasons, got {got}")
        if self.months is not None and len(self.months) != len(_MONTHS):
            raise ValueError(f"months needs 12 temperatures in °C, January first, got {len(self.months)}")
        return self

    def build(self) -> Climate:
        """The climate."""
        if self.temperature is not None:
            return Climate.constant(self.temperature)
        if self.months is not None:
            return Climate.equal_parts(self.months, _MONTHS)
        assert self.seasons is not None
        return Climate(tuple(Season(one.name, one.share, one.temperature) for one in self.seasons))
