"""The tread unrolled, and what has been worn off it since an earlier scan."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.errors import GeometryError
from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.scan import meridian as unrolling
from treadload.tire.scan.rays import Caster, radial
from treadload.tire.scan.surface import EXTENT_DROP, ScanSurface

STEP = math.radians(0.5)
ACROSS = 1e-3
DEEPER = 0.02  # below the tread's deepest row rays are followed no further, m
SAME_GROOVE = 0.012  # a groove of one scan is that of the other when they lie this near, m
RIB_BAND = 0.003


def unroll(surface: ScanSurface, theta: Array, y: Array) -> Array:
    """(ny, nt) radius of the tread, m, from straight down towards travel; NaN where nothing was scanned.

    theta: (nt,) rad. y: (ny,) m, from the middle of the tread to the right. As cleaned and smoothed, not as revolved.
    """
    radius = surface.report.crown_radius
    caster = Caster(surface.vertices, surface.faces)
    return radial(caster, theta, y, 1.5 * radius, radius - surface.deepest - DEEPER)


@dataclass(frozen=True, eq=False)
class Wear:
    """What was worn off a tread between two scans of it, m, along the radius.

    y: (ny,) places across. theta: (nt,) rad. worn: (ny, nt), positive where material is gone, NaN where one of the
    scans knows nothing. land: (ny,) True on ribs. datum: by which the radii of the earlier scan were lowered so that
    the floors of the grooves, which do not wear, agree; 0 without grooves. shift: of the earlier scan across.
    grooves: (centre, depth before, depth now) of those in both.
    """

    y: Array
    theta: Array
    worn: Array
    land: BoolArray
    datum: float
    shift: float
    grooves: tuple[tuple[float, float, float], ...]

    @cached_property
    def by_place(self) -> Array:
        """(ny,) median round the tire, m; NaN off the ribs."""
        out = np.full(len(self.y), np.nan)
        rows = self.land & np.isfinite(self.worn).any(axis=1)
        out[rows] = unrolling.row_quantile(self.worn[rows], 0.5)
        return out

    @property
    def mean(self) -> float:
        """Of the ribs, m."""
        return float(np.nanmean(self.by_place))

    @property
    def uneven(self) -> float:
        """Most minus least across, m: 95 % less 5 % of the places."""
        low, high = np.nanquantile(self.by_place, [0.05, 0.95])
        return float(high - low)

    def __str__(self) -> str:
        place = int(np.nanargmax(self.by_place))
        lines = [
            f"worn off the ribs {self.mean * 1e3:.2f} mm on average, most {self.by_place[place] * 1e3:.2f} mm at "
            f"y = {self.y[place] * 1e3:+.0f} mm; uneven across by {self.uneven * 1e3:.2f} mm",
            f"radii agree in the grooves after {self.datum * 1e3:+.2f} mm" if self.grooves else
            "no groove in both scans: the radii are compared as they are, swelling and scale included",
        ]  # fmt: skip
        lines += [
            f"groove at y = {centre * 1e3:+.1f} mm: {before * 1e3:.1f} mm deep before, {now * 1e3:.1f} mm now"
            for centre, before, now in self.grooves
        ]
        return "\n".join(lines)


def wear(new: ScanSurface, reference: ScanSurface) -> Wear:
    """What is gone of a tread since an earlier scan of the same tire.

    Both are unrolled about their own axles. The earlier one enters by its median round the tire, as nothing tells how
    far the wheel was turned between them: wear of ribs is mapped round the tire, of lugs and blocks on average.
    It is shifted across and along the radius so that the grooves in both agree. Raises GeometryError when the radii
    differ by more than a tread is deep.
    """
    apart = reference.report.crown_radius - new.report.crown_radius
    if abs(apart) > EXTENT_DROP:
        raise GeometryError(
            f"the crown of the earlier scan is {apart * 1e3:+.0f} mm larger, more than a tread is deep "
            f"({EXTENT_DROP * 1e3:.0f} mm): check that both are of one tire, and their units"
        )
    pairs = [
        (now, before)
        for now in new.report.grooves
        for before in reference.report.grooves
        if abs(now.centre - before.centre) < SAME_GROOVE
    ]
    shift = float(np.median([now.centre - before.centre for now, before in pairs])) if pairs else 0.0
    y = np.arange(new.across[0], new.across[-1], ACROSS)
    theta = np.arange(-math.pi, math.pi, STEP) + 0.3 * STEP
    turn = unroll(new, theta, y)
    before = np.interp(y - shift, reference.across, reference.meridian, left=np.nan, right=np.nan)
    deep = (unrolling.groove_depth(reference.across, reference.meridian) > RIB_BAND).astype(np.float64)
    low = np.interp(y - shift, reference.across, deep) > 0
    tread = before > reference.report.crown_radius - EXTENT_DROP
    floors = np.zeros(len(y), dtype=bool)
    for now, _ in pairs:
        floors |= np.abs(y - now.centre) < 0.25 * now.width
    over = before[:, None] - turn
    known = over[floors]
    datum = float(np.nanmedian(known)) if np.isfinite(known).any() else 0.0
    grooves = tuple((now.centre, before.depth, now.depth) for now, before in pairs)
    # Walls move sideways by tenths of a millimetre and up and down by millimetres.
    steep = np.abs(np.gradient(before, ACROSS)) > 0.5
    return Wear(y, theta, over - datum, np.asarray(tread & ~low & ~steep, dtype=bool), datum, shift, grooves)
