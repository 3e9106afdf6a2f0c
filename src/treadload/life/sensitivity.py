"""What a life depends on most: elasticities of the governing criterion by central differences."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from treadload import variables
from treadload.composing import BaseResult, Holds
from treadload.damage.answer import RUT
from treadload.damage.criterion import Criterion
from treadload.damage.life import Life
from treadload.damage.miner import damage_of, wander_of
from treadload.damage.thermal import years_until
from treadload.damage.traffic import AxleClass, Traffic, Wander
from treadload.damage.words import STEEPEST
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.life.contacts import Progress
from treadload.life.design import Design
from treadload.life.halving import as_solved
from treadload.life.stiffer import names_of, stiffer
from treadload.life.thermal import daily_cycles
from treadload.life.threads import pool_of
from treadload.life.variants import (
    Question,
    Solver,
    each_class,
    friction_number,
    in_seasons,
    most,
    thicker,
)
from treadload.materials import Mix, StressDependent
from treadload.materials.kinds import AnyElastic
from treadload.pavement import Pavement
from treadload.rows import Row, row

TEMPERATURE = "temperature (per °C)"
_STEP, _DEGREES = 0.05, 1.0

Change = Callable[[float], Question]


@dataclass(frozen=True, eq=False)
class Sensitivity(BaseResult, group="sensitivity"):
    """How the life by the governing criterion depends on its inputs.

    dataset: elasticity (input), d ln(life in years) / d ln(input), of temperature d ln(life) per °C; the most
    important first, as inputs change by 5 %, temperature by 1 °C. criterion: the governing one. coverage: share of
    its damage in the classes and seasons that were solved again. contacts, responses: how many were solved. skipped:
    inputs that could not be changed, and why.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> sensitivity = tl.life.life_sensitivity(design, life)
    >>> str(sensitivity.dataset.input.values[0])  # what matters most
    'thickness of asphalt'
    """

    title: ClassVar[str] = "Sensitivity of the service life"
    subject: ClassVar[str] = "What the life of a road depends on"
    holds: ClassVar[Holds] = Holds(
        {"elasticity": "input"},
        finite="elasticity",
        largest={"elasticity": STEEPEST},
        labels={"input": "input"},
        maybe_numbers="contacts responses coverage",
        with_it={"elasticity": "input"},
        tree="elasticity",
    )

    dataset: xr.Dataset
    criterion: str
    coverage: float
    contacts: int
    responses: int
    skipped: tuple[str, ...] = ()

    @property
    def stats(self) -> dict[str, float]:
        """How much was solved, and for which share of the damage."""
        return {"contacts": self.contacts, "responses": self.responses, "coverage": self.coverage}

    @property
    def heading(self) -> str:
        """The criterion, and how inputs change."""
        return f"life by {self.criterion}, how much longer it gets as an input grows by 1 %, temperature by 1 °C"

    def rows(self) -> tuple[Row, ...]:
        """The inputs by their importance, what was solved for them, and those that could not be changed."""
        rows = [
            row("elasticity", value * (100 if name == TEMPERATURE else 1), label=str(name))
            for name, value in zip(
                self.dataset["input"].to_numpy(), self.dataset["elasticity"].to_numpy(), strict=True
            )
        ]
        solved = (
            f"{self.contacts} contacts and {self.responses} responses of the classes and seasons that do "
            f"{100 * self.coverage:.0f} % of the damage"
        )
        return (*rows, row("solved", solved), *(row("skipped", text) for text in self.skipped))


def life_sensitivity(
    design: Design,
    life: Life,
    *,
    coverage: float = 0.8,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Sensitivity:
    """Elasticities of a life: d ln(life) / d ln(input) of its governing criterion, by central differences of ±5 %.

    life: of the design. coverage: share of the governing damage, in
    (0, 1]; the classes and seasons that do most, up to this share, are solved again with each input changed, the
    rest is taken to change as they do. workers, progress: as in `solve_passages`.
    Inputs: wheel load, inflation pressure and friction of all classes; thickness and modulus of every layer, the
    numbers of its law unchanged; temperature by ±1 °C; passes, wander, and the strain or stress that the law
    allows, which need no solve. Raises InputError for a life that never ends, and ConvergenceError of a contact.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> sensitivity = tl.life.life_sensitivity(design, life)
    >>> f"{sensitivity.dataset.elasticity.sel(input='passes').item():.0f}: twice the passes, half the life"
    '-1: twice the passes, half the life'
    """
    if not 0 < coverage <= 1:
        raise InputError(f"coverage must lie in (0, 1], got {coverage}; 0.8 is the default")
    design = as_solved(design, life)
    data = life.dataset.sel(criterion=life.governing_criterion)
    number = [criterion.name for criterion in life.criteria].index(life.governing_criterion)
    criterion = life.criteria[number]
    passes = float(data["life_passes"])
    if not math.isfinite(passes):
        raise InputError("no criterion ever fails, so no input shortens the life; give more passes")
    pairs, covered = most(data["damage_share"].to_numpy(), coverage)
    weather = life.weather_damage(number)
    busy = float(data["damage_per_year"].max()) - weather
    growth, steady = _growth(life.traffic, passes), 0.0
    if weather > 0:
        growth, steady = _slopes(life.traffic, busy, weather)
    question = (design.road, life.traffic, life.climate)
    elasticity = _without_solves(life, number, growth, steady)
    changes, skipped = _changes(question)
    skipped += _of_the_rut(life)
    questions: list[tuple[str, float, Question]] = []
    days: dict[str, list[float]] = {}
    for name, change in changes.items():
        try:
            both = [(name, sign, change(sign)) for sign in (-1.0, 1.0)]
            for _, _, changed in both:
                in_seasons(changed, criterion, pairs)
        except InputError as error:
            skipped.append(f"{name}: {error}")
            continue
        questions += both
        if steady:
            days[name] = [_of_days(changed, criterion) for _, _, changed in both]
    solver = Solver(criterion, pairs, design.contacts, progress)
    with pool_of(workers) as pool:
        damage = solver.damages([question for _, _, question in questions], pool)
    for (name, _, _), less, more in zip(questions[::2], damage[::2], damage[1::2], strict=True):
        apart = 2 * _DEGREES if name == TEMPERATURE else math.log((1 + _STEP) / (1 - _STEP))
        elasticity[name] = -growth * math.log(more / less) / apart
        if steady:
            elasticity[name] -= steady * math.log(days[name][1] / days[name][0]) / apart
    order = sorted(elasticity, key=lambda name: -abs(elasticity[name]) * (_DEGREES if name == TEMPERATURE else _STEP))
    dataset = variables.dataset(
        {"elasticity": (("input",), [elasticity[name] for name in order])},
        {"input": order},
        criterion=criterion.name,
        coverage=covered,
        contacts=solver.solved,
        responses=solver.responses,
    )
    return Sensitivity(dataset, criterion.name, covered, solver.solved, solver.responses, tuple(skipped))


def _of_the_rut(life: Life) -> list[str]:
    """A sentence where the rut ends the road first: what its curve over the years shows, and what is not solved."""
    if life.governing != RUT or not math.isfinite(life.rut_years):
        return []
    data, at = life.dataset, life.rut_years
    year, depth = data["year"].to_numpy(), data["rut_depth"].to_numpy().sum(axis=0)
    # ln of the rut is about linear in ln of the passes; the last two years hold for what lies beyond the curve.
    right = int(np.clip(np.searchsorted(year, at), 1, len(year) - 1)) if len(year) > 1 else 0
    cause = f"the rut, which ends the road first, after {at:.3g} years"
    if not right:
        return [f"{cause}: no input is changed for it"]
    passes = [life.traffic.passes(float(passages)) for passages in year[right - 1 : right + 1]]
    power = math.log(depth[right] / depth[right - 1]) / math.log(passes[1] / passes[0])
    slope = _growth(life.traffic, life.traffic.passes(at))
    return [
        f"{cause}: by its curve its years change by {-slope:+.2g} % as the passes grow by 1 % and by "
        f"{slope / power:+.2g} % as its limit does; loads, thicknesses, moduli and temperature are not changed for "
        f"it, and what is stated above is the life by {life.governing_criterion}"
    ]


def _growth(traffic: Traffic, passes: float) -> float:
    """Elasticity of the years to the passes at the end of life."""
    less, more = (traffic.years_to(passes * (1 + sign * _STEP)) for sign in (-1, 1))
    if not math.isfinite(more):
        return 1.0
    return math.log(more / less) / math.log((1 + _STEP) / (1 - _STEP))


def _slopes(traffic: Traffic, damage: float, weather: float) -> tuple[float, float]:
    """Elasticities of the years, less their sign, to the damage of the traffic and to that of the weather."""
    less, more = 1 - _STEP, 1 + _STEP
    apart = math.log(more / less)
    by_traffic = [years_until(traffic, damage * factor, weather) for factor in (less, more)]
    by_weather = [years_until(traffic, damage, weather * factor) for factor in (less, more)]
    return math.log(by_traffic[0] / by_traffic[1]) / apart, math.log(by_weather[0] / by_weather[1]) / apart


def _of_days(question: Question, criterion: Criterion) -> float:
    """Damage of a year that daily thermal stress does in a changed question."""
    road, traffic, climate = question
    cycles = daily_cycles(road, climate, (criterion,), traffic)
    return 0.0 if cycles is None else float(cycles.yearly[0])


def _without_solves(life: Life, number: int, growth: float, steady: float = 0.0) -> dict[str, float]:
    """Elasticities for passes, wander and the law's strain, from the readings of the life."""
    traffic, climate, criterion = life.traffic, life.climate, life.criteria[number]
    readings = life.readings.to_numpy()[number : number + 1]
    y = life.readings["y"].to_numpy()
    elasticity = {"passes": -growth}
    laws = life.class_laws[number]

    def peak(values: Array, wander: Wander) -> float:
        damage = damage_of(values, [laws], traffic, climate).sum(axis=(0, 1, 2))
        return float(wander.spread(damage, float(y[1] - y[0])).max())

    apart = math.log((1 + _STEP) / (1 - _STEP))
    wander_scatter = wander_of(laws[0][0], traffic)
    stronger, weaker = (peak(readings / (1 + sign * _STEP), wander_scatter) for sign in (1, -1))
    strength = -growth * math.log(stronger / weaker) / apart
    if steady:
        read = life.dataset["weather_reading"].to_numpy()[number]
        strong, weak = ((1 / laws[0][0].allowable_passes(read / (1 + sign * _STEP))).sum() for sign in (1, -1))
        strength -= steady * math.log(strong / weak) / apart
    elasticity[f"strength of {criterion.name}"] = strength
    if wander_scatter.deviation:
        wide, narrow = (
            peak(readings, Wander.normal(wander_scatter.deviation * (1 + sign * _STEP))) for sign in (1, -1)
        )
        elasticity["wander"] = -growth * math.log(wide / narrow) / apart
    return elasticity


