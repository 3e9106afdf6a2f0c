"""What passes leave in a road: plastic strain, residual stress and the rut, pass by pass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
import xarray as xr

from treadload.composing import BaseResult, Holds
from treadload.describing import first_line
from treadload.pavement import Pavement
from treadload.response.fields import COMPONENTS
from treadload.response.loads import PlacedLoad
from treadload.response.passes.grid_error import relative
from treadload.response.passes.verdict import in_words
from treadload.tire import Tire

_TENSORS = " ".join(f"{name}_{c}" for name in ("plastic_strain", "residual_stress") for c in COMPONENTS)


@dataclass(frozen=True, eq=False)
class Passes(BaseResult, group="passes"):
    """Passes of a load over a road that yields.

    dataset: plastic_strain_*, residual_stress_* (Pa) and equivalent_plastic_strain over (pass, depth, y), the same
    all along travel; residual_displacement_z (m, down positive) over (pass, across), wider than y; by pass rut_depth
    and heave (m), plastic_increment and plastic_left, and wheel_offset (m); where laws are followed step by step
    peak_plastic_strain, the largest mean over a square of the width averaging_width (an attribute, m, half of
    that of the loaded patches), and peak_plastic_strain_error and rut_depth_error, as the attribute error_estimate
    describes. attrs: verdict and criterion; elastic_load_factor, the part of the load at which the road first yields;
    shakedown_load_factor where it was sought; falls, where the last pass adds less than the one before, by how much
    of it. stats: rounds, seconds, box.
    warnings: sentences. loads, road, speed: the question; of a drum on its track drum and normal_load, N, in the
    place of loads, and in the dataset pressure over (pass, y, x), and by pass approach, contact_length,
    contact_width, contact_area, peak_pressure, pressure_centre_x and rolling_resistance.
    """

    holds: ClassVar[Holds] = Holds(
        {
            "pass": "pass", "depth": "depth", "y": "y", "across": "across",
            f"{_TENSORS} equivalent_plastic_strain": "pass depth y",
            "residual_displacement_z": "pass across",
            "rut_depth heave plastic_increment plastic_left wheel_offset": "pass",
        },
        known="equivalent_plastic_strain residual_displacement_z rut_depth",
        numbers="yield_strain",
        texts="verdict criterion law",
        maybe_numbers="averaging_width shakedown_load_factor elastic_load_factor falls",
        sizes={"pass": (1, np.inf), "depth": (1, np.inf)},
        maybe={
            "x": "x",
            "peak_plastic_strain rut_depth_error peak_plastic_strain_error": "pass",
            "pressure": "pass y x",
            "approach contact_length contact_width contact_area peak_pressure pressure_centre_x rolling_resistance":
                "pass",
        },
        asked={"drum": "x pressure approach contact_length contact_width contact_area peak_pressure"},
    )  # fmt: skip

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()
    loads: tuple[PlacedLoad, ...] = ()
    road: Pavement | None = None
    speed: float | None = None
    drum: Tire | None = None
    normal_load: float | None = None

    @property
    def verdict(self) -> str:
        """Elastic, shakedown, cyclic or ratchetting."""
        return str(self.dataset.attrs["verdict"])

    @property
    def in_words(self) -> str:
        """The verdict as headlines tell it, with what more passes may change."""
        return in_words(self.verdict, self.dataset.attrs.get("falls"))

    def summary(self) -> str:
        """The verdict, the rut and where it yields most, by pass."""
        data, attrs = self.dataset, self.dataset.attrs
        numbers = data["pass"].to_numpy()
        lines = [f"Verdict after {numbers[-1]:g} pass(es): {self.in_words}; {attrs['law']}"]
        for name, words in (
            ("elastic_load_factor", "first yields at"),
            ("shakedown_load_factor", "shakes down up to"),
        ):
            if name in attrs and np.isfinite(attrs[name]):
                lines.append(f"the road {words} {100 * attrs[name]:.3g} % of this load")
        lines.append("pass   rut mm   heave mm   largest plastic strain %   added by the pass %")
        shown = np.unique(np.linspace(0, len(numbers) - 1, 10).round().astype(int))
        for row in shown:
            one = data.isel({"pass": row})
            lines.append(
                f"{numbers[row]:<6g} {_mm(one['rut_depth']):>6}   {_mm(one['heave']):>8}   "
                f"{100 * float(one['equivalent_plastic_strain'].max()):>24.3g}   "
                f"{100 * float(one['plastic_increment']):>19.3g}"
            )
        if {"peak_plastic_strain", "rut_depth_error", "peak_plastic_strain_error"} <= set(data):
            lines.append(
                f"error of the grid: rut {_part(data, 'rut_depth')}, largest plastic strain as a mean over "
                f"{1e3 * float(attrs.get('averaging_width', np.nan)):.3g} mm, "
                f"{100 * float(data['peak_plastic_strain'][-1]):.3g} %, "
                f"{_part(data, 'peak_plastic_strain')}, by cells of twice the size"
            )
        if "pressure" in data:
            lines.append("pass   sinks mm   contact long mm   wide mm   peak kPa   resists N")
            for row in shown:
                one = data.isel({"pass": row})
                lines.append(
                    f"{numbers[row]:<6g} {_mm(one['approach']):>8}   {_mm(one['contact_length']):>15}   "
                    f"{_mm(one['contact_width']):>7}   {float(one['peak_pressure']) / 1e3:>8.4g}   "
                    f"{float(one['rolling_resistance']):>9.4g}"
                )
        last = data["equivalent_plastic_strain"].isel({"pass": -1}).to_numpy()
        if last.any():
            row, column = np.unravel_index(int(last.argmax()), last.shape)
            lines.append(
                f"most strained at y = {float(data['y'][column]) * 1e3:.1f} mm, "
                f"{float(data['depth'][row]) * 1e3:.1f} mm deep"
            )
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])

    __repr__ = first_line


def _part(data: xr.Dataset, name: str) -> str:
    """Error of a number after the last pass that has it, as a part of the number."""
    off = relative(data[f"{name}_error"].to_numpy(), data[name].to_numpy())
    return f"{100 * off:.2g} %" if np.isfinite(off) else "unknown"


def _mm(length: xr.DataArray) -> str:
    return f"{float(length) * 1e3:.3g}"
