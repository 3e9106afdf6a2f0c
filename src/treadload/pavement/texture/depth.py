"""How deep a texture is: mean profile depth, on lines and on maps, and mean texture depth by filling.

Sources: ISO 13473-1:2019 for the mean profile depth, its steps as a public implementation of the standard has them
(captif-slp, MIT), with whose results on a measured profile this one is compared; EN 13036-1 for the volumetric patch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array, BoolArray
from treadload.pavement.texture.description import Texture
from treadload.pavement.texture.treatment import spikes

# Of ISO 13473-1:2019, m.
SEGMENT, LOW_PASS, _SAMPLES = 0.1, 2.4e-3, (0.5e-3, 1e-3)
# What a segment may lack, and how much of it must be there.
_MOST_DROPOUTS, _MOST_SPIKES, _LEAST = 0.1, 0.05, 0.9


@dataclass(frozen=True)
class ProfileDepth:
    """Mean profile depth. mean: of the valid segments, m. segments: depth of each, m, NaN of those not valid."""

    mean: float
    segments: Array
    valid: int

    def __str__(self) -> str:
        return f"MPD {self.mean * 1e3:.3g} mm, {self.valid} of {self.segments.size} segments valid"


def mean_profile_depth(texture: Texture, *, spike_slope: float = 3.0, sample: float | None = None) -> ProfileDepth:
    """Mean profile depth of ISO 13473-1:2019, along travel, of one line or of all the lines of a map.

    Drop-outs are filled between their neighbours, points averaged to samples, spikes taken out and filled, waves
    below 2.4 mm filtered (second-order Butterworth, both ways), and every segment of 100 mm levelled; its depth is
    the mean of the highest points of its two halves above its mean. A segment with more than 10 % drop-outs or 5 %
    spikes is not valid. spike_slope: of a step that is a spike; 3 in the standard. sample: m, 0.5 or 1 mm; left out,
    the finer one that the texture has. Raises InputError for coarser points, and where no segment is valid.
    """
    positive("spike_slope", spike_slope, "1", "3 is that of ISO 13473-1")
    step = texture.dx
    chosen = next((length for length in _SAMPLES if step <= length * (1 + 1e-6)), None) if sample is None else sample
    if chosen is None or chosen not in _SAMPLES or step > chosen * (1 + 1e-6):
        raise InputError(
            f"ISO 13473-1 samples every 0.5 or 1 mm, and this texture has points every {step * 1e3:.4g} mm; "
            "measure it finer"
        )
    profiles = [_line(row, step, chosen, spike_slope) for row in texture.heights]
    segments = np.concatenate(profiles)
    valid = np.isfinite(segments)
    if not valid.any():
        raise InputError(
            f"no segment of 100 mm is valid in a texture of {texture.length * 1e3:.4g} mm: each needs nine tenths of "
            f"its points, at most 10 % drop-outs and 5 % steps steeper than {spike_slope:g}"
        )
    return ProfileDepth(float(segments[valid].mean()), segments, int(valid.sum()))


def _line(heights: Array, step: float, sample: float, slope: float) -> Array:
    """Depths of the segments of one line, m."""
    place = step * np.arange(heights.size)
    missing = np.isnan(heights)
    if missing.all():
        return np.full(max(1, int(heights.size * step / SEGMENT)), np.nan)
    filled = np.interp(place, place[~missing], heights[~missing])
    # Points belong to the sample that ends at or after them, the first point to the first.
    into = np.maximum(np.ceil(place / sample - 1e-9).astype(int), 1) - 1
    counts = np.bincount(into)
    sampled: Array = np.bincount(into, filled) / counts
    ends = sample * (1 + np.arange(sampled.size))
    steep = spikes(sampled, slope * sample * (1 - 1e-12))
    if not steep.all():
        sampled = np.interp(ends, ends[~steep], sampled[~steep])
    if sampled.size > 12:
        sampled = _smoothed(sample, sampled)
    bins = np.maximum(np.ceil(ends / SEGMENT - 1e-9).astype(int) - 1, 0)
    raw = np.maximum(np.ceil(place / SEGMENT - 1e-9).astype(int) - 1, 0)
    depths = []
    for number in range(int(bins.max()) + 1):
        here = bins == number
        if here.sum() < _LEAST * SEGMENT / sample:
            continue
        depths.append(_segment(ends[here], sampled[here], steep[here], missing[raw == number]))
    return np.array(depths)


def _segment(place: Array, height: Array, steep: BoolArray, missing: BoolArray) -> float:
    if missing.mean() > _MOST_DROPOUTS or steep.mean() > _MOST_SPIKES:
        return float("nan")
    level = height - np.polyval(np.polyfit(place - place[0], height, 1), place - place[0])
    half = place <= place[0] + 0.5 * (place[-1] - place[0])
    return float(0.5 * (level[half].max() + level[~half].max()) - level.mean())


def _smoothed(sample: float, heights: Array, axis: int = -1) -> Array:
    """Heights that stand a sample apart along an axis, m, without what is shorter than the method's limit."""
    # scipy.signal brings scipy.stats along, which takes as long to import as all of this package.
    from scipy.signal import butter, sosfiltfilt

    return np.asarray(sosfiltfilt(butter(2, 2 * sample / LOW_PASS, output="sos"), heights, axis=axis))


