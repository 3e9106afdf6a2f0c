"""What every tread surface can do, and the surface given as a height map."""

from __future__ import annotations

import hashlib
import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from treadload.errors import GeometryError, InputError, one_line
from treadload.files import read_tree
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.labels import check_names, factor_of, factor_of_argument
from treadload.metrology import ENDINGS, read_surface_map
from treadload.tables import read_table, real_array
from treadload.tire.crown import arc_radius
from treadload.tire.quality import ScanQuality

if TYPE_CHECKING:
    import xarray as xr

# What a map of a height is made of.
_NAMES = ("gap", "x", "y")
# A groove on a small piece of tread is this deep, m.
_DEEP = 0.05
FLATTEST = 5.0  # a map that bends less is not of a wheel, m


@runtime_checkable
class Surface(Protocol):
    """A tread surface that gives its gap to the tangent plane at first contact.

    >>> tread = tl.tire.ProfileSurface(tl.tire.TreadProfile(rolling_radius=0.5, crown_radius=1.0, width=0.2))
    >>> isinstance(tread, tl.tire.Surface), round(tread.extent[1], 2)  # m, across
    (True, 0.22)
    """

    @property
    def extent(self) -> tuple[float, float]:
        """(length, width), m: the largest piece around the contact that the surface describes."""
        ...

    @property
    def fixed_grid(self) -> Grid | None:
        """The only grid the surface knows, or None when any grid will do."""
        ...

    @property
    def quality(self) -> ScanQuality | None:
        """How good the scan was, or None when the surface is not a scan."""
        ...

    def height_map(self, grid: Grid) -> Array:
        """(ny, nx) gap in m from the tread to the tangent plane, ≥ 0; NaN where there is no material."""
        ...


@runtime_checkable
class Raised(Protocol):
    """A tread's surface above a road that is no plane: the tread is that of `tread_surface`."""

    @property
    def tread_surface(self) -> Surface:
        """The tread itself."""
        ...

    def above_road(self, gap: Array, grid: Grid) -> Array:
        """(ny, nx) gap to the road, m, of a gap to its plane."""
        ...


def fingerprint(*parts: object) -> str:
    """Digest of arrays and printable values: equal contents give equal text."""
    digest = hashlib.sha256()
    for part in parts:
        if isinstance(part, np.ndarray):
            digest.update(repr((part.shape, part.dtype.str)).encode())
            digest.update(np.ascontiguousarray(part).tobytes())
        else:
            digest.update(repr(part).encode())
    return digest.hexdigest()


