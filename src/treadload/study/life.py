"""The life of a road under a traffic and a climate, from the tire to the governing criterion."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from treadload import variables
from treadload.contact.solve import DEFAULT_SPACING
from treadload.damage.climate import Climate
from treadload.damage.criterion import Criterion
from treadload.damage.interface import interface_in_words
from treadload.damage.miner import Life, miner
from treadload.damage.rutting import Rutting
from treadload.damage.traffic import Traffic
from treadload.damage.words import RUT
from treadload.errors import InputError
from treadload.pavement import Pavement, lift_below
from treadload.study.contacts import Contacts, Progress
from treadload.study.doubts import beyond_tables, traffic_doubts
from treadload.study.groups import group_factors, in_words
from treadload.study.layered_climate import climate_fields
from treadload.study.passages import Passages, solve_passages
from treadload.study.rutting import rut_fields
from treadload.study.seasons import frequencies
from treadload.study.surface_works import surface_works
from treadload.study.thermal import daily_cycles
from treadload.tire import Tire


def solve_life(
    tire: Tire,
    road: Pavement,
    traffic: Traffic,
    climate: Climate,
    criteria: Sequence[Criterion],
    *,
    spacing: float = DEFAULT_SPACING,
    tolerance: float = 5e-3,
    workers: int | None = None,
    progress: Progress | None = None,
    contacts: Contacts | None = None,
    rutting: Rutting | None = None,
) -> Life:
    """How many years a road lasts, by every criterion.

    Arguments as in `solve_passages`: what each law reads as every class of axle passes in every season; then
    Miner's sum after wander, see `miner`, and how the axles of a group interact, see `study.groups`. rutting: how a
    rut is counted, see `study.rutting`; left out, none is.
    stats of the result: contacts and responses solved, combinations that they serve, the largest relative error of
    readings interpolated over the climate, how far wheels were moved onto the common cells (m), seconds.
    Raises InputError, and ConvergenceError of a contact.
    """
    start = time.perf_counter()
    if rutting is not None and any(one.name == RUT for one in criteria):
        raise InputError(f"a criterion has the name {RUT!r}, which the life's rut has; give it another name")
    contacts = contacts or Contacts(tire, spacing)
    again: dict[str, Any] = {"workers": workers, "progress": progress, "contacts": contacts}
    passages = solve_passages(
        tire, road, traffic, climate, criteria,
        spacing=spacing, tolerance=tolerance, workers=workers, progress=progress, contacts=contacts,
    )  # fmt: skip
    weather = daily_cycles(road, climate, criteria, traffic)
    life = miner(
        passages.readings,
        criteria,
        traffic,
        climate,
        layer_temperatures=passages.layer_temperatures,
        cracks=(passages.crack_angle, passages.crack_dip),
        laws=passages.laws,
        weather=weather,
    )
    depths = ("criterion", _read_depths(life, passages), variables.attributes("read_depth"))
    life = replace(life, dataset=life.dataset.assign(read_depth=depths))
    factors, axles = group_factors(road, life, passages, workers)
    names = (tuple(row.name for row in traffic.classes), tuple(criterion.name for criterion in criteria))
    plain = _at_one_frequency(tire, road, traffic, climate, criteria, life, tolerance=tolerance, **again)
    sentences = [*climate.about, *(weather.about if weather else ()), *plain, *in_words(*names, factors, axles)]
    about = {
        "groups": json.dumps(sentences, ensure_ascii=False),
        "between": json.dumps(_interfaces(road, criteria), ensure_ascii=False),
    }
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "group_factor": (("criterion", "axle_class"), factors),
        "axles": (("axle_class",), axles),
    }
    fields |= surface_works(tire, road, traffic, climate, contacts)
    told = {name: (*field, variables.attributes(name)) for name, field in fields.items()}
    dataset = life.dataset.assign(told).assign_attrs(about)
    life = replace(life, dataset=dataset.merge(climate_fields(road, climate), combine_attrs="override"))
    rut: tuple[str, ...] = ()
    if rutting is not None:
        fields_of_rut, rut = rut_fields(road, traffic, climate, passages.wheels, rutting, tolerance=tolerance)
        life = replace(life, dataset=life.dataset.merge(fields_of_rut, combine_attrs="no_conflicts"))
    stats = {
        "contacts": passages.contacts,
        "responses": passages.responses + int((axles > 1).sum()),
        "combinations": passages.combinations,
        "interpolation_error": passages.interpolation_error,
        "wheels_moved": passages.moved,
        "seconds": time.perf_counter() - start,
    }
    said = (
        *_lifts(road, criteria), *traffic_doubts(tire, traffic, climate), *climate.warnings,
        *beyond_tables(road, climate), *(weather.warnings if weather else ()), *passages.warnings, *rut,
    )  # fmt: skip
    return replace(life, stats=stats, warnings=(*life.warnings, *said))


def _interfaces(road: Pavement, criteria: Sequence[Criterion]) -> dict[str, str]:
    """The interface, in words, of each criterion that reads one."""
    names = [layer.name or f"layer {number + 1}" for number, layer in enumerate(road.layers)]
    numbers = {one.name: one.number(road) for one in criteria if one.quantity.between_layers}
    return {
        name: interface_in_words(number, f"{names[number]} / {names[number + 1]}") for name, number in numbers.items()
    }


def _read_depths(life: Life, passages: Passages) -> list[float]:
    """Depth of the reading that does most at the worst place of each criterion, m."""
    y, shares = life.readings["y"].to_numpy(), life.dataset["damage_share"].to_numpy()
    found = []
    for k, place in enumerate(life.dataset["worst_y"].to_numpy()):
        column = int(np.abs(y - place).argmin())
        by = shares[k] if shares[k].max() > 0 else passages.readings.to_numpy()[k, ..., column].max(axis=-1)
        row, season = np.unravel_index(int(by.argmax()), by.shape)
        found.append(float(passages.read_depth[k, row, season, column]))
    return found


def _at_one_frequency(
    tire: Tire,
    road: Pavement,
    traffic: Traffic,
    climate: Climate,
    criteria: Sequence[Criterion],
    life: Life,
    **how: Any,
) -> list[str]:
    """Sentences on the loading frequencies of the classes, and on the life without them, which is solved for it."""
    ruled = [row for row in traffic.classes if row.frequency is not None]
    if not ruled:
        return []
    shares = life.dataset["damage_share"].to_numpy().sum(axis=(0, 1))
    season = climate.seasons[int(shares.argmax())]
    said = []
    for row in ruled:
        found, ratios = frequencies(road, season, row)
        if found:
            said.append(
                f"{row.name} reads moduli at {min(found):.3g} to {max(found):.3g} Hz over depth in {season.name}: "
                f"{min(ratios):.3g} to {max(ratios):.3g} times those of the road as given ({row.frequency})"
            )
    plain = replace(traffic, classes=tuple(replace(row, frequency=None) for row in traffic.classes))
    other = solve_life(tire, road, plain, climate, criteria, **how)
    for one in criteria:
        own, without = life.years(one.name), other.years(one.name)
        if math.isfinite(own) and math.isfinite(without):
            said.append(f"{one.name}: {own:.3g} years with these frequencies, {without:.3g} without them")
    return said


def _lifts(road: Pavement, criteria: Sequence[Criterion]) -> tuple[str, ...]:
    """Sentences on criteria that read the bottom of a lift which another of the same mix carries."""
    said = []
    for one in criteria:
        if one.place == "bottom" and lift_below(road, one.layer):
            number = one.number(road)
            said.append(
                f"{one.name}: it reads the bottom of layer {number + 1}, but a lift of the same mix lies below; the "
                f"base is read at its bottom, that of layer {_lowest_lift(road, number) + 1}"
            )
    return tuple(said)


def _lowest_lift(road: Pavement, number: int) -> int:
    while lift_below(road, number):
        number += 1
    return number
