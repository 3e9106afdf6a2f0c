"""Values of a traffic that no road sees, and bonds beyond their tests: sentences for the warnings of a life."""

from __future__ import annotations

from collections.abc import Sequence

from treadload.contact.friction.laws import law_of
from treadload.damage.climate import Climate
from treadload.damage.criterion import Criterion
from treadload.damage.traffic import Traffic
from treadload.pavement import Pavement
from treadload.plausible import doubt, load_doubt
from treadload.study.seasons import Warm, beyond_data
from treadload.study.wheels import Wheels
from treadload.tire import Tire


def beyond_tables(road: Pavement, climate: Climate) -> tuple[str, ...]:
    """Sentences on mixes that the climate takes beyond their tables: how far, and in which share of the passes."""
    found: dict[tuple[str, float], tuple[float, float]] = {}
    for season in climate.seasons:
        worst: dict[tuple[str, float], float] = {}
        for name, value, limit in beyond_data(road, season):
            far = worst.get((name, limit), limit)
            worst[name, limit] = max(far, value) if value > limit else min(far, value)
        for key, value in worst.items():
            furthest, share = found.get(key, (key[1], 0.0))
            furthest = max(furthest, value) if value > key[1] else min(furthest, value)
            found[key] = furthest, share + season.share
    return tuple(
        f"{name} reaches {furthest:.0f} °C, beyond its table to {limit:g} °C, in {100 * share:.2g} % of the passes: "
        "ln E is extrapolated there, laws stay at the limit"
        for (name, limit), (furthest, share) in found.items()
    )


def bond_doubts(criteria: Sequence[Criterion], warm: Sequence[Warm], wheels: Sequence[Wheels]) -> tuple[str, ...]:
    """Sentences on bonds in seasons and under classes for which their strength was not tested."""
    said = {
        f"{one.name}: {text}": None
        for season in warm
        for k, one in enumerate(criteria)
        if one.quantity.between_layers
        for wheel in wheels
        for text in season.criteria[k]
        .passing(wheel.speed, season.criteria[k].depth(season.road), wheel.length)
        .quantity.doubt.split("; ")
        if text not in one.quantity.doubt
    }
    return tuple(said)


def traffic_doubts(tire: Tire, traffic: Traffic, climate: Climate) -> tuple[str, ...]:
    """Sentences on the classes of axles, how many there are, how that grows, and the temperatures."""
    said = doubt("number of passes per year", traffic.passes_per_year) if traffic.passes_per_year else ()
    said += doubt("annual growth", traffic.growth)
    for row in traffic.classes:
        _, width = (row.tire or tire).extent
        said += load_doubt(row.wheel_load, width, row.name)
        said += doubt("inflation pressure", row.inflation_pressure, row.name)
        said += doubt("friction", law_of(row.friction).largest, row.name)
        if row.speed is not None:
            said += doubt("speed", row.speed, row.name)
    for season in climate.seasons:
        for one in season.temperatures:
            said += doubt("temperature", one, season.name)
    return said
