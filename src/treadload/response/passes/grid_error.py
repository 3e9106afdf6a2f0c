"""How far the grid is off: passes on cells of twice the size beside those on the cells that count.

The strain of a cell is constant. Where a smooth strain would fit together and leave no stress, steps between cells do
not: they resist as a part of the modulus that falls as the square of the size, and flow is too small as long as that
part is no less than the hardening modulus, a fiftieth of the modulus or less. So errors fall slower than as the
square of the size: as its power 1.1 to 1.5 under a sphere, 1.8 under ribs. Two thirds of the change from cells of
twice the size to these are more than cells of half the size change by an error of first order, and all that finer
ones do from a power of 4/3 on.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.response.passes.box import Box, Course
from treadload.response.passes.surface import surface_profile

# Of the rut and of the largest plastic strain: above it a warning tells how to lower it.
MOST = 0.10
# Cells across and down that yield, from which on the change from cells of twice the size is an error: below a sphere
# at 1.4 times the load of first yield, 2 rows, the rut grew 2.5 times on cells of two thirds, where that was 1 %.
FEWEST = 4
# Of the change from cells of twice the size.
_SHARE = 2 / 3
# What is left of the box reaches beyond cells of twice the size that take this part of the largest plastic strain, by
# so many of these.
_YIELDS, _BESIDE = 1e-3, 2
HOW = (
    "two thirds of the change of the rut and of the largest mean plastic strain from cells of twice the size to "
    "these: where errors are of first order in the size or better, cells of half the size change less; not estimated "
    f"(NaN) while what yields is fewer than {FEWEST} cells deep or wide"
)


def doubled(box: Box, among: Sequence[Course]) -> Box:
    """A box of cells of twice the size, around the same middle. among: the courses, whose interfaces stay."""
    nx, ny = math.ceil(box.nx / 2), math.ceil(box.ny / 2)
    x0, y0 = (
        first + 0.5 * (count - 1) * step - (half - 1) * step
        for first, count, half, step in ((box.x0, box.nx, nx, box.dx), (box.y0, box.ny, ny, box.dy))
    )
    kept = [0]
    stays = [z for course in among for z in (course.top, course.bottom)]
    for row in range(1, len(box.edges) - 1):
        at_interface = any(math.isclose(box.edges[row], z) for z in stays)
        if at_interface or row - kept[-1] == 2:
            kept.append(row)
    return replace(
        box, nx=nx, ny=ny, dx=2 * box.dx, dy=2 * box.dy, x0=x0, y0=y0, edges=box.edges[[*kept, len(box.edges) - 1]]
    )


def cut(box: Box, wide: Box, hardening: Array, along: Array, depth: float | None) -> Box:
    """The box without the lines, columns and rows around what yields on cells of twice the size.

    wide: the box of these cells. hardening: of its passes, (nz, ny). along: see `steady.Pass`. depth: that was asked
    for, m, which stays.
    """
    least = _YIELDS * max(float(hardening.max()), np.finfo(float).tiny)
    rows, lines, columns = (
        np.flatnonzero(amount > least) for amount in (hardening.max(axis=1), hardening.max(axis=0), along)
    )
    if not (rows.size and lines.size and columns.size):
        return box
    first_x, last_x = _within(wide.x[columns[0]], wide.x[columns[-1]], wide.dx, box.x)
    first_y, last_y = _within(wide.y[lines[0]], wide.y[lines[-1]], wide.dy, box.y)
    deepest = wide.edges[min(rows[-1] + 2, len(wide.edges) - 1)] if depth is None else box.edges[-1]
    return replace(
        box, nx=last_x - first_x + 1, ny=last_y - first_y + 1, x0=float(box.x[first_x]), y0=float(box.y[first_y]),
        edges=box.edges[: 1 + int(np.searchsorted(box.edges, deepest * (1 - 1e-9)))],
    )  # fmt: skip


def _within(low: float, high: float, step: float, places: Array) -> tuple[int, int]:
    """First and last of places within a range and some cells of a step beside it."""
    inside = np.flatnonzero((places >= low - (_BESIDE + 0.5) * step) & (places <= high + (_BESIDE + 0.5) * step))
    return int(inside[0]), int(inside[-1])


def largest_mean(field: Array, box: Box, width: float) -> float:
    """Largest mean of a field (nz, ny) over a square of a width, m, across and down, that lies within the box."""
    across = box.y0 + box.dy * (np.arange(box.ny + 1) - 0.5)
    total = np.zeros((len(box.edges), box.ny + 1))
    total[1:, 1:] = np.cumsum(np.cumsum(field * np.diff(box.edges)[:, None] * box.dy, axis=0), axis=1)
    sums = total
    size = 1.0
    for axis, edges in enumerate((box.edges, across)):
        part = min(width, float(edges[-1] - edges[0]))
        # A sum over a window that moves is largest where one of its ends meets an edge of cells.
        starts = np.unique(np.clip(np.concatenate([edges, edges - part]), edges[0], edges[-1] - part))
        sums = _at(sums, edges, starts + part, axis) - _at(sums, edges, starts, axis)
        size *= part
    return float(sums.max()) / size


def _at(values: Array, edges: Array, places: Array, axis: int) -> Array:
    """Values at edges along an axis, between them in a straight line."""
    right = np.clip(np.searchsorted(edges, places, side="right"), 1, len(edges) - 1)
    share = (places - edges[right - 1]) / (edges[right] - edges[right - 1])
    low, high = np.take(values, right - 1, axis), np.take(values, right, axis)
    share = share[:, None] if axis == 0 else share
    result: Array = low + share * (high - low)
    return result


def rut_depths(strains: Sequence[Array], box: Box, road: Pavement) -> Array:
    """Depth of the rut, m, of plastic strains (6, nz, ny) one after the other."""
    across = box.y0 + box.dy * np.arange(-box.ny, 2 * box.ny)
    depths: Array = np.maximum(surface_profile(np.array(strains), box, road, across).max(axis=-1), 0.0)
    return depths


def change(fine: Array, coarse: Array) -> Array:
    """Error of values by pass; NaN for passes that the coarse grid did not come to."""
    result = np.full(len(fine), np.nan)
    both = min(len(fine), len(coarse))
    result[:both] = _SHARE * np.abs(fine[:both] - coarse[:both])
    return result


def relative(error: Array, value: Array) -> float:
    """The error after the last pass that both grids came to, as a part of the value; NaN where there is none."""
    finite = np.flatnonzero(np.isfinite(error) & (value > 0))
    return float(error[finite[-1]] / value[finite[-1]]) if finite.size else math.nan


def yielding(hardening: Array) -> tuple[int, int]:
    """Cells down and across that yield. hardening: accumulated plastic strain of the cells (nz, ny) after a pass."""
    yields = hardening > _YIELDS * max(float(hardening.max()), np.finfo(float).tiny)
    return int(np.count_nonzero(yields.any(axis=1))), int(np.count_nonzero(yields.any(axis=0)))


def enough_cells(hardenings: Sequence[Array]) -> Array:
    """Of which passes the change from cells of twice the size is an error, (n,): of none where not of the last.

    hardenings: see `yielding`, after each pass.
    """
    enough = np.array([min(yielding(field)) >= FEWEST for field in hardenings])
    result: Array = enough & enough[-1]
    return result


def caveats(box: Box, off: tuple[float, float], verdicts: tuple[str, str], hardening: Array) -> Iterator[str]:
    """What to know of a grid.

    off: errors of rut and strain, as parts of them, NaN where they are not known. verdicts: on both grids.
    hardening: see `yielding`, after the last pass.
    """
    deep, wide = yielding(hardening)
    if deep and min(deep, wide) < FEWEST:
        yield (
            f"what yields is {deep} cells deep and {wide} wide, fewer than the {FEWEST} from which on the error of "
            "the grid is estimated: the rut may be off by more than itself; lower spacing (now "
            f"{1e3 * box.dy:.3g} mm)"
        )
    if max(off) > MOST:
        yield (
            f"by cells of twice the size the error of the rut is {100 * off[0]:.0f} % and that of the largest "
            f"plastic strain {100 * off[1]:.0f} %, above {100 * MOST:g} %: lower spacing (now {1e3 * box.dy:.3g} mm)"
        )
    if verdicts[0] != verdicts[1]:
        yield (
            f"on cells of twice the size the verdict is {verdicts[1]}, on these {verdicts[0]}: lower spacing "
            f"(now {1e3 * box.dy:.3g} mm) before you rely on it"
        )
