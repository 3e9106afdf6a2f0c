"""A file of surface metrology becomes heights on even cells, in metres, with holes where nothing was measured."""

from __future__ import annotations

import io
import os
import warnings
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from treadload.errors import InputError, how_to_install, reading
from treadload.labels import factor
from treadload.metrology.archive import check_x3p
from treadload.metrology.headers import check_al3d, check_sdf, check_sur

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_CHECKS = {".x3p": check_x3p, ".sdf": check_sdf, ".sur": check_sur, ".al3d": check_al3d}
ENDINGS = tuple(_CHECKS)
"""Endings of files that `read_surface_map` knows."""

_MOST_BYTES = 2**29


@dataclass(frozen=True, eq=False)
class SurfaceMap:
    """Heights as they were measured.

    heights: (ny, nx), m, out of the surface positive; NaN where nothing was measured. Columns rise along x of the
    instrument, rows along its y, in the order of the file. dx, dy: between the points, m. source: the file and how it
    was understood, for people.
    """

    heights: NDArray[np.float64]
    dx: float
    dy: float
    source: str


def read_surface_map(path: str | os.PathLike[str], *, options: Iterable[object] = ()) -> SurfaceMap:
    """Heights of a surface from X3P (ISO 25178-72), SDF (ISO 25178-71), SUR (Digital Surf) or AL3D (Alicona).

    options: spacing, units and the like that the caller named, None or none: these files bring their own. Raises
    InputError for a file that is missing, damaged, a bomb, no single surface on even cells, or has no measured point,
    and without SurfaceTopography.
    """
    import numpy as np

    path = Path(path)
    if not os.path.isfile(path):
        raise InputError(f"no file {str(path)!r}: give the path of an X3P, SDF, SUR or AL3D surface")
    named = [option for option in options if option is not None]
    if named:
        raise InputError(
            f"{path.name!r} brings its own spacing and units, and {named[0]!r} was given; leave spacing, cell, units "
            "and decimal out"
        )
    size = path.stat().st_size
    if not 0 < size <= _MOST_BYTES:
        raise InputError(
            f"{path.name!r} has {size} bytes, between 1 and {_MOST_BYTES} can be read; cut a piece of the surface in "
            "the software of the instrument"
        )
    # What is checked is what is read: the library gets these bytes and not the file.
    content = path.read_bytes()
    kind = path.suffix[1:].lower()
    shape = _CHECKS[path.suffix.lower()](content, path.name)
    with reading(repr(path.name), kind.upper()), warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        measured = _library(path.suffix)(io.BytesIO(content), format=kind).topography()
        heights = np.ma.filled(np.ma.asarray(measured.heights(), dtype=np.float64), np.nan).T
        unit = factor(str(measured.unit), "m")
        heights = unit * heights
        dx, dy = (
            unit * float(length) / count
            for length, count in zip(measured.physical_sizes, measured.nb_grid_pts, strict=True)
        )
    if heights.shape != shape:
        raise InputError(
            f"{path.name!r} was read as {heights.shape[0]} x {heights.shape[1]} points, its header tells of "
            f"{shape[0]} x {shape[1]}; export it again"
        )
    if not (0 < dx < np.inf and 0 < dy < np.inf):
        raise InputError(f"{path.name!r} has points {dx:g} x {dy:g} m apart; a spacing must be a positive length")
    finite = int(np.isfinite(heights).sum())
    if not finite:
        raise InputError(f"none of the {heights.size} points of {path.name!r} was measured; export it again")
    heights[~np.isfinite(heights)] = np.nan
    source = f"{path.name}, {kind.upper()} of {shape[1]} x {shape[0]} points"
    if finite < heights.size:
        source += f", {heights.size - finite} of them not measured"
    return SurfaceMap(np.ascontiguousarray(heights), dx, dy, source)


def _library(suffix: str) -> Any:
    """What opens a topography."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            from SurfaceTopography.IO import open_topography
    except ImportError as error:
        raise InputError(
            f"reading {suffix} needs SurfaceTopography, which is not installed; {how_to_install('metrology')}, or, "
            "on macOS, for which the library has no wheel, export the surface as a matrix (.csv) or NetCDF"
        ) from error
    return open_topography
