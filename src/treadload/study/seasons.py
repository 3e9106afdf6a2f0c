"""The road and the criteria at the temperatures of a season."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.damage.climate import Season
from treadload.damage.criterion import Criterion
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement


@dataclass(frozen=True)
class Warm:
    """The road and the criteria at the temperatures of a season."""

    road: Pavement
    criteria: tuple[Criterion, ...]

    def reading(self, numbers: Sequence[int]) -> Warm:
        """With those of the criteria."""
        return Warm(self.road, tuple(self.criteria[k] for k in numbers))


def warmed(road: Pavement, criteria: Sequence[Criterion], season: Season) -> Warm:
    """The road and the criteria in a season. Raises InputError for temperatures that do not fit the road."""
    temperature = season.temperature
    if isinstance(temperature, tuple) and len(temperature) != len(road.layers):
        raise InputError(
            f"season {season.name!r} has {len(temperature)} temperatures, the road {len(road.layers)} layers"
        )
    warm = road.at_temperature(temperature)
    return Warm(warm, tuple(criterion.at(_at_layer(criterion.number(road), season)) for criterion in criteria))


def layer_temperatures(road: Pavement, criteria: Sequence[Criterion], seasons: Sequence[Season]) -> Array:
    """Temperature (criterion, season) of the layer that each criterion reads, °C."""
    return np.array([[_at_layer(c.number(road), season) for season in seasons] for c in criteria])


def _at_layer(layer: int, season: Season) -> float:
    return season.temperature[layer] if isinstance(season.temperature, tuple) else season.temperature
