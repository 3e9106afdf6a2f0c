"""What is done to a measured texture before it is used: drop-outs, outliers, slope, waves that are not wanted."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
import scipy

from treadload.errors import InputError, positive
from treadload.kernels import fft
from treadload.kernels.arrays import Array, BoolArray
from treadload.pavement.texture.description import Texture

# More holes than this are a measurement that failed.
_MOST_UNKNOWN = 0.5
# From the median absolute deviation to the standard deviation of a Gaussian.
_GAUSSIAN = 1.4826


def fill_dropouts(texture: Texture, *, most: float = 0.2) -> Texture:
    """Heights that are not known, between those on either side, as ISO 13473-1 asks; at the ends the nearest one.

    most: share that may be missing. Linear along x; a row without any height is taken from its neighbours. Raises
    InputError where more is missing.
    """
    if not 0 <= most <= _MOST_UNKNOWN:
        raise InputError(f"most must lie in [0, {_MOST_UNKNOWN:g}], got {most:g}")
    unknown = np.isnan(texture.heights)
    count = int(unknown.sum())
    if not count:
        return texture
    share = count / unknown.size
    if share > most:
        raise InputError(
            f"{100 * share:.1f} % of the texture's heights are missing, more than {100 * most:.0f} %; measure again, "
            "cut what is good, or raise most"
        )
    heights = texture.heights.copy()
    rows, place = np.flatnonzero((~unknown).any(axis=1)), np.arange(heights.shape[1])
    for row in rows:
        valid = ~unknown[row]
        heights[row] = np.interp(place, place[valid], heights[row, valid])
    for column in range(heights.shape[1]) if rows.size < heights.shape[0] else ():
        heights[:, column] = np.interp(np.arange(heights.shape[0]), rows, heights[rows, column])
    return texture.changed(heights, f"{count} drop-outs ({100 * share:.1f} %) filled between their neighbours")


def remove_outliers(texture: Texture, *, slope: float = 3.0) -> Texture:
    """Spikes and points far from all others become drop-outs.

    slope: of a step between neighbours along x from which both of its points are a spike; 3 as in ISO 13473-1, more
    for points so close that stones have steeper sides. Points further from the median of their neighbourhood, 5
    points, than eight standard deviations of all (by the median deviation) go as well.
    """
    positive("slope", slope, "1", "3 is that of ISO 13473-1")
    heights = texture.heights.copy()
    bad = spikes(heights, slope * texture.dx)
    size = (1, 5) if texture.is_profile else (5, 5)
    filled = np.where(np.isnan(heights), float(np.nanmedian(heights)), heights)
    off = np.abs(heights - scipy.ndimage.median_filter(filled, size=size, mode="nearest"))
    usual = _GAUSSIAN * float(np.nanmedian(np.abs(heights - np.nanmedian(heights))))
    with np.errstate(invalid="ignore"):
        bad |= off > max(8 * usual, np.finfo(float).tiny)
    count = int(bad.sum())
    if not count:
        return texture
    if count == int(np.isfinite(heights).sum()):
        raise InputError(
            f"every one of the {count} heights of the texture is a spike: steps of its points are steeper than "
            f"{slope:g}; look at the units of height and distance"
        )
    heights[bad] = np.nan
    return texture.changed(
        heights, f"{count} outliers removed (steps steeper than {slope:g}, or far from all others)"
    )


def spikes(heights: Array, step: float) -> BoolArray:
    """True of both points of a step along x of `step`, m, or more. heights: (…, nx), m."""
    with np.errstate(invalid="ignore"):
        steep = np.abs(np.diff(heights, axis=-1)) >= step
    result = np.zeros(heights.shape, bool)
    result[..., 1:] |= steep
    result[..., :-1] |= steep
    return result


def level(texture: Texture, *, order: Literal[0, 1, 2] = 1) -> Texture:
    """Without mean (order 0), plane (1) or paraboloid (2), by least squares through the heights that are known."""
    if order not in (0, 1, 2):
        raise InputError(f"order must be 0, 1 or 2, got {order!r}")
    ny, nx = texture.heights.shape
    x, y = np.linspace(-1, 1, nx)[None, :], (np.linspace(-1, 1, ny) if ny > 1 else np.zeros(1))[:, None]
    powers = [(i, j) for i in range(order + 1) for j in range(order + 1 - i) if ny > 1 or not j]
    terms = np.array([(x**i * y**j).ravel() for i, j in powers]).T
    valid = np.isfinite(texture.heights).ravel()
    coefficients, *_ = np.linalg.lstsq(terms[valid], texture.heights.ravel()[valid], rcond=None)
    shape = {0: "mean", 1: "plane", 2: "paraboloid"}[order]
    return texture.changed(texture.heights - (terms @ coefficients).reshape(ny, nx), f"levelled: {shape} taken out")


def band_pass(texture: Texture, *, shortest: float | None = None, longest: float | None = None) -> Texture:
    """Its waves between two lengths, m; those beyond are taken out whole.

    A texture that does not continue at its ends is mirrored there, so that no step appears. Raises InputError for
    drop-outs, for no length at all, and where nothing lies between them.
    """
    if shortest is None and longest is None:
        raise InputError("give the shortest wave that stays, the longest, or both, in m")
    short, long = (shortest or 0.0), (math.inf if longest is None else longest)
    for name, value in (("shortest", shortest), ("longest", longest)):
        if value is not None:
            positive(f"the {name} wave", value, "metres", "2.4 mm is 0.0024")
    if short >= long:
        raise InputError(f"the shortest wave must be below the longest, got {short:g} and {long:g} m")
    heights = texture.whole("a band-pass")
    ny, nx = heights.shape
    mean = heights.mean()
    if texture.periodic:
        k = np.hypot(fft.rfftfreq(nx, texture.dx)[None, :], fft.fftfreq(ny, texture.dy)[:, None])
    else:
        k = np.hypot(np.arange(nx) / (2 * nx * texture.dx), (np.arange(ny) / (2 * ny * texture.dy))[:, None])
    with np.errstate(divide="ignore"):
        stays = (1 / k >= short * (1 - 1e-9)) & (1 / k <= long * (1 + 1e-9))
    if not stays[k > 0].any():
        raise InputError(
            f"no wave of the texture lies between {short:g} and {long:g} m: its points are {texture.step:g} m apart "
            f"and it is {texture.length:g} m long"
        )
    if texture.periodic:
        kept = fft.irfft2(fft.rfft2(heights - mean) * stays, s=(ny, nx))
    else:
        kept = fft.mirrored_waves(fft.mirrored_waves(heights - mean) * stays, back=True)
    band = " and ".join(
        [f"shorter than {short * 1e3:.4g} mm"] * (shortest is not None)
        + [f"longer than {long * 1e3:.4g} mm"] * (longest is not None)
    )
    finest = max(texture.finest_wave, short)
    return texture.changed(kept, f"waves {band} taken out", shortest=finest)


def cut(texture: Texture, *, length: float, x: float = 0.0, width: float | None = None, y: float = 0.0) -> Texture:
    """A piece of length along travel and width across, m, about (x, y), m. Raises InputError where it ends."""
    positive("length", length, "metres")
    across = texture.width if width is None else width
    columns = _reach("length", texture.x, texture.dx, x, length)
    rows = slice(None) if texture.is_profile else _reach("width", texture.y, texture.dy, y, across)
    note = f"cut to {length * 1e3:.4g} mm about x = {x * 1e3:.4g} mm"
    return texture.changed(texture.heights[rows, columns], note, periodic=False)


def _reach(name: str, places: Array, step: float, middle: float, size: float) -> slice:
    first, count = round((middle - 0.5 * size - places[0]) / step), round(size / step)
    if first < 0 or count < 2 or first + count > places.size:
        raise InputError(
            f"a {name} of {size * 1e3:.4g} mm about {middle * 1e3:.4g} mm does not lie in the texture, which reaches "
            f"from {places[0] * 1e3:.4g} to {places[-1] * 1e3:.4g} mm"
        )
    return slice(first, first + count)
