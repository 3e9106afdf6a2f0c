"""What a map of pressure measures: areas, extents, centre, ribs. Functions of arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.kernels.arrays import Array, BoolArray

# A groove is where the force per width falls below this share of a typical rib's.
_GROOVE = 0.2
# The typical rib: this quantile of the force per width where anything presses.
_TYPICAL = 0.75


@dataclass(frozen=True)
class Measures:
    """What a map of pressure measures.

    load: N. net_area: of the loaded cells, m². gross_area: inside their convex outline, grooves with it, m².
    length, width: from the first to the last loaded cell along x and y, m. mean, peak: pressure, Pa; the mean is over
    the net area. centre_x, centre_y: of pressure, m. spread_x, spread_y: standard deviations of x and y under the
    pressure, m.

    >>> load = tl.response.GridLoad(tl.response.Grid.centred(0.16, 0.16, 0.02), [[0] * 2 + [6e5] * 4 + [0] * 2] * 8)
    >>> measures = tl.Footprint(load).measures
    >>> f"{measures.load / 1e3:.2f} kN on {measures.net_area * 1e4:.0f} cm²"
    '7.68 kN on 128 cm²'
    """

    load: float
    net_area: float
    gross_area: float
    length: float
    width: float
    mean: float
    peak: float
    centre_x: float
    centre_y: float
    spread_x: float
    spread_y: float


def measure(pressure: Array, x: Array, y: Array, dx: float, dy: float, angle: float = 0.0) -> Measures:
    """Measures of a map.

    pressure: (ny, nx), Pa, zero where nothing presses. x: (nx,), y: (ny,), m. angle: rad, by which the cells' axes
    are turned from those along which it is measured.
    """
    along_cells, across_cells = np.meshgrid(x, y)
    loaded = pressure > 0
    if not loaded.any():
        nan = float("nan")
        return Measures(0.0, 0.0, 0.0, 0.0, 0.0, nan, 0.0, nan, nan, nan, nan)
    weights, loaded_x, loaded_y = pressure[loaded], along_cells[loaded], across_cells[loaded]
    along, across = turn(loaded_x, loaded_y, angle)
    total = float(weights.sum())
    centre_x, centre_y = (float((weights * at).sum() / total) for at in (along, across))
    spread = [
        float(np.sqrt((weights * (at - c) ** 2).sum() / total)) for at, c in ((along, centre_x), (across, centre_y))
    ]
    net = float(loaded.sum()) * dx * dy
    return Measures(
        total * dx * dy,
        net,
        _outline_area(loaded_x, loaded_y, dx, dy),
        float(np.ptp(along)) + dx,
        float(np.ptp(across)) + dy,
        total * dx * dy / net,
        float(weights.max()),
        centre_x,
        centre_y,
        *spread,
    )


def turn(x: Array, y: Array, angle: float) -> tuple[Array, Array]:
    """Places (x, y) of axes that are turned by an angle, rad, in those that are not."""
    return x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)


def _outline_area(x: Array, y: Array, dx: float, dy: float) -> float:
    """Area of the convex hull of cells by their centres."""
    corners = np.concatenate([np.stack([x + a * dx, y + b * dy], -1) for a in (-0.5, 0.5) for b in (-0.5, 0.5)])
    try:
        return float(scipy.spatial.ConvexHull(corners).volume)
    except scipy.spatial.QhullError as error:
        raise InputError("the outline of the footprint has no area; check its spacing") from error


def find_ribs(pressure: Array, y: Array, dy: float) -> Array:
    """Edges (ribs + 1,) of the ribs, m: the outer ones and the middles of the grooves between.

    pressure: (ny, nx), Pa. y: (ny,), m. A groove is a run of rows with less than a fifth of the force of a typical
    rib; a tread whose grooves lie aslant has one rib. Empty if nothing presses.
    """
    force = pressure.sum(axis=1)
    pressing = force > 0
    if not pressing.any():
        return np.zeros(0)
    rib = force >= _GROOVE * float(np.quantile(force[pressing], _TYPICAL))
    marks = np.diff(np.concatenate([[0], rib.astype(int), [0]]))
    starts, ends = np.nonzero(marks == 1)[0], np.nonzero(marks == -1)[0]
    first, last = np.nonzero(pressing)[0][[0, -1]]
    middles = [0.5 * (y[end - 1] + y[start]) for end, start in zip(ends[:-1], starts[1:], strict=True)]
    return np.array([y[first] - 0.5 * dy, *middles, y[last] + 0.5 * dy])


def shares(pressure: Array, y: Array, edges: Array) -> Array:
    """Share (ribs,) of the load that presses between edges (ribs + 1,), m; what lies outside goes to the outer ribs.

    pressure: (ny, nx). y: (ny, nx), m, of the cells' centres.
    """
    total = float(pressure.sum())
    which = np.clip(np.searchsorted(edges, y.ravel(), side="right") - 1, 0, len(edges) - 2)
    summed = np.bincount(which, weights=pressure.ravel(), minlength=len(edges) - 1)
    parts: Array = summed / (total if total > 0 else 1.0)
    return parts


def check_ribs(edges: Sequence[float] | Array) -> Array:
    """Edges of ribs as an array. Raises InputError unless they are two or more rising numbers."""
    ribs = np.asarray(edges, dtype=float)
    if ribs.ndim != 1 or len(ribs) < 2 or not np.isfinite(ribs).all() or not (np.diff(ribs) > 0).all():
        raise InputError(f"ribs must be two or more rising edges across the tread, m, got {list(edges)!r}")
    return ribs


def lone(pressure: Array, valid: BoolArray) -> tuple[BoolArray, BoolArray]:
    """Cells (ny, nx) that read nothing amid eight that are loaded, and those that are loaded amid eight that are not.

    valid: cells that there are; the others are no neighbours, and a cell without eight is neither.
    """
    loaded = (pressure > 0) & valid
    count = _around(loaded.astype(int))
    there = _around(valid.astype(int)) == 8
    return valid & ~loaded & there & (count == 8), loaded & there & (count == 0)


def filled(pressure: Array, holes: BoolArray, valid: BoolArray) -> Array:
    """Pressure with the mean of the known neighbours in the holes; zero where there are none."""
    sound = valid & ~holes
    count = _around(sound.astype(float))
    means = np.divide(_around(np.where(sound, pressure, 0.0)), count, out=np.zeros(pressure.shape), where=count > 0)
    return np.where(holes, means, pressure)


def _around(values: Array) -> Array:
    """Sum over the eight neighbours of each cell."""
    wide = np.pad(values, 1)
    ny, nx = values.shape
    total: Array = sum(
        (wide[j : j + ny, i : i + nx] for j in range(3) for i in range(3) if (j, i) != (1, 1)),
        start=np.zeros_like(values),
    )
    return total