def mean_texture_depth(texture: Texture, *, patch: float = 0.1) -> float:
    """Depth, m, of what fills a texture up to the plane through its three highest parts: the volumetric patch.

    patch: side of the squares, m, each of which is levelled and filled up to a plate on the highest points of its
    quarters; of a profile, of the lines, filled up to those of its halves. The mean of all whole patches; the only
    one where the texture is smaller. A glass-bead patch of EN 13036-1 is filled over some 250 mm of road by hand; by
    geometry this stands for it, without the size of the beads. Raises InputError for drop-outs.
    """
    positive("patch", patch, "metres", "100 mm is 0.1")
    heights = texture.whole("the texture depth")
    columns = _pieces(heights.shape[1], texture.dx, patch)
    rows = [slice(None)] if texture.is_profile else _pieces(heights.shape[0], texture.dy, patch)
    return float(np.mean([_filled(heights[row, column]) for row in rows for column in columns]))


def map_profile_depth(texture: Texture, *, patch: float = SEGMENT) -> float:
    """Two-dimensional mean profile depth of a map, m: as ISO 13473-1 does it on lines, on squares.

    Waves below 2.4 mm are taken out along both axes, every square of `patch`, m, levelled by a plane; its depth is
    the mean of the highest points of its four quarters above its mean. It lies above the depth of lines, since the
    highest point of an area is higher than that of a line across it. Raises InputError for a profile and drop-outs.
    """
    if texture.is_profile:
        raise InputError("a profile has no depth of squares; use mean_profile_depth, or give a map")
    positive("patch", patch, "metres", "100 mm is 0.1")
    heights = texture.whole("the depth of squares").copy()
    for axis, step in ((1, texture.dx), (0, texture.dy)):
        if step < 0.5 * LOW_PASS and heights.shape[axis] > 12:
            heights = _smoothed(step, heights, axis)
    squares = [
        _levelled(heights[row, column])
        for row in _pieces(heights.shape[0], texture.dy, patch)
        for column in _pieces(heights.shape[1], texture.dx, patch)
    ]
    return float(np.mean([np.mean(_quarters(square)) for square in squares]))


def _pieces(count: int, step: float, size: float) -> list[slice]:
    """Whole pieces of a size; one of all points where there is none."""
    points = min(count, max(4, round(size / step)))
    return [slice(k * points, (k + 1) * points) for k in range(count // points)]


def _levelled(heights: Array) -> Array:
    ny, nx = heights.shape
    x, y = np.meshgrid(np.linspace(-1, 1, nx), np.linspace(-1, 1, ny) if ny > 1 else np.zeros(1))
    terms = np.array(
        [np.ones(heights.size), x.ravel(), y.ravel()] if ny > 1 else [np.ones(heights.size), x.ravel()]
    ).T
    coefficients, *_ = np.linalg.lstsq(terms, heights.ravel(), rcond=None)
    return np.asarray(heights - (terms @ coefficients).reshape(ny, nx))


def _quarters(level: Array) -> list[float]:
    """Highest points of the quarters, of a line of its halves."""
    ny, nx = level.shape
    rows = (slice(0, ny // 2), slice(ny // 2, ny)) if ny > 1 else (slice(None),)
    return [float(level[row, column].max()) for row in rows for column in (slice(0, nx // 2), slice(nx // 2, nx))]


def _filled(heights: Array) -> float:
    level = _levelled(heights)
    plate = float(np.mean(_quarters(level)))
    return float(np.maximum(plate - level, 0.0).mean())
