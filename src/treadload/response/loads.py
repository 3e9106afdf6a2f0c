"""What loads the road: pressure and shear on a grid, uniform discs and rectangles.

Each load is a frozen description with a place; `moved` and `mirrored` give copies elsewhere. `response.gears` puts
wheels together, `response.measured` reads recorded stress.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal, TypeAlias, Unpack

import numpy as np

from treadload.composing import Source, dataset_of, has_fields
from treadload.contact.fields import RIB_SIDES
from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.kernels.half_space.bilinear import bilinear_spectrum
from treadload.kernels.layers.wavenumbers import Spectrum, cells_spectrum
from treadload.response import measured
from treadload.tables import real_array

# A pressure this far below zero, as a part of the largest, is a solver's tolerance; more is a wrong sign.
_TINY = 1e-6


@dataclass(frozen=True, eq=False)
class GridLoad:
    """Pressure and shear on the cells of a grid.

    grid: the cells. pressure: (ny, nx), Pa, >= 0. traction_x, traction_y: (ny, nx), Pa, shear exerted by
    the tire on the road; None: no shear. Arrays are copied; InputError for a wrong shape or value.
    interpolation: "constant": uniform on each cell. "bilinear": bilinear between the cells' centres, falling to
    zero one cell beyond the outermost centres; same force, no steps. Under smooth shear the strain at the surface
    then converges like dx² instead of dx: for a Gaussian and cells of 0.16 of its standard deviation, the largest
    error at cell centres falls from 4.5 % of the largest strain to 0.5 %. Two cells deep and deeper both converge
    like dx², "constant" being twice as near. "bilinear" does not help where the load itself has steps, as at the
    edges of ribs: it blurs them over a cell. source: where it was read and in which units, for people. rib_sides: of
    the tire whose contact it is, as in `Tire`; empty where it is of none.

    >>> patch = tl.response.GridLoad.from_arrays([[400e3, 800e3, 400e3]], [[0.0, 100e3, 200e3]], spacing=0.05)
    >>> f"{patch.normal_load / 1e3:.2f} kN", f"{patch.tractive_force / 1e3:.2f} kN"  # shear ahead brakes the wheel
    ('4.00 kN', '-0.75 kN')
    """

    grid: Grid
    pressure: Array
    traction_x: Array | None = None
    traction_y: Array | None = None
    interpolation: Literal["constant", "bilinear"] = "constant"
    source: str = ""
    rib_sides: str = field(default="", repr=False)

    def __post_init__(self) -> None:
        if self.interpolation not in ("constant", "bilinear"):
            raise InputError(f'interpolation must be "constant" or "bilinear", got {self.interpolation!r}')
        for name in ("pressure", "traction_x", "traction_y"):
            array = getattr(self, name)
            values = np.zeros(self.grid.shape) if array is None else real_array(array, name)
            if values.shape != self.grid.shape:
                raise InputError(f"{name} has shape {values.shape}, the grid has {self.grid.shape} (ny, nx)")
            if not np.isfinite(values).all():
                where = tuple(int(i) for i in np.argwhere(~np.isfinite(values))[0])
                raise InputError(f"{name} must be finite, got {values[where]} in cell (y, x) = {where}")
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        lowest = float(self.pressure.min())
        if lowest < -_TINY * float(self.pressure.max(initial=0.0)):
            where = tuple(int(i) for i in np.unravel_index(int(self.pressure.argmin()), self.grid.shape))
            raise InputError(
                f"pressure must not be negative, got {lowest:g} Pa in cell (y, x) = {where}; pressure counts "
                "compression positive, unlike stress_zz"
            )

    @classmethod
    def from_arrays(
        cls,
        pressure: Array,
        traction_x: Array | None = None,
        traction_y: Array | None = None,
        *,
        spacing: float | str | tuple[float | str, float | str],
        x0: float | None = None,
        y0: float | None = None,
        shear_on: Literal["road", "tire"] = "road",
        interpolation: Literal["constant", "bilinear"] = "constant",
    ) -> GridLoad:
        """Load from arrays of stress, such as a sensor's.

        pressure: (ny, nx), Pa, rows along y (to the right), columns along x (travel). traction_x, traction_y:
        likewise. spacing: of the cells, m or text with a unit, or (dx, dy). x0, y0: centre of the first cell, m;
        None: the origin lies in the middle. shear_on: the body that the recorded shear acts on; what the tire
        is affected by, "tire", changes its sign. InputError for a wrong shape or value.
        """
        values = real_array(pressure, "pressure")
        if values.ndim != 2 or not values.size:
            raise InputError(f"pressure must be an array of rows along y, columns along x; got shape {values.shape}")
        sign = measured.shear_sign(shear_on)
        along, across = (
            None if part is None else sign * real_array(part, name)
            for name, part in (("traction_x", traction_x), ("traction_y", traction_y))
        )
        return cls(measured.grid_of(values.shape, spacing, x0, y0), values, along, across, interpolation)

    @classmethod
    def from_csv(
        cls,
        path: str | os.PathLike[str],
        *,
        shear_on: Literal["road", "tire"] = "road",
        interpolation: Literal["constant", "bilinear"] = "constant",
        **layout: Unpack[measured.Layout],
    ) -> GridLoad:
        """Load from a text file, a table of points or a matrix of pressures.

        layout: spacing=, x0=, y0=, units=, missing=, noise=, decimal= as `measured.read_csv` takes them.
        """
        sign = measured.shear_sign(shear_on)
        return cls._of(measured.read_csv(path, **layout), interpolation, sign)

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        *,
        units: Mapping[str, str] | None = None,
        interpolation: Literal["constant", "bilinear"] = "constant",
    ) -> GridLoad:
        """Load from a NetCDF file: the contact of a saved result, or pressure over y and x. See `from_dataset`.

        Every variable is read in the unit that its attribute `units` names ("kPa", "N m-2", "mm"); units: variable →
        unit where the file names none, {"pressure": "kPa"}. Raises InputError where neither does.
        """
        return cls._of(measured.read_netcdf(path, units), interpolation)

    @classmethod
    def from_dataset(
        cls,
        dataset: Source,
        *,
        units: Mapping[str, str] | None = None,
        interpolation: Literal["constant", "bilinear"] = "constant",
    ) -> GridLoad:
        """Load from `pressure`, `traction_x` and `traction_y` over `y` and `x`; a missing shear is zero.

        dataset: a dataset, or a result that has one, such as a contact. Its attributes dx and dy give the cell
        where a single coordinate cannot. A variable whose attribute `units` names another unit than SI is converted;
        units: variable → unit where there is none; else SI, as all bare numbers.
        Raises InputError if pressure or a coordinate is missing, or the coordinates are not evenly spaced.
        """
        data = dataset_of(dataset)
        load = cls._of(measured.of_dataset(data, units=units), interpolation)
        return replace(load, rib_sides=str(data.attrs.get(RIB_SIDES, "")))

    @classmethod
    def _of(
        cls, read: measured.Recorded, interpolation: Literal["constant", "bilinear"], sign: float = 1.0
    ) -> GridLoad:
        """Load as recorded; sign: of its shear."""
        along, across = (None if part is None else sign * part for part in (read.traction_x, read.traction_y))
        return cls(read.grid, read.pressure, along, across, interpolation, read.source)

    @property
    def spectrum(self) -> Spectrum:
        """Its Fourier transform, exact for its interpolation, see `kernels.layers.wavenumbers.cells_spectrum`."""
        transform = bilinear_spectrum if self.interpolation == "bilinear" else cells_spectrum
        return transform(self.array, self.grid.dx, self.grid.dy, self.grid.x0, self.grid.y0)

    def moved(self, x: float = 0.0, y: float = 0.0) -> GridLoad:
        """The same load moved by x and y, m."""
        _check_move(x, y)
        return replace(self, grid=replace(self.grid, x0=self.grid.x0 + x, y0=self.grid.y0 + y))

    def mirrored(self) -> GridLoad:
        """Its image in the plane y = 0, as the left wheel of an axle is the right one's: traction_y turns round."""
        grid = replace(self.grid, y0=-(self.grid.y0 + (self.grid.ny - 1) * self.grid.dy))
        pressure, along, across = self.array[:, ::-1]
        return replace(self, grid=grid, pressure=pressure, traction_x=along, traction_y=-across)

    def __str__(self) -> str:
        """What presses where, so that a wrong unit shows."""
        loaded = float((self.pressure > 0).sum()) * self.grid.cell_area
        parts = [
            f"{_plain(self.normal_load / 1e3)} kN on {_plain(loaded * 1e6)} mm² ({self.grid})",
            f"peak pressure {_plain(float(self.pressure.max()) / 1e3)} kPa",
        ]
        shear = float(np.hypot(self.array[1], self.array[2]).max())
        return ", ".join([*parts, f"peak shear {_plain(shear / 1e3)} kPa"] if shear else parts)

    @property
    def normal_load(self) -> float:
        """Force on the road, N, down."""
        return float(self.array[0].sum() * self.grid.cell_area)

    @property
    def tractive_force(self) -> float:
        """Force of the road on the tire along travel, N: minus the sum of traction_x, positive when driving."""
        return -float(self.array[1].sum() * self.grid.cell_area)

    @property
    def lateral_force(self) -> float:
        """Force of the road on the tire to the right, N: minus the sum of traction_y."""
        return -float(self.array[2].sum() * self.grid.cell_area)

    @property
    def array(self) -> Array:
        """(3, ny, nx): pressure, traction_x, traction_y, Pa."""
        array: Array = np.stack([self.pressure, self.traction_x, self.traction_y])  # type: ignore[list-item]
        return array

    @property
    def extent_x(self) -> tuple[float, float]:
        """First and last loaded point along x, m."""
        edge = (1.0 if self.interpolation == "bilinear" else 0.5) * self.grid.dx
        return self.grid.x0 - edge, self.grid.x0 + (self.grid.nx - 1) * self.grid.dx + edge

    @property
    def extent_y(self) -> tuple[float, float]:
        """First and last loaded point along y, m."""
        edge = (1.0 if self.interpolation == "bilinear" else 0.5) * self.grid.dy
        return self.grid.y0 - edge, self.grid.y0 + (self.grid.ny - 1) * self.grid.dy + edge

    __repr__ = as_call