@dataclass(frozen=True, eq=False)
class HeightMapSurface:
    """A tread known by its gap on a grid of its own.

    gap: (ny, nx), m; NaN means no material there; its minimum is shifted to 0.
    grid: cells of the map. source: the file it was read from and how it was understood, for people.
    Raises InputError for infinite values or a shape that is not the grid's, GeometryError for a map of NaN only.

    >>> grid = tl.response.Grid.centred(0.04, 0.04, 0.02)
    >>> tread = tl.tire.HeightMapSurface([[0.020, 0.032], [0.020, 0.032]], grid)
    >>> (tread.height_map(grid) * 1e3).round().tolist()  # mm above the first contact
    [[0.0, 12.0], [0.0, 12.0]]
    """

    gap: Array
    grid: Grid
    source: str = ""

    def __post_init__(self) -> None:
        gap = real_array(self.gap, "a height map")
        if gap.ndim != 2 or gap.shape != self.grid.shape:
            raise InputError(f"a height map must be 2-D of shape (ny, nx) = {self.grid.shape}, got {gap.shape}")
        if np.isinf(gap).any():
            raise InputError(
                f"the height map has {int(np.isinf(gap).sum())} infinite values; write NaN where there is no material"
            )
        if np.isnan(gap).all():
            raise GeometryError(
                f"all {gap.size} values of the height map are NaN; at least one must be a length in m"
            )
        with np.errstate(over="ignore"):
            gap -= np.nanmin(gap)
        if np.isinf(gap).any():
            raise InputError("the heights of the map differ by more than the largest number, 1.8e308")
        # NaN has many bit patterns; one of them, so that equal maps have equal digests.
        gap[np.isnan(gap)] = np.nan
        gap += 0.0
        gap.flags.writeable = False
        object.__setattr__(self, "gap", gap)

    @cached_property
    def _digest(self) -> str:
        return fingerprint(self.gap, self.grid)

    def __eq__(self, surface: object) -> bool:
        if not isinstance(surface, HeightMapSurface):
            return NotImplemented
        return self._digest == surface._digest

    def __hash__(self) -> int:
        return hash(self._digest)

    def __repr__(self) -> str:
        return f"HeightMapSurface({self.grid})"

    def __str__(self) -> str:
        holes = int(np.isnan(self.gap).sum())
        text = f"height map, {self.grid}, gap up to {self.relief * 1e3:.4g} mm, "
        text += f"{holes} of {self.gap.size} without material" if holes else "no holes"
        return f"{text}; read from {self.source}" if self.source else text

    @property
    def relief(self) -> float:
        """From the lowest to the highest cell, m."""
        return float(np.nanmax(self.gap))

    @property
    def is_steep(self) -> bool:
        """True if the map is higher than it is long: no tread is, but millimetres taken for metres are."""
        return self.relief > max(math.hypot(*self.extent), _DEEP)

    @property
    def extent(self) -> tuple[float, float]:
        """(length, width) of the map, m."""
        return self.grid.nx * self.grid.dx, self.grid.ny * self.grid.dy

    @property
    def fixed_grid(self) -> Grid | None:
        """The grid of the map."""
        return self.grid

    @property
    def quality(self) -> ScanQuality | None:
        """None: a height map is taken as it is."""
        return None

    @property
    def outer_radius(self) -> float | None:
        """Radius, m, of the parabola through the lowest point of every column; None when it does not bend up."""
        columns = np.isfinite(self.gap).any(axis=0)
        if columns.sum() < 5:
            return None
        x = self.grid.x[columns]
        low = np.nanmin(self.gap[:, columns], axis=0)
        # In cells, so that the fit is well conditioned at any scale.
        bend = float(np.polyfit((x - x.mean()) / self.grid.dx, low, 2)[0]) / self.grid.dx**2
        return 0.5 / bend if bend > 0.5 / FLATTEST else None

    @property
    def crown_arc_radius(self) -> float | None:
        """Radius across, m, of the arc through the lowest point of every row; see `crown.arc_radius`."""
        low = np.fmin.reduce(self.gap, axis=1)
        with np.errstate(invalid="ignore"):
            return arc_radius(self.grid.y, np.where(low < _DEEP, low, np.nan))

    def height_map(self, grid: Grid) -> Array:
        """(ny, nx) gap, m. Raises InputError for any grid but the map's own (there is no interpolation)."""
        axes = self.grid
        near = 1e-6 * min(axes.dx, axes.dy)
        same = grid.shape == axes.shape and np.allclose(
            [grid.dx, grid.dy, grid.x0, grid.y0], [axes.dx, axes.dy, axes.x0, axes.y0], rtol=1e-9, atol=near
        )
        if not same:
            raise InputError(
                f"this tire is a height map on {axes} and was asked for on {grid}; "
                "leave the spacing out, or make the map again at the spacing you want"
            )
        return self.gap.copy()


