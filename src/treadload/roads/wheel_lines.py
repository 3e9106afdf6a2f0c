"""Loads as lines along travel, close together near the line of the sensors: what the half-space of a track needs."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.layers.tracks import Lines
from treadload.kernels.layers.wavenumbers import gauss
from treadload.response.loads import GridLoad, SurfaceLoad, UniformDisc

# Points of a strip that is no wider than its distance from the sensors' line, and chords of a disc.
_POINTS, _CHORDS = 8, 40

_Line = tuple[Array, Array, Array]


def lines_of(loads: Sequence[SurfaceLoad], side: float) -> Lines:
    """Loads, as lines of (middle, half-length, force). side: of the sensors' line, m, beside all of them."""
    places: list[float] = []
    parts: list[_Line] = []
    for load in loads:
        for y, line in _of_disc(load) if isinstance(load, UniformDisc) else _of_grid(load, side):
            places.append(y)
            parts.append(line)
    return Lines(np.array(places), parts)


def _of_disc(disc: UniformDisc) -> list[tuple[float, _Line]]:
    points, share = gauss(_CHORDS)
    # In the angle chords end smoothly: y = R sin t, dy = R cos t dt.
    angle, weight = 0.5 * np.pi * points, 0.5 * np.pi * share
    lines = []
    for t, w in zip(angle, weight, strict=True):
        half = disc.radius * float(np.cos(t))
        force = disc.pressure * 2 * half * half * float(w)
        lines.append(
            (disc.y + disc.radius * float(np.sin(t)), (np.array([disc.x]), np.array([half]), np.array([force])))
        )
    return lines


def _of_grid(load: GridLoad, side: float) -> list[tuple[float, _Line]]:
    grid, pressure = load.grid, np.asarray(load.pressure)
    lines = []
    for row in np.flatnonzero(pressure.any(axis=1)):
        cells = np.flatnonzero(pressure[row])
        middle = grid.x0 + cells * grid.dx
        half = np.full(len(cells), 0.5 * grid.dx)
        y = grid.y0 + row * grid.dy
        for place, width in _strips(y - 0.5 * grid.dy - side, y + 0.5 * grid.dy - side):
            lines.append((side + place, (middle, half, pressure[row, cells] * grid.dx * width)))
    return lines


def _strips(low: float, high: float) -> list[tuple[float, float]]:
    """Places and widths of a row's lines, from its edges (both on a side of 0, the sensors' line)."""
    sign, near, far = (1.0, low, high) if low > 0 else (-1.0, -high, -low)
    edges = [near]
    while edges[-1] < far:
        edges.append(min(far, 2 * edges[-1]))
    points, share = gauss(_POINTS)
    strips = []
    for start, end in itertools.pairwise(edges):
        for point, part in zip(points, share, strict=True):
            place = 0.5 * (start + end) + 0.5 * (end - start) * float(point)
            strips.append((sign * place, 0.5 * (end - start) * float(part)))
    return strips
