"""How far whole cells put off the mean strain of a soft stone or a void.

A sphere of whole cells has steps on its border, which make a soft one look larger, and where its centre lies in its
cell its steps are not alike along the axes. The estimate is a fit, not a bound that is proved:

    error = (0.085 n^-0.6 (1 + 0.08 / k) + 1.6 a s) s,    s = (1 - g) / (1 + 1.2 g)

n: cells a radius. k: cover over radius. g: the smaller of both moduli, 3 k and 2 G, over that of the mortar, 0 for a
void. a: by how much the sphere of cells is longer or shorter along an axis than on average, from the second moments
of its cells. error: of any component of the mean strain, over its largest one, under tensions along or down.

Source: own finite elements in bispherical coordinates, which fit plane and sphere (`tests/bispherical.py`), of single
spheres under tensions in x and y, in x alone and down; 2 to 12 cells a radius, covers of 0.1 to 3 radii, contrasts
of 0 to 0.5, Poisson's ratios of 0.2 to 0.4, and centres anywhere in a cell. It covers all 120 cases and is 1.0 to 2.5
times as large as their error, in the middle 1.4. Neighbours and stress that varies over a stone are not in it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.kernels.arrays import Array, BoolArray, IntArray

# Cells a radius and covers over the radius below which nothing is estimated.
FEWEST, THINNEST = 2.0, 0.1
BASIS = (
    "soft_strain_error: of the mean strain of that stone softer than the mortar, or void, that its cells put off "
    "most, over its largest component; by cells a radius, cover, contrast and how unlike its axes are, a fit to "
    "single spheres beside axisymmetric finite elements"
)


def strain_error(cells: float, cover: float, contrast: float, unlike: float = 0.0) -> float:
    """Error of the mean strain of a soft sphere, over its largest component; source and terms in this module.

    cells: a radius. cover: of its top over its radius. contrast: of its moduli over those of the mortar, 0 of a void.
    unlike: see `unlike_axes`. Returns NaN below `FEWEST` cells or `THINNEST` cover, 0 for what is not soft.
    """
    if contrast >= 1:
        return 0.0
    if cells < FEWEST * (1 - 1e-9) or cover < THINNEST * (1 - 1e-9):
        return math.nan
    softness = (1 - contrast) / (1 + 1.2 * contrast)
    result: float = (0.085 * cells**-0.6 * (1 + 0.08 / cover) + 1.6 * unlike * softness) * softness
    return result


def unlike_axes(cells: BoolArray, x: Array, y: Array, z: Array) -> float:
    """By which part a body of cells (nz, ny, nx) is longer or shorter along an axis than on average.

    x, y, z: centres of cubes, of one size. Of a slightly stretched sphere it is what is stretched of its radius.
    """
    moments = []
    for at, axis in ((x, 2), (y, 1), (z, 0)):
        places = at[np.nonzero(cells)[axis]]
        size = float(at[1] - at[0]) if len(at) > 1 else 0.0
        moments.append(float(np.var(places)) + size**2 / 12)
    return 0.5 * float(np.abs(np.array(moments) / np.mean(moments) - 1).max())


def soft_errors(
    numbers: IntArray, radius: Array, depth: Array, contrasts: Array, x: Array, y: Array, z: Array
) -> Array:
    """Errors of the soft ones among the stones of a window, (n,); NaN where there is no estimate, as for a scan.

    numbers: of stones by cells, from 1. radius, depth: of each sphere and its centre, m, both empty of a scan.
    contrasts: of each stone. x, y, z: centres of cells, m. Stones that hold no cell are left out.
    """
    soft = [stone for stone in np.flatnonzero(contrasts < 1).tolist() if (numbers == stone + 1).any()]
    if not radius.size:
        return np.full(len(soft), np.nan)
    # The first row begins at the surface.
    cells, cover = radius / (2 * z[0]), depth / radius - 1
    return np.array(
        [
            strain_error(cells[stone], cover[stone], contrasts[stone], unlike_axes(numbers == stone + 1, x, y, z))
            for stone in soft
        ]
    )


def largest(errors: Array) -> float:
    """The largest of errors that are known, NaN where none is."""
    finite = errors[np.isfinite(errors)]
    return float(finite.max()) if finite.size else math.nan


def caveats(errors: Array, spacing: float) -> Iterator[str]:
    """A sentence on soft stones without an estimate, where there are some. spacing: of the cells, m."""
    count = int(np.isnan(errors).sum())
    if count:
        yield (
            f"the error of the mean strain is not estimated for {count} of {len(errors)} stones softer than the "
            f"mortar, or voids: they have fewer than {FEWEST:g} cells a radius, less cover than {THINNEST:g} of "
            f"their radius, or come from a scan; lower spacing (now {1e3 * spacing:.3g} mm), or give more cover"
        )
