"""A crack's growth through a road: when it starts, how deep it is when, and how likely."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from treadload.composing import BaseResult, Holds
from treadload.damage.growth.asked import CrackGrowth
from treadload.describing import first_line

MODES = ("I", "II", "III", "Irwin")


@dataclass(frozen=True, eq=False)
class Growth(BaseResult, group="growth"):
    """How a crack grows through a road under a traffic.

    dataset, over crack_depth (m, of the tip from the mouth, the first that of initiation, the last the end of the
    layers), y (m, across the wheel path): initiation_passes (y); growth_passes (crack_depth, y), from the opening;
    growth_rate (solved_depth, y), m per pass of the whole traffic; reach_years, reach_passes (crack_depth), at the
    place where the end, or else the most, is reached first, worst_y; risk_years (risk, crack_depth); where the road
    has a design life reach_chance (crack_depth); stress_intensity_range (axle_class, solved_depth, mode) at worst_y
    with no wander, in the season where it is largest; crack_offset (crack_depth), of a path that is not vertical.
    asked: how it grows. stats: solves, seconds. warnings: sentences for the user.
    """

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
        maybe={"reach_chance": "crack_depth"},
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

    def summary(self) -> str:
        """Years to initiation, to each depth and to the end, with what scatters; what drives the growth."""
        data = self.dataset
        years, risks = data["reach_years"].to_numpy(), data["risk"].to_numpy()
        lines = [f"crack growth {data.attrs['grows']}", f"  starts: {data.attrs['starts']}"]
        for k, depth in enumerate(self.depths):
            spread = ", ".join(
                f"{_years(float(data['risk_years'][r, k]))} at {100 * risk:g} %" for r, risk in enumerate(risks)
            )
            what = "initiation" if k == 0 else "end of its way" if k == len(years) - 1 else "growth"
            lines.append(f"  {depth * 1e3:5.1f} mm, {what}: {_years(float(years[k]))} ({spread})")
        ranges = data["stress_intensity_range"].max("solved_depth")
        most = int(ranges.sel(mode="Irwin").to_numpy().argmax())
        parts = ", ".join(f"K_{mode} {float(ranges[most].sel(mode=mode)) / 1e6:.3g}" for mode in MODES[:3])
        lines.append(
            f"  largest ranges, MPa √m: {parts} by {data['axle_class'].to_numpy()[most]}; "
            f"first at y = {float(data['worst_y']) * 1e3:z.0f} mm"
        )
        lines.append("Verdict: " + self._verdict())
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    def _verdict(self) -> str:
        data = self.dataset
        start, end = float(data["reach_years"][0]), float(data["reach_years"][-1])
        if math.isinf(start):
            return "no crack ever starts under this traffic."
        if math.isinf(end):
            return f"a crack starts after {_years(start)} and does not grow to the end of its way."
        said = f"a crack starts after {_years(start)} and is through after {_years(end)}"
        if "reach_chance" in data and "design_years" in data.attrs:
            chance = 100 * float(data["reach_chance"][-1])
            said += f"; {chance:.0f} % of such roads are cracked through within {data.attrs['design_years']:g} years"
        return said + "."

    __repr__ = first_line


def _years(years: float) -> str:
    return "never" if math.isinf(years) else f"{years:.3g} years"
