"""What every tread surface can do, and the surface given as a height map."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Protocol, runtime_checkable

import numpy as np

from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.tire.quality import ScanQuality


@runtime_checkable
class Surface(Protocol):
    """A tread surface that can say its gap to the tangent plane at first contact."""

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
        """How good the scan was, or None when the surface is no scan."""
        ...

    def height_map(self, grid: Grid) -> Array:
        """(ny, nx) gap in m from the tread to the tangent plane, ≥ 0; NaN where there is no material."""
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
    grid: cells of the map.
    Raises InputError for infinite values or a shape that is not the grid's, GeometryError for a map of NaN only.
    """

    gap: Array
    grid: Grid

    def __post_init__(self) -> None:
        gap = np.array(self.gap, dtype=np.float64)
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
        gap -= np.nanmin(gap)
        # NaN has many bit patterns; one of them, so that equal maps have equal digests.
        gap[np.isnan(gap)] = np.nan
        gap += 0.0
        gap.flags.writeable = False
        object.__setattr__(self, "gap", gap)

    @cached_property
    def _digest(self) -> str:
        return fingerprint(self.gap, self.grid)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, HeightMapSurface):
            return NotImplemented
        return self._digest == other._digest

    def __hash__(self) -> int:
        return hash(self._digest)

    def __repr__(self) -> str:
        return f"HeightMapSurface({self.grid})"

    def __str__(self) -> str:
        return f"height map, {self.grid}"

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

    def height_map(self, grid: Grid) -> Array:
        """(ny, nx) gap, m. Raises InputError for any grid but the map's own (there is no interpolation)."""
        own = self.grid
        near = 1e-6 * min(own.dx, own.dy)
        same = grid.shape == own.shape and np.allclose(
            [grid.dx, grid.dy, grid.x0, grid.y0], [own.dx, own.dy, own.x0, own.y0], rtol=1e-9, atol=near
        )
        if not same:
            raise InputError(
                f"this tire is a height map on {own} and was asked for on {grid}; "
                "leave the spacing out, or make the map anew at the spacing you want"
            )
        return self.gap.copy()


def read_height_map(path: str | Path, spacing: tuple[float, float] | None) -> HeightMapSurface:
    """Height map of a file.

    path: NetCDF (variable `initial_gap`, or its only 2-D one, on coordinates x and y in m), or a matrix of
    numbers in m as text, CSV, NPY or NPZ (rows along y, columns along x). spacing: (dx, dy) in m, for a matrix.
    Raises InputError when it is missing, unreadable or without spacing.
    """
    path = Path(path)
    if not path.is_file():
        raise InputError(f"no file {str(path)!r}: give the path of a NetCDF, CSV, text, NPY or NPZ height map")
    suffix = path.suffix.lower()
    if suffix in (".nc", ".nc4", ".h5", ".cdf"):
        return _read_netcdf(path, spacing)
    if suffix not in (".csv", ".txt", ".dat", ".tsv", ".npy", ".npz"):
        raise InputError(
            f"{path.name!r} has the unknown ending {suffix!r} for a height map; "
            "use .nc, .csv, .txt, .dat, .tsv, .npy or .npz"
        )
    if spacing is None:
        raise InputError(f"{path.name!r} does not say the size of its cells; give spacing in m, e.g. spacing=3e-3")
    try:
        gap = _read_matrix(path, suffix)
    except InputError:
        raise
    except Exception as error:
        raise InputError(f"{path.name!r} could not be read as a matrix of numbers: {error}") from error
    return centred_height_map(gap, spacing)


def centred_height_map(gap: Array, spacing: tuple[float, float]) -> HeightMapSurface:
    """Height map of an array (ny, nx) in m with its origin at the middle. spacing: (dx, dy), m."""
    gap = np.asarray(gap, dtype=np.float64)
    if gap.ndim != 2 or gap.size == 0:
        raise InputError(f"a height map must be a 2-D array (ny, nx) with at least one value, got shape {gap.shape}")
    ny, nx = gap.shape
    dx, dy = spacing
    return HeightMapSurface(gap, Grid(nx, ny, dx, dy, -0.5 * (nx - 1) * dx, -0.5 * (ny - 1) * dy))


