"""The computed contact beside the uniform loads of conventional design: what those miss."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.contact import Contact
from treadload.damage.quantities import Extension, HorizontalTension, VerticalCompression, VerticalShear
from treadload.damage.quantity import Quantity
from treadload.deferred import xarray as xr
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.materials import AtStress
from treadload.pavement import Pavement
from treadload.response import MATERIAL_LENGTH, GridLoad, UniformDisc, UniformRectangle, place_load, solve_response
from treadload.response.material import check_length
from treadload.rows import Row, row

COMPUTED, DISC, RECTANGLE = "computed contact", "uniform disc", "uniform rectangle"

# Largest of a quantity over the plane at each depth.
READINGS: Mapping[str, Quantity] = {
    "largest_extension": Extension("principal"),
    "largest_in_plane_extension": Extension(),
    "largest_vertical_shear": VerticalShear(),
    "largest_vertical_compression": VerticalCompression(),
    "largest_horizontal_tension": HorizontalTension(),
}
_STRAINS = ("largest_extension", "largest_in_plane_extension", "largest_vertical_shear")
# Points beyond the load, m, and their spacing where fields are as smooth as the depth.
_MARGIN, _PER_DEPTH, _COARSE = 0.15, 4, 0.02


@dataclass(frozen=True, eq=False)
class UniformComparison(BaseResult, group="uniform"):
    """Largest strains and stress under a computed contact and under uniform loads of the same force.

    dataset: readings over (load, depth), see `treadload.variables`, with the loads' areas and pressures.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> comparison = tl.damage.compare_uniform(contact, road, depths=[0.05], pressure=1.5e5, mean_over=None)
    >>> f"{comparison.dataset.uniform_area.item() * 1e4:.1f} cm² carry 100 N at 150 kPa"
    '6.7 cm² carry 100 N at 150 kPa'
    """

    title: ClassVar[str] = "Comparison with uniform loads"
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

    @property
    def heading(self) -> str:
        """What is evaluated near the surface."""
        length = self.dataset.attrs.get("mean_over")
        evaluated = "at points" if length is None else f"near the surface means over {1e3 * length:g} mm"
        return f"computed contact and uniform loads of the same force, {evaluated}"

    def rows(self) -> tuple[Row, ...]:
        """Tensile strains and vertical shear at every depth under every load."""
        data = self.dataset
        return tuple(
            row(name, data[name].sel(load=load)[number], group=f"{1e3 * float(depth):.0f} mm deep, {load}")
            for number, depth in enumerate(data["depth"])
            for load in map(str, data["load"].to_numpy())
            for name in _STRAINS
        )


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

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), material=tl.Elastic(5e6, 0.5))
    >>> road, wheel = tl.Pavement.half_space(tl.Elastic(5.4e9, 0.35)), tl.Rolling(normal_load=100.0, friction=0.7)
    >>> contact = tl.solve_contact(tire, road, wheel, spacing=0.006)
    >>> comparison = tl.damage.compare_uniform(contact, road, depths=[0.05], pressure=1.5e5, mean_over=None)
    >>> [f"{strain * 1e6:.2f} microstrain" for strain in comparison.dataset.largest_extension.values.ravel()]
    ['1.17 microstrain', '1.16 microstrain', '1.16 microstrain']
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
    levels = _depths(road, load.grid.dx, mean_over) if depths is None else np.asarray(depths, dtype=float)
    at = np.unique(np.atleast_1d(levels))
    values = {name: np.empty((len(loads), len(at))) for name in READINGS}
    for number, unit_load in enumerate(loads.values()):
        placed = [place_load(unit_load, x=x, y=y) for x, y in wheels]
        for level, depth in enumerate(at):
            for name, value in _largest(placed, road, float(depth), load, wheels, mean_over).items():
                values[name][number, level] = value
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
    # Not the parts into which a stress-dependent layer is divided.
    laws = [layer.material.law if isinstance(layer.material, AtStress) else None for layer in road.layers]
    below = [*laws[1:], None]
    ends = [
        float(z)
        for z, law, next_law in zip(road.interfaces, laws, below, strict=False)
        if law is None or law != next_law
    ]
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

    def points(places: Array, spacing: float, centres: list[float]) -> Array:
        if step > 2 * spacing:
            return np.arange(places[0] + min(centres) - _MARGIN, places[-1] + max(centres) + _MARGIN, step)
        return np.unique(np.round(np.concatenate([places + centre for centre in centres]), 9))

    x = points(grid.x, grid.dx, sorted({x for x, _ in wheels}))
    y = points(grid.y, grid.dy, sorted({y for _, y in wheels}))
    data = solve_response(loads, road, depths=[depth], x=x, y=y, mean_over=mean_over).dataset.isel(depth=0)
    return {name: float(quantity.values(data).max()) for name, quantity in READINGS.items()}
