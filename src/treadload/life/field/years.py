"""A life at the surface beside what roads show: the mechanics alone, and years by a named field shift."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.damage.field_shift import UNSUPPORTED, FieldShift
from treadload.damage.life import Life
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.life.field.standard_axles import standard_axles
from treadload.pavement import Pavement
from treadload.pavement.asphalt import bituminous_thickness
from treadload.rows import Row, row
from treadload.variables import dataset, display_of

SHARES = (0.05, 0.5, 0.95)
"""Shares of roads whose years are stated."""


@dataclass(frozen=True, eq=False)
class FieldYears(BaseResult, group="field_shift"):
    """Years of roads by a named shift, for every criterion of the surface.

    dataset: mechanics_years (criterion), by the line of a young mix, and field_years (criterion, road_share), by
    which that share of roads shows the first crack; NaN outside the shift's range. shift: by its name, with its
    data, error and range. outside: why the road lies outside its range; empty within. warnings: sentences for the
    user.

    >>> tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("axle", 1.0, wheel_load=32.5e3, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1.5e6), tl.damage.Climate.constant(15.0)
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    >>> top = tl.damage.Criterion("top", tl.damage.AgedLine(), 0, "top")
    >>> life = tl.solve_life(tl.Design(tire, road, traffic, climate, [top], spacing=0.03))
    >>> years = tl.life.field_years(life, road, tl.damage.field_shifts["LTPP"])
    >>> years.outside or "within the range of the shift"
    'within the range of the shift'
    """

    title: ClassVar[str] = "What roads show"
    subject: ClassVar[str] = "Years of roads by a named field shift"
    holds: ClassVar[Holds] = Holds(
        {"mechanics_years": "criterion", "field_years": "criterion road_share", "road_share": "road_share"},
        labels={"criterion": "criterion"},
        above_zero="mechanics_years field_years",
        positive="road_share",
    )

    dataset: xr.Dataset
    shift: FieldShift
    outside: str = ""
    stats: Mapping[str, float] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def rows(self) -> tuple[Row, ...]:
        """Mechanics alone and years of roads for every criterion, the shift, and what it does not support."""
        data, shift = self.dataset, self.shift
        rows: list[Row] = []
        label = display_of("field_years").label
        for name in map(str, data["criterion"].to_numpy()):
            at = data.sel(criterion=name)
            rows.append(row("mechanics_years", at["mechanics_years"], group=name))
            if not self.outside:
                rows += [
                    row("field_years", years, label=f"{label} at {100 * float(share):g} %", group=name)
                    for share, years in zip(data["road_share"], at["field_years"], strict=True)
                ]
        error = f"times or over {np.exp(shift.level_error):.2f}"
        rows.append(
            row(
                "field_shift",
                f"{shift.name}, {shift.date}: {shift.event} of {shift.sections} roads, median {shift.level:.2g} "
                f"years {error}, scatter {shift.scatter:.2f} of ln age; factor to the mechanics "
                f"{shift.factor():.2g}; {shift.likelihood}",
            )
        )
        rows.append(row("roads_show", shift.roads_show))
        if self.outside:
            rows.append(row("outside", f"{self.outside}: the mechanics alone"))
        rows.append(row("unsupported", UNSUPPORTED))
        return tuple(rows)


def field_years(life: Life, road: Pavement, shift: FieldShift) -> FieldYears:
    """Years of roads by a named shift, for every criterion of a life that reads tensile strain at the surface.

    The median is the predicted life by the line of a young mix times the shift's factor; 5 and 95 % are of the
    scatter of roads. Outside the range of the shift (asphalt, mean temperature of the surface, standard axles of the
    first year) the mechanics stand alone. Raises InputError for a life without
    such a criterion.

    >>> tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("axle", 1.0, wheel_load=32.5e3, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1.5e6), tl.damage.Climate.constant(15.0)
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    >>> top = tl.damage.Criterion("top", tl.damage.AgedLine(), 0, "top")
    >>> life = tl.solve_life(tl.Design(tire, road, traffic, climate, [top], spacing=0.03))
    >>> years = tl.life.field_years(life, road, tl.damage.field_shifts["LTPP"])
    >>> [f"{limit:.1f}" for limit in years.dataset.field_years.sel(criterion="top").values]  # 5, 50, 95 % of roads
    ['31.1', '106.5', '364.4']
    """
    names = list(json.loads(life.dataset.attrs.get("surface_lines", "{}")))
    if not names:
        raise InputError(
            f"the field shift {shift.name!r} is of cracks at the surface, and no criterion of this life reads "
            'tensile strain there; add one, place = "top" of layer 1'
        )
    mechanics = life.dataset["life_years_fresh_line"].sel(criterion=names).to_numpy()
    traffic = standard_axles(life.traffic)
    outside = shift.outside(bituminous_thickness(road, 0), _mean_surface(life), traffic)
    years = [
        [np.nan if outside else shift.shifted(float(predicted), share) for share in SHARES] for predicted in mechanics
    ]
    data = dataset(
        {
            "mechanics_years": (("criterion",), mechanics),
            "field_years": (("criterion", "road_share"), np.array(years)),
        },
        {"criterion": names, "road_share": list(SHARES)},
    )
    caveats = (f"outside the range of the field shift {shift.name!r}: {outside}",) if outside else ()
    return FieldYears(data, shift, outside, warnings=(*caveats, *shift.caveats[1:]))


def _mean_surface(life: Life) -> float:
    """Of the road's surface over the year, °C: of the top layer where a season has no temperature over depth."""
    seasons = life.climate.seasons
    return float(sum(season.share * season.temperatures[0] for season in seasons) / sum(s.share for s in seasons))
