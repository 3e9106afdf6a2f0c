"""The life of a road under a traffic and a climate, from the tire to the governing criterion."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from treadload import variables
from treadload.damage.criterion import Criterion
from treadload.damage.interface import interface_in_words
from treadload.damage.life import Life
from treadload.damage.miner import miner
from treadload.damage.thermal import DailyCycles
from treadload.damage.words import CAUSES, DIRECTIONS
from treadload.life.caveats import beyond_tables, cell_caveats, surface_caveats, traffic_caveats
from treadload.life.contacts import Progress
from treadload.life.design import Design
from treadload.life.first_crack import first_cracks
from treadload.life.groups import group_factors, in_words
from treadload.life.halving import needs_halved_cells, on_halved_cells
from treadload.life.layered_climate import climate_fields
from treadload.life.passages import Passages, solve_passages
from treadload.life.rutting import rut_fields
from treadload.life.seasons import frequencies
from treadload.life.surface_lines import surface_line_fields
from treadload.life.surface_works import surface_works
from treadload.life.thermal import daily_cycles
from treadload.life.wheels import Wheels
from treadload.pavement import Pavement, lift_below


def solve_life(design: Design, *, workers: int | None = None, progress: Progress | None = None) -> Life:
    """The service life of a road by every criterion.

    Evaluates each law for every class of axles in every season, see `solve_passages`; then Miner's sum after
    wander, see `miner`, and how the axles of a group interact, see `life.groups`; the rut, see `life.rutting`.
    workers: threads; all cores if left out. progress: called after every solve.
    stats of the result: contacts and responses solved, combinations that they serve, the largest relative error of
    readings interpolated over the climate, how far wheels were moved onto the common cells (m), seconds.
    Raises InputError, and ConvergenceError of a contact.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> f"{life.years('base'):.1f} years until the bottom of the asphalt cracks"
    '1.2 years until the bottom of the asphalt cracks'
    """
    start = time.perf_counter()
    tire, road, traffic, climate = design.tire, design.road, design.traffic, design.climate
    criteria = tuple(design.criteria)
    summed = solve_sum(design, workers=workers, progress=progress)
    design = summed.design
    life, passages, weather = summed.life, summed.passages, summed.weather
    depths = ("criterion", _read_depths(life, passages), variables.attributes("read_depth"))
    life = replace(life, dataset=life.dataset.assign(read_depth=depths))
    factors, axles = group_factors(road, life, passages, workers)
    names = (tuple(row.name for row in traffic.classes), tuple(criterion.name for criterion in criteria))
    plain = _at_one_frequency(design, life, workers, progress)
    sentences = [*climate.about, *(weather.about if weather else ()), *plain, *in_words(*names, factors, axles)]
    about = {
        "groups": json.dumps(sentences, ensure_ascii=False),
        "between": json.dumps(_interfaces(road, criteria), ensure_ascii=False),
    }
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "group_factor": (("criterion", "axle_class"), factors),
        "axles": (("axle_class",), axles),
    }
    fields |= surface_works(design)
    fields |= first_cracks(design, life, passages, workers)
    kept = passages.readings
    by_lines, lines = surface_line_fields(design, kept.to_numpy(), kept["y"].to_numpy(), weather)
    fields |= {name: (("criterion",), by_line) for name, by_line in by_lines.items()}
    variables_added = {name: (*field, variables.attributes(name)) for name, field in fields.items()}
    ways = {"direction": list(DIRECTIONS), "cause": list(CAUSES)}
    dataset = life.dataset.assign(variables_added).assign_coords(ways).assign_attrs(about | lines)
    life = replace(life, dataset=dataset.merge(climate_fields(road, climate), combine_attrs="override"))
    life, rut = with_rut(life, design, passages.wheels)
    stats = {
        "contacts": passages.contacts,
        "responses": passages.responses + int((axles > 1).sum()),
        "combinations": passages.combinations,
        "interpolation_error": passages.interpolation_error,
        "wheels_moved": passages.moved,
        "halved_cells": design.contacts.halved,
        "seconds": time.perf_counter() - start,
    }
    caveats = (
        *_lifts(road, criteria), *traffic_caveats(tire, traffic, climate), *climate.warnings,
        *beyond_tables(road, climate), *(weather.warnings if weather else ()), *passages.warnings, *rut,
        *surface_caveats(road, criteria, tire, traffic), *cell_caveats(design),
    )  # fmt: skip
    return replace(life, stats=stats, warnings=(*life.warnings, *caveats))


@dataclass(frozen=True, eq=False)
class Summed:
    """Miner's sum of a design, the passages behind it, and the cycles of its weather, if it has any.

    design: with the contacts that were read, see `life.halving`.
    """

    design: Design
    life: Life
    passages: Passages
    weather: DailyCycles | None


def solve_sum(design: Design, *, workers: int | None = None, progress: Progress | None = None) -> Summed:
    """The passages of a design and Miner's sum of them: the years by every criterion, and no more.

    workers, progress: as in `solve_life`. Raises InputError, and ConvergenceError of a contact.
    """
    criteria = tuple(design.criteria)
    weather = daily_cycles(design.road, design.climate, criteria, design.traffic)

    def summed(design: Design, earlier: Passages | None = None) -> Summed:
        passages = solve_passages(design, workers=workers, progress=progress, earlier=earlier)
        life = miner(
            passages.readings,
            criteria,
            design.traffic,
            design.climate,
            layer_temperatures=passages.layer_temperatures,
            cracks=(passages.crack_angle, passages.crack_dip),
            laws=passages.laws,
            weather=weather,
        )
        return Summed(design, life, passages, weather)

    first = summed(design)
    return summed(on_halved_cells(design), first.passages) if needs_halved_cells(design, first.life) else first


def with_rut(life: Life, design: Design, wheels: Sequence[Wheels]) -> tuple[Life, tuple[str, ...]]:
    """The life with the rut of its design, and sentences on it; as it is where no rut is counted.

    wheels: of every class, see `Passages`.
    """
    if design.rutting is None:
        return life, ()
    fields, caveats = rut_fields(design, design.rutting, wheels)
    return replace(life, dataset=life.dataset.merge(fields, combine_attrs="no_conflicts")), caveats


def _interfaces(road: Pavement, criteria: Sequence[Criterion]) -> dict[str, str]:
    """The interface, in words, of each criterion that reads one."""
    names = [layer.name or f"layer {number + 1}" for number, layer in enumerate(road.layers)]
    numbers = {criterion.name: criterion.number(road) for criterion in criteria if criterion.quantity.between_layers}
    return {
        name: interface_in_words(number, f"{names[number]} / {names[number + 1]}") for name, number in numbers.items()
    }


def _read_depths(life: Life, passages: Passages) -> list[float]:
    """Depth of the reading that does most at the worst place of each criterion, m."""
    y, shares = life.readings["y"].to_numpy(), life.dataset["damage_share"].to_numpy()
    depths = []
    for k, place in enumerate(life.dataset["worst_y"].to_numpy()):
        column = int(np.abs(y - place).argmin())
        by = shares[k] if shares[k].max() > 0 else passages.readings.to_numpy()[k, ..., column].max(axis=-1)
        row, season = np.unravel_index(int(by.argmax()), by.shape)
        depths.append(float(passages.read_depth[k, row, season, column]))
    return depths


def _at_one_frequency(design: Design, life: Life, workers: int | None, progress: Progress | None) -> list[str]:
    """Sentences on the loading frequencies of the classes, and on the life without them, which is solved for it."""
    traffic, climate = design.traffic, design.climate
    ruled = [row for row in traffic.classes if row.frequency is not None]
    if not ruled:
        return []
    shares = life.dataset["damage_share"].to_numpy().sum(axis=(0, 1))
    season = climate.seasons[int(shares.argmax())]
    caveats = []
    for row in ruled:
        hertz, ratios = frequencies(design.road, season, row)
        if hertz:
            caveats.append(
                f"{row.name} reads moduli at {min(hertz):.3g} to {max(hertz):.3g} Hz over depth in {season.name}: "
                f"{min(ratios):.3g} to {max(ratios):.3g} times those of the road as given ({row.frequency})"
            )
    plain = replace(traffic, classes=tuple(replace(row, frequency=None) for row in traffic.classes))
    plain_life = solve_sum(replace(design, traffic=plain, rutting=None), workers=workers, progress=progress).life
    for criterion in design.criteria:
        years, without = life.years(criterion.name), plain_life.years(criterion.name)
        if math.isfinite(years) and math.isfinite(without):
            caveats.append(f"{criterion.name}: {years:.3g} years with these frequencies, {without:.3g} without them")
    return caveats


def _lifts(road: Pavement, criteria: Sequence[Criterion]) -> tuple[str, ...]:
    """Sentences on criteria that read the bottom of a lift which another of the same mix carries."""
    caveats = []
    for criterion in criteria:
        if criterion.place == "bottom" and lift_below(road, criterion.layer):
            number = criterion.number(road)
            caveats.append(
                f"{criterion.name}: it reads the bottom of layer {number + 1}, but a lift of the same mix lies "
                f"below; the base is read at its bottom, that of layer {_lowest_lift(road, number) + 1}"
            )
    return tuple(caveats)


def _lowest_lift(road: Pavement, number: int) -> int:
    while lift_below(road, number):
        number += 1
    return number
