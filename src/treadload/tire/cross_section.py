"""The cross-section of a tread: where it ends, and its circumferential grooves with the walls that they have."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from treadload.kernels.arrays import Array
from treadload.tire.quality import GrooveMeasure
from treadload.tire.unrolled import TOP_BAND, crossing, top_meridian

# Share of the faces of ribs that lateral grooves, sipes and holes may take.
MOST_INTERRUPTED = 0.01
# Lengths of a measured section are rounded to this, m, and slopes to that, both finer than a meridian is known, so
# that ribs that are alike share the table of one section.
_LENGTHS, _SLOPES = 4, 2
# Parts of the height of a wall between which a straight line is fitted, at so many levels: edge and foot are rounded.
_LOW, _HIGH, _LEVELS = 0.15, 0.85, 15
# The face beside a wall is the highest point so near to it, m.
_BESIDE = 0.005
# A wall that is this far off a straight line, rms, m, is worth a sentence.
_CURVED = 0.3e-3
# The shoulder of a tread without grooves stands where it has fallen so far, m.
_FALLEN = 0.008


@dataclass(frozen=True)
class Channel:
    """A circumferential groove as its straight walls bound it.

    left, right: of its walls at the height of the face, m, to the right of the middle of the tread. depth: of the
    floor below the mean of the faces beside it, m. slopes: of its left and its right wall, by which it narrows per
    depth, ≥ 0. tie_bar: height of a rubber bridge above the floor, m, continuous along travel; 0 for none.
    """

    left: float
    right: float
    depth: float
    slopes: tuple[float, float] = (0.0, 0.0)
    tie_bar: float = 0.0

    @property
    def clear_depth(self) -> float:
        """Depth down to the tie bar, m; to the floor where there is none."""
        return self.depth - self.tie_bar

    @property
    def centre(self) -> float:
        """Between its walls at the face, m."""
        return 0.5 * (self.left + self.right)


@dataclass(frozen=True)
class TreadSection:
    """A tread that is the same along travel.

    left, right: its ends, m, to the right of its middle. channels: its circumferential grooves, from left to right.
    obstacle: why it is not the same along travel or not known across, in words; empty where it is. measured: read
    from a surface, not described by numbers. caveats: of the walls, a sentence each.
    """

    left: float
    right: float
    channels: tuple[Channel, ...] = ()
    obstacle: str = ""
    measured: bool = False
    caveats: tuple[str, ...] = ()

    @property
    def deepest(self) -> float:
        """Depth of the deepest groove, m; 0 without any."""
        return max((channel.depth for channel in self.channels), default=0.0)


@runtime_checkable
class Grooved(Protocol):
    """A surface that knows its cross-section."""

    @property
    def cross_section(self) -> TreadSection:
        """Its ends and circumferential grooves, or what keeps it from having them."""
        ...


def measured_section(
    y: Array, height: Array, grooves: Sequence[GrooveMeasure], arc_radius: float | None, obstacle: str = ""
) -> TreadSection:
    """Cross-section of a meridian: the straight lines nearest to its walls.

    y: (n,) across in even steps, m. height: (n,) of the tread there, up, over any level line, m; NaN where there is
    none. grooves: found in it. arc_radius: of the tread across, m, inf if it is flat, None if unknown. obstacle: as
    in `TreadSection`. A wall that rises within one step of y is vertical: its slope is not resolved.
    """
    step = float(y[1] - y[0])
    finite = np.flatnonzero(np.isfinite(height))
    channels, caveats = [], []
    for groove in grooves:
        floor = _floor(y, height, groove)
        walls = (_wall(y, height, groove, floor, side, step) for side in (-1, 1))
        sides = [wall for wall in walls if wall is not None]
        if len(sides) < 2:
            # At the border of a surface that is bent across: no face stands beside it.
            continue
        left, right = (round(wall.place, _LENGTHS) for wall in sides)
        depth = round(0.5 * sum(wall.height for wall in sides), _LENGTHS)
        slopes = (round(sides[0].slope, _SLOPES), round(sides[1].slope, _SLOPES))
        channels.append(Channel(left, right, depth, slopes))
        off = max(wall.off for wall in sides)
        if off > _CURVED:
            caveats.append(
                f"a wall of the groove at y = {groove.centre * 1e3:+.1f} mm is up to {off * 1e3:.1f} mm (rms) off a "
                "straight line; its rib has the straight wall nearest to it"
            )
    ends = (float(y[finite[0]]) - 0.5 * step, float(y[finite[-1]]) + 0.5 * step)
    left, right = _ends(y, height, channels, arc_radius, ends)
    return TreadSection(
        round(left, _LENGTHS), round(right, _LENGTHS), tuple(channels), obstacle, True, tuple(caveats)
    )


def interrupted_share(y: Array, unrolled: Array, grooves: Sequence[GrooveMeasure]) -> float:
    """Share of the faces of ribs that lies in lateral grooves or holes; NaN where there is no face.

    y: (ny,) m. unrolled: (ny, nt) height of the tread, up, without its bend along travel, m; NaN where nothing is
    known. Void lies 3 mm, or half the depth of the shallowest groove, below the tops of its row.
    """
    near = np.zeros(len(y), dtype=bool)
    margin = 2 * float(y[1] - y[0])
    for groove in grooves:
        near |= np.abs(y - groove.centre) < 0.5 * groove.width + max(margin, groove.width / 4)
    rows = unrolled[~near & np.isfinite(unrolled).any(axis=1)]
    band = min([TOP_BAND, *(0.5 * groove.depth for groove in grooves)])
    if not rows.size:
        return math.nan
    top = top_meridian(rows)[:, None]
    finite = np.isfinite(rows)
    with np.errstate(invalid="ignore"):
        return float((rows < top - band)[finite].mean())


def lateral_obstacle(share: float) -> str:
    """Why a tread whose ribs are interrupted on this share of their faces has no circumferential ribs; or nothing."""
    if not share > MOST_INTERRUPTED:
        return ""
    return (
        f"lateral grooves or sipes interrupt {share:.0%} of the faces between its circumferential grooves, and ribs "
        f"are interrupted on at most {MOST_INTERRUPTED:.0%}"
    )


def _floor(y: Array, height: Array, groove: GrooveMeasure) -> float:
    """Height of the floor of a groove, m: the middle of its middle half."""
    inside = np.abs(y - groove.centre) <= max(0.25 * groove.width, 0.51 * float(y[1] - y[0]))
    return float(np.nanmedian(height[inside]))


@dataclass(frozen=True)
class _Wall:
    """A straight wall: its place at the face, height, m, slope, and how far the wall is off it, rms, m."""

    place: float
    height: float
    slope: float
    off: float


def _wall(y: Array, height: Array, groove: GrooveMeasure, floor: float, side: int, step: float) -> _Wall | None:
    """The straight line nearest to a wall, None without a face above the floor. side: -1 left, 1 right."""
    # Along `away` the wall rises from the middle of the groove to the face.
    away = side * (y - groove.centre)
    order = np.argsort(away)
    order = order[(away[order] >= 0) & (away[order] <= 0.5 * groove.width + _BESIDE + step)]
    at, rise = away[order], height[order] - floor
    face = float(np.nanmax(rise[at >= 0.5 * groove.width - step]))
    if not face > 0:
        return None
    part = rise / face
    on = part[(part > _LOW) & (part < _HIGH) & (at > _crossing(at, part, 0.5) - 2 * face)]
    if len(on) < 2:
        # One place on the wall bounds its run: its neighbours lie on the floor and on the face.
        run = 0.5 * step / max(float(on[0]), 1 - float(on[0])) if len(on) else 0.0
        height_there = float(on[0]) if len(on) else 0.5
        place = _crossing(at, part, height_there) + (1 - height_there) * run
        return _Wall(groove.centre + side * place, face, run / face, 0.0)
    # Between two places on a wall it is as steep as between them; more of them show all of it.
    low, high = (float(on.min()), float(on.max())) if len(on) == 2 else (_LOW, _HIGH)
    levels = np.linspace(low, high, _LEVELS)
    crossings = np.array([_crossing(at, part, level) for level in levels])
    run, start = np.polyfit(levels, crossings, 1)
    off = float(np.sqrt(np.mean(np.square(run * levels + start - crossings))))
    run = max(float(run), 0.0)
    place = float(crossings.mean()) + run * (1 - float(levels.mean()))
    return _Wall(groove.centre + side * place, face, run / face, off)


def _crossing(at: Array, rise: Array, level: float) -> float:
    """Outermost place where a rise passes a level, m."""
    below = np.flatnonzero(~(rise >= level))
    last = int(below[-1]) if below.size else 0
    if last + 1 >= len(at) or not np.isfinite(rise[last]):
        return float(at[min(last, len(at) - 1)])
    part = (level - rise[last]) / (rise[last + 1] - rise[last])
    return float(at[last] + part * (at[last + 1] - at[last]))


def _ends(
    y: Array, height: Array, channels: Sequence[Channel], arc_radius: float | None, ends: tuple[float, float]
) -> tuple[float, float]:
    """Where the tread has fallen by half of its deepest groove below its arc, m; ends if it is not known there."""
    bend = 0.0 if arc_radius is None or math.isinf(arc_radius) else 0.5 / arc_radius
    level = np.where(np.isfinite(height), height, -1.0) + bend * np.square(y)
    inner = [channel.left for channel in channels[:1]] + [channel.right for channel in channels[-1:]] or [0.0, 0.0]
    half = 0.5 * max((channel.depth for channel in channels), default=2 * _FALLEN)
    face = _face(y, level, channels) if channels else float(np.nanmedian(level))
    with np.errstate(invalid="ignore"):
        fallen = ~(level > face - half)
    left, right = np.flatnonzero(fallen & (y < inner[0])), np.flatnonzero(fallen & (y > inner[-1]))
    low = crossing(y, level, int(left[-1]), face - half) if left.size else ends[0]
    high = crossing(y, level, int(right[0]) - 1, face - half) if right.size else ends[1]
    return max(low, ends[0]), min(high, ends[1])


def _face(y: Array, level: Array, channels: Sequence[Channel]) -> float:
    """Height of the faces of all ribs over the arc, m: the median from the first groove to the last."""
    first, last = channels[0], channels[-1]
    reach = max(first.right - first.left, last.right - last.left)
    face = (y > first.left - reach) & (y < last.right + reach)
    for channel in channels:
        face &= (y < channel.left - _BESIDE) | (y > channel.right + _BESIDE)
    return float(np.nanmedian(level[face] if np.isfinite(level[face]).any() else level))
