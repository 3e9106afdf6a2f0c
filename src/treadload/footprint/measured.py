"""What was measured of a tire, and what is sought by it: the question of a calibration."""

from __future__ import annotations

import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from treadload.describing import as_call
from treadload.errors import InputError, nearest, positive
from treadload.footprint.footprint import Footprint
from treadload.footprint.measures import check_ribs
from treadload.footprint.reading import read_footprint
from treadload.response import GridLoad
from treadload.tire.modulus import check_inflation_pressure
from treadload.tire.numbers import NUMBERS
from treadload.tire.tire import Tire
from treadload.units import (
    AligningStiffness,
    Area,
    CorneringStiffness,
    Force,
    Length,
    Moment,
    Number,
    Pressure,
    Share,
    SpringStiffness,
    Unit,
    quantity,
)

FRICTION = "friction"
"""The one number that is sought and no tire's."""
_FRICTION_BOUNDS = (0.01, 3.0)
# Loads of a row and of its footprint that differ by more are refused: it was taken under another load.
_SAME_LOAD = 0.25


@dataclass(frozen=True)
class Reading:
    """A kind of reading of a tire.

    words: what it is. unit: SI. shown, factor: what people count it in. how: what gives it, a standing tire pressed
    on ("print"), slopes of rolling ("card"), a rolling state ("rolling"), or its shear ("pins"). deviation: standard
    deviation that is taken where none is given, of the value if relative. Grounds: repeated readings of one tire.
    """

    words: str
    unit: str
    shown: str
    factor: float
    how: str
    deviation: float
    relative: bool = True


READINGS: Mapping[str, Reading] = {
    "deflection": Reading("deflection", "m", "mm", 1e3, "print", 0.01),
    "net_area": Reading("net area", "m^2", "cm²", 1e4, "print", 0.03),
    "gross_area": Reading("gross area", "m^2", "cm²", 1e4, "print", 0.03),
    "length": Reading("length", "m", "mm", 1e3, "print", 0.02),
    "width": Reading("width", "m", "mm", 1e3, "print", 0.02),
    "spread_x": Reading("spread of pressure along", "m", "mm", 1e3, "print", 0.01),
    "spread_y": Reading("spread of pressure across", "m", "mm", 1e3, "print", 0.01),
    "rib_shares": Reading("share of rib", "", "%", 100.0, "print", 0.01, relative=False),
    "footprint": Reading("share of block", "", "%", 100.0, "print", 0.005, relative=False),
    "pins": Reading("shear over load of pins", "", "", 1.0, "pins", 0.02, relative=False),
    "effective_rolling_radius": Reading("effective rolling radius", "m", "mm", 1e3, "card", 0.002),
    "longitudinal_stiffness": Reading("longitudinal stiffness", "N", "kN", 1e-3, "card", 0.05),
    "cornering_stiffness": Reading("cornering stiffness", "N/rad", "kN/rad", 1e-3, "card", 0.05),
    "aligning_stiffness": Reading("aligning stiffness", "N m/rad", "kN m/rad", 1e-3, "card", 0.05),
    "lateral_stiffness": Reading("lateral stiffness", "N/m", "N/mm", 1e-3, "card", 0.05),
    "relaxation_length": Reading("relaxation length", "m", "mm", 1e3, "card", 0.05),
    "tractive_force": Reading("tractive force", "N", "kN", 1e-3, "rolling", 0.03),
    "lateral_force": Reading("lateral force", "N", "kN", 1e-3, "rolling", 0.03),
    "aligning_moment": Reading("aligning moment", "N m", "N m", 1.0, "rolling", 0.03),
}
"""All kinds of readings. No peak is among them: it depends on the cells, at the edges of ribs without limit."""


