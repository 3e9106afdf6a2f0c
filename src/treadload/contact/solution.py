"""The result of a contact: fields, scalars, and how they were solved."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from treadload.composing import BaseResult, Holds
from treadload.contact.rolling_state import Rolling
from treadload.pavement import Pavement
from treadload.tire import Tire
from treadload.units import stress_in_words


@dataclass(frozen=True, eq=False)
class Contact(BaseResult, group="contact"):
    """Pressure and shear between a tire and a road, with the question that was asked.

    dataset: fields on (y, x) and scalars, named and signed as docs/explanation/conventions.md says.
    stats: iterations, residuals, seconds. warnings: sentences for the user.
    """

    holds: ClassVar[Holds] = Holds(
        {
            "pressure traction_x traction_y state": "y x",
            "approach normal_load tractive_force lateral_force aligning_moment creepage_x creepage_y spin": "",
        },
        maybe={"friction_work_total friction_power_total": "", "flash_temperature road_height": "y x"},
        numbers="dx dy",
        positive="dx dy",
        stats=("road_share layer_share layers_solved",),
    )

    dataset: xr.Dataset
    tire: Tire
    road: Pavement
    rolling: Rolling
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    @property
    def cell_area(self) -> float:
        """Area of a cell, m²."""
        return float(self.dataset.attrs["dx"] * self.dataset.attrs["dy"])

    @property
    def area(self) -> float:
        """Area of the cells in contact, m²."""
        return float((self.dataset.pressure > 0).sum()) * self.cell_area

    @property
    def slip_fraction(self) -> float:
        """Share of the contact area that slips."""
        state = self.dataset.state.values
        return float((state == 2).sum() / max(1, (state > 0).sum()))

    def summary(self) -> str:
        """A screenful: load, area, peaks, creepages, stick and slip, work lost by sliding."""
        d = self.dataset
        shear = np.hypot(d.traction_x, d.traction_y)
        dx, dy = d.attrs["dx"] * 1e3, d.attrs["dy"] * 1e3
        area = self.area
        mean = float(d.normal_load) / area / 1e3 if area else np.nan
        lines = [
            f"contact       {self.rolling}",
            f"grid          {d.sizes['x']} x {d.sizes['y']} cells of {dx:g} x {dy:g} mm",
            f"normal load   {float(d.normal_load) / 1e3:.3f} kN at an approach of {float(d.approach) * 1e3:.2f} mm",
            f"contact area  {area * 1e6:.0f} mm², mean pressure {mean:.0f} kPa",
            f"peak pressure {stress_in_words(float(d.pressure.max()))}",
            f"peak shear    {stress_in_words(float(shear.max()))}",
            f"forces        Qx = {float(d.tractive_force):z.1f} N, Qy = {float(d.lateral_force):z.1f} N, "
            f"aligning moment {float(d.aligning_moment):z.1f} N m",
            f"creepage      x {float(d.creepage_x):z.5f}, y {float(d.creepage_y):z.5f}, spin {float(d.spin):g} rad/m",
            f"slip zone     {100 * self.slip_fraction:.1f} % of the contact area",
        ]
        if "road_height" in d:
            low, high = float(d.road_height.min()) * 1e3, float(d.road_height.max()) * 1e3
            lines.insert(1, f"road          no plane: {low:.3g} to {high:.3g} mm below the tread")
        if self.tire.fixed_grid is not None:
            lines.insert(1, f"tread         {self.tire.surface}")
        if "road_share" in self.stats:
            lines.append(self._road_line())
        if "friction_work_total" in d:
            power = f", {float(d.friction_power_total):.1f} W" if "friction_power_total" in d else ""
            lines.append(f"sliding loses {float(d.friction_work_total):z.3f} J per m travelled{power}")
        if "flash_temperature" in d:
            lines.append(f"flash heat    {float(d.flash_temperature.max()):.1f} K at most")
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    def _road_line(self) -> str:
        share, change = 100 * self.stats["road_share"], 100 * self.stats["layer_share"]
        line = f"road          gives {share:.3g} % of the compliance: {'negligible' if share < 1 else 'it matters'}"
        if self.road.is_homogeneous:
            return line
        how = "they are in" if self.stats["layers_solved"] else "left out"
        size = f"{change:+.2g}" if abs(change) < 10 else f"{change:+.0f}"
        return f"{line}; its layers change it by {size} %, {how}"

    def __repr__(self) -> str:
        peak = float(self.dataset.pressure.max()) / 1e3
        return f"<Contact {self.rolling}: {self.area * 1e6:.0f} mm², {peak:.0f} kPa peak>"
