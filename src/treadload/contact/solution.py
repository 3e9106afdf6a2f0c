"""The result of a contact: fields, scalars, and how they were solved."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from treadload.composing import BaseResult, Columns, Holds
from treadload.contact.rolling_state import Rolling
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.largest import index_of_largest
from treadload.materials import Orthotropic, Prony, TransverselyIsotropic
from treadload.pavement import Pavement
from treadload.rows import Place, Row, row
from treadload.tire import Tire
from treadload.tire.rib_rows import shares_of_rows

_SCALARS = ("tractive_force", "lateral_force", "aligning_moment", "creepage_x", "creepage_y", "spin")
_LOSSES = ("friction_work_total", "friction_power_total", "flash_temperature")


@dataclass(frozen=True, eq=False)
class Contact(BaseResult, group="contact"):
    """Pressure and shear between a tire and a road, with the question that was asked.

    dataset: fields on (y, x) and scalars, named and signed as in docs/explanation/conventions.md.
    stats: iterations, residuals, seconds. warnings: sentences for the user.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35))
    >>> contact = tl.solve_contact(tire, road, tl.Rolling(normal_load=100.0, friction=0.7), spacing=0.006)
    >>> f"{100.0 / contact.area / 1e3:.0f} kPa on average"
    '132 kPa on average'
    """

    columns: ClassVar[Columns] = Columns("Contact", "Contact solver")
    title: ClassVar[str] = "Contact"
    holds: ClassVar[Holds] = Holds(
        {
            "pressure traction_x traction_y state": "y x",
            "approach normal_load tractive_force lateral_force aligning_moment creepage_x creepage_y spin": "",
        },
        maybe={
            "friction_work_total friction_power_total friction pressure_centre_x rolling_resistance_moment": "",
            "initial_gap gap displacement_x displacement_y displacement_z slip_x slip_y": "y x",
            "friction_coefficient friction_work friction_power flash_temperature road_height": "y x",
        },
        finite="pressure traction_x traction_y approach spin normal_load tractive_force lateral_force",
        bounded="initial_gap gap displacement_x displacement_y displacement_z",
        codes={"state": 3},
        numbers="dx dy",
        positive="dx dy",
        tree="x y pressure",
        agree=lambda data: _check_slip(data),
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
        """Area of the cells in contact, m²; of ribs what these cells stand for, see `tire.rib_rows`."""
        touching = (self.dataset.pressure > 0).sum("x").to_numpy()
        if self.tire.ribs:
            y, dy = self.dataset.y.to_numpy(), float(self.dataset.attrs["dy"])
            return float(touching @ shares_of_rows(y, dy, self.tire.ribs)) * self.cell_area
        return float(touching.sum()) * self.cell_area

    @property
    def slip_fraction(self) -> float:
        """Share of the contact area that slips."""
        state = self.dataset.state.values
        return float((state == 2).sum() / max(1, (state > 0).sum()))

    @property
    def heading(self) -> str:
        """Load, friction and rolling state."""
        return str(self.rolling)

    def rows(self) -> tuple[Row, ...]:
        """Load, area, peaks, forces, creepages, stick and slip, energy lost by sliding."""
        d, area = self.dataset, self.area
        shear = xr.DataArray(np.hypot(d.traction_x, d.traction_y), d.pressure.coords, d.pressure.dims)
        sizes = f"{d.sizes['x']} x {d.sizes['y']} cells of {d.attrs['dx'] * 1e3:g} x {d.attrs['dy'] * 1e3:g} mm"
        # Pressure and shear grow without bound towards the wall of a rib.
        at_wall = "depends on the cells at the walls of ribs" if self.tire.tread == "ribs" else ""
        lines = [row("grid", sizes)]
        if self.tire.fixed_grid is not None:
            lines.insert(0, row("tread", str(self.tire.surface)))
        if "road_height" in d:
            low, high = float(d.road_height.min()) * 1e3, float(d.road_height.max()) * 1e3
            text = f"no plane: {low:.3g} to {high:.3g} mm below the tread"
            lines.insert(0, row("road_height", text))
        lines += [
            *(row(name, float(d[name])) for name in ("normal_load", "approach")),
            row("net_area", area),
            row("mean_pressure", float(d.normal_load) / area if area else np.nan),
            row("largest_pressure", float(d.pressure.max()), place=_peak(d.pressure), note=at_wall),
            row("largest_traction", float(shear.max()), place=_peak(shear), note=at_wall),
            *(row(name, float(d[name])) for name in _SCALARS),
            row("slip_fraction", self.slip_fraction),
            *self._road_rows(),
            *(row(name, float(d[name].max())) for name in _LOSSES if name in d),
        ]
        return tuple(lines)

    def cites(self) -> tuple[str, ...]:
        """Methods of the contact; those of friction, materials and splitting only where they were used."""
        tire, road = self.tire.material, self.road.layers[0].material
        methods = {
            **dict.fromkeys(("influence", "convolution", "normal", "preconditioner", "rolling", "newton"), True),
            "splitting": bool(self.stats.get("splitting_iterations")),
            **dict.fromkeys(("coupling", "mixing"), self.stats.get("coupling_rounds", 1) > 1),
            "falling": self.rolling.law.needs_speed,
            "flash": "flash_temperature" in self.dataset,
            "grain": isinstance(tire, Orthotropic) or isinstance(road, Orthotropic),
            "upright contact": isinstance(road, TransverselyIsotropic),
            **dict.fromkeys(("memory", "pivoting"), isinstance(tire, Prony)),
        }
        return tuple(key for key, is_used in methods.items() if is_used)

    def _road_rows(self) -> Iterator[Row]:
        if "road_share" in self.stats:
            share = float(self.stats["road_share"])
            yield row("road_share", share, note="negligible" if share < 0.01 else "it matters")
            if not self.road.is_homogeneous:
                how = "they are in" if self.stats["layers_solved"] else "left out"
                yield row("layer_share", float(self.stats["layer_share"]), note=how)

    def __repr__(self) -> str:
        peak = float(self.dataset.pressure.max()) / 1e3
        return f"<Contact {self.rolling}: {self.area * 1e6:.0f} mm², {peak:.0f} kPa peak>"


def _check_slip(data: xr.Dataset) -> None:
    """Slip and creepage over a speed are numbers; they are NaN where a wheel stood, which slips by a distance."""
    over_speed, over_distance = (
        ("slip_x", "slip_y", "creepage_x", "creepage_y"),
        ("slip_distance_x", "slip_distance_y"),
    )
    present = {name: data[name].to_numpy() for name in over_speed if name in data}
    stood = set(over_distance) <= set(data.data_vars) and all(np.isnan(values).all() for values in present.values())
    for name, values in present.items():
        wrong = int((~np.isfinite(values)).sum())
        if wrong and not stood:
            raise InputError(
                f"{name} has {wrong} of {values.size} values that are NaN or infinite; only a wheel that turned or "
                f"was shifted on the spot has no {', '.join(over_speed)}, but {over_distance[0]}"
            )


def _peak(field: xr.DataArray) -> Place | None:
    """Where a field is largest; None where nothing presses."""
    if not float(field.max()) > 0:
        return None
    plane = field.transpose(..., "y", "x")
    cell = plane.isel(dict(zip(plane.dims, index_of_largest(plane.to_numpy()), strict=True)))
    return Place(float(cell["x"]), float(cell["y"]))