def _read_matrix(path: Path, suffix: str) -> Array:
    if suffix == ".npy":
        return np.asarray(np.load(path, allow_pickle=False), dtype=np.float64)
    if suffix == ".npz":
        with np.load(path, allow_pickle=False) as archive:
            names = [name for name in archive.files if archive[name].ndim == 2]
            if "initial_gap" in names:
                names = ["initial_gap"]
            if len(names) != 1:
                raise InputError(
                    f"{path.name!r} must hold one 2-D array or one named 'initial_gap', found {names or 'none'}"
                )
            return np.asarray(archive[names[0]], dtype=np.float64)
    text = path.read_text(encoding="utf-8-sig")
    if not text.strip():
        raise InputError(f"{path.name!r} is empty; write the height map again")
    delimiter = next((mark for mark in (";", "\t", ",") if mark in text), None)
    return np.atleast_2d(
        np.genfromtxt(text.splitlines(), delimiter=delimiter, dtype=np.float64, missing_values="", invalid_raise=True)
    )


def _read_netcdf(path: Path, spacing: tuple[float, float] | None) -> HeightMapSurface:
    import xarray as xr

    try:
        with xr.open_dataset(path, engine="h5netcdf") as opened:
            data = opened.load()
    except Exception as error:
        raise InputError(f"{path.name!r} could not be read as NetCDF-4: {error}") from error
    planar = [str(name) for name, variable in data.data_vars.items() if variable.ndim == 2]
    if "initial_gap" in planar:
        planar = ["initial_gap"]
    if len(planar) != 1:
        raise InputError(
            f"{path.name!r} must hold the variable 'initial_gap' or exactly one 2-D variable, "
            f"found {planar or 'none'}"
        )
    variable = data[planar[0]]
    if {"x", "y"} <= set(variable.dims):
        variable = variable.transpose("y", "x")
    unit = variable.attrs.get("units", "m")
    if unit != "m":
        raise InputError(f"variable {planar[0]!r} of {path.name!r} is in {unit!r}; it must be in m")
    if not {"x", "y"} <= set(data.coords):
        if spacing is None:
            raise InputError(f"{path.name!r} has no coordinates x and y; add them in m, or give spacing in m")
        return centred_height_map(variable.to_numpy(), spacing)
    variable = variable.sortby(["y", "x"])
    x0, dx = _even_steps(variable["x"].to_numpy(), "x", path.name, None if spacing is None else spacing[0])
    y0, dy = _even_steps(variable["y"].to_numpy(), "y", path.name, None if spacing is None else spacing[1])
    gap = variable.to_numpy()
    ny, nx = gap.shape
    return HeightMapSurface(gap, Grid(nx, ny, dx, dy, x0, y0))


def _even_steps(values: Array, name: str, file: str, given: float | None) -> tuple[float, float]:
    """First value and step of an evenly spaced coordinate, m."""
    if len(values) < 2:
        if given is None:
            raise InputError(f"coordinate {name} of {file!r} has one value and gives no spacing; give spacing in m")
        return float(values[0]), given
    step = float(values[-1] - values[0]) / (len(values) - 1)
    error = float(np.abs(np.diff(values) - step).max())
    if not step > 0 or error > 1e-3 * step:
        raise InputError(
            f"coordinate {name} of {file!r} is not evenly spaced: "
            f"steps differ by up to {error:.3g} m from {step:.3g} m"
        )
    if given is not None and abs(given - step) > 1e-3 * step:
        raise InputError(
            f"spacing along {name} was given as {given:g} m but {file!r} has {step:g} m; leave spacing out"
        )
    return float(values[0]), step
