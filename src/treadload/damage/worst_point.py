"""The worst point of a map of means, searched between its points and between its depths."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import scipy

from treadload import variables
from treadload.damage.quantity import Quantity
from treadload.damage.reading import Field, read_means
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.response.means import Means

# Points around the worst of a map, in a material length; and again around the worst of those.
_STEPS = 20
_FINER = 8
# Maxima of a map this near to its largest may be larger between its points; so many are looked at.
_RIVAL = 0.94
_RIVALS = 8
# Depths between two of the response that are looked at below the worst point.
_DEPTHS = 4
# Points each way between which the fields nearest to the worst one are interpolated.
_CHEBYSHEV = 5
# A point that was found may differ by this much when it is read in full.
_ROUGH = 1e-5
# Readings nearer to each other than this are the same.
_SAME = 1e-6
# Points along an axis from which they are a map, and not a few places that were chosen.
_MAP = 5
# A map is filled with points up to so many in all, over its depths.
_MOST = 50_000
# Of distances between points.
_ROUND_OFF = 1e-9


def closer(means: Means, field: Field) -> tuple[Field, dict[str, float]] | None:
    """The worst point between those of a field, and the largest strains around it; None where it is not searched.

    field: means over (depth, y, x). A map whose points lie further apart than the side of the cubes is filled with
    points first, see `filled`. The map's points lie as far apart as its cells, and the largest reading lies
    between them: by round maxima a little higher, by the line where tension ends, which cuts the reading off at once,
    by up to a twentieth. So the neighbourhood is searched twice, and that of every maximum near the largest; then the
    depths between those of the field, under the worst point, and the neighbourhood there. Fields within 1e-6 are
    enough to find the point; it is then read in full.
    """
    field = filled(means, field)
    if not field.most > 0:
        return None
    if not means.road.is_viscoelastic:
        better = _worst_between(means, field, rough=True)
        if better is None:
            return None
        row, j, i = better.worst
        depth, y, x = (better.data[name].to_numpy()[k : k + 1] for name, k in (("depth", row), ("y", j), ("x", i)))
        exact = replace(better, data=read_means(means, better.quantity, depth, x=x, y=y))
        # Beside the line where tension ends either of them may lie beyond it.
        if abs(exact.most / better.most - 1) < _ROUGH:
            return exact, better.largest
    better = _worst_between(means, field, rough=False)
    return None if better is None else (better, better.largest)


def filled(means: Means, field: Field) -> Field:
    """A field with further points, so that neighbours lie at most a side of its cubes apart; itself where they do.

    A mean over a cube changes little over its side: at the edge of a rib it may rise by a seventh over 11.5 mm, and
    by more further away. Axes of fewer than five points are chosen places and stay as they are, and so does a map
    that would take more than 50 000 points; `unsearched` states this.
    """
    axes = _filled_axes(field)
    if axes is None:
        return field
    depths = field.data["depth"].to_numpy()
    return replace(
        field, data=read_means(means, field.quantity, depths, rough=not means.road.is_viscoelastic, **axes)
    )


def unsearched(field: Field) -> list[str]:
    """A sentence if a larger value may lie between the points of a map of means, too far apart to be searched."""
    axes = _filled_axes(field) or {name: field.data[name].to_numpy() for name in ("y", "x")}
    apart = {name: float(np.abs(np.diff(at)).max(initial=0.0)) for name, at in axes.items()}
    wide = [name for name, gap in apart.items() if gap > field.length * (1 + _ROUND_OFF)]
    if not wide:
        return []
    where = " and ".join(f"{1e3 * apart[name]:.4g} mm along {name}" for name in wide)
    return [
        f"the evaluation points are up to {where} apart, so that a larger strain may lie between them; points at "
        f"most {1e3 * field.length:g} mm apart, the side of the cubes over which strain is averaged, are searched: "
        f"solve the response with a spacing of {1e3 * field.length:g} mm or less"
    ]


def _filled_axes(field: Field) -> dict[str, Array] | None:
    """The axes y and x of a field with further points; None where none is needed or they are too many."""
    before = {name: field.data[name].to_numpy() for name in ("y", "x")}
    after = {name: _filled_axis(at, field.length) for name, at in before.items()}
    if all(len(after[name]) == len(at) for name, at in before.items()):
        return None
    return after if field.data.sizes["depth"] * len(after["y"]) * len(after["x"]) <= _MOST else None


def _filled_axis(at: Array, length: float) -> Array:
    """Coordinates with others evenly between those further apart than a length, m; chosen places as they are."""
    if len(at) < _MAP:
        return at
    parts = np.ceil(np.abs(np.diff(at)) / length * (1 - _ROUND_OFF)).astype(int).clip(1)
    inside = [
        np.linspace(low, high, count, endpoint=False) for low, high, count in zip(at[:-1], at[1:], parts, strict=True)
    ]
    return np.concatenate([*inside, at[-1:]])


def _worst_between(means: Means, field: Field, *, rough: bool) -> Field | None:
    """The field around the worst point that `closer` looks for; rough: see `Means.at`."""
    fields = [near for at in _rivals(field) if (near := _nearer(means, field, at, rough=rough)) is not None]
    if not fields:
        return None
    best = _worst_of(fields)
    finer = {
        name: _between(best.data[name].to_numpy(), k) for name, k in zip(("y", "x"), best.worst[1:], strict=True)
    }
    read = _read_between if rough else read_means
    finest = replace(best, data=read(means, best.quantity, best.data["depth"].to_numpy(), rough=rough, **finer))
    best = max(best, finest, key=lambda near: near.most)
    return max(best, _deeper(means, field, best, rough=rough), key=lambda near: near.most)


def _worst_of(fields: Sequence[Field]) -> Field:
    """The field with the largest reading; of those that are equally large, as under the two shoulders of a symmetric
    tire, the one whose worst place has the largest y, then the largest x, see `index_of_largest`.
    """
    least = (1 - _ROUGH) * max(near.most for near in fields)

    def place(field: Field) -> tuple[float, float]:
        _, j, i = field.worst
        return float(field.data["y"][j]), float(field.data["x"][i])

    return max((field for field in fields if field.most >= least), key=place)


def _deeper(means: Means, field: Field, best: Field, *, rough: bool) -> Field:
    """The neighbourhood of the worst place at the worst depth between those of a field; the best if that is worse."""
    depths = field.data["depth"].to_numpy()
    if len(depths) < 2:
        return best
    _, j, i = best.worst
    here = {"y": best.data["y"].to_numpy()[j : j + 1], "x": best.data["x"].to_numpy()[i : i + 1]}
    most, depth = _worst_below(means, best, depths, here, rough=rough)
    # Cubes less than half a length deep are one and the same.
    if not most > best.most * (1 + _SAME):
        return best
    apart = {name: np.abs(np.diff(field.data[name].to_numpy()[:2])) for name in here}
    around = {
        name: at + (step / _FINER * np.arange(-_FINER, _FINER + 1) if len(step) else np.zeros(1))
        for (name, at), step in zip(here.items(), apart.values(), strict=True)
    }
    return replace(best, data=read_means(means, best.quantity, np.array([depth]), rough=rough, **around))


def _worst_below(
    means: Means, best: Field, depths: Array, here: dict[str, Array], *, rough: bool
) -> tuple[float, float]:
    """The largest reading below the worst place of the best field, at depths between some, m; and its depth.

    here: y and x of the place, (1,) each.
    """
    largest_by_read = {means.reads(float(best.data["depth"][best.worst[0]])): best.most}

    def readings(at: Array) -> Array:
        """Of cubes around depths; those that reach as far are read once."""
        reads = [means.reads(float(depth)) for depth in at]
        new = {read: depth for read, depth in zip(reads, at, strict=True) if read not in largest_by_read}
        if new:
            column = replace(
                best, data=read_means(means, best.quantity, np.array([*new.values()]), rough=rough, **here)
            )
            largest_by_read.update(zip(new, column.value[:, 0, 0].tolist(), strict=True))
        return np.array([largest_by_read[read] for read in reads])

    parts = np.arange(1, _DEPTHS + 1) / (_DEPTHS + 1)
    between = (depths[:-1, None] + np.diff(depths)[:, None] * parts).ravel()
    worst = between[int(np.argmax(readings(between)))]
    # And again between the neighbours of the worst of them.
    beside = np.diff(depths)[int(np.searchsorted(depths, worst)) - 1] / (_DEPTHS + 1)
    closer_by = worst + beside * np.arange(-_DEPTHS, _DEPTHS + 1) / (_DEPTHS + 1)
    values = readings(closer_by)
    k = int(np.argmax(values))
    return float(values[k]), float(closer_by[k])


def _rivals(field: Field) -> list[tuple[int, int, int]]:
    """Maxima of a map that may be the largest between its points, the largest first.

    Beside the line where tension ends the reading may rise, up to that line, to the extension beyond it.
    """
    value = np.where(np.isnan(field.value), -np.inf, field.value)
    around = scipy.ndimage.maximum_filter(
        np.where(np.isnan(field.extension), -np.inf, field.extension), (1, 3, 3), mode="nearest"
    )
    shut = scipy.ndimage.maximum_filter((value < field.extension).astype(np.uint8), (1, 3, 3), mode="nearest").astype(
        bool
    )
    ends = shut & (value > 0)
    most = np.where(ends, around, value)
    alone = np.where(ends, value, -np.inf)
    top = (value == scipy.ndimage.maximum_filter(value, (1, 3, 3), mode="nearest")) | (
        ends & (alone == scipy.ndimage.maximum_filter(alone, (1, 3, 3), mode="nearest"))
    )
    top &= most >= _RIVAL * value[field.worst]
    places = sorted(map(tuple, np.argwhere(top)), key=lambda at: -most[at])
    first = [(int(row), int(j), int(i)) for row, j, i in places[:_RIVALS]]
    return first if field.worst in first else [field.worst, *first]


def _nearer(means: Means, field: Field, at: tuple[int, int, int], *, rough: bool) -> Field | None:
    """The field up to the neighbours of a point of its map; None where they are too far."""
    row, *place = at
    plane = (field.data[name].to_numpy() for name in ("y", "x"))
    around = [_around(axis, k, field.length) for axis, k in zip(plane, place, strict=True)]
    if any(bounds is None for bounds in around):
        return None
    y, x = (np.asarray(bounds) for bounds in around)
    depth = field.data["depth"].to_numpy()[row : row + 1]
    return replace(field, data=read_means(means, field.quantity, depth, x=x, y=y, rough=rough))


def _between(at: Array, k: int) -> Array:
    """Coordinates between a point and its neighbours; it alone where there are none."""
    if len(at) == 1:
        return at
    fine: Array = at[k] + (at[1] - at[0]) / _FINER * np.arange(1 - _FINER, _FINER)
    return fine


def _read_between(means: Means, quantity: Quantity, depths: Array, *, x: Array, y: Array, rough: bool) -> xr.Dataset:
    """The same on points so near to each other that polynomials between few of Chebyshev's points give their fields.

    The mean over a cube is that of points a fifth of its side below the surface or deeper, which is five times as far
    as these reach; polynomials through n of Chebyshev's points then err as 10^-n.
    """
    (from_x, at_x), (from_y, at_y) = (_chebyshev(at) for at in (x, y))
    sampled = read_means(means, quantity, depths, x=at_x, y=at_y, rough=rough)
    fields = {
        str(name): (("depth", "y", "x"), np.einsum("ya,zab,xb->zyx", from_y, sampled[name].to_numpy(), from_x))
        for name in sampled.data_vars
    }
    return variables.dataset(fields, {"depth": depths, "y": y, "x": x}, **sampled.attrs)


def _chebyshev(at: Array) -> tuple[Array, Array]:
    """Weights (m, n) of values at n points in those at m coordinates between, m, and the points; all if few."""
    if len(at) <= _CHEBYSHEV:
        return np.eye(len(at)), at
    unit = -np.cos(np.pi * (np.arange(_CHEBYSHEV) + 0.5) / _CHEBYSHEV)
    middle, half = 0.5 * (at.max() + at.min()), 0.5 * np.ptp(at)
    # Lagrange's polynomials.
    off_diagonal = ~np.eye(_CHEBYSHEV, dtype=bool)
    away = ((at - middle) / half)[:, None, None] - unit
    apart = np.where(off_diagonal, np.subtract.outer(unit, unit), 1.0)
    return np.where(off_diagonal, away, 1.0).prod(axis=2) / apart.prod(axis=1), middle + half * unit


def _around(at: Array, k: int, length: float) -> Array | None:
    """Coordinates up to the neighbours of one; it alone where there are none, None where they are too far."""
    if len(at) == 1:
        return at
    apart = float(np.abs(np.diff(at)[max(k - 1, 0) : k + 1]).max())
    if apart > length * (1 + _ROUND_OFF):
        return None
    steps = math.ceil(_STEPS * apart / length * (1 - _ROUND_OFF))
    around: Array = at[k] + apart / steps * np.arange(-steps, steps + 1)
    return around
