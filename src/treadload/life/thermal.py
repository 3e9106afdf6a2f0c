"""Daily thermal stress of a restrained road: a cycle a day for every criterion that reads a mix."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from treadload.damage.climate import MONTHS, Climate, Season
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.quantity import STRAIN, STRESS
from treadload.damage.thermal import DAYS, DailyCycles, includes_weather
from treadload.damage.traffic import Traffic
from treadload.kernels.arrays import Array
from treadload.kernels.thermal import periodic_stress, reduced_steps
from treadload.life.seasons import layer_temperatures, warmed
from treadload.materials import HydraulicMix, Mix, Thermorheological
from treadload.materials.kinds import AnyElastic, elastic_part, upright
from treadload.materials.series import as_prony
from treadload.pavement import Pavement, TemperatureProfile
from treadload.pavement.asphalt import is_bituminous

# Error of the series of a mix, and how far its range goes beyond the reduced times of the day.
_SERIES, _BEYOND = 1e-2, 10.0
# Frequency at which a viscoelastic mix is read for its fatigue, Hz.
_READ = 10.0
# A model this far from its table is worth a sentence.
_CAVEATFUL = 0.1
_WHY = (
    "daily thermal stress: the mean day of each month in its steady state, restrained in the plane, one cycle a day; "
    "the law reads the strain that a wheel would make for the same stress at the modulus of the worst hour; nothing "
    "heals, and tension of the traffic and of the weather at one time are not added"
)


def daily_cycles(
    road: Pavement, climate: Climate, criteria: Sequence[Criterion], traffic: Traffic
) -> DailyCycles | None:
    """Cycles of the mean days of a climate, for each criterion; None where the climate does not ask for them.

    road: whose materials wait for their temperature. traffic: its design life, for the utilisation. The mix is held
    in both horizontal directions: σ = -α/(1 - ν) ∫ E(ξ - ξ') dT through its relaxation, in the steady state of equal
    days, with the temperatures at the middle of what the criterion reads. Criteria of unbound and cement-bound
    layers and of bonds, and those whose law was fitted to roads, have none; nor have those of a mix that does not
    state how it relaxes, of which a warning speaks.
    """
    thermal, days = climate.thermal, climate.days
    if thermal is None or days is None:
        return None
    shape = (len(criteria), len(MONTHS))
    stress = np.full(shape, np.nan)
    readings, damage = np.zeros(shape), np.zeros(shape)
    used = np.zeros(len(criteria))
    years = traffic.years
    reasons: list[str] = [_WHY]
    caveats: list[str] = []
    for k, criterion in enumerate(criteria):
        why = _left_out(criterion, road)
        if why:
            reasons.append(f"{criterion.name}: daily thermal stress is left out: {why}")
            continue
        material = road.layers[criterion.number(road)].material
        unknown = thermal.unknown(material)
        if unknown:
            caveats.append(f"{criterion.name}: daily thermal stress is left out: {unknown}")
            continue
        relaxing, expansion, misfit = thermal.of(material)
        if misfit > _CAVEATFUL:
            caveats.append(
                f"{criterion.name}: the model by which its mix relaxes misses the table by "
                f"{100 * misfit:.0f} % (rms); give relaxation, a viscoelastic material with a shift"
            )
        warmth = _at_depth(days.depths, days.temperatures, _depth(criterion, road))
        tension = daily_stress(relaxing, expansion, days.hours, warmth.T).T
        for month, share in enumerate(DAYS):
            hour = int(tension[month].argmax())
            season = instant(climate, days.depths, days.temperatures[month, hour], MONTHS[month])
            reading, law = _reading(criterion, road, season, float(tension[month, hour]))
            stress[k, month], readings[k, month] = tension[month, hour], reading
            damage[k, month] = share / float(law.allowable_passes(reading))
            cycles = sum(DAYS) * (1.0 if years is None else years)
            used[k] = max(used[k], reading / float(law.allowable_strain(cycles)))
    return DailyCycles(stress, readings, damage, used, tuple(reasons), tuple(dict.fromkeys(caveats)))


def day_tension(road: Pavement, climate: Climate) -> Array:
    """Largest tension of the mean day of each month (month, depth), Pa, at the depths of the climate's days.

    NaN in what is no mix, and in a mix of unknown relaxation; at an interface that of the layer above. Of
    a climate that asks for daily thermal stress.
    """
    thermal, days = climate.thermal, climate.days
    assert thermal is not None
    assert days is not None
    owner = np.array([road.layer_at(float(depth)) for depth in days.depths])
    tension = np.full((len(MONTHS), len(days.depths)), np.nan)
    for number in np.unique(owner):
        material = elastic_part(road.layers[number].material)
        if isinstance(material, Mix | Thermorheological) and not thermal.unknown(material):
            relaxing, expansion, _ = thermal.of(material)
            points = owner == number
            stress = daily_stress(relaxing, expansion, days.hours, np.moveaxis(days.temperatures[..., points], 1, 0))
            tension[:, points] = stress.max(axis=0)
    return tension


def daily_stress(material: Thermorheological, expansion: float, hours: Array, temperature: Array) -> Array:
    """Stress over a day that comes back, of a mix held in both horizontal directions, Pa, tension positive.

    expansion: 1/K. hours: (nh,), rising, in [0, 24). temperature: °C, (nh, ...), linear between. Returns (nh, ...).
    """
    time = 3600 * np.append(hours, hours[0] + 24.0)
    reduced = reduced_steps(time, np.concatenate([temperature, temperature[:1]]), material.shift.factor)
    slow, fast = 1 / (_BEYOND * float(reduced.sum(axis=0).max())), _BEYOND / float(reduced.min())
    series = as_prony(material.material, slow, fast, tolerance=_SERIES)
    moduli = np.array([series.modulus * share for share, _ in series.terms])
    times = np.array([tau for _, tau in series.terms])
    strain = -expansion * temperature
    return periodic_stress(strain, reduced, moduli, times, series.long_term_modulus) / (1 - series.poisson)


def _left_out(criterion: Criterion, road: Pavement) -> str:
    """Why the weather does no damage by a criterion, in words; empty if it does some."""
    quantity = criterion.quantity
    if quantity.between_layers:
        return "it reads a bond, which the restraint leaves unsheared far from edges"
    material = elastic_part(road.layers[criterion.number(road)].material)
    if isinstance(material, HydraulicMix):
        return "a layer bound by cement has cracked into slabs that move"
    if is_bituminous(material) is False:
        return "its layer is not bituminous"
    if includes_weather(criterion.law_at(15.0)):
        return "its law was fitted to roads, which have weather"
    if not set(quantity.needs) <= {*STRESS, *STRAIN}:
        return f"the {quantity} is one of a wheel that passes"
    return ""


def _depth(criterion: Criterion, road: Pavement) -> float:
    """Depth whose temperature counts, m: the middle of the cube that is read at the top of a layer."""
    depth = criterion.depth(road)
    return depth + 0.5 * (criterion.mean_over or 0.0) if criterion.place == "top" else depth


def _at_depth(depths: Array, temperatures: Array, depth: float) -> Array:
    """Temperatures (month, hour) at a depth, linear between those known."""
    column = int(np.clip(np.searchsorted(depths, depth) - 1, 0, len(depths) - 2))
    part = np.clip((depth - depths[column]) / (depths[column + 1] - depths[column]), 0.0, 1.0)
    value: Array = (1 - part) * temperatures[..., column] + part * temperatures[..., column + 1]
    return value


def instant(climate: Climate, depths: Array, temperatures: Array, name: str) -> Season:
    """An hour of a day as a season, divided and aged as those of the climate are."""
    first = climate.seasons[0]
    profile = TemperatureProfile(depths.tolist(), temperatures.tolist())
    return Season(name, 0.0, profile, first.sublayers, first.ageing)


def _reading(criterion: Criterion, road: Pavement, season: Season, stress: float) -> tuple[float, FatigueLaw]:
    """What the law reads of a stress in the plane, Pa, with the law at that hour."""
    warm = warmed(road, (criterion,), season)
    criterion_here = warm.criteria[0]
    material = warm.road.layers[criterion_here.number(warm.road)].resolved
    if isinstance(material, AnyElastic):
        modulus, poisson = upright(material)
    else:
        fast = material.complex_modulus(2 * math.pi * _READ)
        modulus, poisson = float(np.abs(fast)), material.poisson
    across, down = stress * (1 - poisson) / modulus, -2 * poisson * stress / modulus
    tensor, strain = np.array([stress, stress, 0.0, 0.0, 0.0, 0.0]), np.array([across, across, down, 0.0, 0.0, 0.0])
    law = criterion_here.law_on(warm.road, float(layer_temperatures(road, (criterion,), (season,))[0, 0]))
    return max(float(criterion_here.quantity.of(tensor, strain)), 0.0), law