@dataclass(frozen=True, kw_only=True)
class Measured:
    """What was measured of a tire under one load and inflation pressure: give at least one reading.

    load: of the wheel, N; left out, that of the footprint. inflation_pressure: Pa; left out, the tire's own.
    deflection: m. net_area, gross_area: of the cells in contact, and inside their outline, m². length, width: of the
    print, m. spread_x, spread_y: standard deviations of x and y under the pressure, m. rib_shares: of the load, from
    left to right. ribs: edges of these across the tread, m. footprint: a `Footprint`, the path of one, or a table of
    what `read_footprint` takes with the path as "file"; shares of its load in blocks are compared, its middle laid on
    the computed one. pins: a `Footprint` of pins with shear that the tire rolled over, freely or at creepages, its
    path, or a table like that of a footprint; shear over load is compared in blocks, thirds of ribs by fifths of the
    load. They sample a part of the print, so that the load of the wheel must be given.
    effective_rolling_radius: of free rolling, m. longitudinal_stiffness: N. cornering_stiffness: N/rad.
    aligning_stiffness: N m/rad. lateral_stiffness: N/m, of the standing tire. relaxation_length: m.
    creepage_x, creepage_y: of a rolling tire, signs as in `Rolling`. tractive_force, lateral_force: of the road on it
    there, N. aligning_moment: there, N m.
    errors: standard deviation of readings by their names, in their SI units, or texts such as "0.3 mm" and "2 %".
    name: free text.
    Raises InputError for a reading that cannot be one, and where there is none.

    >>> measured = tl.footprint.Measured(load=30e3, deflection=0.03, errors={"deflection": "0.3 mm"})
    >>> size, given = measured.error("deflection", 0.03, {})
    >>> f"{size * 1e3:.1f} mm"
    '0.3 mm'
    """

    load: Force | None = None
    inflation_pressure: Pressure | None = None
    deflection: Length | None = None
    net_area: Area | None = None
    gross_area: Area | None = None
    length: Length | None = None
    width: Length | None = None
    spread_x: Length | None = None
    spread_y: Length | None = None
    rib_shares: tuple[Share, ...] | None = None
    ribs: tuple[Length, ...] | None = None
    footprint: Any = None
    pins: Any = None
    effective_rolling_radius: Length | None = None
    longitudinal_stiffness: Force | None = None
    cornering_stiffness: CorneringStiffness | None = None
    aligning_stiffness: AligningStiffness | None = None
    lateral_stiffness: SpringStiffness | None = None
    relaxation_length: Length | None = None
    creepage_x: Number | None = None
    creepage_y: Number | None = None
    tractive_force: Force | None = None
    lateral_force: Force | None = None
    aligning_moment: Moment | None = None
    errors: dict[str, float | str] | None = None
    name: str = ""

    def __post_init__(self) -> None:
        if not self.readings:
            raise InputError(f"a row of data needs a reading beside its load; known are {', '.join(READINGS)}")
        if self.load is not None:
            positive("the load of a row of data", self.load, "N", "a truck's wheel carries 20e3 to 60e3")
        elif self.footprint is None:
            raise InputError(f"a row of data needs its load in N, got {', '.join(self.readings)} alone")
        if self.inflation_pressure is not None:
            check_inflation_pressure(self.inflation_pressure)
        signed = ("tractive_force", "lateral_force", "aligning_moment", "rib_shares", "footprint", "pins")
        for name in self.readings:
            if name not in signed:
                positive(f"{name} of the data", getattr(self, name), READINGS[name].unit)
        self._check_ribs()
        forces = [name for name in self.readings if READINGS[name].how == "rolling"]
        slips = self.creepage_x is not None or self.creepage_y is not None
        if bool(forces) != slips and not (slips and self.pins is not None):
            raise InputError(
                "forces of a rolling tire go with creepage_x or creepage_y: "
                + (f"give the creepage at which {forces[0]} was measured" if forces else "no force was given")
            )
        self.check_errors(self.errors or {})
        for name in self.errors or {}:
            if name not in self.readings:
                raise InputError(f"errors names {name}, of which this row has no reading")

    def _check_ribs(self) -> None:
        if (self.rib_shares is None) != (self.ribs is None):
            raise InputError("rib_shares and ribs, their edges across the tread in m, go together")
        if self.rib_shares is None or self.ribs is None:
            return
        object.__setattr__(self, "rib_shares", tuple(float(share) for share in self.rib_shares))
        object.__setattr__(self, "ribs", tuple(float(rib) for rib in check_ribs(self.ribs)))
        if len(self.rib_shares) != len(self.ribs) - 1:
            raise InputError(f"{len(self.rib_shares)} rib_shares need one edge more, got {len(self.ribs)} in ribs")
        total = sum(self.rib_shares)
        if not (min(self.rib_shares) >= 0 and math.isclose(total, 1.0, abs_tol=0.02)):
            raise InputError(f"rib_shares must be ≥ 0 and make 1 together, got a sum of {total:.4g}")

    @staticmethod
    def check_errors(errors: Mapping[str, float | str]) -> None:
        """Raise InputError for errors of what is no reading, and for those that are no numbers."""
        for name, error in errors.items():
            if name not in READINGS:
                raise InputError(f"no reading is called {name!r}; {nearest(name, READINGS)}")
            value, _ = _error(name, error)
            positive(f"the error of {name}", value, READINGS[name].unit)

    @classmethod
    def load_deflection(cls, rows: Iterable[Iterable[float | str]]) -> list[Measured]:
        """Rows of (load, deflection) or (load, deflection, inflation pressure): SI, or texts with their units."""
        points = []
        for row in rows:
            values = list(row)
            if len(values) not in (2, 3):
                raise InputError(
                    f"a row of load_deflection is [load, deflection] or with the pressure behind, got {values!r}; "
                    'write ["10 kN", "14.1 mm", "8 bar"]'
                )
            numbers = [quantity(value, unit) for value, unit in zip(values, ("N", "m", "Pa"), strict=False)]
            pressure = numbers[2] if len(numbers) == 3 else None
            points.append(cls(load=numbers[0], deflection=numbers[1], inflation_pressure=pressure))
        return points

    @property
    def readings(self) -> tuple[str, ...]:
        """Names of what was measured."""
        return tuple(name for name in READINGS if getattr(self, name) is not None)

    def error(self, name: str, value: float, defaults: Mapping[str, float | str]) -> tuple[float, bool]:
        """Standard deviation of a reading of a value, SI, and whether it was given. defaults: for rows without it."""
        error = (self.errors or {}).get(name, defaults.get(name))
        row = READINGS[name]
        size, relative = (row.deviation, row.relative) if error is None else _error(name, error)
        return size * abs(value) if relative else size, error is not None

    def loaded(self, folder: str | os.PathLike[str] = ".") -> Measured:
        """The same with its footprint read and its load known. folder: that paths start from.

        Raises InputError for a footprint that cannot be read, or that carries another load than its row states.
        """
        pins = None if self.pins is None else _with_shear(_recorded("pins", self.pins, folder))
        if self.footprint is None:
            return self if pins is None else replace(self, pins=pins)
        recorded = _recorded("footprint", self.footprint, folder)
        carried = recorded.normal_load
        if not carried > 0:
            raise InputError("a footprint of the data carries no load, so that there is nothing to compare")
        load = self.load if self.load is not None else carried
        if abs(carried / load - 1) > _SAME_LOAD:
            raise InputError(
                f"a footprint of the data carries {carried / 1e3:.4g} kN and its row gives {load / 1e3:.4g} kN, "
                f"{100 * (carried / load - 1):+.3g} %, and at most {100 * _SAME_LOAD:g} % will do; give the "
                "load that it was taken under, or its unit"
            )
        return replace(self, load=load, footprint=recorded, pins=pins)

    __repr__ = as_call