def read_height_map(
    path: str | Path,
    spacing: tuple[float, float] | None,
    units: str | Mapping[str, str] | None = None,
    decimal: str | None = None,
) -> HeightMapSurface:
    """Height map of a file.

    path: NetCDF (variable `initial_gap`, or its only 2-D one, on coordinates x and y), a matrix of numbers as
    text, CSV, NPY or NPZ (rows along y, columns along x), or heights above the tread of surface metrology, X3P, SDF,
    SUR or AL3D (see `metrology`), whose highest point touches the road. spacing: (dx, dy) in m, for a matrix.
    units: of the gap of a matrix, {"gap": "mm"}, m if left out; of variables of a NetCDF file that name none, "gap",
    "x" and "y", which are refused if left out. A text alone, "mm", is the unit of all three. decimal: "." or ",", of
    a text that can be read in two ways. An empty cell, NaN, NA, N/A, NoData and null mean no material.
    Raises InputError when it is missing, unreadable, without spacing or unit, or steeper than a tread can be.
    """
    path = Path(path)
    if not os.path.isfile(path):
        raise InputError(f"no file {str(path)!r}: give the path of a NetCDF, CSV, text, NPY or NPZ height map")
    suffix = path.suffix.lower()
    units_of = units_by_name(units)
    if suffix in ENDINGS:
        measured = read_surface_map(path, options=(spacing, units, decimal))
        # The outside of the tread is up in the file, and down on the road.
        top = float(np.nanmax(measured.heights))
        surface = centred_height_map(top - measured.heights, (measured.dx, measured.dy), measured.source)
    elif suffix in (".nc", ".nc4", ".h5", ".cdf"):
        surface = _read_netcdf(path, spacing, units_of)
    elif suffix not in (".csv", ".txt", ".dat", ".tsv", ".npy", ".npz"):
        raise InputError(
            f"{path.name!r} has the unknown ending {suffix!r} for a height map; "
            f"use .nc, .csv, .txt, .dat, .tsv, .npy, .npz or a surface as {', '.join(ENDINGS)}"
        )
    elif spacing is None:
        raise InputError(f"{path.name!r} does not state the size of its cells; give spacing in m, e.g. spacing=3e-3")
    else:
        gap, how = _read_matrix(path, suffix, decimal)
        source = f"{path.name}{how}, gap in {units_of.get('gap', 'm')}"
        surface = centred_height_map(in_metres(gap, units_of), spacing, source)
    if surface.is_steep:
        length, width = surface.extent
        raise InputError(
            f"{path.name!r}: its heights differ by {surface.relief:.4g} m on a map of {length:.3g} x {width:.3g} m, "
            'more than any tread\'s; give units={"gap": "mm"}, or write NaN where there is no material'
        )
    return surface


def units_by_name(units: str | Mapping[str, str] | None) -> dict[str, str]:
    """Units of gap, x and y by name, from a mapping or one text for all. Raises InputError."""
    if isinstance(units, str):
        return dict.fromkeys(_NAMES, units)
    named_units = dict(units or {})
    check_names(named_units, _NAMES, "the names of a height map")
    return named_units


def in_metres(gap: Array, units: Mapping[str, str]) -> Array:
    """A gap in the unit that was given for it, in m."""
    with np.errstate(over="ignore"):
        return gap * factor_of_argument("gap", units["gap"], "m") if "gap" in units else gap


def centred_height_map(gap: Array, spacing: tuple[float, float], source: str = "") -> HeightMapSurface:
    """Height map of an array (ny, nx) in m with its origin at the middle. spacing: (dx, dy), m."""
    gap = real_array(gap, "a height map")
    if gap.ndim != 2 or gap.size == 0:
        raise InputError(f"a height map must be a 2-D array (ny, nx) with at least one value, got shape {gap.shape}")
    ny, nx = gap.shape
    dx, dy = spacing
    return HeightMapSurface(gap, Grid(nx, ny, dx, dy, -0.5 * (nx - 1) * dx, -0.5 * (ny - 1) * dy), source)


def _read_matrix(path: Path, suffix: str, decimal: str | None) -> tuple[Array, str]:
    """Gap as it stands in the file, and how it was understood."""
    if suffix not in (".npy", ".npz"):
        gap, how = read_table(path, decimal=decimal).values(name=lambda column: "the gap")
        return gap, f": {how}"
    try:
        # Opened here: of a broken archive numpy forgets to close the file.
        with path.open("rb") as stream:
            loaded = np.load(stream, allow_pickle=False)
            if isinstance(loaded, np.ndarray):
                return real_array(loaded, f"{path.name!r}"), ""
            with loaded as archive:
                arrays = {name: archive[name] for name in archive.files}
    except InputError:
        raise
    except Exception as error:
        raise InputError(f"{path.name!r} could not be read as a matrix of numbers: {one_line(str(error))}") from error
    names = [name for name, array in arrays.items() if array.ndim == 2]
    if "initial_gap" in names:
        names = ["initial_gap"]
    if len(names) != 1:
        raise InputError(f"{path.name!r} must hold one 2-D array or one named 'initial_gap', found {names or 'none'}")
    return real_array(arrays[names[0]], f"{names[0]!r} of {path.name!r}"), ""


def _read_netcdf(path: Path, spacing: tuple[float, float] | None, units: Mapping[str, str]) -> HeightMapSurface:
    data = read_tree(path, "NetCDF-4").to_dataset()
    planar = [str(name) for name, variable in data.data_vars.items() if variable.ndim == 2]
    if "initial_gap" in planar:
        planar = ["initial_gap"]
    if len(planar) != 1:
        raise InputError(
            f"{path.name!r} must hold the variable 'initial_gap' or exactly one 2-D variable, "
            f"found {planar or 'none'}"
        )
    return of_variable(data[planar[0]], spacing, units, where=path.name, strict=True)


