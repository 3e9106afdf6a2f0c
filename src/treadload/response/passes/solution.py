"""What passes leave in a road: plastic strain, residual stress and the rut, pass by pass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.citations import DENTS, PASSES
from treadload.composing import BaseResult, Holds
from treadload.deferred import xarray as xr
from treadload.kernels.largest import index_of_largest
from treadload.pavement import Pavement
from treadload.response.fields import COMPONENTS
from treadload.response.loads import PlacedLoad
from treadload.response.passes.grid_error import relative
from treadload.response.passes.verdict import in_words
from treadload.rows import Row, row
from treadload.tire import Tire
from treadload.variables import SAMPLE

# Row and variable by pass; of a drum as well.
_BY_PASS = (
    ("rut_depth",) * 2, ("heave",) * 2, ("largest_plastic_strain", "equivalent_plastic_strain"),
    ("plastic_increment",) * 2,
)  # fmt: skip
_OF_DRUM = (
    ("approach",) * 2, ("contact_length",) * 2, ("contact_width",) * 2, ("largest_pressure", "peak_pressure"),
    ("rolling_resistance",) * 2,
)  # fmt: skip
_TENSORS = " ".join(f"{name}_{c}" for name in ("plastic_strain", "residual_stress") for c in COMPONENTS)


@dataclass(frozen=True, eq=False)
class Passes(BaseResult, group="passes"):
    """Passes of a load over a road that yields.

    dataset: plastic_strain_*, residual_stress_* (Pa) and equivalent_plastic_strain over (pass, depth, y), the same
    all along travel; residual_displacement_z (m, down positive) over (pass, across), wider than y; by pass rut_depth
    and heave (m), plastic_increment and plastic_left, and wheel_offset (m); where laws are followed step by step
    peak_plastic_strain, the largest mean over a square of the width averaging_width (an attribute, m, half of
    that of the loaded patches), and peak_plastic_strain_error and rut_depth_error, as the attribute error_estimate
    describes; NaN while fewer than four cells yield, down or across. attrs: verdict and criterion;
    elastic_load_factor, the part of the load at which the road first yields;
    shakedown_load_factor where it was sought; falls, where the last pass adds less than the one before, by how much
    of it. stats: rounds, seconds, box.
    warnings: sentences. loads, road, speed: the question; of a drum on its track drum and normal_load, N, in the
    place of loads, and in the dataset pressure over (pass, y, x), and by pass approach, contact_length,
    contact_width, contact_area, peak_pressure, pressure_centre_x and rolling_resistance.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(0.4e6, kinematic=60e6))
    >>> tire, road = tl.UniformDisc(0.1, 0.3e6), tl.Pavement.half_space(yielding)
    >>> passes = tl.response.roll_passes(tire, road, passes=3, spacing=0.05, layers=4)
    >>> f"{passes.verdict}; first yield at {0.3 * passes.dataset.attrs['elastic_load_factor']:.1f} MPa"
    'elastic; first yield at 0.7 MPa'
    """

    title: ClassVar[str] = "Load repetitions on a road that yields"
    subject: ClassVar[str] = "What passes leave in a road"
    holds: ClassVar[Holds] = Holds(
        {
            "pass": "pass", "depth": "depth", "y": "y", "across": "across",
            f"{_TENSORS} equivalent_plastic_strain": "pass depth y",
            "residual_displacement_z": "pass across",
            "rut_depth heave plastic_increment plastic_left wheel_offset": "pass",
        },
        not_nan="equivalent_plastic_strain residual_displacement_z rut_depth",
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
        with_field={"drum": "x pressure approach contact_length contact_width contact_area peak_pressure"},
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
        """The assessment in the words of a headline, with what more passes may change."""
        return in_words(self.verdict, self.dataset.attrs.get("falls"))

    @property
    def heading(self) -> str:
        """The law of the road."""
        return str(self.dataset.attrs["law"])

    def cites(self) -> tuple[str, ...]:
        """Methods of plastic strain under passes; those of the contact, too, where a drum rolls."""
        return (*PASSES, *(() if self.drum is None else DENTS))

    def rows(self) -> tuple[Row, ...]:
        """Where it first yields, the rut pass by pass, errors of the grid, where it yields most, the assessment."""
        data, attrs = self.dataset, self.dataset.attrs
        numbers = data["pass"].to_numpy()
        lines = [
            row(name, attrs[name])
            for name in ("elastic_load_factor", "shakedown_load_factor")
            if name in attrs and np.isfinite(attrs[name])
        ]
        of_drum = _OF_DRUM if "pressure" in data else ()
        for number in np.unique(np.linspace(0, len(numbers) - 1, 10).round().astype(int)):
            lines += [
                row(key, float(data[name][number].max()), group=f"pass {numbers[number]:g}", display=SAMPLE.get(key))
                for key, name in (*_BY_PASS, *of_drum)
            ]
        if {"peak_plastic_strain", "rut_depth_error", "peak_plastic_strain_error"} <= set(data):
            mean = f"mean over {1e3 * float(attrs.get('averaging_width', np.nan)):.3g} mm"
            lines.append(row("peak_plastic_strain", float(data["peak_plastic_strain"][-1]), note=mean))
            lines += [
                row(f"{name}_error", f"{_part(data, name)}, by cells of twice the size")
                for name in ("rut_depth", "peak_plastic_strain")
            ]
        last = data["equivalent_plastic_strain"].isel({"pass": -1}).to_numpy()
        if last.any():
            deep, across = index_of_largest(last, horizontal=1)
            place = f"at y = {float(data['y'][across]) * 1e3:.1f} mm, {float(data['depth'][deep]) * 1e3:.1f} mm deep"
            lines.append(row("largest_plastic_strain", float(last.max()), note=place))
        return (*lines, row("verdict", f"after {numbers[-1]:g} pass(es): {self.in_words}"))


def _part(data: xr.Dataset, name: str) -> str:
    """Error of a number after the last pass that has it, as a part of the number."""
    off = relative(data[f"{name}_error"].to_numpy(), data[name].to_numpy())
    return f"{100 * off:.2g} %" if np.isfinite(off) else "not estimated"