@dataclass(frozen=True)
class UniformDisc:
    """Uniform pressure on a disc.

    radius: m, > 0. pressure: Pa, >= 0. x, y: centre, m. Raises InputError for a wrong value.

    >>> disc = tl.UniformDisc(radius=0.15, pressure=700e3)
    >>> f"{disc.pressure * 3.14159 * disc.radius**2 / 1e3:.1f} kN"
    '49.5 kN'
    """

    radius: float
    pressure: float
    x: float = 0.0
    y: float = 0.0

    def __post_init__(self) -> None:
        _check_uniform("disc", {"radius": self.radius}, self.pressure, {"x": self.x, "y": self.y})

    def moved(self, x: float = 0.0, y: float = 0.0) -> UniformDisc:
        """The same load moved by x and y, m."""
        _check_move(x, y)
        return replace(self, x=self.x + x, y=self.y + y)

    def mirrored(self) -> UniformDisc:
        """Its image in the plane y = 0."""
        return replace(self, y=-self.y)

    @property
    def normal_load(self) -> float:
        """Force on the road, N, down."""
        return math.pi * self.radius**2 * self.pressure

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

    >>> patch = tl.response.UniformRectangle(0.2, 0.15, 800e3)
    >>> patch
    UniformRectangle(length=0.2, width=0.15, pressure=800000.0, x=0.0, y=0.0, traction_x=0.0, traction_y=0.0)
    """

    length: float
    width: float
    pressure: float
    x: float = 0.0
    y: float = 0.0
    traction_x: float = 0.0
    traction_y: float = 0.0

    def __post_init__(self) -> None:
        further = {name: getattr(self, name) for name in ("x", "y", "traction_x", "traction_y")}
        _check_uniform("rectangle", {"length": self.length, "width": self.width}, self.pressure, further)

    def moved(self, x: float = 0.0, y: float = 0.0) -> UniformRectangle:
        """The same load moved by x and y, m."""
        _check_move(x, y)
        return replace(self, x=self.x + x, y=self.y + y)

    def mirrored(self) -> UniformRectangle:
        """Its image in the plane y = 0: traction_y turns round."""
        return replace(self, y=-self.y, traction_y=-self.traction_y)

    @property
    def normal_load(self) -> float:
        """Force on the road, N, down."""
        return self.length * self.width * self.pressure

    @property
    def tractive_force(self) -> float:
        """Force of the road on the tire along travel, N, positive when driving."""
        return -self.length * self.width * self.traction_x

    @property
    def lateral_force(self) -> float:
        """Force of the road on the tire to the right, N."""
        return -self.length * self.width * self.traction_y

    @property
    def cell(self) -> GridLoad:
        """The same as a grid of one cell."""
        grid = Grid(1, 1, self.length, self.width, self.x, self.y)
        ones = np.ones((1, 1))
        return GridLoad(grid, self.pressure * ones, self.traction_x * ones, self.traction_y * ones)


Load: TypeAlias = "GridLoad | UniformDisc | UniformRectangle | Source"
PlacedLoad = GridLoad | UniformDisc | UniformRectangle
SurfaceLoad = GridLoad | UniformDisc


def gather(loads: Load | Sequence[Load]) -> tuple[PlacedLoad, ...]:
    """Loads to superpose, from one or several contacts, datasets, GridLoads, discs and rectangles."""
    single = isinstance(loads, PlacedLoad) or has_fields(loads)
    several: Any = [loads] if single else loads
    if not isinstance(several, Sequence) or isinstance(several, str) or not len(several):
        raise InputError(
            "loads must be a contact, a dataset, a GridLoad, a UniformDisc, a UniformRectangle or a list of these, "
            f"got {_kind(loads)}"
        )
    return tuple(_load(item) for item in several)


def _check_uniform(kind: str, sizes: dict[str, float], pressure: float, further: dict[str, float]) -> None:
    for name, value in sizes.items():
        positive(f"the {name} of a {kind}", value, "metres", "150 mm is 0.15")
    if not (math.isfinite(pressure) and pressure >= 0):
        raise InputError(f"the pressure of a {kind} must be >= 0 Pa, got {pressure}; compression counts positive")
    for name, value in further.items():
        if not math.isfinite(value):
            raise InputError(f"{name} of a {kind} must be finite, got {value}")


def _check_move(x: float, y: float) -> None:
    if not (math.isfinite(x) and math.isfinite(y)):
        raise InputError(f"a load moves by finite numbers of metres, got x = {x}, y = {y}")


def _load(item: Load) -> PlacedLoad:
    if isinstance(item, PlacedLoad):
        return item
    if has_fields(item):
        return GridLoad.from_dataset(item)
    raise InputError(f"a load must be a contact, a dataset or a GridLoad, got {_kind(item)}")


def _kind(value: object) -> str:
    return f"an empty {type(value).__name__}" if isinstance(value, Sequence) and not value else type(value).__name__


def _plain(value: float) -> str:
    """Four digits, and all of a whole number."""
    return f"{value:.0f}" if 1e3 <= value < 1e9 else f"{value:.4g}"
