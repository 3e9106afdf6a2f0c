"""Results that no solver made: a footprint that was recorded, fields of any verb, the height map of a tire."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from treadload._version import __version__
from treadload.composing import BaseResult
from treadload.describing import first_line
from treadload.grid import Grid
from treadload.pavement import Pavement
from treadload.response import GridLoad
from treadload.results.roads import road_in_words
from treadload.tire import Tire
from treadload.variables import dataset

# Variables that a summary of fields tells.
_TOLD = 24


@dataclass(frozen=True, eq=False)
class Footprint(BaseResult, group="contact"):
    """A footprint that was recorded in place of a contact that is computed.

    load: as it was read. road: that it stands on, or None.
    """

    load: GridLoad
    road: Pavement | None = None

    @property
    def dataset(self) -> xr.Dataset:
        """The footprint with the names that a contact has."""
        return footprint(self.load, self.road)

    def summary(self) -> str:
        """What presses where, the forces, and where it was read."""
        load = self.load
        lines = [
            f"recorded footprint: {load}",
            f"tractive force {load.tractive_force / 1e3:z.2f} kN, lateral force {load.lateral_force / 1e3:z.2f} kN",
        ]
        return "\n".join(lines + ([f"read from {load.source}"] if load.source else []))

    __repr__ = first_line


@dataclass(frozen=True, eq=False)
class Fields(BaseResult, group="fields"):
    """Fields that a verb gave as a dataset: criteria of cracking, residual stress, an envelope, a rose, interfaces.

    dataset: variables with units and long names.
    """

    dataset: xr.Dataset

    def summary(self) -> str:
        """What the fields are over, and the range of each."""
        data = self.dataset
        sizes = ", ".join(f"{size} {name}" for name, size in data.sizes.items()) or "single numbers"
        lines = [f"fields over {sizes}"]
        for name in list(data.data_vars)[:_TOLD]:
            unit = str(data[name].attrs.get("units", ""))
            lines.append(f"{name}: {_range(data[name])}{f' {unit}' if unit not in ('', '1') else ''}")
        more = len(data.data_vars) - _TOLD
        return "\n".join(lines + ([f"and {more} variables more"] if more > 0 else []))

    __repr__ = first_line


def _range(field: xr.DataArray) -> str:
    values = field.to_numpy()
    if values.dtype.kind not in "fiub" or not values.size:
        return f"{values.size} of {values.dtype}"
    known = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    if not known.size:
        return "NaN"
    low, high = float(known.min()), float(known.max())
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"


def height_map(tire: Tire, spacing: float) -> xr.Dataset:
    """The tire's initial gap on its whole extent, as `Tire.from_height_map` reads it back from a file.

    spacing: of the cells, m; a tire that is a height map keeps its own.
    """
    grid = tire.fixed_grid or Grid.on_lattice(*tire.extent, spacing)
    gap = {"initial_gap": (("y", "x"), tire.height_map(grid))}
    about = {"tire": str(tire), "treadload_version": __version__}
    return dataset(gap, {"x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy, **about)


def footprint(load: GridLoad, road: Pavement | None) -> xr.Dataset:
    """A recorded footprint with the names that a contact has."""
    plane = ("y", "x")
    pressure, along, across = load.array
    fields: dict[str, tuple[tuple[str, ...], object]] = {
        "pressure": (plane, pressure),
        "traction_x": (plane, along),
        "traction_y": (plane, across),
        "normal_load": ((), load.normal_load),
        "tractive_force": ((), load.tractive_force),
        "lateral_force": ((), load.lateral_force),
    }
    words = {} if road is None else {"road": road_in_words(road)}
    cell = {"dx": load.grid.dx, "dy": load.grid.dy}
    told = f"recorded footprint{f', read from {load.source}' if load.source else ''}: {load}"
    return dataset(fields, {"x": load.grid.x, "y": load.grid.y}, **cell, tire=told, **words)
