"""A file of surface metrology becomes heights on even cells, in metres, with holes where nothing was measured."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from treadload.errors import InputError, reading
from treadload.metrology.archive import read_x3p
from treadload.metrology.headers import read_al3d, read_sdf, read_sur

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

_FORMATS = {".x3p": read_x3p, ".sdf": read_sdf, ".sur": read_sur, ".al3d": read_al3d}
ENDINGS = tuple(_FORMATS)
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
    InputError for a file that is missing, damaged, a bomb, no single surface on even cells, or has no measured point.
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
    content = path.read_bytes()
    kind = path.suffix[1:].upper()
    with reading(repr(path.name), kind), np.errstate(all="ignore"):
        heights, dx, dy = _FORMATS[path.suffix.lower()](content, path.name)
    if not (0 < dx < np.inf and 0 < dy < np.inf):
        raise InputError(f"{path.name!r} has points {dx:g} x {dy:g} m apart; a spacing must be a positive length")
    finite = int(np.isfinite(heights).sum())
    if not finite:
        raise InputError(f"none of the {heights.size} points of {path.name!r} was measured; export it again")
    heights[~np.isfinite(heights)] = np.nan
    source = f"{path.name}, {kind} of {heights.shape[1]} x {heights.shape[0]} points"
    if finite < heights.size:
        source += f", {heights.size - finite} of them not measured"
    return SurfaceMap(np.ascontiguousarray(heights), dx, dy, source)
