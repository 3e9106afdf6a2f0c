"""Cracks that grow through a road: from a life to when the first crack is how deep, and how likely."""

from __future__ import annotations

import functools
import json
import math
import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from treadload import variables
from treadload.damage.climate import MONTHS
from treadload.damage.criterion import Criterion
from treadload.damage.growth.advance import RISKS, chances, drawn, grown, refined, risk_quantiles
from treadload.damage.growth.directions import side_by_side
from treadload.damage.growth.intensity import (
    CLOSE,
    Crossing,
    Way,
    crack_paths,
    faces_along,
    intensity_ranges,
    modes,
    section_of,
    way_through,
)
from treadload.damage.growth.laws import GrowthLaw, ParisLaw, law_of_mix
from treadload.damage.growth.options import CrackGrowth
from treadload.damage.growth.solution import MODES, Growth
from treadload.damage.life import Life
from treadload.damage.words import DIRECTIONS
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.kernels.fracture.crack import CrackFaces
from treadload.kernels.fracture.dislocations import Section
from treadload.kernels.largest import index_of_largest
from treadload.life.climate import warmth_of
from treadload.life.contacts import Counter, Progress
from treadload.life.crack_caveats import at_the_end, cautions
from treadload.life.crack_starts import damage_across, passes_of_the_year, passes_to_start, scatter_of_start
from treadload.life.crossings import (
    CrackLines,
    between_rows,
    distances_to,
    nodes_of_climate,
    over_seasons,
    stresses,
)
from treadload.life.design import Design
from treadload.life.first_crack import opens_at_surface
from treadload.life.passage import Passing, turns_of
from treadload.life.seasons import Warm, Warmed, roads_of
from treadload.life.thermal_growth import Ends, daily_intensity
from treadload.life.threads import pool_of
from treadload.life.wheels import across, states_of, wheels_of
from treadload.materials.kinds import elastic_part, limit_of, upright
from treadload.pavement import Pavement
from treadload.response import MATERIAL_LENGTH
from treadload.response.basin import basin_reach

# Depths that a result tells between initiation and the end, m apart at least.
_STEP = 0.005
_DAILY = (
    "crack growth: daily thermal stress adds one cycle a day, the mean day of each month without a wheel; wheels "
    "that pass while the weather pulls are not read on top of it"
)


