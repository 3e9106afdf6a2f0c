"""Results that no solver made: fields of any verb, the height map of a tire."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from treadload._version import __version__
from treadload.composing import BaseResult
from treadload.describing import first_line
from treadload.grid import Grid
from treadload.tire import Tire
from treadload.variables import dataset

# Variables that a summary of fields lists.
_TOLD = 24


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
        return "\n".join(lines + ([f"and {more} more variables"] if more > 0 else []))

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
