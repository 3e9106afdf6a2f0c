"""Few roads for the many of a climate: which temperatures are solved, and readings at those between."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import scipy

from treadload.damage.climate import Season
from treadload.damage.traffic import Wander
from treadload.kernels.arrays import Array
from treadload.materials.kinds import AnyElastic, upright
from treadload.pavement import Pavement

NEVER = Wander.none()
# Of what profiles differ in: the part that is left out, and the directions that are looked at.
_SPREAD, _DIMENSIONS = 1e-3, 3
# Below this part of the largest, readings are not told apart by their logarithm.
_LINEAR = 0.1
# Of the tolerance of a reading, in the damage of a year: in the sum over seasons errors of both signs meet.
_OF_A_YEAR = 0.2
# Of the reading, in the damage: from soils and steep mixes over asphalt to courses bound with cement.
_POWERS = (3, 5, 12)


def warmth_of(seasons: Sequence[Season], roads: Sequence[Pavement]) -> Array | None:
    """What orders the roads of a climate, of which strains are smoother functions than of temperature.

    Of seasons of one temperature the mean of the layers' ln E, (road,). Of profiles over depth, and with factors on
    layers, the few combinations of the layers' ln E in which the roads differ, (road, k), the widest from 0 to 1.
    None where these do not distinguish the roads, or layers have temperatures of their own.
    """
    if any(isinstance(season.temperature, tuple) for season in seasons):
        return None
    materials = [[layer.resolved for layer in road.layers] for road in roads]
    moduli = [[upright(material)[0] for material in row if isinstance(material, AnyElastic)] for row in materials]
    if any(len(elastic) < len(row) for elastic, row in zip(moduli, materials, strict=True)):
        return None
    warmth: Array = np.log(moduli)
    deep = any(season.profile is not None or season.factors for season in seasons)
    warmth = _apart(warmth) if deep else warmth.mean(axis=1)
    return warmth if len(np.unique(warmth, axis=0)) == len(warmth) else None


def _apart(moduli: Array) -> Array:
    """Principal components (road, k) of ln E (road, layer) that hold all but a thousandth of the spread."""
    centred = moduli - moduli.mean(axis=0)
    left, size, _ = np.linalg.svd(centred, full_matrices=False)
    cumulative = np.cumsum(size**2) / max(float((size**2).sum()), np.finfo(float).tiny)
    count = min(int(np.searchsorted(cumulative, 1 - _SPREAD)) + 1, _DIMENSIONS)
    scores = (left * size)[:, :count]
    result: Array = (scores - scores.min(axis=0)) / max(float(np.ptp(scores)), np.finfo(float).tiny)
    return result


def nodes(
    warmth: Array | None,
    pilot: Array,
    tolerance: float,
    wander: Wander = NEVER,
    spacing: float = 1.0,
    yearly: Callable[[Array], Array] | None = None,
) -> tuple[list[int], float]:
    """Roads to solve for the other classes, in the order of warmth, and the error of the rest on the pilot.

    pilot: (road, turn, y), peaks and valleys that one criterion reads, y `spacing` m apart. wander: that counts with
    its law. yearly: damage of each road in a year (road, y) from readings such as the pilot; the sum over roads,
    after wander, is held to a fifth of the tolerance where it is largest: that is what a life is made of.
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
    kept = first_nodes(warmth)
    while True:
        kept.sort(key=lambda k: warmth[k] if warmth.ndim == 1 else k)
        read = curves(warmth[kept], pilot[kept], 0)(warmth)
        apart = np.abs(_harm(read / largest, wander, spacing) - true) / most
        errors = (apart.max(axis=2) / np.array(_POWERS)[:, None]).max(axis=0)
        if errors.max() <= tolerance:
            off = np.zeros(len(pilot)) if yearly is None else _off(yearly(pilot), yearly(read), wander, spacing)
            if abs(off.sum()) <= _OF_A_YEAR * tolerance:
                return kept, float(errors.max())
            # The road that does most of what is wrong with the sum.
            errors = np.abs(off)
        if len(kept) + 1 == len(pilot):
            return everything, 0.0
        errors[kept] = 0.0
        kept.append(int(errors.argmax()))