def grow_cracks(
    design: Design,
    life: Life,
    growth: CrackGrowth,
    *,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Growth:
    """How a crack that a criterion of a life has started grows through the road.

    life: of the design. growth: which crack, and how it grows. workers: threads; all cores if left out. progress:
    called after every solve.
    In every season every class passes once: the uncracked stress is read along a few lines down the road, the weight
    functions of the layers make stress intensities of it with faces that close and rub, rainflow makes cycles and the
    growth law a length per passage; these are summed over shares and spread over the tracks of the traffic.
    Raises InputError, and ConvergenceError of a contact and of faces that do not settle.
    """
    solve = functools.partial(_grow, design, life, workers=workers, progress=progress)
    if growth.trace != "both":
        return solve(growth)
    alone = {name: solve(replace(growth, trace=name), direction=name) for name in DIRECTIONS}  # type: ignore[arg-type]
    return side_by_side(alone, growth)


def _grow(
    design: Design,
    life: Life,
    growth: CrackGrowth,
    *,
    direction: str | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Growth:
    """The growth of a crack of one trace, see `grow_cracks`.

    direction: whose cracks start it, where the criterion reads a tensile strain at the surface; left out, any.
    """
    start = time.perf_counter()
    tire, road, contacts = design.tire, design.road, design.contacts
    criterion, number = _criterion(life, growth.criterion)
    layer = criterion.number(road)
    upwards = criterion.place == "bottom"
    if not upwards and layer != 0:
        raise InputError(
            f"the criterion {criterion.name!r} reads the top of layer {layer + 1}; a crack grows down from the top "
            "of the road, or up from the bottom of a layer"
        )
    if criterion.place == "interface":
        raise InputError(f"the criterion {criterion.name!r} reads a bond, which parts; take one of a layer")
    classes, seasons = life.traffic.classes, life.climate.seasons
    top, bottom = way_through(road, layer, growth.layers, upwards=upwards)
    thickness = bottom - top
    length = growth.initial_length or criterion.mean_over or MATERIAL_LENGTH
    if not length < CLOSE * thickness:
        raise InputError(
            f"the crack is {length * 1e3:g} mm long when it starts, and its way only {thickness * 1e3:g} mm; give a "
            "shorter initial_length, or more layers"
        )
    laws = _laws(road, growth, layer, upwards)
    warm = roads_of(road, life.criteria, seasons, classes)
    states = [state for row in classes for state in states_of(row, tire)]
    touched = len(contacts.missing(states))
    nodes = nodes_of_climate(warmth_of(seasons, [road.road for road in warm.distinct]), len(warm.distinct))
    count = Counter(touched + len(classes) * len(nodes), progress)
    solved = np.geomspace(length, CLOSE * thickness, growth.steps)
    trace = _trace(life, number, growth)
    with pool_of(workers) as pool:
        contacts.solve(states, warm.distinct[0].road, pool, count)
        by_class = [[contacts.solved[state] for state in states_of(row, tire)] for row in classes]
        reach = basin_reach(road.road for roads in warm.by_class for road in roads)
        y = across([contacts_of_class[0] for contacts_of_class in by_class], classes, reach)
        wheels = [
            wheels_of(contacts_of_class, row, y) for contacts_of_class, row in zip(by_class, classes, strict=True)
        ]
        mouth = bottom if upwards else top
        distances = distances_to(
            thickness, sorted(abs(mouth - place) for place in _inside(warm, top, bottom)), upwards=upwards
        )
        depths = mouth - distances[::-1] if upwards else distances

        def cross(row: int) -> list[Crossing]:
            lines = CrackLines.of(wheels[row], y, reach)
            roads, own_roads = [warm.by_class[row][node] for node in nodes], []
            for season, stress in zip(nodes, stresses(wheels[row], roads, depths, lines), strict=True):
                section, poisson = section_of(warm.by_class[row][season].road, top, bottom)
                stress_above = stress[:, ::-1] if upwards else stress
                axles = len(wheels[row].x)
                whole = Crossing(stress_above, distances, lines.y, lines.x, section, upwards, poisson, axles)
                own_roads.append(count.after(whole, "response"))
            return own_roads

        tasks = [(row, season) for row in range(len(classes)) for season in nodes]
        crossings = [crossing for several in pool.map(cross, range(len(classes))) for crossing in several]
        way = _way(crossings, tasks, life, warm, growth, solved, trace, number)

        # Classes share the roads of a season, unless they read moduli at frequencies of their own.
        @functools.cache
        def faces_at(section: Section, length: float) -> CrackFaces:
            return faces_along(section, way.until(length), length, upwards=upwards, points=growth.points)

        def ranges_of(crossing: Crossing) -> tuple[Array, int]:
            stack, jammed = [], 0
            for length in solved.tolist():
                faces = faces_at(crossing.section, length)
                history, stuck = modes(crossing, faces, trace, growth.friction)
                stack.append(intensity_ranges(history, crossing.poisson, crossing.axles))
                jammed += stuck
            return np.stack(stack), jammed

        read = list(pool.map(ranges_of, crossings))
        damage = None
        if direction is not None and opens_at_surface(criterion, road):
            turns = turns_of(wheels)
            passings = {
                (row, node): Passing(wheels[row], warm.by_class[row][node].reading([number]), y, turns, reach)
                for row, node in tasks
            }
            damage = damage_across(life, number, direction, passings, warm, pool)
    ranges_by_task = {task: ranges for task, (ranges, _) in zip(tasks, read, strict=True)}
    jammed = sum(stuck for _, stuck in read)
    rows = {task: crossing.y for task, crossing in zip(tasks, crossings, strict=True)}
    spacing = float(y[1] - y[0])
    _, slopes = way.at(solved)
    rate = np.zeros((len(solved), len(y)))
    largest = np.zeros((len(classes), len(solved), len(MODES), len(y)))
    for row in range(len(classes)):
        ranges_at = np.stack([between_rows(rows[row, node], y, ranges_by_task[row, node]) for node in nodes])
        largest[row] = ranges_at.max(axis=(0, -1)).transpose(0, 2, 1)
        roads = warm.by_class[row]
        every_road = over_seasons(warmth_of(seasons, [road.road for road in roads]), nodes, ranges_at)
        for season, number_of in zip(seasons, warm.where, strict=True):
            here, share = every_road[number_of], classes[row].share * season.share
            for k in range(len(solved)):
                law = _law_at(laws, road, roads[number_of], layer, float(solved[k]), upwards)
                # Along a path that leans a crack must grow by more than its depth does.
                rate[k] += share * law.growth(here[k, :, 3]).sum(axis=-1) / math.hypot(1.0, float(slopes[k]))
    wide = life.traffic.wander.spread(rate, spacing)
    daily = daily_intensity(road, life.climate, distances, way, solved, growth, Ends(top, bottom, upwards=upwards))
    margin = (wide.shape[-1] - rate.shape[-1]) // 2
    places = y[0] + spacing * (np.arange(wide.shape[-1]) - margin)
    initiation = passes_to_start(life, number, places, damage)
    targets = _targets(length, thickness)
    by_weather = np.zeros(len(solved))
    if daily is not None:

        def cycle(warm_road: Warm, k: int, size: Array) -> Array:
            return _law_at(laws, road, warm_road, layer, float(solved[k]), upwards).growth(size)

        by_weather = daily.yearly_growth(cycle) / np.hypot(1.0, slopes)
        # A year of the weather is shared between the passes of the year in which the crack starts.
        wide = wide + by_weather[:, None] / passes_of_the_year(life, initiation)
    passes = grown(*refined(solved, wide), targets)
    scatter, at_risk = scatter_of_start(criterion, growth)
    growth_scatter = max(law.scatter for law in laws)
    every = max(1, round(0.008 / spacing))
    # One place from the first crack to its full depth: where the way is done first; and others, a few of them.
    total = initiation + passes
    reached = np.isfinite(total).any(axis=1)
    last = int(np.flatnonzero(reached)[-1]) if reached.any() else 0
    at_life = int(np.abs(places - float(life.dataset["worst_y"][number])).argmin())
    worst, earliest = (
        index_of_largest(-until)[0] if np.isfinite(until).any() else at_life for until in (total[last], initiation)
    )
    keep = np.unique(np.concatenate([np.arange(worst % every, len(places), every), total.argmin(axis=1)]))
    # Laws that tell the passes of a small risk start half of the roads later.
    median = initiation * 10 ** (-scatter * at_risk)
    sampled = drawn(median[[worst]], passes[:, [worst]], scatter, growth_scatter)
    quantiles = risk_quantiles(sampled)
    offsets, _ = way.at(targets)
    fields = {
        "initiation_passes": (("y",), initiation[keep]),
        "growth_passes": (("crack_depth", "y"), total[:, keep]),
        "growth_rate": (("solved_depth", "y"), wide[:, keep]),
        "reach_passes": (("crack_depth",), total[:, worst]),
        "reach_years": (("crack_depth",), [life.traffic.years_to(float(n)) for n in total[:, worst]]),
        "risk_years": (("risk", "crack_depth"), [[life.traffic.years_to(float(n)) for n in q] for q in quantiles]),
        "stress_intensity_range": (
            ("axle_class", "solved_depth", "mode"),
            largest[..., int(np.abs(y - places[worst]).argmin())],
        ),
        "crack_offset": (("crack_depth",), offsets),
        "worst_y": ((), places[worst]),
        "earliest_years": ((), life.traffic.years_to(float(initiation[earliest]))),
        "earliest_y": ((), places[earliest]),
    }
    more = {}
    if life.traffic.years is not None:
        until = life.traffic.passes(life.traffic.years)
        fields["reach_chance"] = (("crack_depth",), chances(sampled, until))
        more["design_years"] = life.traffic.years
    coordinates: dict[str, list[str]] = {}
    if daily is not None:
        fields["thermal_growth_rate"] = (("solved_depth",), by_weather)
        fields["thermal_intensity_range"] = (("month", "solved_depth"), daily.ranges)
        coordinates["month"] = list(MONTHS)
    doubts = list(dict.fromkeys(law.doubt for law in laws if law.doubt))
    dataset = variables.dataset(
        fields,
        {
            "crack_depth": targets, "solved_depth": solved, "risk": list(RISKS), "mode": list(MODES),
            "axle_class": [row.name for row in classes], "y": places[keep], **coordinates,
        },
        grows=_in_words(road, growth, layer, trace, upwards),
        starts=f"{criterion.name}, a crack of {length * 1e3:g} mm where its damage is 1",
        laws=json.dumps([str(law) for law in laws], ensure_ascii=False),
        sources=json.dumps(list(dict.fromkeys(law.source for law in laws)), ensure_ascii=False),
        doubts=json.dumps(doubts, ensure_ascii=False),
        initiation_scatter=scatter,
        growth_scatter=growth_scatter,
        trace=trace,
        **more,
    )  # fmt: skip
    states_solved = len(solved) * sum(int(crossing.stress[0, 0].size) for crossing in crossings)
    stats = {
        "contacts": touched,
        "responses": len(tasks),
        "lengths": len(solved),
        "states": states_solved,
        "jammed": jammed,
        "seconds": time.perf_counter() - start,
    }
    caveats = cautions(doubts, jammed, states_solved, way, warm.distinct[0].road)
    caveats += at_the_end(crossings, laws, warm, growth, (top, bottom), upwards=upwards)
    caveats += [_DAILY] if daily is not None else []
    return Growth(dataset, growth, stats, tuple(caveats))


def _inside(warm: Warmed, top: float, bottom: float) -> list[float]:
    """Depths of the interfaces between two depths, m, in any season: of layers, and of a course's parts."""
    places = {round(float(z), 6) for road in warm.distinct for z in road.road.interfaces}
    return sorted(z for z in places if top + 1e-4 < z < bottom - 1e-4)


def _criterion(life: Life, name: str) -> tuple[Criterion, int]:
    names = [criterion.name for criterion in life.criteria]
    if name not in names:
        raise InputError(f"no criterion {name!r} starts a crack; {nearest(name, names)}")
    return life.criteria[names.index(name)], names.index(name)


def _laws(road: Pavement, growth: CrackGrowth, layer: int, upwards: bool) -> list[GrowthLaw]:
    """One for each layer on the way, from where the crack starts."""
    if growth.law is not None:
        return [growth.law] * growth.layers
    way = [layer - k if upwards else layer + k for k in range(growth.layers)]
    return [law_of_mix(elastic_part(road.layers[k].material), road.layers[k].name or f"{k + 1}") for k in way]


def _law_at(
    laws: Sequence[GrowthLaw], road: Pavement, warm: Warm, layer: int, distance: float, upwards: bool
) -> ParisLaw:
    """The law where the tip is, a distance from the mouth, m."""
    ends = np.cumsum([road.layers[layer - k if upwards else layer + k].thickness for k in range(len(laws))])
    law = laws[min(int(np.searchsorted(ends, distance)), len(laws) - 1)]
    depth = float(road.interfaces[layer]) - distance if upwards else distance
    material = warm.road.layers[warm.road.layer_at(max(depth, 0.0))].resolved
    return law.at(upright(limit_of(material, "glassy"))[0])


def _trace(life: Life, number: int, growth: CrackGrowth) -> float:
    """Angle of the crack's trace from travel towards the right, rad."""
    if isinstance(growth.trace, str):
        return {"longitudinal": 0.0, "transverse": 0.5 * math.pi}[growth.trace]
    if growth.trace is not None:
        return growth.trace
    first = life.dataset.get("first_crack_angle")
    angle = math.nan if first is None else float(first[number])
    if math.isnan(angle):
        raise InputError(
            f"the criterion {growth.criterion!r} does not tell which way its crack runs; give the trace, "
            '"longitudinal" or "transverse"'
        )
    return angle


def _way(
    crossings: Sequence[Crossing],
    tasks: Sequence[tuple[int, int]],
    life: Life,
    warm: Warmed,
    growth: CrackGrowth,
    solved: Array,
    trace: float,
    number: int,
) -> Way:
    """The path of the crack: straight, or kinked as it is at the place where the criterion's damage is largest."""
    if growth.path != "kinked":
        slope = 0.0 if isinstance(growth.path, str) else math.tan(growth.path)
        return Way(np.array([0.0, solved[-1]]), np.array([0.0, slope * solved[-1]]))
    worst = float(life.dataset["worst_y"][number])
    shares = life.dataset["damage_share"].to_numpy()[number]
    row, season = np.unravel_index(int(shares.argmax()), shares.shape)
    number_here, solved_roads = (
        warm.where[int(season)],
        [number_there for row_there, number_there in tasks if row_there == row],
    )
    if number_here not in solved_roads:
        warmth = warmth_of(life.climate.seasons, [road.road for road in warm.distinct])
        assert warmth is not None
        places = warmth.reshape(len(warmth), -1)
        number_here = min(
            solved_roads, key=lambda number_there: float(np.linalg.norm(places[number_there] - places[number_here]))
        )
    chosen = crossings[tasks.index((int(row), number_here))]
    place = int(np.abs(chosen.y - worst).argmin())
    return crack_paths([chosen], np.ones(1), place, solved, trace, growth.friction)


def _targets(length: float, thickness: float) -> Array:
    """Depths that are told: of initiation, every so many mm, the end."""
    step = _STEP * max(1, math.ceil((thickness - length) / _STEP / 12))
    between = step * np.arange(math.floor(length / step) + 1, math.ceil(thickness / step - 1e-9))
    inside = between[(between > length + 1e-4) & (between < thickness - 1e-4)]
    return np.round(np.concatenate([[length], inside, [thickness]]), 9)


def _in_words(road: Pavement, growth: CrackGrowth, layer: int, trace: float, upwards: bool) -> str:
    end = layer - growth.layers + 1 if upwards else layer + growth.layers - 1
    names = [road.layers[k].name or f"layer {k + 1}" for k in (layer, end)]
    through = names[0] if layer == end else f"{names[0]} to {names[1]}"
    path = growth.path if isinstance(growth.path, str) else f"leaning by {math.degrees(growth.path):g} degrees"
    way = "up" if upwards else "down"
    return f"{way} through {through}, {path}, trace {math.degrees(trace):z.0f} degrees from travel"
