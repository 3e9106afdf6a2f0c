"""When a crack starts at every place across the wheel path: by a criterion's damage, or by that of one direction."""

from __future__ import annotations

import math
from collections.abc import Mapping
from concurrent.futures import Executor

import numpy as np
import scipy

from treadload.damage.criterion import Criterion
from treadload.damage.growth.options import CrackGrowth
from treadload.damage.life import Life
from treadload.damage.miner import damage_of, wander_of
from treadload.damage.thermal import passes_until
from treadload.kernels.arrays import Array
from treadload.life.climate import warmth_of
from treadload.life.crossings import over_seasons
from treadload.life.first_crack import SolvedPassage, strain_across
from treadload.life.passage import Passing
from treadload.life.seasons import Warmed

# Standard deviation of log₁₀ of the passes to initiation where the law has none.
_SCATTER = 0.25


def passes_to_start(life: Life, number: int, places: Array, damage: Array | None = None) -> Array:
    """Passes until the damage at each place (ny,), m, is 1 by a criterion, by its number; inf for never.

    damage: of the traffic in the first year at the life's y (m,), see `damage_across`; left out, that of the
    criterion, whichever way its cracks run. The weather's days are added.
    """
    weather = life.weather_damage(number)
    if damage is None:
        damage = life.dataset["damage_per_year"].to_numpy()[number] - weather
    there = np.interp(places, life.dataset["y"].to_numpy(), damage, left=0.0, right=0.0)
    return passes_until(life.traffic, there, weather)


def passes_of_the_year(life: Life, initiation: Array) -> Array:
    """Passes of the traffic in the year that begins with each number of passes (ny,); inf where that never comes."""
    traffic = life.traffic
    starts = [traffic.years_to(float(passes)) for passes in initiation]
    return np.array(
        [traffic.passes(year + 1) - traffic.passes(year) if math.isfinite(year) else math.inf for year in starts]
    )


def damage_across(
    life: Life,
    number: int,
    direction: str,
    passings: Mapping[tuple[int, int], Passing],
    warm: Warmed,
    pool: Executor,
) -> Array:
    """Damage of the first year by the normal strain across cracks of a direction, after wander, at the life's y (m,).

    number: of a criterion that reads a tensile strain at the surface. direction: one of `DIRECTIONS`. passings: by
    class and road, by number, with that criterion alone: every class in the roads that are solved. warm: all roads.
    In the roads that are solved the strain across the crack is evaluated near and far, counted by rainflow and taken
    by the criterion's law; what part that is of the damage by the largest strain in any direction is between them a
    curve over warmth, and a part of the life's own damage of each class and season.
    """
    laws, seasons = life.class_laws[number], life.climate.seasons

    def part_across(key: tuple[int, int]) -> Array:
        row, node = key
        solved = SolvedPassage.of(passings[key])
        assert solved is not None
        law = laws[row][warm.where.index(node)]
        across, _, _ = solved.harm(strain_across(direction), law)
        whole, _, _ = solved.harm(solved.criterion.read_uncut, law)
        return np.divide(across, whole, out=np.zeros_like(across), where=whole > 0)

    parts = dict(zip(passings, pool.map(part_across, passings), strict=True))
    readings, at = life.readings.to_numpy()[[number]], life.readings["y"].to_numpy()
    damage = damage_of(readings, [laws], life.traffic, life.climate)[0]
    still = np.zeros(len(at))
    for row, by_season in enumerate(damage):
        nodes = [node for class_number, node in parts if class_number == row]
        warmth = warmth_of(seasons, [road.road for road in warm.by_class[row]])
        every = np.minimum(over_seasons(warmth, nodes, np.stack([parts[row, node] for node in nodes])), 1.0)
        for season, harm in enumerate(by_season):
            still += every[warm.where[season]] * harm
    wander, spacing = wander_of(laws[0][0], life.traffic), float(at[1] - at[0])
    spread = wander.spread(still, spacing)
    margin = (life.dataset.sizes["y"] - len(spread)) // 2
    return np.pad(spread, (margin, margin))


def scatter_of_start(criterion: Criterion, growth: CrackGrowth) -> tuple[float, float]:
    """Standard deviation of log₁₀ of the passes to initiation, and the normal deviate of the law's own risk."""
    law = criterion.law_at(15.0)
    law_scatter = getattr(law, "scatter", None)
    scatter = (
        growth.scatter if growth.scatter is not None else law_scatter if isinstance(law_scatter, float) else _SCATTER
    )
    risk = getattr(law, "risk", None)
    return float(scatter), float(scipy.special.ndtri(risk)) if isinstance(risk, float) else 0.0
