"""A crack's growth through a road: when it starts, how deep it is when, and how likely."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.composing import BaseResult, Holds
from treadload.damage.growth.options import CrackGrowth
from treadload.deferred import xarray as xr
from treadload.rows import Row, row
from treadload.units import years_in_words

# Years that differ by less than this part are those of one place.
_ALIKE = 0.005
MODES = ("I", "II", "III", "Irwin")


@dataclass(frozen=True, eq=False)
class Growth(BaseResult, group="growth"):
    """How a crack grows through a road under a traffic.

    dataset, over crack_depth (m, of the tip from the mouth, the first that of initiation, the last the end of the
    layers), y (m, across the wheel path): initiation_passes (y); growth_passes (crack_depth, y), from the opening;
    growth_rate (solved_depth, y), m per pass of the whole traffic; reach_years, reach_passes (crack_depth), at the
    one place where the end, or else the most, is reached first, worst_y; earliest_years, earliest_y, where a crack
    starts first, which may be another place; risk_years (risk, crack_depth) at worst_y; where the road
    has a design life reach_chance (crack_depth); stress_intensity_range (axle_class, solved_depth, mode) at worst_y
    with no wander, in the season where it is largest; crack_offset (crack_depth), of a path that is not vertical.
    Where both directions grow side by side, direction_years (direction, crack_depth) and direction_y (direction) of
    each where it is through first, direction_earliest_years and direction_earliest_y (direction) where it starts
    first; the rest is that of the crack which is through first.
    Where the climate asks for daily thermal stress: thermal_intensity_range (month, solved_depth), Pa √m, and what it
    adds, thermal_growth_rate (solved_depth), m per year, which growth_rate contains as shared between the passes of
    the year in which the crack starts.
    asked: how it grows. stats: solves, seconds. warnings: sentences for the user.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> law = tl.damage.ParisLaw(1e-7, 4.0)
    >>> growth = tl.life.grow_cracks(design, life, tl.damage.CrackGrowth("base", law=law, steps=3, points=20))
    >>> [f"{years:.1f} years" for years in growth.dataset.reach_years.values[[0, -1]]]  # starts, is through
    ['1.2 years', '79.1 years']
    """

    title: ClassVar[str] = "Crack growth"
    subject: ClassVar[str] = "How a crack grows through a layer"
    holds: ClassVar[Holds] = Holds(
        {
            "initiation_passes": "y",
            "growth_passes": "crack_depth y",
            "growth_rate": "solved_depth y",
            "reach_years reach_passes crack_offset": "crack_depth",
            "risk_years": "risk crack_depth",
            "stress_intensity_range": "axle_class solved_depth mode",
            "worst_y": "",
            "crack_depth": "crack_depth",
            "solved_depth": "solved_depth",
            "risk": "risk",
        },
        maybe={
            "reach_chance": "crack_depth",
            "earliest_years earliest_y": "",
            "direction_years": "direction crack_depth",
            "direction_y direction_earliest_years direction_earliest_y": "direction",
            "thermal_growth_rate": "solved_depth",
            "thermal_intensity_range": "month solved_depth",
        },
        labels={"axle_class": "axle_class", "mode": "mode"},
        values={"mode": MODES},
        texts="grows starts",
        maybe_numbers="design_years",
        sizes={"crack_depth": (2, math.inf), "y": (1, math.inf), "risk": (1, math.inf)},
        together=("design_years",),
    )

    dataset: xr.Dataset
    asked: CrackGrowth
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def depths(self) -> np.ndarray:
        """Depths of the tip from the mouth, m: of initiation, then as asked, then the end of the layers."""
        return self.dataset["crack_depth"].to_numpy()

    def years_to(self, depth: float) -> float:
        """Years from the opening until the first crack is so deep, m; inf if never. Between depths: linear."""
        return float(np.interp(depth, self.depths, self.dataset["reach_years"].to_numpy()))

    def risk_years_to(self, depth: float) -> dict[float, float]:
        """Risk → years by which so large a share of roads has a crack so deep, m."""
        rows = self.dataset["risk_years"].to_numpy()
        return {
            float(risk): float(np.interp(depth, self.depths, row))
            for risk, row in zip(self.dataset["risk"].to_numpy(), rows, strict=True)
        }

    @property
    def heading(self) -> str:
        """Through which layers it grows."""
        return str(self.dataset.attrs["grows"])

    def rows(self) -> tuple[Row, ...]:
        """Years until the crack starts, reaches depths and is through, with scatter; its cause; the assessment."""
        data = self.dataset
        rows = [row("growth_starts", str(data.attrs["starts"]))]
        last = len(self.depths) - 1
        for k, depth in enumerate(self.depths):
            stage = "initiation" if k == 0 else "end of its way" if k == last else "growth"
            name = f"{stage}, {depth * 1e3:.1f} mm"
            rows.append(row("reach_years", data["reach_years"][k], group=name))
            rows += [
                row("risk_years", years, label=f"at a risk of {100 * float(risk):g} %", group=name)
                for risk, years in zip(data["risk"], data["risk_years"][:, k], strict=True)
            ]
        ranges = data["stress_intensity_range"].max("solved_depth")
        most = int(ranges.sel(mode="Irwin").to_numpy().argmax())
        axles = str(data["axle_class"].to_numpy()[most])
        rows += [
            row("stress_intensity_range", ranges[most].sel(mode=mode), label=f"largest range of K_{mode}", note=axles)
            for mode in MODES[:3]
        ]
        if "thermal_intensity_range" in data:
            daily = data["thermal_intensity_range"].max("solved_depth").to_numpy()
            month = str(data["month"].to_numpy()[int(daily.argmax())])
            rows.append(row("thermal_intensity_range", float(daily.max()), note=month))
        rows.append(row("worst_y", data["worst_y"], note="first through here, and started here"))
        rows += self._elsewhere()
        rows += self._directions()
        if self._chance is not None:
            years = f"{float(data.attrs['design_years']):g} years"
            rows.append(row("reach_chance", self._chance, note=years))
        return (*rows, row("verdict", self._verdict()))

    def _directions(self) -> list[Row]:
        """When and where a crack of each direction starts first and is through first, if both grow side by side."""
        data, rows = self.dataset, []
        stages = (
            ("starts", "direction_earliest_years", "direction_earliest_y"),
            ("is through", "direction_years", "direction_y"),
        )
        for verb, key, place in stages:
            if key not in data or place not in data:
                continue
            by_direction = data[key].to_numpy().reshape(data.sizes["direction"], -1)[:, -1]
            rows += [
                row(key, years, label=f"{name} crack {verb} after", note=f"at y = {1e3 * y:z.0f} mm")
                for name, years, y in zip(
                    data["direction"].to_numpy(), by_direction, data[place].to_numpy(), strict=True
                )
            ]
        return rows

    def _elsewhere(self) -> list[Row]:
        """Where another crack starts earlier, which is through later; none where the same is first in both."""
        data = self.dataset
        if "earliest_years" not in data or "earliest_y" not in data:
            return []
        earlier = float(data["earliest_years"])
        if not earlier < (1 - _ALIKE) * float(data["reach_years"][0]):
            return []
        place = f"at y = {1e3 * float(data['earliest_y']):z.0f} mm, where it is through later"
        return [row("earliest_years", earlier, note=place)]

    @property
    def _chance(self) -> float | None:
        """Share of roads that are cracked through within the design life; None without one."""
        data = self.dataset
        has_chance = "reach_chance" in data and "design_years" in data.attrs
        return float(data["reach_chance"][-1]) if has_chance else None

    def _verdict(self) -> str:
        data = self.dataset
        start, end = float(data["reach_years"][0]), float(data["reach_years"][-1])
        if math.isinf(start):
            return "no crack ever starts under this traffic."
        if math.isinf(end):
            return f"a crack starts after {years_in_words(start)} and does not grow to the end of its way."
        sentence = f"a crack starts after {years_in_words(start)} and is through after {years_in_words(end)}"
        if self._chance is not None:
            years = f"{float(data.attrs['design_years']):g} years"
            sentence += f"; {100 * self._chance:.0f} % of such roads are cracked through within {years}"
        return f"{sentence}."
