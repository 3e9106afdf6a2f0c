"""What of a road, a climate and a traffic scatters, and the question with all of it changed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from treadload.damage.climate import Climate
from treadload.damage.laws.french import thickness_scatter
from treadload.damage.scatter import Scatter
from treadload.damage.traffic import Traffic
from treadload.errors import InputError, nearest
from treadload.life.stiffer import names_of, stiffer
from treadload.life.variants import Question, thicker
from treadload.materials import Mix, StressDependent
from treadload.materials.kinds import AnyElastic, elastic_part
from treadload.pavement import Pavement
from treadload.pavement.asphalt import is_bituminous

ASPHALT, TEMPERATURE = "thickness of the asphalt", "temperature"
TRAFFIC, FATIGUE, INTERPOLATION = "traffic", "fatigue", "interpolation"
# A thickness that scatters by more than this part of it might vanish.
_MOST = 0.3
_ROUND_OFF = 1e-9


@dataclass(frozen=True)
class Input:
    """An input whose change must be solved. name: for tables. deviation: in words. width: of one deviation in what
    the strain is usually plotted over, m of thickness, else NaN. change: the road and climate at z deviations.
    """

    name: str
    deviation: str
    width: float
    change: Callable[[Pavement, Climate, float], tuple[Pavement, Climate]]


def inputs_of(road: Pavement, scatter: Scatter) -> tuple[tuple[Input, ...], tuple[str, ...]]:
    """What of the road and its climate scatters; what could not be taken, and why. Raises InputError."""
    names = names_of(road)
    inputs = [
        *_thicknesses(road, names, scatter.thickness),
        *_moduli(road, names, scatter.moduli, scatter.modulus_correlation),
    ]
    skipped: list[str] = []
    if scatter.temperature:
        if any(layer.depends_on_temperature for layer in road.layers):
            deviation = scatter.temperature
            inputs.append(
                Input(
                    TEMPERATURE,
                    f"{deviation:g} °C",
                    math.nan,
                    lambda road, climate, z: (road, climate.warmer(z * deviation)),
                )
            )
        else:
            skipped.append("temperature: no layer has moduli for it")
    return tuple(inputs), tuple(skipped)


def question_at(
    inputs: Sequence[Input], road: Pavement, traffic: Traffic, climate: Climate, point: Sequence[float]
) -> Question:
    """Road, traffic and climate with each input at a number of deviations from its mean."""
    for unsure, z in zip(inputs, point, strict=True):
        road, climate = unsure.change(road, climate, float(z))
    return road, traffic, climate


def check_names(fatigue: float | Mapping[str, float] | None, criteria: Sequence[str]) -> None:
    """Raise InputError for the SN of a criterion that is not there."""
    by_criterion = fatigue if isinstance(fatigue, Mapping) else {}
    wrong = next((name for name in by_criterion if name not in criteria), None)
    if wrong is not None:
        raise InputError(f"scatter of fatigue: this life has no criterion {wrong!r}; {nearest(wrong, criteria)}")


def lognormal(variation: float) -> float:
    """Standard deviation of the logarithm for a coefficient of variation."""
    return math.sqrt(math.log1p(variation**2))


def _thicknesses(road: Pavement, names: Sequence[str], variation: float | Mapping[str, float] | None) -> list[Input]:
    if isinstance(variation, Mapping):
        rows = [(number, variation[name]) for number, name in _by_name(names, variation, "thickness")]
        for number, _ in rows:
            if road.layers[number].thickness is None:
                raise InputError(
                    f"scatter of thickness: {names[number]!r} is semi-infinite and has none; leave it out"
                )
        return [_thickness(road, f"thickness of {names[n]}", (n,), deviation) for n, deviation in rows if deviation]
    certain = variation is None
    numbers = tuple(
        number
        for number, layer in enumerate(road.layers)
        if layer.thickness is not None and _asphalt(road, number, names, certain=certain)
    )
    if not numbers:
        return []
    total = sum(road.layers[number].thickness or 0.0 for number in numbers)
    deviation = thickness_scatter(total) if variation is None else variation
    return [_thickness(road, ASPHALT, numbers, deviation)] if deviation else []


def _asphalt(road: Pavement, number: int, names: Sequence[str], *, certain: bool) -> bool:
    bituminous = is_bituminous(elastic_part(road.layers[number].material))
    if bituminous is None and certain:
        raise InputError(
            f"scatter of thickness: {names[number]!r} may be asphalt or bound by cement, so that the rule for Sh "
            'does not define whether it counts; give thickness, such as "20 mm", or thicknesses by names of layers'
        )
    return bituminous is not False


def _thickness(road: Pavement, name: str, numbers: tuple[int, ...], deviation: float) -> Input:
    total = sum(road.layers[number].thickness or 0.0 for number in numbers)
    part = deviation / total
    if part > _MOST:
        raise InputError(
            f"{name}: a scatter of {deviation * 1e3:g} mm is {100 * part:.0f} % of {total * 1e3:g} mm, so that the "
            f"layer might vanish; give at most {100 * _MOST:g} %"
        )

    def change(road: Pavement, climate: Climate, z: float) -> tuple[Pavement, Climate]:
        for number in numbers:
            road = thicker(road, number, 1 + z * part)
        return road, climate

    return Input(name, f"{deviation * 1e3:g} mm", deviation, change)


def _moduli(
    road: Pavement,
    names: Sequence[str],
    coefficients: float | Mapping[str, float],
    correlation: Sequence[tuple[str, str, float]] = (),
) -> list[Input]:
    if isinstance(coefficients, Mapping):
        rows = [(number, coefficients[name]) for number, name in _by_name(names, coefficients, "moduli")]
    else:
        rows = [(number, coefficients) for number in range(len(names))]
    inputs = []
    for number, variation in rows:
        if not variation:
            continue
        if not isinstance(road.layers[number].material, AnyElastic | Mix | StressDependent):
            raise InputError(
                f"scatter of moduli: {names[number]!r} is viscoelastic and has no single modulus; give moduli by the "
                "names of the other layers"
            )
        inputs.append(_modulus(f"modulus of {names[number]}", number, variation))
    return _together(names, rows, correlation) if correlation else inputs


def _together(
    names: Sequence[str], rows: Sequence[tuple[int, float]], correlation: Sequence[tuple[str, str, float]]
) -> list[Input]:
    """Moduli that scatter together: the principal directions of the covariance of their logarithms.

    Raises InputError for correlations that no numbers can have.
    """
    numbers = [number for number, _ in rows]
    place = {names[number]: k for k, number in enumerate(numbers)}
    matrix = np.eye(len(rows))
    for first, second, value in correlation:
        matrix[place[first], place[second]] = matrix[place[second], place[first]] = value
    size = np.array([lognormal(variation) for _, variation in rows])
    shares, directions = np.linalg.eigh(matrix * np.outer(size, size))
    if shares[0] < -_ROUND_OFF * shares[-1]:
        raise InputError(
            "the correlations of the moduli contradict each other: no numbers scatter so; give those of one fit"
        )
    inputs: list[Input] = []
    for share, direction in zip(shares[::-1], directions.T[::-1], strict=True):
        powers = math.sqrt(max(float(share), 0.0)) * direction
        if np.abs(powers).max() > _ROUND_OFF:
            words = ", ".join(
                f"{names[n]} {100 * math.expm1(p):+.2g} %" for n, p in zip(numbers, powers, strict=True)
            )
            inputs.append(_direction(f"moduli together, {len(inputs) + 1}", words, numbers, powers.tolist()))
    return inputs


def _direction(name: str, words: str, numbers: Sequence[int], powers: Sequence[float]) -> Input:
    def change(road: Pavement, climate: Climate, z: float) -> tuple[Pavement, Climate]:
        for number, power in zip(numbers, powers, strict=True):
            road = stiffer(road, number, math.exp(z * power))
        return road, climate

    return Input(name, words, math.nan, change)


def _modulus(name: str, number: int, variation: float) -> Input:
    deviation = lognormal(variation)

    def change(road: Pavement, climate: Climate, z: float) -> tuple[Pavement, Climate]:
        return stiffer(road, number, math.exp(z * deviation)), climate

    return Input(name, f"{100 * variation:g} %", math.nan, change)


def _by_name(names: Sequence[str], variations: Mapping[str, float], what: str) -> list[tuple[int, str]]:
    wrong = next((name for name in variations if name not in names), None)
    if wrong is not None:
        raise InputError(f"scatter of {what}: no layer has the name {wrong!r}; {nearest(wrong, names)}")
    return [(number, name) for number, name in enumerate(names) if name in variations]
