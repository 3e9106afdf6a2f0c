"""Textures from files: laser profiles, height maps, OpenCRG."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal

import numpy as np

from treadload.errors import InputError, one_line
from treadload.files import read_tree
from treadload.kernels.arrays import Array
from treadload.labels import factor_of, factor_of_argument
from treadload.metrology import ENDINGS, read_surface_map
from treadload.pavement.texture.crg import read_crg
from treadload.pavement.texture.description import Texture
from treadload.tables import read_table, real_array

_MOST_BYTES = 2**29
# The line that ends the header of a stationary laser profilometer.
_LASER = "*****DATA*****"
# Distances between points may differ by their rounding, as a part of the step.
_UNEVEN = 0.2


def read_texture(
    path: str | os.PathLike[str],
    *,
    spacing: float | tuple[float, float] | None = None,
    units: str | None = None,
    decimal: Literal[".", ","] | None = None,
) -> Texture:
    """Texture of a file, as it was measured: drop-outs stay NaN, nothing is levelled or filtered.

    path: OpenCRG (.crg); a stationary laser's text (header, *****DATA*****, number, distance in mm, height in mm); a
    matrix of heights as CSV, text or NPY (rows across, columns along travel; one row or column is a profile);
    NetCDF, its only variable over (y, x) or x; or a surface of metrology, X3P, SDF, SUR or AL3D (see `metrology`),
    its x along travel, which brings its spacing and units. spacing: m, or (dx, dy), of a matrix. units: of the
    heights of a matrix or of a variable that names none, "mm"; m if left out of a matrix, refused of NetCDF.
    Raises InputError.
    """
    path = Path(path)
    if not os.path.isfile(path):
        raise InputError(f"no file {str(path)!r}: give the path of a CRG, laser, CSV, text, NPY or NetCDF texture")
    if path.stat().st_size > _MOST_BYTES:
        raise InputError(
            f"{path.name!r} has {path.stat().st_size / 1e6:.0f} MB, more than {_MOST_BYTES / 1e6:.0f}; cut a piece "
            "of it"
        )
    suffix = path.suffix.lower()
    if suffix == ".crg":
        return read_crg(path).texture()
    if suffix in ENDINGS:
        measured = read_surface_map(path, options=(spacing, units, decimal))
        # Seen from above, y of an instrument runs to the left of its x; that of a road to the right.
        return Texture(measured.heights[::-1], measured.dx, measured.dy, source=measured.source)
    if suffix in (".nc", ".nc4", ".h5", ".cdf"):
        return _netcdf(path, units)
    if suffix not in (".csv", ".txt", ".dat", ".tsv", ".npy"):
        raise InputError(
            f"{path.name!r} has the unknown ending {suffix!r} for a texture; "
            f"use .crg, .dat, .csv, .txt, .tsv, .npy, .nc or a surface as {', '.join(ENDINGS)}"
        )
    if suffix != ".npy" and _is_laser(path):
        return _laser(path)
    return _matrix(path, suffix, spacing, units, decimal)


def _is_laser(path: Path) -> bool:
    with path.open("rb") as stream:
        return _LASER.encode() in stream.read(4096)


def _laser(path: Path) -> Texture:
    """A profile of numbered points, distance and height in mm; an empty height is a drop-out."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise InputError(f"{path.name!r} is no text: {one_line(str(error))}") from error
    start = next((number for number, line in enumerate(lines) if line.strip() == _LASER), None)
    if start is None:
        raise InputError(f"{path.name!r} names {_LASER}, but not on a line of its own, below which its points begin")
    rows = [
        (number, line.split("\t")) for number, line in enumerate(lines[start + 2 :], start=start + 3) if line.strip()
    ]
    if len(rows) < 2:
        raise InputError(f"{path.name!r} has {len(rows)} points below {_LASER}; a profile needs two or more")
    places, heights = np.empty(len(rows)), np.empty(len(rows))
    for point, (number, cells) in enumerate(rows):
        try:
            places[point] = float(cells[1])
            heights[point] = float(cells[2]) if len(cells) > 2 and cells[2].strip() else np.nan
        except (ValueError, IndexError) as error:
            raise InputError(
                f"{path.name!r}, line {number}: expected number, distance and height in mm apart by tabs, got "
                f"{one_line(chr(9).join(cells))!r}"
            ) from error
    step = (places[-1] - places[0]) / (places.size - 1)
    uneven = not np.isfinite(places).all() or step <= 0
    if uneven or np.abs(places - places[0] - step * np.arange(places.size)).max() > max(_UNEVEN * step, 2e-3):
        raise InputError(
            f"{path.name!r}: the distances do not rise in even steps, from {places[0]:g} to {places[-1]:g} mm in "
            f"{places.size} points; sort them, or resample the profile"
        )
    return Texture(1e-3 * heights, 1e-3 * step, 1e-3 * step, source=f"laser profile {path.name}")


