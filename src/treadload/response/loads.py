"""What loads the road: pressure and shear on a grid, uniform discs and rectangles."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np
import xarray as xr

from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array

# Round-off of coordinates that went through a file, as a part of a cell.
_EVEN = 1e-4
# A pressure this far below zero, as a part of the largest, is a solver's tolerance; more is a wrong sign.
_TINY = 1e-6


@runtime_checkable
class HasDataset(Protocol):
    """A result that carries its fields in `.dataset`, such as a Contact."""

    @property
    def dataset(self) -> xr.Dataset:
        """Fields by name."""


@dataclass(frozen=True, eq=False)
class GridLoad:
    """Pressure and shear, uniform on each cell of a grid.

    grid: the cells. pressure: (ny, nx), Pa, >= 0. traction_x, traction_y: (ny, nx), Pa, shear exerted by
    the tire on the road; None: no shear. Arrays are copied; InputError for a wrong shape or value.
    """

    grid: Grid
    pressure: Array
    traction_x: Array | None = None
    traction_y: Array | None = None

    def __post_init__(self) -> None:
        for name in ("pressure", "traction_x", "traction_y"):
            given = getattr(self, name)
            values = np.zeros(self.grid.shape) if given is None else np.array(given, dtype=float)
            if values.shape != self.grid.shape:
                raise InputError(f"{name} has shape {values.shape}, the grid has {self.grid.shape} (ny, nx)")
            if not np.isfinite(values).all():
                where = tuple(int(i) for i in np.argwhere(~np.isfinite(values))[0])
                raise InputError(f"{name} must be finite, got {values[where]} in cell (y, x) = {where}")
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        lowest = float(self.pressure.min())
        if lowest < -_TINY * float(self.pressure.max(initial=0.0)):
            raise InputError(
                f"pressure must not be negative, got {lowest:g} Pa; pressure counts compression positive, "
                "unlike stress_zz"
            )

    @classmethod
    def from_dataset(cls, dataset: xr.Dataset) -> GridLoad:
        """Load from `pressure`, `traction_x` and `traction_y` over `y` and `x`; a missing shear is none.

        Attributes dx and dy of the dataset give the cell where a single coordinate cannot.
        Raises InputError if pressure or a coordinate is missing, or the coordinates are not evenly spaced.
        """
        missing = [name for name in ("pressure", "x", "y") if name not in dataset.variables]
        if missing:
            raise InputError(f"a load needs pressure over y and x; {', '.join(missing)} missing in the dataset")
        x0, nx, dx = _even("x", dataset["x"].to_numpy(), dataset.attrs.get("dx"))
        y0, ny, dy = _even("y", dataset["y"].to_numpy(), dataset.attrs.get("dy"))

        def field(name: str) -> Array | None:
            if name not in dataset:
                return None
            if set(dataset[name].dims) != {"y", "x"}:
                raise InputError(f"{name} must have dimensions (y, x), got {dataset[name].dims}")
            return np.asarray(dataset[name].transpose("y", "x").to_numpy(), dtype=float)

        pressure = field("pressure")
        assert pressure is not None
        return cls(Grid(nx, ny, dx, dy, x0, y0), pressure, field("traction_x"), field("traction_y"))

    @property
    def array(self) -> Array:
        """(3, ny, nx): pressure, traction_x, traction_y, Pa."""
        array: Array = np.stack([self.pressure, self.traction_x, self.traction_y])  # type: ignore[list-item]
        return array

    @property
    def extent_x(self) -> tuple[float, float]:
        """First and last edge along x, m."""
        return self.grid.x0 - 0.5 * self.grid.dx, self.grid.x0 + (self.grid.nx - 0.5) * self.grid.dx

    @property
    def extent_y(self) -> tuple[float, float]:
        """First and last edge along y, m."""
        return self.grid.y0 - 0.5 * self.grid.dy, self.grid.y0 + (self.grid.ny - 0.5) * self.grid.dy


@dataclass(frozen=True)
class UniformDisc:
    """Uniform pressure on a disc.

    radius: m, > 0. pressure: Pa, >= 0. x, y: centre, m. Raises InputError for a wrong value.
    """

    radius: float
    pressure: float
    x: float = 0.0
    y: float = 0.0

    def __post_init__(self) -> None:
        _check_uniform("disc", {"radius": self.radius}, self.pressure, {"x": self.x, "y": self.y})

    @property
    def extent_x(self) -> tuple[float, float]:
        """First and last point along x, m."""
        return self.x - self.radius, self.x + self.radius

    @property
    def extent_y(self) -> tuple[float, float]:
        """First and last point along y, m."""
        return self.y - self.radius, self.y + self.radius


@dataclass(frozen=True)
class UniformRectangle:
    """Uniform pressure and shear on a rectangle.

    length, width: along x and y, m, > 0. pressure: Pa, >= 0. x, y: centre, m. traction_x, traction_y: shear
    exerted by the tire on the road, Pa. Raises InputError for a wrong value.
    """

    length: float
    width: float
    pressure: float
    x: float = 0.0
    y: float = 0.0
    traction_x: float = 0.0
    traction_y: float = 0.0

    def __post_init__(self) -> None:
        others = {name: getattr(self, name) for name in ("x", "y", "traction_x", "traction_y")}
        _check_uniform("rectangle", {"length": self.length, "width": self.width}, self.pressure, others)

    @property
    def cell(self) -> GridLoad:
        """The same as a grid of one cell."""
        grid = Grid(1, 1, self.length, self.width, self.x, self.y)
        one = np.ones((1, 1))
        return GridLoad(grid, self.pressure * one, self.traction_x * one, self.traction_y * one)


Load = GridLoad | UniformDisc | UniformRectangle | HasDataset | xr.Dataset
SurfaceLoad = GridLoad | UniformDisc


def gather(loads: Load | Sequence[Load]) -> tuple[GridLoad | UniformDisc | UniformRectangle, ...]:
    """Loads to superpose, from one or several contacts, datasets, GridLoads, discs and rectangles."""
    single = isinstance(loads, (GridLoad, UniformDisc, UniformRectangle, xr.Dataset, HasDataset))
    several: Any = [loads] if single else loads
    if not isinstance(several, Sequence) or isinstance(several, str) or not len(several):
        raise InputError(
            "loads must be a contact, a dataset, a GridLoad, a UniformDisc, a UniformRectangle or a list of these, "
            f"got {_kind(loads)}"
        )
    return tuple(_load(item) for item in several)


def common_grid(several: Sequence[GridLoad | UniformDisc | UniformRectangle]) -> Grid:
    """Smallest grid that holds every load's cells; InputError if the loads do not share one lattice."""
    loads = [load for load in several if isinstance(load, GridLoad)]
    if len(loads) < len(several):
        raise InputError("a disc or a rectangle has no grid of its own; give x and y of the result")
    first = loads[0].grid
    low_x = low_y = 0
    high_x, high_y = first.nx, first.ny
    for number, grid in enumerate((load.grid for load in loads[1:]), start=2):
        shift_x, shift_y = (grid.x0 - first.x0) / first.dx, (grid.y0 - first.y0) / first.dy
        apart = (shift_x - round(shift_x), shift_y - round(shift_y), grid.dx / first.dx - 1, grid.dy / first.dy - 1)
        if max(abs(part) for part in apart) > _EVEN:
            raise InputError(f"load {number} ({grid}) and load 1 ({first}) share no grid; give x and y of the result")
        low_x, high_x = min(low_x, round(shift_x)), max(high_x, round(shift_x) + grid.nx)
        low_y, high_y = min(low_y, round(shift_y)), max(high_y, round(shift_y) + grid.ny)
    return Grid(
        high_x - low_x,
        high_y - low_y,
        first.dx,
        first.dy,
        first.x0 + low_x * first.dx,
        first.y0 + low_y * first.dy,
    )


