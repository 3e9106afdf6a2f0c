"""Cracks that grow through a road: from a life to when the first crack is how deep, and how likely."""

from __future__ import annotations

import functools
import json
import time
from concurrent.futures import Executor
from dataclasses import dataclass, replace

import numpy as np

from treadload import variables
from treadload.damage.climate import MONTHS
from treadload.damage.growth.advance import RISKS, chances, drawn, grown, refined, risk_quantiles
from treadload.damage.growth.directions import side_by_side
from treadload.damage.growth.intensity import Way
from treadload.damage.growth.options import CrackGrowth
from treadload.damage.growth.solution import MODES, Growth
from treadload.damage.life import Life
from treadload.damage.words import DIRECTIONS
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.life.contacts import Progress
from treadload.life.crack import Crack
from treadload.life.crack_caveats import at_the_end, cautions
from treadload.life.crack_intensity import growth_rates, path_of, ranges_of_crossings
from treadload.life.crack_starts import damage_across, passes_of_the_year, passes_to_start, scatter_of_start
from treadload.life.crack_stress import CrackStress
from treadload.life.design import Design
from treadload.life.first_crack import opens_at_surface
from treadload.life.halving import as_solved
from treadload.life.passage import Passing, turns_of
from treadload.life.seasons import Warm, roads_of
from treadload.life.thermal_growth import DailyIntensity, daily_intensity
from treadload.life.threads import pool_of

# Places of a result across, m apart at least.
_APART = 0.008
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

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> law = tl.damage.ParisLaw(1e-7, 4.0)
    >>> growth = tl.life.grow_cracks(design, life, tl.damage.CrackGrowth("base", law=law, steps=3, points=20))
    >>> growth
    <Growth: a crack starts after 1.25 years and is through after 79.1 years.>
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
    crack, design = Crack.of(design.road, life, growth), as_solved(design, life)
    warm = roads_of(design.road, life.criteria, life.climate.seasons, life.traffic.classes)
    with pool_of(workers) as pool:
        stress = CrackStress.solve(crack, design, warm, pool, progress)
        way = path_of(crack, stress)
        ranges, jammed = ranges_of_crossings(crack, stress, way, pool)
        damage = _damage_across(crack, stress, direction, pool)
    rate, largest = growth_rates(crack, stress, way, ranges)
    advance = _Advance.of(crack, stress, way, rate, damage)
    states = stress.states(len(crack.lengths))
    stats = {
        "contacts": stress.contacts,
        "responses": len(stress.crossings),
        "lengths": len(crack.lengths),
        "states": states,
        "jammed": jammed,
        "seconds": time.perf_counter() - start,
    }
    caveats = cautions(_caveats(crack), jammed, states, way, warm.distinct[0].road)
    ends = crack.ends.top, crack.ends.bottom
    caveats += at_the_end(list(stress.crossings.values()), crack.laws, warm, growth, ends, upwards=crack.upwards)
    caveats += [_DAILY] if advance.daily is not None else []
    return Growth(_dataset(crack, stress, way, largest, advance), growth, stats, tuple(caveats))


def _damage_across(crack: Crack, stress: CrackStress, direction: str | None, pool: Executor) -> Array | None:
    """Damage by the strain across cracks of a direction, see `damage_across`; None where the criterion reads any."""
    if direction is None or not opens_at_surface(crack.criterion, crack.road):
        return None
    turns = turns_of(stress.wheels)
    passings = {
        (row, node): Passing(
            stress.wheels[row], stress.warm.by_class[row][node].reading([crack.number]), stress.y, turns, stress.reach
        )
        for row, node in stress.crossings
    }
    return damage_across(crack.life, crack.number, direction, passings, stress.warm, pool)


