"""The rut of a life: permanent strain of every layer under all classes and seasons, year by year."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import scipy

from treadload import variables
from treadload.damage.climate import Climate, Season
from treadload.damage.indices import depth_factor
from treadload.damage.rutting import CAVEAT, COLDEST, SOIL, UNBOUND, WARMEST, Rutting
from treadload.damage.traffic import Traffic
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.life.climate import curves, first_nodes, warmth_of
from treadload.life.design import Design
from treadload.life.seasons import Warmed, roads_of
from treadload.life.wheels import Wheels
from treadload.materials import PassesPowerLaw, Unbound
from treadload.materials.kinds import elastic_part
from treadload.pavement import Pavement, TemperatureProfile, bituminous_thickness
from treadload.response import solve_response

# Parts of a course over depth, m, at whose middles it is read; depth of soil that counts, and its parts, which grow.
_PART, _DEEP, _BELOW = 0.03, 2.0, 8
# Points across, m apart, and so many under an axle, along.
_ACROSS, _ALONG = 0.02, 5
# Years of the curve where the traffic has no design life, and the longest that a limit is looked for.
_USUAL, _LONGEST = 20, 1000.0
# How often in a row what is interpolated must be right.
_RIGHT = 3


def rut_fields(design: Design, rutting: Rutting, wheels: Sequence[Wheels]) -> tuple[xr.Dataset, tuple[str, ...]]:
    """Rut of a life, m, over (rut_layer, year) where it is deepest, and sentences for the user.

    wheels: of each class. One response is solved for each class and each road that differs, or for as few of the
    climate's roads as give the compression of the others to a tolerance, relative; 0 solves all. Bituminous layers,
    unbound ones of the catalogue and the last layer rut; others are stiff and do not. Attributes: rut_names,
    rut_years, until the limit, inf if never, rut_limit. Raises InputError for a road without asphalt at its surface.
    """
    road, traffic, climate = design.road, design.traffic, design.climate
    whole = bituminous_thickness(road, 0)
    depths, thick, owner = _parts(road)
    asphalt = depths <= whole
    soft = np.array([_is_unbound(road, int(number)) for number in owner])
    y = _places(wheels)
    rate: Array = np.zeros((len(depths), len(y)))
    strain: Array = np.zeros((len(depths), len(y)))
    axles = np.array([len(wheel.x) for wheel in wheels])
    power = PassesPowerLaw.asphalt(COLDEST).exponent
    deep = depth_factor(depths, whole)
    warm = roads_of(road, (), climate.seasons, traffic.classes)
    compression = _over_the_climate(wheels, warm, climate, traffic, (depths, thick), y, design.tolerance)
    for k, row in enumerate(traffic.classes):
        for which, season in zip(warm.where, climate.seasons, strict=True):
            part = row.share * season.share * axles[k]
            warmth = np.clip(_temperatures(season, depths, owner), COLDEST, WARMEST)
            factor = np.array([PassesPowerLaw.asphalt(temperature).factor for temperature in warmth])
            rate += part * (compression[k, which] * (factor * deep)[:, None]) ** (1 / power)
            strain += part * compression[k, which]
    step = float(y[1] - y[0])
    rate, strain = (traffic.wander.spread(part_of_rut, step) for part_of_rut in (rate, strain))
    mean = float(np.sum(axles * [row.share for row in traffic.classes]))
    calibrated = np.where(owner == len(road.layers) - 1, SOIL, UNBOUND)

    def rut(years: float) -> Array:
        """Of every layer across, (layer, y), m."""
        passes = traffic.passes(years)
        each = np.where(asphalt[:, None], (rate * passes) ** power, 0.0)
        # The mean strain of an axle times the curve at the number of all of them.
        each = each + np.where(
            soft[:, None], (calibrated * rutting.soil_ratio(passes * mean))[:, None] * strain / mean, 0.0
        )
        each = rutting.calibration * each * thick[:, None]
        return np.array([each[owner == number].sum(axis=0) for number in range(len(road.layers))])

    end = math.ceil(traffic.years or _USUAL)
    years = np.arange(1, end + 1, dtype=float)
    worst = int(rut(float(end)).sum(axis=0).argmax())
    depth = np.array([rut(float(year))[:, worst] for year in years]).T
    names = [layer.name or f"layer {number}" for number, layer in enumerate(road.layers, start=1)]
    limit = rutting.limit
    attrs: dict[str, Any] = {"rut_names": json.dumps(names, ensure_ascii=False)}
    if limit is not None:
        attrs |= {"rut_limit": limit, "rut_years": _until(lambda n: float(rut(n)[:, worst].sum()) - limit)}
    places = {"rut_layer": np.arange(len(names)), "year": years}
    data = variables.dataset({"rut_depth": (("rut_layer", "year"), depth)}, places, **attrs)
    caveats = [f"rut: {CAVEAT}"]
    cold = [season.name for season in climate.seasons if _temperatures(season, depths, owner).min() < COLDEST]
    if cold:
        caveats.append(
            f"rut: asphalt below {COLDEST:g} °C counts as if at {COLDEST:g} °C, where its data end: {cold[0]}"
        )
    return data, tuple(caveats)


def _over_the_climate(
    wheels: Sequence[Wheels],
    warm: Warmed,
    climate: Climate,
    traffic: Traffic,
    parts: tuple[Array, Array],
    y: Array,
    tolerance: float,
) -> Array:
    """Largest vertical compression (class, road, depth, y) on all roads of a climate.

    parts: depths and thicknesses, m. Under the heaviest class the road that is furthest from those solved is solved
    next, until the others predicted it rightly three times in a row: the sum of what is wrong over depth within
    the tolerance of the largest sum of all. The other classes are solved on the same roads.
    """
    depths, thick = parts
    heaviest = int(np.argmax([row.wheel_load for row in traffic.classes]))
    roads = [[warm_road.road for warm_road in warm_roads] for warm_roads in warm.by_class]
    warmths = [warmth_of(climate.seasons, roads_of_class) for roads_of_class in roads]
    count = len(warm.distinct)

    def solved(row: int, number: int) -> Array:
        return _compression(wheels[row], roads[row][number], depths, y)

    warmth, kept, right = warmths[heaviest], list(range(count)), 0
    if warmth is not None and tolerance > 0 and count > 3 and all(warmth is not None for warmth in warmths):
        kept = first_nodes(warmth)
    pilot = {number: solved(heaviest, number) for number in kept}
    while len(pilot) < count and right < _RIGHT:
        assert warmth is not None
        places = warmth.reshape(count, -1)
        solved_roads = sorted(pilot, key=lambda k: tuple(places[k]))
        far = np.linalg.norm(places[:, None] - places[solved_roads], axis=-1).min(axis=1)
        number = int(far.argmax())
        estimate = _between(warmth, solved_roads, np.array([pilot[k] for k in solved_roads]))[number]
        pilot[number] = solved(heaviest, number)
        off = (thick[:, None] * np.abs(estimate - pilot[number])).sum(axis=0).max()
        right = right + 1 if off <= tolerance * (thick[:, None] * pilot[number]).sum(axis=0).max() else 0
    every = np.empty((len(wheels), count, len(depths), len(y)))
    for row, warmth in enumerate(warmths):
        by_number = pilot if row == heaviest else {number: solved(row, number) for number in pilot}
        if len(by_number) == count:
            every[row] = [by_number[number] for number in range(count)]
            continue
        assert warmth is not None
        solved_roads = sorted(by_number, key=lambda k: tuple(np.atleast_1d(warmth[k])))
        every[row] = _between(warmth, solved_roads, np.array([by_number[k] for k in solved_roads]))
    return every


def _between(warmth: Array, solved: list[int], values: Array) -> Array:
    """Compression on all roads (road, depth, y) from that on some, in the order of their warmth."""
    # Compression is a smooth function of it everywhere, as extension under a tread's edge is not.
    through = (
        scipy.interpolate.CubicSpline(warmth[solved], values)
        if warmth.ndim == 1
        else curves(warmth[solved], values, 0)
    )
    result: Array = np.maximum(through(warmth), 0.0)
    result[solved] = values
    return result


def _until(over: Callable[[float], float]) -> float:
    low, high = 1e-3, _LONGEST
    if over(low) >= 0:
        return low
    return float(scipy.optimize.brentq(over, low, high, rtol=1e-6)) if over(high) > 0 else math.inf


def _parts(road: Pavement) -> tuple[Array, Array, Array]:
    """Middles of the parts of all layers, their thicknesses, m, and the number of their layer."""
    middles, thick, owner = [], [], []
    top = 0.0
    for number, layer in enumerate(road.layers):
        if layer.thickness is None:
            edges = top + np.geomspace(0.05, _DEEP + 0.05, _BELOW + 1) - 0.05
        else:
            count = max(1, math.ceil(layer.thickness / _PART - 1e-9))
            edges = np.linspace(top, top + layer.thickness, count + 1)
            top += layer.thickness
        middles += (0.5 * (edges[1:] + edges[:-1])).tolist()
        thick += np.diff(edges).tolist()
        owner += [number] * (len(edges) - 1)
    return np.array(middles), np.array(thick), np.array(owner)


def _is_unbound(road: Pavement, number: int) -> bool:
    return number == len(road.layers) - 1 or isinstance(elastic_part(road.layers[number].material), Unbound)


def _places(wheels: Sequence[Wheels]) -> Array:
    """Points across, from beside the outermost wheel to the other side, m."""
    half = max(float(np.abs(load.grid.y).max()) for wheel in wheels for load in wheel.loads) + 0.2
    count = math.ceil(half / _ACROSS)
    return _ACROSS * np.arange(-count, count + 1)


def _compression(wheels: Wheels, road: Pavement, depths: Array, y: Array) -> Array:
    """Largest vertical compression under an axle, (depth, y), >= 0."""
    axle = wheels.x[len(wheels.x) // 2]
    x = np.linspace(axle[0], axle[-1], _ALONG)
    speed = wheels.speed if road.is_viscoelastic else None
    data = solve_response(wheels.joined, road, depths=depths, x=x, y=y, speed=speed).dataset
    compression: Array = np.maximum(-data["strain_zz"].transpose("depth", "y", "x").to_numpy(), 0.0).max(axis=-1)
    return compression


def _temperatures(season: Season, depths: Array, owner: Array) -> Array:
    """Temperature at the depths, °C. owner: the layer of each depth."""
    profile, temperature = season.profile, season.temperature
    if profile is not None:
        return np.array([profile.temperature_at(float(depth), extrapolate=True) for depth in depths])
    assert not isinstance(temperature, TemperatureProfile)
    return np.array([temperature[int(number)] if isinstance(temperature, tuple) else temperature for number in owner])