@dataclass(frozen=True)
class Unknown:
    """A number that is sought.

    name: of a number of the tire (`treadload.tire.numbers`), or "friction". start: of the search; left out, what the
    tire has. low, high: between which it is sought. SI, or texts with their unit.
    Raises InputError for an unknown name, and for a start outside its bounds.

    >>> tl.footprint.Unknown("foundation", low=2.0, high=5.0).words
    'hold of the sidewalls per inflation pressure'
    """

    name: str
    start: float | str | None = None
    low: float | str | None = None
    high: float | str | None = None

    def __post_init__(self) -> None:
        if self.name != FRICTION and self.name not in NUMBERS:
            raise InputError(
                f"no number that could be fitted is called {self.name!r}; {nearest(self.name, [*NUMBERS, FRICTION])}"
            )
        for name in ("start", "low", "high"):
            value = getattr(self, name)
            if value is not None:
                object.__setattr__(self, name, quantity(value, self.unit.si))

    @property
    def unit(self) -> Unit:
        """What it is counted in."""
        return Unit("") if self.name == FRICTION else NUMBERS[self.name].unit

    @property
    def words(self) -> str:
        """What it is."""
        return "coefficient of friction" if self.name == FRICTION else NUMBERS[self.name].words

    def on(self, tire: Tire, friction: float) -> tuple[float, float, float]:
        """Start, low and high on a tire, SI. friction: that is there before. Raises InputError."""
        if self.name == FRICTION:
            friction_start, (low, high) = friction, _FRICTION_BOUNDS
        else:
            friction_start, (low, high) = NUMBERS[self.name].of(tire), NUMBERS[self.name].bounds(tire)
        start = friction_start if self.start is None else float(self.start)
        low = low if self.low is None else max(low, float(self.low))
        high = high if self.high is None else min(high, float(self.high))
        if not low < high:
            raise InputError(f"{self.name} is sought between {low:g} and {high:g}, which leaves nothing")
        if not low <= start <= high or not math.isfinite(start):
            raise InputError(
                f"the search for {self.name} starts at {start:g} {self.unit.si}, outside its bounds {low:g} to "
                f"{high:g}; move the start or the bounds"
            )
        return start, low, high

    __repr__ = as_call


