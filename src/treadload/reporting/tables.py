"""Tables of results and statistics: a row for each quantity, a column for each case."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from treadload.plots.kit.plan import KPA, MICRO, Plan, plane, without_round_off
from treadload.plots.kit.style import measure, power_of_ten, signed, thousands
from treadload.reporting.reading import ReportCase

MISSING = "–"


@dataclass(frozen=True)
class Row:
    """A quantity, its unit, and its value for every case, as text. note: a word about it."""

    name: str
    unit: str
    values: tuple[str, ...]
    note: str = ""


@dataclass(frozen=True)
class Section:
    """Rows under a heading."""

    heading: str
    rows: tuple[Row, ...]


def result_table(cases: list[ReportCase]) -> list[Section]:
    """What came out: forces and contact, strain, verdict; rows that no case can fill are left out."""
    contact = _column(cases, "contact")
    damage = _column(cases, "damage")
    sections = [
        Section(
            "Contact",
            (
                contact("normal load", "kN", lambda d: f"{float(d['normal_load']) / 1e3:.2f}"),
                contact("tractive force", "kN", lambda d: _force(d, "tractive_force"), "positive when driving"),
                contact("lateral force", "kN", lambda d: _force(d, "lateral_force"), "to the right"),
                contact("aligning moment", "N m", lambda d: _near_zero(float(d["aligning_moment"]), 1)),
                contact("approach of tire and road", "mm", lambda d: f"{float(d['approach']) * 1e3:.2f}"),
                contact("contact area", "mm²", lambda d: thousands(_area(d))),
                contact("mean pressure", "kPa", lambda d: f"{float(d['normal_load']) * 1e3 / _area(d):.0f}"),
                contact("peak pressure", "kPa", lambda d: measure(float(np.nanmax(plane(d, "pressure"))) * KPA)),
                contact("peak shear", "kPa", lambda d: measure(float(_shear(d).max()) * KPA)),
                contact("longitudinal creepage", "–", lambda d: _creepage(d, "creepage_x"), "negative when driving"),
                contact("lateral creepage", "–", lambda d: _creepage(d, "creepage_y")),
                contact("spin", "rad/m", lambda d: _near_zero(float(d["spin"]), 4)),
                contact("share of the contact that slips", "%", lambda d: f"{_slip(d):.1f}"),
            ),
        ),
        Section(
            f"Largest extension strain at points {cases[0].depth_in_words}: near the edges of ribs it depends on the "
            "cells",
            tuple(_strain_rows(cases)),
        ),
        Section(
            "Fatigue and cracks",
            (
                damage(
                    "ε₆, strain at a million passes", "microstrain", lambda d: f"{d.attrs['epsilon_6'] * MICRO:g}"
                ),
                damage("slope of the fatigue line", "–", lambda d: signed(float(d.attrs["slope"]), 2)),
                Row("strain that the line reads", "", tuple(case.reads or MISSING for case in cases)),
                Row("read under", "", tuple(case.read_under or MISSING for case in cases)),
                damage("worst strain read", "microstrain", lambda d: f"{float(d['worst_strain']) * MICRO:.1f}"),
                damage("its place", "mm", _worst_place),
                damage(
                    "worst strain over ε₆", "–", lambda d: f"{float(d['worst_strain']) / d.attrs['epsilon_6']:.2f}"
                ),
                damage("allowable passes", "–", lambda d: power_of_ten(float(d["worst_passes"]))),
                Row("first crack", "", tuple(case.first_crack or MISSING for case in cases)),
                damage(
                    "its trace, from travel", "°", lambda d: _degrees(d, "worst_crack_angle"), "positive to the right"
                ),
                damage("dip of its plane from the horizontal", "°", lambda d: _degrees(d, "worst_crack_dip")),
            ),
        ),
    ]
    return _filled(sections)


def statistics_table(cases: list[ReportCase]) -> list[Section]:
    """How it was solved: iterations, residuals, cells, seconds."""
    sections = []
    for group, heading in (("contact", "Contact solver"), ("response", "Response")):
        statistics = [case.statistics(group) for case in cases]
        names = list(dict.fromkeys(name for stats in statistics for name in stats))
        rows = tuple(
            Row(
                _STATISTICS.get(name, name.replace("_", " ")),
                "s" if name == "seconds" else "",
                tuple(_number(stats.get(name)) for stats in statistics),
            )
            for name in names
        )
        sections.append(Section(heading, rows))
    return _filled(sections)


_STATISTICS = {
    "normal_iterations": "iterations of the normal contact",
    "normal_residual": "residual of the normal contact",
    "newton_iterations": "Newton iterations of the rolling contact",
    "krylov_iterations": "Krylov iterations of the rolling contact",
    "splitting_iterations": "splitting iterations of the rolling contact",
    "rolling_residual": "residual of the rolling contact",
    "coupling_rounds": "rounds between normal and rolling contact",
    "coupling_change": "last change of the pressure between rounds",
    "dundurs": "Dundurs' β of tire and road",
    "seconds": "time",
}


def _column(cases: list[ReportCase], group: str) -> Callable[..., Row]:
    def row(name: str, unit: str, read: Callable[[xr.Dataset], str], note: str = "") -> Row:
        return Row(name, unit, tuple(_read(case.group(group), read) for case in cases), note)

    return row


def _read(data: xr.Dataset | None, read: Callable[[xr.Dataset], str]) -> str:
    """The text that `read` makes, or a dash where the dataset lacks what it needs (a measured footprint does)."""
    if data is None:
        return MISSING
    try:
        return read(data)
    except (KeyError, ZeroDivisionError):
        return MISSING


def _worst_place(data: xr.Dataset) -> str:
    x, y, depth = (1e3 * float(data[f"worst_{name}"]) for name in ("x", "y", "depth"))
    return f"x = {signed(x, 1)}, y = {signed(y, 1)}, {depth:g} deep"


def _strain_rows(cases: list[ReportCase]) -> list[Row]:
    rows = []
    for strain, name in (("principal", "three-dimensional"), ("in-plane", "in the horizontal plane")):
        worst = [case.worst(strain) for case in cases]
        rows += [
            Row(name, "microstrain", tuple(MISSING if w is None else f"{w.strain:.1f}" for w in worst)),
            Row(f"{name}: where", "", tuple(MISSING if w is None else w.place for w in worst)),
            Row(f"{name}: direction", "", tuple(MISSING if w is None else w.direction for w in worst)),
        ]
    deepest = [case.worst_in_sections() for case in cases]
    # Below the edges of ribs the largest extension at points can lie below the surface.
    rows += [
        Row(
            "in the vertical sections",
            "microstrain",
            tuple(MISSING if w is None else f"{w.strain:.1f}" for w in deepest),
        ),
        Row("in the vertical sections: where", "", tuple(MISSING if w is None else w.place for w in deepest)),
    ]
    return rows


def _filled(sections: list[Section]) -> list[Section]:
    kept = [
        Section(s.heading, tuple(row for row in s.rows if any(value != MISSING for value in row.values)))
        for s in sections
    ]
    return [section for section in kept if section.rows]


def _area(data: xr.Dataset) -> float:
    """Area of the cells in contact, mm²."""
    plan = Plan.of(data)
    return float(np.outer(np.diff(plan.y_edges), np.diff(plan.x_edges))[plane(data, "pressure") > 0].sum())


def _shear(data: xr.Dataset) -> Any:
    data = without_round_off(data)
    return np.hypot(plane(data, "traction_x"), plane(data, "traction_y"))


def _slip(data: xr.Dataset) -> float:
    state = plane(data, "state")
    return 100 * float((state == 2).sum()) / max(1, int((state > 0).sum()))


def _force(data: xr.Dataset, name: str) -> str:
    return _near_zero(float(data[name]) / 1e3, 2)


def _creepage(data: xr.Dataset, name: str) -> str:
    return _near_zero(float(data[name]), 5)


def _near_zero(value: float, digits: int) -> str:
    """A number without the sign of round-off."""
    return signed(round(value, digits), digits)


def _degrees(data: xr.Dataset, name: str) -> str:
    value = float(data[name])
    return MISSING if math.isnan(value) else signed(math.degrees(value), 0)


def _number(value: Any) -> str:
    if value is None:
        return MISSING
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, int | float):
        return str(value)
    if float(value).is_integer() and abs(value) < 1e9:
        return thousands(float(value))
    if abs(value) >= 0.01:
        return f"{value:.3g}"
    return power_of_ten(value) if value > 0 else f"{value:.2g}".replace("-", "\u2212")