def of_variable(
    variable: xr.DataArray,
    spacing: tuple[float, float] | None,
    units: Mapping[str, str],
    *,
    where: str = "",
    strict: bool = False,
) -> HeightMapSurface:
    """Height map of a variable over y and x.

    spacing: (dx, dy) in m, where it has no coordinates. units: of gap, x and y where the variable names none; strict:
    refuse it if neither does, m otherwise. where: the file it comes from. Raises InputError.
    """
    about = where or "the array"
    bare = None if strict else "m"
    if variable.ndim != 2 or not variable.size:
        raise InputError(
            f"a height map must be a 2-D array (ny, nx) of one value or more, got shape {variable.shape} of {about!r}"
        )
    factors = {"gap": _factor("gap", variable, units, about, bare)}
    if {"x", "y"} <= set(variable.dims):
        variable = variable.transpose("y", "x")
    if not {"x", "y"} <= set(variable.coords):
        if spacing is None:
            raise InputError(f"{about!r} has no coordinates x and y; add them in m, or give spacing in m")
        source = f"{where}: gap in {_unit_of('gap', variable, units)}" if where else ""
        return centred_height_map(factors["gap"] * real_array(variable.to_numpy(), about), spacing, source)
    for name in ("x", "y"):
        if variable[name].dims != (name,):
            raise InputError(f"coordinate {name} of {about!r} must run along {name}, got {variable[name].dims}")
        factors[name] = _factor(name, variable[name], units, about, bare)
    variable = variable.sortby(["y", "x"])
    steps: dict[str, tuple[float, float]] = {}
    for k, name in enumerate(("x", "y")):
        with np.errstate(over="ignore"):
            places = factors[name] * variable[name].to_numpy().astype(np.float64)
        steps[name] = _even_steps(places, name, about, None if spacing is None else spacing[k])
    with np.errstate(over="ignore"):
        gap = factors["gap"] * real_array(variable.to_numpy(), about)
    ny, nx = gap.shape
    variables = ", ".join(
        f"{name} in {_unit_of(name, part, units)}"
        for name, part in (("gap", variable), ("x", variable["x"]), ("y", variable["y"]))
    )
    grid = Grid(nx, ny, steps["x"][1], steps["y"][1], steps["x"][0], steps["y"][0])
    return HeightMapSurface(gap, grid, f"{where}: {variables}" if where else "")


def _unit_of(name: str, part: xr.DataArray, units: Mapping[str, str]) -> str:
    return str(part.attrs.get("units") or units.get(name, "m"))


def _factor(name: str, part: xr.DataArray, units: Mapping[str, str], about: str, bare: str | None) -> float:
    """What makes a part of a height map metres; refuses what holds no numbers."""
    if part.dtype.kind not in "iuf":
        # What names a unit of time is read as time.
        raise InputError(f"{about}: {name} must hold numbers in m or the like, got {part.dtype}")
    return factor_of(name, part.attrs.get("units"), "m", units, where=about, bare=bare)


def _even_steps(values: Array, name: str, file: str, stated_step: float | None) -> tuple[float, float]:
    """First value and step of an evenly spaced coordinate, m."""
    if len(values) < 2:
        if stated_step is None:
            raise InputError(f"coordinate {name} of {file!r} has one value and gives no spacing; give spacing in m")
        return float(values[0]), stated_step
    with np.errstate(over="ignore", invalid="ignore"):
        step = float(values[-1] - values[0]) / (len(values) - 1)
        error = float(np.abs(np.diff(values) - step).max())
    if not (math.isfinite(step) and step > 0 and error <= 1e-3 * step):
        raise InputError(
            f"coordinate {name} of {file!r} is not evenly spaced: "
            f"steps differ by up to {error:.3g} m from {step:.3g} m"
        )
    if stated_step is not None and abs(stated_step - step) > 1e-3 * step:
        raise InputError(
            f"spacing along {name} was given as {stated_step:g} m but {file!r} has {step:g} m; leave spacing out"
        )
    return float(values[0]), step