def _matrix(
    path: Path, suffix: str, spacing: float | tuple[float, float] | None, units: str | None, decimal: str | None
) -> Texture:
    if spacing is None:
        raise InputError(f"{path.name!r} does not state how far apart its points are; give spacing in m, e.g. 0.5e-3")
    if suffix == ".npy":
        try:
            with path.open("rb") as stream:
                heights = real_array(np.load(stream, allow_pickle=False), f"{path.name!r}")
        except InputError:
            raise
        except Exception as error:
            raise InputError(
                f"{path.name!r} could not be read as a matrix of numbers: {one_line(str(error))}"
            ) from error
    else:
        heights, _ = read_table(path, decimal=decimal).values(name=lambda column: "the height")
    return of_matrix(heights, spacing, units, source=f"{path.name}, heights in {units or 'm'}")


def of_matrix(
    heights: Array, spacing: float | tuple[float, float], units: str | None = None, source: str = ""
) -> Texture:
    """Texture of an array of heights (ny, nx) in a unit, m if left out; one row or one column is a profile."""
    try:
        steps = tuple(float(step) for step in np.atleast_1d(np.asarray(spacing, dtype=float)))
    except (TypeError, ValueError):
        steps = ()
    if len(steps) not in (1, 2):
        raise InputError(f"spacing must be a number of m, or (dx, dy), got {spacing!r}")
    heights = np.atleast_2d(real_array(heights, "a texture"))
    if heights.ndim == 2 and heights.shape[1] == 1:
        heights = heights.T
    with np.errstate(over="ignore"):
        scaled = heights * (factor_of_argument("heights", units, "m") if units else 1.0)
    return Texture(scaled, steps[0], steps[-1], source=source)


def _netcdf(path: Path, units: str | None) -> Texture:
    data = read_tree(path, "NetCDF-4").to_dataset()
    named = [str(name) for name, part in data.data_vars.items() if part.dims in (("y", "x"), ("x", "y"), ("x",))]
    if len(named) != 1:
        raise InputError(f"{path.name!r} must hold one variable of heights over (y, x) or x, found {named or 'none'}")
    part = data[named[0]]
    units_of = {} if units is None else {"heights": units, "x": units, "y": units}
    if part.dtype.kind not in "iuf":
        raise InputError(f"{path.name!r}: {named[0]} must hold numbers in m or the like, got {part.dtype}")
    factor = factor_of("heights", part.attrs.get("units"), "m", units_of, where=path.name, bare=None)
    if part.dims == ("x", "y"):
        part = part.transpose("y", "x")
    steps = {}
    for name in part.dims:
        if name not in part.coords or part[name].size < 2:
            raise InputError(f"{path.name!r} needs the coordinate {name} of {named[0]}, two places or more")
        unit = factor_of(str(name), part[name].attrs.get("units"), "m", units_of, where=path.name, bare=None)
        places = unit * part[name].to_numpy().astype(float)
        step = np.diff(places)
        if (
            not np.isfinite(places).all()
            or not np.allclose(step, step.mean(), rtol=_UNEVEN, atol=0)
            or step.mean() <= 0
        ):
            raise InputError(f"{path.name!r}: {name} must rise in even steps; sort it, or resample the map")
        steps[str(name)] = float(step.mean())
    with np.errstate(over="ignore"):
        heights = factor * real_array(part.to_numpy(), f"{named[0]!r} of {path.name!r}")
    return Texture(heights, steps["x"], steps.get("y", steps["x"]), source=f"{path.name}: {named[0]}")
