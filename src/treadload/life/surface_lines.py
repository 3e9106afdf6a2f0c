"""A surface life by two fatigue lines: that of a young mix, and that of old cores."""

from __future__ import annotations

import json

import numpy as np

from treadload.damage.criterion import Criterion
from treadload.damage.laws.aged import AgedLine
from treadload.damage.laws.fatigue import FatigueLaw, FatigueLine
from treadload.damage.miner import damage_of
from treadload.damage.thermal import DAYS, DailyCycles, years_until
from treadload.kernels.arrays import Array
from treadload.life.design import Design
from treadload.materials import Mix
from treadload.materials.kinds import elastic_part
from treadload.pavement import Pavement

FRESH_SLOPE = -0.2
"""Slope of the fatigue line of a young bituminous mix."""


def surface_line_fields(
    design: Design, readings: Array, y: Array, weather: DailyCycles | None
) -> tuple[dict[str, Array], dict[str, str]]:
    """Years of every surface criterion by the young and by the aged line, and which lines these are, in JSON.

    life_years_fresh_line, life_years_aged_line (criterion): NaN of criteria that read no tensile strain at the
    surface, or whose ε₆ is not known. readings: (criterion, axle_class, season, turn, y), y: (y,), m, as of `miner`.
    The lines read the strains of the criterion's law, with the traffic's wander and the same daily thermal stress.
    """
    years = np.full((2, len(design.criteria)), np.nan)
    stated: dict[str, list[str]] = {}
    for k, criterion in enumerate(design.criteria):
        lines = surface_lines(design.road, criterion)
        for row, line in enumerate(lines):
            daily = None if weather is None else weather.readings[k]
            years[row, k] = years_until(design.traffic, *yearly_by(line, design, readings[k], y, daily))
        if lines:
            stated[criterion.name] = [str(line) for line in lines]
    if not stated:
        return {}, {}
    names = ("life_years_fresh_line", "life_years_aged_line")
    return dict(zip(names, years, strict=True)), {"surface_lines": json.dumps(stated, ensure_ascii=False)}


def surface_lines(road: Pavement, criterion: Criterion) -> tuple[FatigueLaw, ...]:
    """The young line, with the ε₆ of the criterion's law or its mix, and the line of old cores; none elsewhere."""
    quantity = criterion.quantity
    if not quantity.extends or quantity.shown != "microstrain" or criterion.place != "top" or criterion.depth(road):
        return ()
    law = criterion.law_at(15.0)
    material = elastic_part(road.layers[criterion.number(road)].material)
    epsilon_6 = getattr(law, "epsilon_6", None) or (material.epsilon_6 if isinstance(material, Mix) else None)
    if epsilon_6 is None:
        return ()
    return FatigueLine(epsilon_6, FRESH_SLOPE, quantity), AgedLine(epsilon_6, FRESH_SLOPE, 1.0, quantity)


def yearly_by(
    line: FatigueLaw, design: Design, readings: Array, y: Array, daily: Array | None
) -> tuple[float, float]:
    """Damage of the first year by a line: of the traffic at the worst place after wander, and of the days.

    readings: (axle_class, season, turn, y). daily: of the months, what the law reads; None for no such stress.
    """
    traffic, climate = design.traffic, design.climate
    laws = [[line] * len(climate.seasons)] * len(traffic.classes)
    damage = damage_of(readings[None], [laws], traffic, climate)[0].sum(axis=(0, 1))
    worst = float(traffic.wander.spread(damage, float(y[1] - y[0])).max())
    days = 0.0 if daily is None else float((np.array(DAYS) / np.asarray(line.allowable_passes(daily))).sum())
    return worst, days