def _changes(question: Question) -> tuple[dict[str, Change], list[str]]:
    """What each input makes of the question for a sign, and what cannot be changed."""
    road, traffic, climate = question
    skipped: list[str] = []

    def of_classes(name: str) -> Change:
        def change(sign: float) -> Question:
            return road, each_class(traffic, lambda row: of_class(row, sign)), climate

        def of_class(row: AxleClass, sign: float) -> AxleClass:
            return replace(row, **{name: getattr(row, name) * (1 + sign * _STEP)})

        return change

    changes: dict[str, Change] = {
        "wheel load": of_classes("wheel_load"),
        "inflation pressure": of_classes("inflation_pressure"),
    }
    numbers = [friction_number(row.friction) for row in traffic.classes]
    numbers_with_friction = [mu for mu in numbers if mu is not None]
    if len(numbers_with_friction) < len(numbers):
        skipped.append("friction: a friction law is not a single number")
    else:

        def rougher(sign: float) -> Question:
            pairs = zip(traffic.classes, numbers_with_friction, strict=True)
            rows = tuple(replace(row, friction=mu * (1 + sign * _STEP)) for row, mu in pairs)
            return road, replace(traffic, classes=rows), climate

        changes["friction"] = rougher
    for k, (label, layer) in enumerate(zip(names_of(road), road.layers, strict=True)):
        if layer.thickness is not None:
            changes[f"thickness of {label}"] = _on_road(question, thicker, k)
        if isinstance(layer.material, AnyElastic | Mix | StressDependent):
            changes[f"modulus of {label}"] = _on_road(question, stiffer, k)
        else:
            skipped.append(f"modulus of {label}: it is viscoelastic")
    if any(layer.depends_on_temperature for layer in road.layers):
        changes[TEMPERATURE] = lambda sign: (road, traffic, climate.warmer(sign * _DEGREES))
    return changes, skipped


def _on_road(question: Question, changed: Callable[[Pavement, int, float], Pavement], number: int) -> Change:
    road, traffic, climate = question
    return lambda sign: (changed(road, number, 1 + sign * _STEP), traffic, climate)
