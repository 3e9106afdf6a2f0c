"""The tread unrolled, and what has been worn off it since an earlier scan."""

from __future__ import annotations

import math

import numpy as np

from treadload.errors import GeometryError
from treadload.kernels.arrays import Array
from treadload.tire.scan.rays import Caster, radial
from treadload.tire.scan.surface import EXTENT_DROP, ScanSurface
from treadload.tire.unrolled import groove_depth, row_quantile
from treadload.tire.wear import Wear
from treadload.variables import dataset

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


def wear(new: ScanSurface, reference: ScanSurface) -> Wear:
    """What is gone of a tread since an earlier scan of the same tire.

    Both are unrolled about their own axles. The earlier one enters by its median round the tire, as nothing records
    how far the wheel was turned between them: wear of ribs is mapped round the tire, of lugs and blocks on average.
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
    deep = (groove_depth(reference.across, reference.meridian) > RIB_BAND).astype(np.float64)
    low = np.interp(y - shift, reference.across, deep) > 0
    tread = before > reference.report.crown_radius - EXTENT_DROP
    floors = np.zeros(len(y), dtype=bool)
    for now, _ in pairs:
        floors |= np.abs(y - now.centre) < 0.25 * now.width
    over = before[:, None] - turn
    depths = over[floors]
    datum = float(np.nanmedian(depths)) if np.isfinite(depths).any() else 0.0
    # Walls move sideways by tenths of a millimetre and up and down by millimetres.
    steep = np.abs(np.gradient(before, ACROSS)) > 0.5
    land = tread & ~low & ~steep
    worn = np.where(land[:, None], over - datum, np.nan)
    median = np.full(len(y), np.nan)
    seen = np.isfinite(worn).any(axis=1)
    median[seen] = row_quantile(worn[seen], 0.5)
    if not seen.any():
        raise GeometryError("the two scans have no rib in common: check that both are of one tire, and their units")
    crown = new.report.crown_radius
    fields = {
        "tread_wear": (("across", "wheel_angle"), worn),
        "median_tread_wear": (("across",), median),
        "tread_height": (("across",), np.interp(y, new.across, new.meridian) - crown),
        "earlier_tread_height": (("across",), before - datum - crown),
    }
    places: dict[str, Array] = {"across": y, "wheel_angle": theta}
    if pairs:
        places["groove"] = np.array([now.centre for now, _ in pairs])
        fields["groove_depth"] = (("groove",), np.array([now.depth for now, _ in pairs]))
        fields["earlier_groove_depth"] = (("groove",), np.array([before.depth for _, before in pairs]))
    return Wear(dataset(fields, places, datum=datum, shift=shift))
