"""A footprint that was recorded: a load with what is known of its sensor, and what it measures."""

from __future__ import annotations

import functools
import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import ClassVar

import numpy as np

from treadload.composing import BaseResult, Source
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.footprint.interpolation import FootprintSet, opened_set
from treadload.footprint.measures import Measures, check_ribs, find_ribs, measure, shares
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.gridding.overlap import means_over_cells
from treadload.pavement import Pavement, road_in_words
from treadload.response import GridLoad
from treadload.rows import Row, row
from treadload.units import quantity
from treadload.variables import dataset

# Row → measure.
_MEASURES = {
    "print_length": "length", "print_width": "width", "net_area": "net_area", "gross_area": "gross_area",
    "mean_pressure": "mean", "largest_pressure": "peak",
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class Footprint(BaseResult, group="contact"):
    """A footprint that was recorded in place of a contact that is computed; a load of `solve_response` like one.

    load: pressure, and shear if it was recorded, on the sensels; zero where there is none. road: that it stands on,
    or None. threshold: pressures below it are not seen, Pa. saturation: what a sensel reads at most, Pa. missing:
    (ny, nx), True where there is no sensel or a dead one; None for none. pin: sides of the face of a pin along x and
    y, m, over which a cell's reading is a mean; None of sensels that fill their cells. warnings: sentences. errors:
    of an interpolated one, see `FootprintSet.errors`; empty of one that was recorded.
    Raises InputError for a wrong value.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.02), [[0] * 2 + [6e5] * 4 + [0] * 2] * 8)
    >>> f"{tl.Footprint(load).scaled_to('10 kN').mean_pressure / 1e3:.0f} kPa"
    '781 kPa'
    """

    title: ClassVar[str] = "Recorded footprint"

    load: GridLoad
    road: Pavement | None = None
    threshold: float = 0.0
    saturation: float = math.inf
    missing: BoolArray | None = None
    warnings: tuple[str, ...] = ()
    pin: tuple[float, float] | None = None
    errors: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not (math.isfinite(self.threshold) and self.threshold >= 0):
            raise InputError(f"the threshold of a footprint must be >= 0 Pa, got {self.threshold}")
        if not self.saturation > self.threshold:
            raise InputError(
                f"the saturation of a footprint must lie above its threshold of {self.threshold:g} Pa, got "
                f"{self.saturation:g}"
            )
        if self.pin is not None:
            object.__setattr__(self, "pin", checked_pin(self.pin))
        if self.missing is not None:
            holes = np.array(self.missing, dtype=bool)
            if holes.shape != self.load.grid.shape:
                raise InputError(f"missing has shape {holes.shape}, the footprint {self.load.grid.shape} (ny, nx)")
            holes.setflags(write=False)
            object.__setattr__(self, "missing", holes if holes.any() else None)

    @classmethod
    def interpolate(
        cls,
        store: str | os.PathLike[str] | Source | FootprintSet,
        *,
        load: float | str | None = None,
        pressure: float | str | None = None,
        slip: float | str | None = None,
        version: str | None = None,
    ) -> Footprint:
        """Footprint between the solved cases of a study, in milliseconds.

        store: of a study of one tire, friction and wear that varies rolling.normal_load, tire.inflation_pressure and
        rolling.creepage_x, or some of them, and keeps the fields pressure, traction_x and traction_y; or the
        `FootprintSet` of it. A path is read once, in about a second, and kept while the store is as it was.
        load: N or "30 kN". pressure: of inflation, Pa or "8 bar". slip: creepage along travel (V - ωR)/V, negative
        when driving. Each inside the sampled range; left out where the study does not vary it. version: of treadload
        that solved the store, where it is not this one.
        The load is exact; forces and moments are those of the interpolated fields, p ≥ 0 and |q| ≤ μp. `errors`, also
        in the dataset, are those of the cases, each left out in turn. Raises InputError outside the range, with the
        bound, and as `FootprintSet.from_store`.

        >>> tl.Footprint.interpolate("set.zarr", load="31 kN", pressure="7.7 bar", slip=-0.012)  # doctest: +SKIP
        """
        cases = opened_set(store, version)
        return cls(
            cases.at(load=load, pressure=pressure, slip=slip), warnings=cases.warnings, errors=dict(cases.errors)
        )

    @property
    def pressure(self) -> Array:
        """(ny, nx), Pa."""
        pressure: Array = self.load.array[0]
        return pressure

    @property
    def grid(self) -> Grid:
        """The sensels."""
        return self.load.grid

    @property
    def pitch(self) -> tuple[float, float]:
        """Distance of the sensels along x and y, m."""
        return self.grid.dx, self.grid.dy

    @property
    def has_shear(self) -> bool:
        """True if shear was recorded beside the pressure."""
        return bool(self.load.array[1:].any())

    @property
    def source(self) -> str:
        """Where it was read and how it was understood, in words."""
        return self.load.source

    @property
    def sensels(self) -> BoolArray:
        """(ny, nx), True where there is a working sensel."""
        return np.ones(self.grid.shape, dtype=bool) if self.missing is None else ~self.missing

    @property
    def saturated(self) -> BoolArray:
        """(ny, nx), True where a sensel reads all that it can: the pressure there is a lower bound."""
        full: BoolArray = self.pressure >= self.saturation * (1 - 1e-9)
        return full

    @functools.cached_property
    def measures(self) -> Measures:
        """Load, areas, extents, mean, peak, centre and spread; see `footprint.Measures`."""
        grid = self.grid
        return measure(np.maximum(self.pressure, 0.0), grid.x, grid.y, grid.dx, grid.dy)

    @property
    def normal_load(self) -> float:
        """Force on the road, N."""
        return self.load.normal_load

    @property
    def net_area(self) -> float:
        """Area of the loaded sensels, m²."""
        return self.measures.net_area

    @property
    def gross_area(self) -> float:
        """Area inside the convex outline of the loaded sensels, grooves with it, m²."""
        return self.measures.gross_area

    @property
    def length(self) -> float:
        """From the first to the last loaded sensel along x, m."""
        return self.measures.length

    @property
    def width(self) -> float:
        """From the first to the last loaded sensel along y, m."""
        return self.measures.width

    @property
    def mean_pressure(self) -> float:
        """Load over net area, Pa."""
        return self.measures.mean

    @property
    def peak_pressure(self) -> float:
        """Largest pressure, Pa: a mean over a sensel."""
        return self.measures.peak

    @property
    def centroid(self) -> tuple[float, float]:
        """Centre of pressure, x and y, m."""
        return self.measures.centre_x, self.measures.centre_y

    def find_ribs(self) -> Array:
        """Edges (ribs + 1,) of the ribs across the tread, m, found from the grooves between them."""
        return find_ribs(self.pressure, self.grid.y, self.grid.dy)

    def rib_shares(self, ribs: Sequence[float] | Array | None = None) -> Array:
        """Share (ribs,) of the load on each rib, from left to right. ribs: edges, m; None: as `find_ribs`."""
        edges = self.find_ribs() if ribs is None else check_ribs(ribs)
        across = np.broadcast_to(self.grid.y[:, None], self.grid.shape)
        return shares(self.pressure, across, edges)

    def moved(self, x: float = 0.0, y: float = 0.0) -> Footprint:
        """The same footprint moved by x and y, m."""
        return replace(self, load=self.load.moved(x, y))

    def mirrored(self) -> Footprint:
        """Its image in the plane y = 0."""
        return replace(self, load=self.load.mirrored(), missing=None if self.missing is None else self.missing[::-1])

    def scaled_to(self, load: float | str) -> Footprint:
        """All stress times one number, so that it carries a known load, N or a text such as "35 kN".

        Raises InputError for a footprint that carries none, or a load that is not above zero.
        """
        wanted = quantity(load, "N")
        if not (wanted > 0 and self.normal_load > 0):
            raise InputError(
                f"a footprint of {self.normal_load:g} N cannot be scaled to {wanted:g} N; both must be above 0"
            )
        return self._scaled(wanted / self.normal_load)

    def _scaled(self, by: float) -> Footprint:
        pressure, along, across = self.load.array * by
        stress = replace(self.load, pressure=pressure, traction_x=along, traction_y=across)
        return replace(self, load=stress, threshold=self.threshold * by, saturation=self.saturation * by)

    def resampled(self, spacing: float | str) -> Footprint:
        """The same stress as means over other cells, exact by area: the load stays. spacing: m or a text with a unit.

        Threshold and saturation are those of sensels and do not go with it; cells whose larger part is missing are.
        """
        size, old = quantity(spacing, "m"), self.grid
        edges = edges_of(old)
        grid = Grid.centred(old.nx * old.dx, old.ny * old.dy, size)
        middle_x, middle_y = (0.5 * float(edge[0] + edge[-1]) for edge in edges)
        grid = replace(grid, x0=grid.x0 + middle_x, y0=grid.y0 + middle_y)
        new = edges_of(grid)
        stress = [means_over_cells(part, *edges, *new) for part in self.load.array]
        holes = None if self.missing is None else means_over_cells(self.missing.astype(float), *edges, *new) > 0.5
        load = replace(
            self.load, grid=grid, pressure=np.maximum(stress[0], 0.0), traction_x=stress[1], traction_y=stress[2]
        )
        return replace(self, load=load, missing=holes, threshold=0.0, saturation=math.inf, pin=None)

    @property
    def dataset(self) -> xr.Dataset:
        """The footprint with the names that a contact has."""
        plane, load = ("y", "x"), self.load
        pressure, along, across = load.array
        fields: dict[str, tuple[tuple[str, ...], object]] = {
            "pressure": (plane, pressure),
            "traction_x": (plane, along),
            "traction_y": (plane, across),
            "normal_load": ((), load.normal_load),
            "tractive_force": ((), load.tractive_force),
            "lateral_force": ((), load.lateral_force),
            **{name: ((), value) for name, value in self.errors.items()},
        }
        words = {} if self.road is None else {"road": road_in_words(self.road)}
        cell = {"dx": load.grid.dx, "dy": load.grid.dy}
        kind = "interpolated" if self.errors else "recorded"
        title = f"{kind} footprint{f', read from {load.source}' if load.source else ''}: {load}"
        return dataset(fields, {"x": load.grid.x, "y": load.grid.y}, **cell, tire=title, **words)

    @property
    def heading(self) -> str:
        """What presses, and where it was read."""
        return str(self.load)

    def rows(self) -> tuple[Row, ...]:
        """What presses where, what it measures, and where it was read."""
        load, measures = self.load, self.measures
        lines = [row(name, getattr(load, name)) for name in ("normal_load", "tractive_force", "lateral_force")]
        if measures.net_area > 0:
            lines += [row(key, getattr(measures, name)) for key, name in _MEASURES.items()]
            ribs = self.rib_shares()
            shares = f"{' / '.join(f'{100 * share:.1f}' for share in ribs)} %"
            text = shares if len(ribs) > 1 else "no groove along travel divides it into ribs"
            lines.append(row("rib_share", text))
        if self.threshold:
            lines.append(row("threshold", f"{self.threshold / 1e3:.3g} kPa"))
        if math.isfinite(self.saturation):
            text = f"{self.saturation / 1e3:.4g} kPa, reached by {int(self.saturated.sum())} sensels"
            lines.append(row("saturation", text))
        if self.pin is not None:
            text = f"{self.pin[0] * 1e3:.3g} x {self.pin[1] * 1e3:.3g} mm"
            lines.append(row("pin_face", text))
        if self.missing is not None:
            text = f"{int(self.missing.sum())} cells without a working sensel"
            lines.append(row("missing", text))
        lines += [row(name, value) for name, value in self.errors.items()]
        if load.source:
            lines.append(row("source", load.source))
        return tuple(lines)


def checked_pin(pin: Sequence[float]) -> tuple[float, float]:
    """Sides of the face of a pin along x and y, m. Raises InputError unless they are two lengths above 0."""
    sides = tuple(float(side) for side in pin)
    if len(sides) != 2 or not all(math.isfinite(side) and side > 0 for side in sides):
        raise InputError(
            f"pin must be the two sides of a face along x and y, m, above 0, got {pin!r}; 9.7 mm is 9.7e-3"
        )
    return sides[0], sides[1]


def edges_of(grid: Grid) -> tuple[Array, Array]:
    """Edges of the cells along x (nx + 1,) and y (ny + 1,), m."""
    x, y = grid.x, grid.y
    return (
        np.concatenate([x - 0.5 * grid.dx, [x[-1] + 0.5 * grid.dx]]),
        np.concatenate([y - 0.5 * grid.dy, [y[-1] + 0.5 * grid.dy]]),
    )
