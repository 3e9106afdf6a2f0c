"""What a climate makes of a road over depth: days of the months, temperatures and moduli of the parts of courses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from treadload import variables
from treadload.damage.climate import MONTHS, Climate, Season
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.life.seasons import in_season, warmed
from treadload.life.stiffer import names_of
from treadload.life.thermal import day_tension
from treadload.materials import AtStress, Elastic, StressDependent
from treadload.materials.kinds import AnyElastic, upright
from treadload.pavement import Pavement, divided
from treadload.pavement.sublayers import middle_temperatures


def climate_fields(road: Pavement, climate: Climate) -> xr.Dataset:
    """Fields of a life, see `Life`, with temperatures and moduli over depth; what a climate lacks is left out.

    day_temperature (month, hour, profile_depth), below a weather; with daily thermal stress day_tension (month,
    profile_depth). sublayer_temperature and sublayer_modulus (season,
    sublayer), where all seasons divide courses alike: of all parts above the last layer, without the frequencies of
    the classes; NaN for a material without one modulus. sublayer_modulus_young: with ageing, that of the young mix.
    Where seasons have factors on the moduli of layers season_modulus (season, factored_layer), of a stress-dependent
    layer at its nominal stress; below a weather with frost frost_depth and thaw_depth (day).
    """
    fields: dict[str, tuple[tuple[str, ...], Any]] = {}
    coordinates: dict[str, Any] = {}
    days = climate.days
    if days is not None:
        fields["day_temperature"] = (("month", "hour", "profile_depth"), days.temperatures)
        coordinates |= {
            "month": np.arange(1, len(MONTHS) + 1),
            "hour": days.hours,
            "profile_depth": days.depths,
        }
        if climate.thermal is not None:
            fields["day_tension"] = (("month", "profile_depth"), day_tension(road, climate))
    seasons = climate.seasons
    if all(season.profile is not None for season in seasons) and len({season.sublayers for season in seasons}) == 1:
        parts, owner = divided(road, thickest=seasons[0].sublayers)
        count = len(parts.interfaces)
        over = ("season", "sublayer")
        fields |= {
            "sublayer_top": (("sublayer",), np.concatenate([[0.0], parts.interfaces])[:count]),
            "sublayer_bottom": (("sublayer",), np.asarray(parts.interfaces, dtype=float)),
            "sublayer_layer": (("sublayer",), np.array(owner[:count])),
            "sublayer_temperature": (over, np.array([_degrees(parts, season)[:count] for season in seasons])),
            "sublayer_modulus": (over, np.array([_moduli(road, season, count) for season in seasons])),
        }
        if any(season.ageing is not None for season in seasons):
            young = [_moduli(road, _young(season), count) for season in seasons]
            fields["sublayer_modulus_young"] = (over, np.array(young))
        coordinates |= {"season": [season.name for season in seasons], "sublayer": np.arange(count)}
    factored = [name for name in names_of(road) if any(name in dict(season.factors) for season in seasons)]
    if factored:
        fields["season_modulus"] = (("season", "factored_layer"), _factored(road, seasons, factored))
        coordinates |= {"season": [season.name for season in seasons], "factored_layer": factored}
    if climate.frost is not None:
        fields |= {
            "frost_depth": (("day",), climate.frost.frost_depth),
            "thaw_depth": (("day",), climate.frost.thaw_depth),
        }
        coordinates["day"] = np.arange(1, len(climate.frost.months) + 1)
        coordinates["day_month"] = ("day", climate.frost.months)
    return variables.dataset(fields, coordinates)


def _factored(road: Pavement, seasons: Sequence[Season], names: Sequence[str]) -> Array:
    """Young's modulus of layers by their names in the seasons (season, layer), Pa; upright where it is anisotropic.

    NaN where a layer waits for a temperature that its season gives over depth.
    """
    table = np.full((len(seasons), len(names)), np.nan)
    for row, season in enumerate(seasons):
        moved = in_season(road, season)
        for column, name in enumerate(names):
            layer = moved.layers[names_of(road).index(name)]
            if layer.depends_on_temperature:
                continue
            material = layer.material.nominal if isinstance(layer.material, StressDependent) else layer.resolved
            if isinstance(material, AnyElastic):
                table[row, column] = upright(material)[0]
    return table


def _young(season: Season) -> Season:
    assert season.profile is not None
    return replace(season, temperature=season.profile, ageing=None)


def _degrees(parts: Pavement, season: Season) -> list[float]:
    assert season.profile is not None
    return middle_temperatures(parts, season.profile)


def _moduli(road: Pavement, season: Season, count: int) -> Array:
    """Young's modulus of the upper parts in a season, Pa."""
    materials = [layer.resolved for layer in warmed(road, (), season).road.layers[:count]]
    single = [isinstance(material, Elastic) and not isinstance(material, AtStress) for material in materials]
    pairs = zip(materials, single, strict=True)
    return np.array([material.modulus if has_modulus else np.nan for material, has_modulus in pairs])  # type: ignore[union-attr]
