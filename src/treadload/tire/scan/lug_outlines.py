"""Lugs and blocks of a scan: the pitch round the tire, and the outline of every block of it as a trapezoid."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.kernels import fft
from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.kernels.sections import Block
from treadload.tire.blocks import BlockPattern, TreadBlock
from treadload.tire.scan.rays import Caster, radial
from treadload.tire.scan.surface import ScanSurface
from treadload.tire.unrolled import groove_depth

# Samples across and along, m; pitches to each side of the one that is read.
_STEP, _BESIDE = 1.5e-3, 2
# What lies less than this below the tops is no void, m; the tread ends where its tops have fallen so far, m.
_SHALLOW, _SHOULDER = 2e-3, 8e-3
# Pitches round a tire, and how alike they must be; voids must take this part of the tread.
_MOST, _ALIKE, _VOIDS = 240, 0.8, 0.01
# Of the largest likeness: more pitches are taken where they are as alike as fewer.
_AS_ALIKE = 0.97
# Area that an outline and its trapezoid share over that of both; smaller outlines are no blocks, m².
_FITS, _SMALLEST = 0.85, 1e-4
# Rows of an outline that count for the slope of its walls, and places along a wall.
_MIDDLE, _PLACES = 0.8, 9


@dataclass(frozen=True, eq=False)
class _Unrolled:
    """Some pitches of a tread: depth (ny, nx) below the tops, m, at x (nx,) along the crown and y (ny,), m."""

    depth: Array
    x: Array
    y: Array
    land: BoolArray


def scanned_blocks(surface: ScanSurface, thickness: float) -> tuple[BlockPattern, ScanSurface]:
    """The blocks of a scan of a tread of a thickness, m, from the belt to the face, and the surface of their tops.

    Walls are upright. The pitch nearest to the road is read. Raises InputError for a tread without lateral voids, one
    whose pitches differ, blocks whose outline is no trapezoid, and voids deeper than the tread.
    """
    caster = Caster(surface.vertices, surface.faces)
    radius = surface.report.crown_radius
    rows = _rows(surface)
    turn = 2 * math.pi * radius
    around = _unrolled(surface, caster, rows, (np.arange(round(turn / _STEP)) + 0.5) * _STEP, None)
    number = _pitches(around.land)
    period = turn / number
    count = round(period / _STEP)
    x = (np.arange(-_BESIDE * count, (_BESIDE + 1) * count) + 0.5) * period / count
    near = _unrolled(surface, caster, rows, x, _level(around))
    labels, _ = scipy.ndimage.label(near.land)
    blocks: list[TreadBlock] = []
    for label in range(1, int(labels.max()) + 1):
        block = _block(near, np.asarray(labels == label), period, thickness)
        if block is not None:
            blocks.append(block)
    if not blocks:
        raise InputError("the scan has no blocks between its voids; give `lateral`, grooves that cut its ribs")
    tops = replace(surface, meridian=surface.envelope, report=replace(surface.report, revolved=True))
    return BlockPattern(period, tuple(blocks)), tops


def _rows(surface: ScanSurface) -> Array:
    """Places across the tread between its shoulders, m."""
    crown = surface.crown_arc_radius
    arc = np.zeros_like(surface.across) if crown is None else np.square(surface.across) / (2 * crown)
    with np.errstate(invalid="ignore"):
        tread = surface.across[surface.report.crown_radius - surface.envelope - arc < _SHOULDER]
    return np.arange(tread.min(), tread.max() + 0.5 * _STEP, _STEP)


def _unrolled(surface: ScanSurface, caster: Caster, y: Array, x: Array, level: float | None) -> _Unrolled:
    """Depth below the tops at x along the crown and y; land above a level, m, half of the voids' depth if None."""
    radius = surface.report.crown_radius
    top = np.interp(y, surface.across, surface.envelope + groove_depth(surface.across, surface.envelope))
    floor = radius - max(surface.deepest, _SHOULDER) - 0.05
    met = radial(caster, x / radius, y, radius + 0.05, floor)
    depth = np.nan_to_num(top[:, None] - met, nan=math.inf)
    unrolled = _Unrolled(depth, x, y, np.zeros(depth.shape, bool))
    return replace(unrolled, land=depth < (_level(unrolled) if level is None else level))


def _level(unrolled: _Unrolled) -> float:
    """Depth that parts blocks from voids, m."""
    voids = unrolled.depth[(unrolled.depth > _SHALLOW) & np.isfinite(unrolled.depth)]
    return 0.5 * float(np.median(voids)) if voids.size else _SHALLOW


def _pitches(land: BoolArray) -> int:
    """How many pitches there are round a tire: the most that look alike."""
    varied = land - land.mean(1, keepdims=True)
    power = (np.abs(fft.rfft(varied, axis=1)) ** 2).sum(0)
    if np.abs(varied).mean() < _VOIDS:
        raise InputError(
            "the scan has no lateral voids: its ribs are endless along travel; give `lateral`, the grooves that cut "
            'them, or take tread = "ribs" and steady rolling'
        )
    wave = np.arange(power.size)
    numbers = np.arange(2, _MOST + 1)
    alike = np.cos(2 * np.pi * np.outer(1 / numbers, wave)) @ power / power.sum()
    best = float(alike.max())
    if best < _ALIKE:
        raise InputError(
            f"the pitches of the scan differ: {int(numbers[alike.argmax()])} of them are {best:.0%} alike, and "
            f"{_ALIKE:.0%} is needed; give `lateral`, grooves of one pitch"
        )
    return int(numbers[alike >= _AS_ALIKE * best].max())


