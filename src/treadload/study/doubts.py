"""Values of a traffic that no road sees: sentences for the warnings of a life."""

from __future__ import annotations

from treadload.contact.friction.laws import law_of
from treadload.damage.climate import Climate
from treadload.damage.traffic import Traffic
from treadload.plausible import doubt, load_doubt
from treadload.tire import Tire


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
        warm = season.temperature
        for one in warm if isinstance(warm, tuple) else (warm,):
            said += doubt("temperature", one, season.name)
    return said