def _check_uniform(kind: str, sizes: dict[str, float], pressure: float, others: dict[str, float]) -> None:
    for name, value in sizes.items():
        if not (math.isfinite(value) and value > 0):
            raise InputError(f"the {name} of a {kind} must be a positive number of metres, got {value}")
    if not (math.isfinite(pressure) and pressure >= 0):
        raise InputError(f"the pressure of a {kind} must be >= 0 Pa, got {pressure}; compression counts positive")
    for name, value in others.items():
        if not math.isfinite(value):
            raise InputError(f"{name} of a {kind} must be finite, got {value}")


def _load(item: Load) -> GridLoad | UniformDisc | UniformRectangle:
    if isinstance(item, (GridLoad, UniformDisc, UniformRectangle)):
        return item
    if isinstance(item, xr.Dataset):
        return GridLoad.from_dataset(item)
    if isinstance(item, HasDataset):
        return GridLoad.from_dataset(item.dataset)
    raise InputError(f"a load must be a contact, a dataset or a GridLoad, got {_kind(item)}")


def _kind(value: Any) -> str:
    return f"an empty {type(value).__name__}" if isinstance(value, Sequence) and not value else type(value).__name__


def _even(name: str, values: Array, single: float | None) -> tuple[float, int, float]:
    """First value, number and spacing of evenly spaced, rising coordinates; `single`: spacing if there is but one."""
    if values.size == 1 and single is not None:
        return float(values.item()), 1, float(single)
    if values.ndim != 1 or len(values) < 2:
        raise InputError(
            f"the spacing along {name} cannot be read from {values.size} coordinate(s); give a GridLoad with its Grid"
        )
    spacing = float(values[-1] - values[0]) / (len(values) - 1)
    uneven = float(np.abs(np.diff(values) - spacing).max())
    if not (spacing > 0 and uneven <= _EVEN * spacing):
        raise InputError(
            f"{name} must rise in even steps: the mean step is {spacing:g} m, the worst differs by {uneven:g} m; "
            "sort or resample the load"
        )
    return float(values[0]), len(values), spacing
