"""Few roads for the many of a climate: which temperatures are solved, and readings at those between."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.interpolate import PchipInterpolator

from treadload.damage.traffic import Season
from treadload.kernels.arrays import Array
from treadload.materials import Elastic
from treadload.pavement import Pavement


def warmth_of(seasons: Sequence[Season], roads: Sequence[Pavement]) -> Array | None:
    """One number that orders the roads of a climate (road,): the mean of the layers' ln E, of which strains are
    smoother functions than of temperature. None where a single number does not tell the roads apart.
    """
    if any(isinstance(season.temperature, tuple) for season in seasons):
        return None
    materials = [[layer.resolved for layer in one.layers] for one in roads]
    moduli = [[one.modulus for one in row if isinstance(one, Elastic)] for row in materials]
    if any(len(elastic) < len(row) for elastic, row in zip(moduli, materials, strict=True)):
        return None
    warmth: Array = np.log(moduli).mean(axis=1)
    return warmth if len(np.unique(warmth)) == len(warmth) else None


def nodes(warmth: Array | None, pilot: Array, tolerance: float) -> tuple[list[int], float]:
    """Roads to solve for the other classes, in the order of warmth, and the error of the rest on the pilot.

    pilot: (road, criterion, turn, y). The error is that of the readings over the largest r₁ of each criterion and
    road, and counts (r/r₁)² where r is read: no law raises harm by less than the third power, so that more than
    this never shows in the damage.
    """
    everything = list(range(len(pilot)))
    if warmth is None or tolerance == 0 or len(pilot) < 4:
        return everything, 0.0
    order = np.argsort(warmth)
    kept = [int(order[0]), int(order[-1])]
    largest = np.abs(pilot).max(axis=(2, 3), keepdims=True)
    largest[largest == 0] = 1.0
    while True:
        kept.sort(key=lambda k: warmth[k])
        apart = np.abs(_spline(warmth[kept], pilot[kept], 0)(warmth) - pilot) / largest
        errors = (apart * (pilot / largest) ** 2).max(axis=(1, 2, 3))
        if errors.max() <= tolerance:
            return kept, float(errors.max())
        if len(kept) + 1 == len(pilot):
            return everything, 0.0
        kept.append(int(errors.argmax()))


def over_the_climate(warmth: Array | None, kept: list[int], rest: Array, turns: int) -> Array:
    """All roads (class, road, ...) from the kept ones: readings by splines, cracks from the nearest."""
    assert warmth is not None
    nearest = np.abs(warmth[:, None] - warmth[kept]).argmin(axis=1)
    whole = rest[:, nearest]
    whole[:, :, :, :turns] = np.maximum(_spline(warmth[kept], rest[:, :, :, :turns], 1)(warmth), 0.0)
    return whole


def _spline(warmth: Array, values: Array, axis: int) -> PchipInterpolator:
    return PchipInterpolator(warmth, values, axis=axis)