def _block(near: _Unrolled, outline: BoolArray, period: float, thickness: float) -> TreadBlock | None:
    """The block of an outline; None for one whose middle is not in the pitch that is read, and specks."""
    rows, columns = np.nonzero(outline)
    cell = float((near.x[1] - near.x[0]) * (near.y[1] - near.y[0]))
    if rows.size * cell < _SMALLEST or not 0 <= near.x[columns].mean() < period:
        return None
    if columns.min() == 0 or columns.max() == near.x.size - 1:
        raise InputError(
            f"a rib of the scan at y = {near.y[rows].mean() * 1e3:.0f} mm is endless along travel; give `lateral`, "
            "the grooves that cut it"
        )
    corners, shared = _trapezoid(near, outline)
    if shared < _FITS:
        raise InputError(
            f"a block of the scan at y = {near.y[rows].mean() * 1e3:.0f} mm is no trapezoid with two sides along "
            f"travel: both share {shared:.0%} of their area, and {_FITS:.0%} is needed; give a TreadProfile with "
            "lateral grooves"
        )
    x, y = corners.mean(0)
    around = tuple((float(a - x), float(b - y)) for a, b in corners)
    floors, reach = _sides(near, outline, corners, thickness)
    try:
        block = Block(around, thickness, floors, reach)  # type: ignore[arg-type]
    except ValueError as error:
        raise InputError(f"a block of the scan: {error}") from None
    return TreadBlock(block, float(x), float(y))


def _trapezoid(near: _Unrolled, outline: BoolArray) -> tuple[Array, float]:
    """Corners (4, 2), m, with two sides along travel, and the share of area that it has in common with an outline."""
    half_x, half_y = 0.5 * (near.x[1] - near.x[0]), 0.5 * (near.y[1] - near.y[0])
    rows = np.flatnonzero(outline.any(1))
    rear = near.x[outline[rows].argmax(1)] - half_x
    front = near.x[outline.shape[1] - 1 - outline[rows][:, ::-1].argmax(1)] + half_x
    cut = int(0.5 * (1 - _MIDDLE) * rows.size)
    inner = slice(cut, rows.size - cut)
    y = near.y[rows]
    low, high = y[0] - half_y, y[-1] + half_y
    degree = 1 if rows[inner].size > 2 else 0
    walls = [np.polyfit(y[inner], wall[inner], degree) for wall in (rear, front)]
    (rear_low, front_low), (rear_high, front_high) = (
        [np.polyval(wall, end) for wall in walls] for end in (low, high)
    )
    corners = np.array([[rear_low, low], [front_low, low], [front_high, high], [rear_high, high]])
    ends = [np.polyval(wall, near.y)[:, None] for wall in walls]
    inside = (near.x >= ends[0]) & (near.x <= ends[1]) & ((near.y >= low) & (near.y <= high))[:, None]
    return corners, float((inside & outline).sum() / (inside | outline).sum())


Four = tuple[float, float, float, float]


def _sides(near: _Unrolled, outline: BoolArray, corners: Array, thickness: float) -> tuple[Four, Four]:
    """Height of the undertread at the four sides and how far it reaches, m; 0 beside the tread."""
    step = (float(near.y[1] - near.y[0]), float(near.x[1] - near.x[0]))
    apart = scipy.ndimage.distance_transform_edt(~(near.land & ~outline), sampling=step)
    floors, reach = [], []
    for start, stop in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = (stop - start) / np.linalg.norm(stop - start)
        outward = np.array([along[1], -along[0]])
        places = start + (np.arange(_PLACES)[:, None] + 0.5) / _PLACES * (stop - start)
        gap = float(np.median(apart[_at(near, places)]))
        beyond = places + outward * min(0.5 * gap, thickness)
        if not (near.y[0] <= np.median(beyond[:, 1]) <= near.y[-1]):
            floors.append(0.0)
            reach.append(0.0)
            continue
        depth = float(np.median(near.depth[_at(near, beyond)]))
        if depth >= thickness:
            raise InputError(
                f"the voids of the scan are {depth * 1e3:.3g} mm deep and the tread {thickness * 1e3:g} mm thick; "
                "give a tread_thickness of the belt above the depth"
            )
        floors.append(thickness - max(depth, 0.0))
        reach.append(min(0.5 * gap, thickness))
    return (floors[0], floors[1], floors[2], floors[3]), (reach[0], reach[1], reach[2], reach[3])


def _at(near: _Unrolled, places: Array) -> tuple[IntArray, IntArray]:
    """Rows and columns of the samples nearest to places (n, 2)."""
    columns = np.clip(np.rint((places[:, 0] - near.x[0]) / (near.x[1] - near.x[0])), 0, near.x.size - 1)
    rows = np.clip(np.rint((places[:, 1] - near.y[0]) / (near.y[1] - near.y[0])), 0, near.y.size - 1)
    return rows.astype(int), columns.astype(int)