@dataclass(frozen=True, eq=False)
class _Advance:
    """When a crack starts and how it goes on at places across (ny,), m, with the wander of the traffic.

    rate: of its depth, m per passage of the whole traffic, at `Crack.lengths` (k, ny). initiation: passes to the
    start (ny,). passes: from there to `Crack.targets` (depths, ny). daily: stress intensity by the weather; None
    without. by_weather: its part of the growth, m per year (k,).
    """

    places: Array
    rate: Array
    initiation: Array
    passes: Array
    daily: DailyIntensity | None
    by_weather: Array

    @classmethod
    def of(cls, crack: Crack, stress: CrackStress, way: Way, rate: Array, damage: Array | None) -> _Advance:
        """From the growth at the wheels' own places (k, ny); damage: see `passes_to_start`."""
        life, lengths = crack.life, crack.lengths
        wide = life.traffic.wander.spread(rate, stress.spacing)
        daily = daily_intensity(crack.road, life.climate, stress.distances, way, lengths, crack.growth, crack.ends)
        margin = (wide.shape[-1] - rate.shape[-1]) // 2
        places = stress.y[0] + stress.spacing * (np.arange(wide.shape[-1]) - margin)
        initiation = passes_to_start(life, crack.number, places, damage)
        by_weather = np.zeros(len(lengths))
        if daily is not None:

            def cycle(warm_road: Warm, k: int, size: Array) -> Array:
                return crack.law_at(warm_road, float(lengths[k])).growth(size)

            _, slopes = way.at(lengths)
            by_weather = daily.yearly_growth(cycle) / np.hypot(1.0, slopes)
            # A year of the weather is shared between the passes of the year in which the crack starts.
            wide = wide + by_weather[:, None] / passes_of_the_year(life, initiation)
        passes = grown(*refined(lengths, wide), crack.targets)
        return cls(places, wide, initiation, passes, daily, by_weather)

    @property
    def total(self) -> Array:
        """Passes from the opening of the road to the depths (depths, ny)."""
        return self.initiation + self.passes

    def worst_and_earliest(self, crack: Crack) -> tuple[int, int]:
        """Numbers of the places where the way is done first, or else most of it, and where a crack starts first."""
        total = self.total
        reached = np.isfinite(total).any(axis=1)
        last = int(np.flatnonzero(reached)[-1]) if reached.any() else 0
        at_life = int(np.abs(self.places - float(crack.life.dataset["worst_y"][crack.number])).argmin())
        worst, earliest = (
            index_of_largest(-until)[0] if np.isfinite(until).any() else at_life
            for until in (total[last], self.initiation)
        )
        return worst, earliest


def _dataset(crack: Crack, stress: CrackStress, way: Way, largest: Array, advance: _Advance) -> xr.Dataset:
    """What `Growth` holds. largest: ranges of stress intensity, see `growth_rates`."""
    traffic, places, initiation, total = crack.life.traffic, advance.places, advance.initiation, advance.total
    worst, earliest = advance.worst_and_earliest(crack)
    # One place from the first crack to its full depth; and others, a few of them.
    every = max(1, round(_APART / stress.spacing))
    keep = np.unique(np.concatenate([np.arange(worst % every, len(places), every), total.argmin(axis=1)]))
    scatter, at_risk = scatter_of_start(crack.criterion, crack.growth)
    growth_scatter = max(law.scatter for law in crack.laws)
    # Laws that tell the passes of a small risk start half of the roads later.
    median = initiation * 10 ** (-scatter * at_risk)
    sampled = drawn(median[[worst]], advance.passes[:, [worst]], scatter, growth_scatter)
    offsets, _ = way.at(crack.targets)
    near = int(np.abs(stress.y - places[worst]).argmin())
    years = [[traffic.years_to(float(n)) for n in row] for row in (total[:, worst], *risk_quantiles(sampled))]
    fields = {
        "initiation_passes": (("y",), initiation[keep]),
        "growth_passes": (("crack_depth", "y"), total[:, keep]),
        "growth_rate": (("solved_depth", "y"), advance.rate[:, keep]),
        "reach_passes": (("crack_depth",), total[:, worst]),
        "reach_years": (("crack_depth",), years[0]),
        "risk_years": (("risk", "crack_depth"), years[1:]),
        "stress_intensity_range": (("axle_class", "solved_depth", "mode"), largest[..., near]),
        "crack_offset": (("crack_depth",), offsets),
        "worst_y": ((), places[worst]),
        "earliest_years": ((), traffic.years_to(float(initiation[earliest]))),
        "earliest_y": ((), places[earliest]),
    }
    more, coordinates = {}, dict[str, list[str]]()
    if traffic.years is not None:
        fields["reach_chance"] = (("crack_depth",), chances(sampled, traffic.passes(traffic.years)))
        more["design_years"] = traffic.years
    if advance.daily is not None:
        fields["thermal_growth_rate"] = (("solved_depth",), advance.by_weather)
        fields["thermal_intensity_range"] = (("month", "solved_depth"), advance.daily.ranges)
        coordinates["month"] = list(MONTHS)
    return variables.dataset(
        fields,
        {
            "crack_depth": crack.targets, "solved_depth": crack.lengths, "risk": list(RISKS), "mode": list(MODES),
            "axle_class": [row.name for row in traffic.classes], "y": places[keep], **coordinates,
        },
        grows=str(crack),
        starts=f"{crack.criterion.name}, a crack of {crack.length * 1e3:g} mm where its damage is 1",
        laws=json.dumps([str(law) for law in crack.laws], ensure_ascii=False),
        sources=json.dumps(list(dict.fromkeys(law.source for law in crack.laws)), ensure_ascii=False),
        caveats=json.dumps(_caveats(crack), ensure_ascii=False),
        initiation_scatter=scatter,
        growth_scatter=growth_scatter,
        trace=crack.trace,
        **more,
    )  # fmt: skip


def _caveats(crack: Crack) -> list[str]:
    return list(dict.fromkeys(law.caveat for law in crack.laws if law.caveat))