def unknowns(wanted: Iterable[str | Unknown]) -> tuple[Unknown, ...]:
    """What is sought, by names or as it is. Raises InputError for none, and for a name that stands twice."""
    sought = tuple(
        name if isinstance(name, Unknown) else Unknown(name)
        for name in ([wanted] if isinstance(wanted, str) else wanted)
    )
    names = [unknown.name for unknown in sought]
    if not names:
        raise InputError(f"a calibration needs something to seek; known are {', '.join([*NUMBERS, FRICTION])}")
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"{twice} is sought twice; name it once")
    return sought


def _recorded(name: str, recorded: object, folder: str | os.PathLike[str]) -> Footprint:
    """A footprint of a row, read where it is a path or a table. name: of its key. Raises InputError."""
    if isinstance(recorded, str | os.PathLike):
        recorded = {"file": recorded}
    if isinstance(recorded, Mapping):
        options = dict(recorded)
        if "file" not in options:
            raise InputError(f'{name} of a row of data is a table without a file; give {name} = {{ file = "…" }}')
        recorded = read_footprint(Path(folder) / str(options.pop("file")), **options)
    elif isinstance(recorded, GridLoad):
        recorded = Footprint(recorded)
    if not isinstance(recorded, Footprint):
        raise InputError(f"{name} of a row of data must be a Footprint or a file, got {recorded!r}")
    return recorded


def _with_shear(pins: Footprint) -> Footprint:
    """Pins with shear. Raises InputError for a footprint of another kind."""
    if pins.pin is None or not pins.has_shear:
        what = "has no pins" if pins.pin is None else "has no shear"
        raise InputError(
            f"pins of a row of data need the three components of a pin table, and {pins.source or 'this footprint'} "
            f"{what}; "
            "give a map of pressure as footprint, or read a table with vertical, longitudinal and lateral"
        )
    return pins


def _error(name: str, error: float | str) -> tuple[float, bool]:
    """A standard deviation, and whether it is a part of the value."""
    row = READINGS[name]
    if isinstance(error, str) and error.strip().endswith("%") and row.unit:
        return quantity(error, ""), True
    value = quantity(error, row.unit)
    return float(np.asarray(value)), False
