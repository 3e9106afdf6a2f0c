"""The computed contact beside the uniform loads of conventional design: what those miss."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.contact import Contact
from treadload.damage import Extension, HorizontalTension, Quantity, VerticalCompression, VerticalShear
from treadload.describing import first_line
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response import MATERIAL_LENGTH, GridLoad, UniformDisc, UniformRectangle, place_load, solve_response
from treadload.response.material import check_length

COMPUTED, DISC, RECTANGLE = "computed contact", "uniform disc", "uniform rectangle"

# Largest of a quantity over the plane at each depth.
READINGS: Mapping[str, Quantity] = {
    "largest_extension": Extension("principal"),
    "largest_in_plane_extension": Extension(),
    "largest_vertical_shear": VerticalShear(),
    "largest_vertical_compression": VerticalCompression(),
    "largest_horizontal_tension": HorizontalTension(),
}
# Points beyond the load, m, and their spacing where fields are as smooth as the depth.
_MARGIN, _PER_DEPTH, _COARSE = 0.15, 4, 0.02


@dataclass(frozen=True, eq=False)
class UniformComparison(BaseResult, group="uniform"):
    """Largest strains and stress under a computed contact and under uniform loads of the same force.

    dataset: readings over (load, depth), see `treadload.variables`, with the loads' areas and pressures.
    """

    holds: ClassVar[Holds] = Holds(
        {"depth": "depth", "largest_extension largest_in_plane_extension largest_vertical_shear": "load depth"},
        labels={"load": "load"},
        maybe_numbers="mean_over",
    )

    dataset: xr.Dataset

    def ratio(self, reading: str, load: str = DISC) -> xr.DataArray:
        """Reading under the computed contact over that under a uniform load, over depth."""
        values = self.dataset[reading]
        return values.sel(load=COMPUTED) / values.sel(load=load)

    def summary(self) -> str:
        """A table: extension and vertical shear at every depth, computed and uniform."""
        data = self.dataset
        names = [str(name) for name in data["load"].to_numpy()]
        length = data.attrs.get("mean_over")
        reading = "at points" if length is None else f"near the surface means over {1e3 * length:g} mm"
        lines = [
            "what uniform loads of the same force miss: largest extension / in the plane / vertical shear "
            f"(microstrain), {reading}",
            "depth (mm)  " + "  ".join(f"{name:>24}" for name in names),
        ]
        for number, depth in enumerate(data["depth"].to_numpy()):
            row = data.isel(depth=number)
            cells = [
                " / ".join(
                    f"{1e6 * float(row[reading].sel(load=name)):.1f}"
                    for reading in ("largest_extension", "largest_in_plane_extension", "largest_vertical_shear")
                )
                for name in names
            ]
            lines.append(f"{1e3 * depth:10.0f}  " + "  ".join(f"{cell:>24}" for cell in cells))
        return "\n".join(lines)

    __repr__ = first_line


def compare_uniform(
    contact: Contact,
    road: Pavement,
    *,
    depths: ArrayLike | None = None,
    pressure: float | None = None,
    slenderness: float = 1.0,
    wheels: Sequence[tuple[float, float]] = ((0.0, 0.0),),
    mean_over: float | None = MATERIAL_LENGTH,
) -> UniformComparison:
    """The same wheel as conventional design loads the road: uniform pressure on a disc, or on a rectangle.

    contact: the computed one; its forces are those of the uniform loads. road: elastic. depths: m; left out, the
    surface, some down to 160 mm and the bottoms of the layers. pressure: of the uniform loads, Pa; left out, the
    tire's inflation pressure, as design methods take it. slenderness: length along travel over width of the
    rectangle. wheels: (x, y) of the wheels that act together, m.
    mean_over: side of the cube of road whose means are read near the surface, m, see `solve_response`; None for
    points, which under the computed contact read more the finer its cells are.
    The disc carries the normal load alone; the rectangle also the net shear, spread evenly.
    Returns the largest readings at each depth, over the plane.
    Raises InputError without a pressure.
    """
    load = GridLoad.from_dataset(contact.dataset)
    uniform = contact.tire.inflation_pressure if pressure is None else pressure
    if uniform is None:
        raise InputError(
            "the uniform loads need a pressure: the tire has no inflation pressure; give pressure= in Pa"
        )
    positive("pressure", uniform, "Pa", "left out, it is the inflation pressure")
    positive("slenderness", slenderness, remedy="1 is a square")
    force = load.normal_load
    area = force / uniform
    length = math.sqrt(area * slenderness)
    sheared = [float(part.sum()) * load.grid.cell_area / area for part in (load.array[1], load.array[2])]
    loads: dict[str, GridLoad | UniformDisc | UniformRectangle] = {
        COMPUTED: load,
        DISC: UniformDisc(math.sqrt(area / math.pi), uniform),
        RECTANGLE: UniformRectangle(length, area / length, uniform, traction_x=sheared[0], traction_y=sheared[1]),
    }
    if mean_over is not None:
        check_length(mean_over)
    asked = _depths(road, load.grid.dx, mean_over) if depths is None else np.asarray(depths, dtype=float)
    at = np.unique(np.atleast_1d(asked))
    values = {name: np.empty((len(loads), len(at))) for name in READINGS}
    for number, one in enumerate(loads.values()):
        placed = [place_load(one, x=x, y=y) for x, y in wheels]
        for row, depth in enumerate(at):
            for name, value in _largest(placed, road, float(depth), load, wheels, mean_over).items():
                values[name][number, row] = value
    dataset = variables.dataset(
        {
            **{name: (("load", "depth"), value) for name, value in values.items()},
            "uniform_pressure": ((), uniform),
            "uniform_area": ((), area),
        },
        {"load": list(loads), "depth": at},
        slenderness=slenderness,
        wheels=len(wheels),
        **({} if mean_over is None else {"mean_over": mean_over}),
        normal_load=force,
    )
    return UniformComparison(dataset)


def _depths(road: Pavement, cell: float, mean_over: float | None) -> Array:
    # In the upper half of the uppermost cube the mean is that of the surface.
    above = 0.5 * (mean_over or 0.0)
    inside = [z for z in (0.005, 0.01, 0.02, 0.04, 0.08, 0.12, 0.16) if z >= 0.5 * cell and z > above]
    ends = road.interfaces
    return np.round([0.0, *[z for z in inside if not len(ends) or z < ends[-1]], *ends], 9)


def _largest(
    loads: Sequence[GridLoad | UniformDisc | UniformRectangle],
    road: Pavement,
    depth: float,
    cells: GridLoad,
    wheels: Sequence[tuple[float, float]],
    mean_over: float | None,
) -> dict[str, float]:
    """Largest readings at one depth, on the contact's cells near the surface and on points a quarter depth apart."""
    grid = cells.grid
    step = min(_COARSE, max(grid.dx, depth / _PER_DEPTH))

    def points(own: Array, spacing: float, centres: list[float]) -> Array:
        if step > 2 * spacing:
            return np.arange(own[0] + min(centres) - _MARGIN, own[-1] + max(centres) + _MARGIN, step)
        return np.unique(np.round(np.concatenate([own + centre for centre in centres]), 9))

    x = points(grid.x, grid.dx, sorted({x for x, _ in wheels}))
    y = points(grid.y, grid.dy, sorted({y for _, y in wheels}))
    data = solve_response(loads, road, depths=[depth], x=x, y=y, mean_over=mean_over).dataset.isel(depth=0)
    return {name: float(quantity.values(data).max()) for name, quantity in READINGS.items()}
