"""What a verdict reads of a response: at which depths, over how much road, and where no crack can open."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import xarray as xr
from scipy.ndimage import maximum_filter

from treadload.composing import Source
from treadload.damage.cracks import crack_plane, gridded
from treadload.damage.history import with_horizontal_stress
from treadload.damage.laws.fatigue import PowerLaw
from treadload.damage.quantity import Quantity, cut
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.layers.depths import on_interface, same_depth
from treadload.response import Response, solve_response
from treadload.response.loads import PlacedLoad
from treadload.response.superposition import mean_loads

# Points around the worst of a map, in a material length; and again around the worst of those.
_STEPS = 20
_FINER = 8
# Maxima of a map this near to its largest may be larger between its points; so many are looked at.
_RIVAL = 0.94
_RIVALS = 8
# Depths between two of the response that are looked at below the worst point.
_DEPTHS = 4
# Readings nearer to each other than this are the same.
_SAME = 1e-6


@dataclass(frozen=True, eq=False)
class Field:
    """A quantity over (depth, y, x) as a verdict sees it. data: stress and strain, see `assess`."""

    data: xr.Dataset
    quantity: Quantity

    @property
    def length(self) -> float:
        """Edge of the cube over which the points are means, m."""
        return float(self.data.attrs["mean_over"])

    @cached_property
    def extension(self) -> Array:
        """Largest extension, whatever opens."""
        return self.quantity.values(self.data)

    @cached_property
    def value(self) -> Array:
        """What is read: the extension, and nothing where no crack can open."""
        return cut(self.extension, self.quantity.opens(self.data))

    @cached_property
    def crack(self) -> tuple[Array, Array]:
        """Angle of the trace and dip, rad; NaN where no crack opens."""
        normal = self.quantity.crack(self.data)
        if normal is None:
            normal = np.full((*self.extension.shape, 3), np.nan)
        angle, dip = crack_plane(normal)
        opens = self.value > 0
        return np.where(opens, angle, np.nan), np.where(opens, dip, np.nan)

    @cached_property
    def worst(self) -> tuple[int, int, int]:
        """Index of the largest reading."""
        at = np.unravel_index(int(np.nanargmax(self.value)), self.value.shape)
        return int(at[0]), int(at[1]), int(at[2])


def check_law(line: PowerLaw) -> None:
    """Raise InputError for a law that reads no extension."""
    if not line.reads.extends:
        raise InputError(
            f"a verdict reads an extension, but {line} reads the {line.reads}; take a law for an extension"
        )


def local_field(response: Source, line: PowerLaw, depth: float) -> xr.Dataset:
    """The points of a response at one of its depths, m, over (depth, y, x). Raises InputError."""
    data = gridded(response)
    depths = data["depth"].to_numpy()
    nearest = int(np.argmin(np.abs(depths - depth)))
    if not same_depth(depths[nearest], depth):
        known = ", ".join(f"{d:g}" for d in depths)
        raise InputError(f"the response has no depth {depth:g} m, it has {known} m; solve it with that depth")
    _check_place(data, line, float(depths[nearest]))
    return data.isel(depth=[nearest])


def mean_field(response: Source, line: PowerLaw, length: float) -> tuple[xr.Dataset, list[str]]:
    """Means over a length, m, at the depths of a response that the law applies to; and what to say of the others.

    A response that is a mean is taken as it is. Raises InputError for one without its road.
    """
    data = gridded(response)
    if line.reads.where.at_bottom:
        raise InputError(
            f"{line} reads the {line.reads}; give depth= of that bottom, an interface of the road, solved from above"
        )
    if "mean_over" in data.attrs:
        depths, said = _asked(data, line)
        return data.isel(depth=np.flatnonzero(np.isin(data["depth"], depths)).tolist()), said
    if not isinstance(response, Response) or response.road is None:
        raise InputError(
            "a mean over the road needs a response of solve_response, whose road can be solved again; give depth= "
            "to read the points of this one as they are"
        )
    depths, said = _asked(data, line)
    at = {"x": data["x"].to_numpy(), "y": data["y"].to_numpy()}
    return _solved(response, depths, length, **at), said


def under_both(response: Source, shifted: Sequence[PlacedLoad], depth: float | None) -> Response:
    """A response whose question is put under the mean of its own loads and of shifted ones, see `assess`."""
    if depth is not None:
        raise InputError("points at a depth belong to the cells of one contact; leave depth or shifted out")
    if not isinstance(response, Response) or "mean_over" in response.dataset.attrs:
        raise InputError("a shifted contact is read with a response of solve_response at points, whose road it loads")
    if len(shifted) != len(response.loads):
        raise InputError(
            f"the response has {len(response.loads)} load(s), but {len(shifted)} shifted one(s); give one for each"
        )
    return replace(response, loads=tuple(mean_loads([response.loads, shifted])))


def closer(response: Source, field: Field) -> Field | None:
    """The field on points close to each other around its worst point; None where the road cannot be solved again.

    field: means over (depth, y, x). The map's points lie as far apart as its cells, and the largest reading lies
    between them: by round maxima a little higher, by the line where tension ends, which cuts the reading off at once,
    by up to a twentieth. So the neighbourhood is searched twice, and that of every maximum near the largest; then the
    depths between those of the field, under the worst point, and the neighbourhood there.
    """
    if not isinstance(response, Response) or response.road is None:
        return None
    fields = [near for at in _rivals(field) if (near := _nearer(response, field, at)) is not None]
    if not fields:
        return None
    best = max(fields, key=_largest)
    finer = {
        name: _between(best.data[name].to_numpy(), k) for name, k in zip(("y", "x"), best.worst[1:], strict=True)
    }
    finest = replace(best, data=_solved(response, best.data["depth"].to_numpy(), best.length, **finer))
    best = max(best, finest, key=_largest)
    return max(best, _deeper(response, field, best), key=_largest)


def _largest(field: Field) -> float:
    return float(field.value[field.worst])


def _deeper(response: Response, field: Field, best: Field) -> Field:
    """The neighbourhood of the worst place at the worst depth between those of a field; the best if that is worse."""
    depths = field.data["depth"].to_numpy()
    if len(depths) < 2:
        return best
    parts = np.arange(1, _DEPTHS + 1) / (_DEPTHS + 1)
    between = (depths[:-1, None] + np.diff(depths)[:, None] * parts).ravel()
    _, j, i = best.worst
    here = {"y": best.data["y"].to_numpy()[j : j + 1], "x": best.data["x"].to_numpy()[i : i + 1]}
    column = replace(best, data=_solved(response, between, best.length, **here))
    # And again between the neighbours of the worst of them.
    worst = between[column.worst[0]]
    beside = np.diff(depths)[int(np.searchsorted(depths, worst)) - 1] / (_DEPTHS + 1)
    closer_by = worst + beside * np.arange(-_DEPTHS, _DEPTHS + 1) / (_DEPTHS + 1)
    column = replace(best, data=_solved(response, closer_by, best.length, **here))
    # Cubes less than half a length deep are one and the same.
    if not _largest(column) > _largest(best) * (1 + _SAME):
        return best
    own = closer_by[column.worst[0] : column.worst[0] + 1]
    apart = {name: np.abs(np.diff(field.data[name].to_numpy()[:2])) for name in here}
    around = {
        name: at + (step / _FINER * np.arange(-_FINER, _FINER + 1) if len(step) else np.zeros(1))
        for (name, at), step in zip(here.items(), apart.values(), strict=True)
    }
    return max(column, replace(best, data=_solved(response, own, best.length, **around)), key=_largest)


def _rivals(field: Field) -> list[tuple[int, int, int]]:
    """Maxima of a map that may be the largest between its points, the largest first.

    Beside the line where tension ends the reading may rise, up to that line, to the extension beyond it.
    """
    value = np.where(np.isnan(field.value), -np.inf, field.value)
    around = maximum_filter(np.where(np.isnan(field.extension), -np.inf, field.extension), (1, 3, 3), mode="nearest")
    shut = maximum_filter((value < field.extension).astype(np.uint8), (1, 3, 3), mode="nearest").astype(bool)
    ends = shut & (value > 0)
    most = np.where(ends, around, value)
    alone = np.where(ends, value, -np.inf)
    top = (value == maximum_filter(value, (1, 3, 3), mode="nearest")) | (
        ends & (alone == maximum_filter(alone, (1, 3, 3), mode="nearest"))
    )
    top &= most >= _RIVAL * value[field.worst]
    places = sorted(map(tuple, np.argwhere(top)), key=lambda at: -most[at])
    first = [(int(row), int(j), int(i)) for row, j, i in places[:_RIVALS]]
    return first if field.worst in first else [field.worst, *first]


def _nearer(response: Response, field: Field, at: tuple[int, int, int]) -> Field | None:
    """The field up to the neighbours of a point of its map; None where they are too far."""
    row, *place = at
    plane = (field.data[name].to_numpy() for name in ("y", "x"))
    around = [_around(one, k, field.length) for one, k in zip(plane, place, strict=True)]
    if any(one is None for one in around):
        return None
    y, x = (np.asarray(one) for one in around)
    depth = field.data["depth"].to_numpy()[row : row + 1]
    return replace(field, data=_solved(response, depth, field.length, x=x, y=y))


def _between(at: Array, k: int) -> Array:
    """Coordinates between a point and its neighbours; it alone where there are none."""
    if len(at) == 1:
        return at
    fine: Array = at[k] + (at[1] - at[0]) / _FINER * np.arange(1 - _FINER, _FINER)
    return fine


def _solved(response: Response, depths: Array, length: float, *, x: Array, y: Array) -> xr.Dataset:
    assert response.road is not None
    data = solve_response(
        response.loads, response.road, depths=depths, x=x, y=y, speed=response.speed, side=response.side,
        mean_over=length,
    ).dataset  # fmt: skip
    if not response.restrained:
        return data
    own = np.asarray(response.dataset["depth"].to_numpy())
    stress = [response.restrained[int(np.argmin(np.abs(own - depth)))] for depth in data["depth"].to_numpy()]
    return with_horizontal_stress(data, np.array(stress))


def _around(at: Array, k: int, length: float) -> Array | None:
    """Coordinates up to the neighbours of one; it alone where there are none, None where they are too far."""
    if len(at) == 1:
        return at
    apart = float(np.abs(np.diff(at)[max(k - 1, 0) : k + 1]).max())
    if apart > length:
        return None
    steps = math.ceil(_STEPS * apart / length)
    around: Array = at[k] + apart / steps * np.arange(-steps, steps + 1)
    return around


def _asked(data: xr.Dataset, line: PowerLaw) -> tuple[Array, list[str]]:
    """Depths that a law applies to: the surface, or the top layer."""
    depths = data["depth"].to_numpy()
    if line.reads.where.at_surface:
        surface = same_depth(depths, 0.0)
        if not surface.any():
            raise InputError(f"{line} reads the {line.reads}; solve the response with depth 0")
        return depths[surface], []
    own = data["layer"].to_numpy() == 0
    if not own.any():
        raise InputError(
            "no depth of the response lies in the top layer, to which the law applies; give depth= to read "
            "another layer with its own law"
        )
    if own.all():
        return depths, []
    left = ", ".join(f"{1e3 * z:g}" for z in depths[~own])
    return depths[own], [
        f"the depths {left} mm lie below the top layer, to which the law applies, and are not read; give depth= "
        "for one of them and the law of its layer"
    ]


def _check_place(data: xr.Dataset, line: PowerLaw, depth: float) -> None:
    """Refuse a law at a depth that it does not apply to."""
    if line.reads.where.at_surface and not same_depth(depth, 0.0):
        raise InputError(f"{line} reads the {line.reads}, got depth {depth:g} m; give depth 0")
    if not line.reads.where.at_bottom or "layer" not in data.coords:
        return
    interfaces = np.atleast_1d(data.attrs.get("interfaces", []))
    side = data.attrs.get("side", "above")
    if side != "above" or not on_interface([depth], interfaces)[0]:
        known = ", ".join(f"{z:g}" for z in interfaces) or "no interface"
        raise InputError(
            f"{line} reads the {line.reads}, got depth {depth:g} m from {side}; the road has {known} m: give the "
            "depth of the asphalt's bottom, and solve it from above"
        )