def _off(true: Array, read: Array, wander: Wander, spacing: float) -> Array:
    """By how much each road's damage (road, y) is read too large where the year's is largest, over that."""
    sums = wander.spread(np.stack([true, read]), spacing)
    year = sums[0].sum(axis=0)
    worst = int(year.argmax())
    off: Array = (sums[1] - sums[0])[:, worst] / year[worst] if year[worst] > 0 else np.zeros(len(true))
    return off


def _harm(readings: Array, wander: Wander, spacing: float) -> Array:
    """Harm across the road (power, road, y) of peaks less valleys (road, turn, y), after wander."""
    above = readings > 0
    # Turns and places where nothing is read are many.
    turns, columns = (np.flatnonzero(above.any(axis=axes)) for axes in ((0, 2), (0, 1)))
    sign, read = np.where(turns % 2, -1.0, 1.0)[:, None], np.maximum(readings[:, turns[:, None], columns], 0.0)
    harm = np.zeros((len(_POWERS), len(readings), readings.shape[2]))
    for part, power in zip(harm, _POWERS, strict=True):
        part[:, columns] = (sign * read**power).sum(axis=1)
    return wander.spread(harm, spacing)


def over_the_climate(warmth: Array | None, kept: list[int], rest: Array, turns: int) -> Array:
    """All roads (class, road, ...) from the kept ones: readings (turn) by splines, cracks from the nearest.

    turns: how many of the third axis are readings; none where nothing is read.
    """
    assert warmth is not None
    places = warmth.reshape(len(warmth), -1)
    nearest = np.linalg.norm(places[:, None] - places[kept], axis=-1).argmin(axis=1)
    whole = rest[:, nearest]
    if turns:
        whole[:, :, :turns] = np.maximum(curves(warmth[kept], rest[:, :, :turns], 1)(warmth), 0.0)
    return whole


def first_nodes(warmth: Array) -> list[int]:
    """Roads to begin with: the ends of every direction, and as many as a plane through them needs."""
    if warmth.ndim == 1:
        order = np.argsort(warmth)
        return [int(order[0]), int(order[-1])]
    kept = {int(row) for column in warmth.T for row in (column.argmin(), column.argmax())}
    while len(kept) < warmth.shape[1] + 2:
        first = sorted(kept)
        far = np.linalg.norm(warmth[:, None] - warmth[first], axis=-1).min(axis=1)
        kept.add(int(far.argmax()))
    return sorted(kept)


def curves(warmth: Array, values: Array, axis: int) -> Callable[[Array], Array]:
    """Curves through values over warmth; over several directions the smoothest surfaces through them.

    These go through about the logarithm of the values, of which strains are smoother functions.
    """
    ahead = np.moveaxis(values, axis, 0)
    if warmth.ndim == 1:
        flat = ahead.reshape(len(ahead), -1)
        # Turns and places where nothing is read are many.
        read_somewhere = np.flatnonzero(flat.any(axis=0))
        curve = scipy.interpolate.PchipInterpolator(warmth, flat[:, read_somewhere])

        def single(at: Array) -> Array:
            whole = np.zeros((len(at), flat.shape[1]))
            whole[:, read_somewhere] = curve(at)
            return np.moveaxis(whole.reshape(len(at), *ahead.shape[1:]), 0, axis)

        return single
    linear = _LINEAR * float(np.abs(values).max()) or 1.0
    surfaces = scipy.interpolate.RBFInterpolator(
        warmth, np.arcsinh(ahead.reshape(len(ahead), -1) / linear), kernel="cubic", degree=1
    )

    def read(at: Array) -> Array:
        curve_values = linear * np.sinh(surfaces(at))
        return np.moveaxis(curve_values.reshape(len(at), *ahead.shape[1:]), 0, axis)

    return read
