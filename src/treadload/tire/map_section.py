"""The cross-section of a height map: its meridian without the bend of the wheel, cut at its grooves."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.tire.cross_section import TreadSection, interrupted_share, lateral_obstacle, measured_section
from treadload.tire.surface import HeightMapSurface
from treadload.tire.unrolled import find_grooves, median_meridian

# What lies further above the road, m, is no tread: as deep as a scan is followed.
_DEEPEST = 0.045
# Columns where the wheel has risen so far, m, are looked at: there grooves are steep, and beyond is sidewall.
_RISEN = 0.02
# Columns of a wide map that are looked at.
_FEWEST, _MOST_COLUMNS = 5, 400


@lru_cache(maxsize=8)
def section_of_map(surface: HeightMapSurface) -> TreadSection:
    """Cross-section of a height map.

    The bend of the wheel along travel is taken out, each row on its own radius, and the middle of every row is the
    meridian. Rows that are not alike along travel, and floors of grooves that the map does not have, are obstacles.
    """
    grid, gap = _thinned(surface.grid, surface.gap)
    ends = (float(grid.y[0]) - 0.5 * grid.dy, float(grid.y[-1]) + 0.5 * grid.dy)
    if min(grid.nx, grid.ny) < _FEWEST:
        return TreadSection(*ends, obstacle=f"the height map has {grid.ny} x {grid.nx} cells, {_FEWEST} are needed")
    flat = _unbent(gap, grid, surface.outer_radius)
    height = -median_meridian(flat)
    tread = np.flatnonzero(np.isfinite(height) & (height > -_DEEPEST))
    if len(tread) < _FEWEST:
        return TreadSection(*ends, obstacle="the height map has no tread less than 45 mm above the road")
    rows = slice(tread[0], tread[-1] + 1)
    y, height, flat = grid.y[rows], height[rows], flat[rows]
    bare = ~np.isfinite(height)
    if bare.any():
        places = ", ".join(f"{1e3 * place:.0f}" for place in y[bare][:4])
        what = f"the height map has no floor of its grooves at y = {places} mm; give their depth there"
        return TreadSection(float(y[0]) - 0.5 * grid.dy, float(y[-1]) + 0.5 * grid.dy, obstacle=what)
    grooves = find_grooves(y, height, float(height.max()))
    obstacle = lateral_obstacle(interrupted_share(y, -flat, grooves))
    return measured_section(y, height, grooves, surface.crown_arc_radius, obstacle)


def _thinned(grid: Grid, gap: Array) -> tuple[Grid, Array]:
    """Every so many columns of a map, as many as show whether its rows are alike."""
    stride = max(1, grid.nx // _MOST_COLUMNS)
    gap = gap[:, ::stride]
    return Grid(gap.shape[1], grid.ny, stride * grid.dx, grid.dy, grid.x0, grid.y0), gap


def _unbent(gap: Array, grid: Grid, radius: float | None) -> Array:
    """A gap (ny, nx), m, without what it rises along travel; NaN in columns that are far from the lowest."""
    if radius is None:
        return np.where(gap < _DEEPEST, gap, np.nan)
    columns = np.isfinite(gap).any(axis=0)
    low = np.nanmin(gap[:, columns], axis=0)
    x = grid.x[columns]
    # Under the axle the lowest points of all columns are lowest.
    bend, slope, _ = np.polyfit(x, low, 2)
    away = np.square(grid.x + 0.5 * slope / bend)
    near = away < 2 * radius * _RISEN
    rise = away / (2 * radius)
    drop = median_meridian(np.where(near, gap - rise, np.nan))[:, None]
    # A row at the floor of a groove turns on a smaller circle.
    inner = radius - np.where(np.isfinite(drop), drop, 0.0)
    rise = inner - np.sqrt(np.maximum(np.square(inner) - away, 0.0))
    flat = np.where(near, gap - rise, np.nan)
    return np.asarray(np.where(flat < _DEEPEST, flat, np.nan))
