"""Results that no solver made: fields of any verb, the height map of a tire."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload._version import __version__
from treadload.composing import BaseResult
from treadload.deferred import xarray as xr
from treadload.grid import Grid
from treadload.rows import Row, row
from treadload.tire import Tire
from treadload.variables import VARIABLES, dataset, display_of

# Fields whose ranges are listed.
_MOST = 24


@dataclass(frozen=True, eq=False)
class Fields(BaseResult, group="fields"):
    """Fields that a verb gave as a dataset: criteria of cracking, residual stress, an envelope, a rose, interfaces.

    dataset: variables with units and long names.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> response = tl.solve_response(tl.UniformDisc(0.15, 700e3), road, depths=[0.15], x=[0.0, 0.1], y=[0.0, 0.1])
    >>> fields = tl.results.Fields(tl.damage.compute_quantities(response, ["vertical_shear_strain"]))
    >>> print(fields.summary())
    Fields: over 1 depth, 2 y, 2 x
    vertical shear strain  0 to 0.003441
    """

    dataset: xr.Dataset

    @property
    def warnings(self) -> tuple[str, ...]:
        """That a class is missing, where the fields are those of a result whose package is not installed."""
        name = self.dataset.attrs.get("unknown_class")
        if name is None:
            return ()
        package = self.dataset.attrs.get("package") or "its package"
        return (f"no installed package has the class {name!r}: its fields are shown as data; install {package}",)

    @property
    def heading(self) -> str:
        """What the fields are over."""
        sizes = ", ".join(f"{size} {name}" for name, size in self.dataset.sizes.items())
        return f"over {sizes}" if sizes else "single numbers"

    def rows(self) -> tuple[Row, ...]:
        """The range of each field, in SI units."""
        data = self.dataset
        lines = []
        for name in map(str, list(data.data_vars)[:_MOST]):
            unit = str(data[name].attrs.get("units", ""))
            text = f"{_range(data[name])}{f' {unit}' if unit not in ('', '1') else ''}"
            lines.append(row(name, text, label=display_of(name).label if name in VARIABLES else name))
        more = len(data.data_vars) - _MOST
        return (*lines, row("more", f"{more} more variables", label="and")) if more > 0 else tuple(lines)


def _range(field: xr.DataArray) -> str:
    values = field.to_numpy()
    if values.dtype.kind not in "fiub" or not values.size:
        return f"{values.size} of {values.dtype}"
    finite = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    if not finite.size:
        return "NaN"
    low, high = float(finite.min()), float(finite.max())
    return f"{low:.4g}" if low == high else f"{low:.4g} to {high:.4g}"


def height_map(tire: Tire, spacing: float) -> xr.Dataset:
    """The tire's initial gap on its whole extent, as `Tire.from_height_map` reads it back from a file.

    spacing: of the cells, m; a tire that is a height map keeps its own.

    >>> tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    >>> gap = tl.results.height_map(tire, spacing=0.01).initial_gap
    >>> f"{gap.sel(x=0.1, y=0.05, method='nearest').item() * 1e3:.1f} mm"  # between tire and road, 0.1 m ahead
    '10.1 mm'
    """
    grid = tire.fixed_grid or Grid.on_lattice(*tire.extent, spacing)
    gap = {"initial_gap": (("y", "x"), tire.height_map(grid))}
    about = {"tire": str(tire), "treadload_version": __version__}
    return dataset(gap, {"x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy, **about)
