"""Few roads for the many of a climate: which temperatures are solved, and readings at those between."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import PchipInterpolator

from treadload.damage.climate import Season
from treadload.damage.traffic import Wander
from treadload.kernels.arrays import Array
from treadload.materials.kinds import AnyElastic, upright
from treadload.pavement import Pavement

NEVER = Wander.none()
# Of the reading, in the damage: from soils and steep mixes over asphalt to courses bound with cement.
_POWERS = (3, 5, 12)


def warmth_of(seasons: Sequence[Season], roads: Sequence[Pavement]) -> Array | None:
    """One number that orders the roads of a climate (road,): the mean of the layers' ln E, of which strains are
    smoother functions than of temperature. None where a single number does not tell the roads apart.
    """
    if any(isinstance(season.temperature, tuple) for season in seasons):
        return None
    materials = [[layer.resolved for layer in one.layers] for one in roads]
    moduli = [[upright(one)[0] for one in row if isinstance(one, AnyElastic)] for row in materials]
    if any(len(elastic) < len(row) for elastic, row in zip(moduli, materials, strict=True)):
        return None
    warmth: Array = np.log(moduli).mean(axis=1)
    return warmth if len(np.unique(warmth)) == len(warmth) else None


def nodes(
    warmth: Array | None, pilot: Array, tolerance: float, wander: Wander = NEVER, spacing: float = 1.0
) -> tuple[list[int], float]:
    """Roads to solve for the other classes, in the order of warmth, and the error of the rest on the pilot.

    pilot: (road, turn, y), peaks and valleys that one criterion reads, y `spacing` m apart. wander: that counts with
    its law.
    The error is that of the harm across the road, after wander, over its largest, as an error of the reading that
    does it: over the power of the reading, for the flattest, a usual and the steepest law. Where the crack under a
    tread's edge opens or not between one temperature and the next, single readings jump; the harm does not.
    """
    everything = list(range(len(pilot)))
    if warmth is None or tolerance == 0 or len(pilot) < 4:
        return everything, 0.0
    largest = float(np.abs(pilot).max()) or 1.0
    true = _harm(pilot / largest, wander, spacing)
    most = true.max(axis=2, keepdims=True)
    most[most == 0] = 1.0
    order = np.argsort(warmth)
    kept = [int(order[0]), int(order[-1])]
    while True:
        kept.sort(key=lambda k: warmth[k])
        read = _spline(warmth[kept], pilot[kept], 0)(warmth)
        apart = np.abs(_harm(read / largest, wander, spacing) - true) / most
        errors = (apart.max(axis=2) / np.array(_POWERS)[:, None]).max(axis=0)
        if errors.max() <= tolerance:
            return kept, float(errors.max())
        if len(kept) + 1 == len(pilot):
            return everything, 0.0
        kept.append(int(errors.argmax()))


def _harm(readings: Array, wander: Wander, spacing: float) -> Array:
    """Harm across the road (power, road, y) of peaks less valleys (road, turn, y), after wander."""
    sign = np.where(np.arange(readings.shape[1]) % 2, -1.0, 1.0)[:, None]
    powers = [(sign * np.maximum(readings, 0.0) ** power).sum(axis=1) for power in _POWERS]
    return wander.spread(np.array(powers), spacing)


def over_the_climate(warmth: Array | None, kept: list[int], rest: Array, turns: int) -> Array:
    """All roads (class, road, ...) from the kept ones: readings (turn) by splines, cracks from the nearest."""
    assert warmth is not None
    nearest = np.abs(warmth[:, None] - warmth[kept]).argmin(axis=1)
    whole = rest[:, nearest]
    whole[:, :, :turns] = np.maximum(_spline(warmth[kept], rest[:, :, :turns], 1)(warmth), 0.0)
    return whole


def _spline(warmth: Array, values: Array, axis: int) -> PchipInterpolator:
    return PchipInterpolator(warmth, values, axis=axis)
