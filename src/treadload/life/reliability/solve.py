"""The reliability of a life: its years at a risk, from the scatter of its inputs and few more solves."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.special import ndtr

from treadload import variables
from treadload.damage.criterion import Criterion
from treadload.damage.laws.equivalence import growth_factor
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.life import Life
from treadload.damage.scatter import Scatter, check_risks
from treadload.damage.traffic import Traffic
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.life.contacts import Progress
from treadload.life.design import Design
from treadload.life.reliability.inputs import (
    FATIGUE,
    INTERPOLATION,
    TRAFFIC,
    Input,
    asked_at,
    check_names,
    inputs_of,
    lognormal,
)
from treadload.life.reliability.propagation import MonteCarlo, Quadratic, drawn, first_order
from treadload.life.reliability.solution import Reliability
from treadload.life.reliability.surface import designed, fitted
from treadload.life.threads import pool_of
from treadload.life.variants import Solver, most
from treadload.pavement import Pavement

# Years of the curves; distances β of the first order between which its probabilities are interpolated.
_YEARS, _BETAS = 80, np.linspace(-4.5, 4.5, 73)
_LONGEST = 1e4
_SAMPLING = MonteCarlo()
# An error of the surface, relative in strain, above which it is worth a sentence.
_DOUBTFUL = 0.03


def life_reliability(
    design: Design,
    life: Life,
    *,
    risks: Sequence[float] = (0.05, 0.5, 0.95),
    criteria: Sequence[str] | None = None,
    coverage: float = 0.5,
    sampling: MonteCarlo = _SAMPLING,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Reliability:
    """Years that a road lasts at given risks, the probability of failure against years, and what scatters most.

    life: of the design, whose scatter counts. risks: in (0, 1). criteria: names; all that ever fail if left out.
    coverage: share of a criterion's damage, in (0, 1], whose classes and seasons are solved again; the rest is taken
    to change as they do. sampling: the draws. workers, progress: as in `solve_passages`.

    The strain that does the damage of a year is solved at few points of thickness, moduli and temperature, and
    interpolated by a quadratic with cross terms in its logarithm; what cross-validation finds as its error scatters,
    too. A law that has k_r in it (`risk_factor`) is taken at its median, so that its risk does not count twice.
    Raises InputError for risks that are 0 or 1, and for a life that never ends; ConvergenceError of a contact.
    """
    start = time.perf_counter()
    risk_levels = check_risks(risks)
    road, scatter = design.road, design.scatter or Scatter()
    if not 0 < coverage <= 1:
        raise InputError(f"coverage must lie in (0, 1], got {coverage}; 0.5 is the default")
    chosen, caveats = _chosen(life, criteria)
    deviations, without = _fatigue(life, road, chosen, scatter)
    caveats += without
    inputs, skipped = inputs_of(road, scatter)
    caveats += skipped
    points = designed(len(inputs))
    fits: list[Fit] = []
    errors, covered = [], []
    solved = responses = 0
    with pool_of(workers) as pool:
        for number, deviation in zip(chosen, deviations, strict=True):
            criterion = life.criteria[number]
            pairs, share = most(life.dataset["damage_share"].to_numpy()[number], coverage)
            solver = Solver(criterion, pairs, design.contacts, progress)
            questions = [asked_at(inputs, road, life.traffic, life.climate, point) for point in points]
            damage = np.array(solver.damages(questions, pool)) if inputs else np.ones(1)
            if not (damage > 0).all():
                raise InputError(
                    f"{criterion.name}: within the scatter of the inputs it does no damage at all, so that no "
                    "surface runs through its logarithm; scatter less, or leave it out by criteria="
                )
            law = life.laws[number][pairs[0][1]]
            power = _power(law, float(life.dataset["largest_reading"][number]))
            _, gradient, curvature, error = fitted(points, np.log(damage) / power)
            peak = float(life.dataset["damage_per_year"][number].max())
            constant = math.log(peak) + power * math.log(_risk_factor(law))
            surface = _with_rest(constant, power, gradient, curvature, scatter, deviation, error)
            fits.append(Fit(number, deviation, surface, power))
            errors.append(error)
            covered.append(share)
            solved += solver.solved if inputs else 0
            responses += solver.responses if inputs else 0
    dataset = reliability_dataset(life, inputs, scatter, fits, risk_levels, sampling)
    dataset = dataset.assign(
        surface_error=("criterion", np.expm1(errors), variables.attributes("surface_error")),
        coverage=("criterion", covered, variables.attributes("coverage")),
    )
    caveats += tuple(
        f"{life.criteria[k].name}: its strain is interpolated with an error of {100 * math.expm1(error):.1f} %, "
        "which scatters with the rest; a smaller scatter of the inputs makes it smaller"
        for k, error in zip(chosen, errors, strict=True)
        if error > _DOUBTFUL
    )
    if math.isfinite(life.rut_years):
        caveats += (
            f"the rut, which is at its limit after {life.rut_years:.3g} years, is not among what is drawn: neither "
            "the scatter of its law nor that of its inputs is known here",
        )
    caveats += tuple(
        f"{life.criteria[k].name}: daily thermal stress does {100 * share:.2g} % of its damage, which scatters and "
        "grows here as that of the traffic does"
        for k in chosen
        if (share := _weather_share(life, k)) > 0
    )
    stats = {
        "contacts": solved,
        "responses": responses,
        "points": len(points) if inputs else 0,
        "draws": sampling.draws,
        "seed": sampling.seed,
        "seconds": time.perf_counter() - start,
    }
    return Reliability(dataset, scatter, stats, tuple(dict.fromkeys(caveats)))


def _weather_share(life: Life, number: int) -> float:
    return float(life.dataset["weather_share"][number].sum()) if "weather_share" in life.dataset else 0.0


def roads_asked(road: Pavement, criteria: Sequence[Criterion], scatter: Scatter) -> int:
    """How many roads a reliability solves for each criterion; InputError for a scatter of what is not there."""
    check_names(scatter.fatigue, [criterion.name for criterion in criteria])
    inputs, _ = inputs_of(road, scatter)
    return len(designed(len(inputs))) if inputs else 0


def _chosen(life: Life, criteria: Sequence[str] | None) -> tuple[list[int], tuple[str, ...]]:
    """Numbers of the criteria that are asked for and ever fail, and a sentence on those whose law has no power."""
    names = [criterion.name for criterion in life.criteria]
    wrong = next((name for name in criteria or () if name not in names), None)
    if wrong is not None:
        raise InputError(f"this life has no criterion {wrong!r}; {nearest(wrong, names)}")
    ends = [
        number
        for number, name in enumerate(names)
        if (criteria is None or name in criteria) and math.isfinite(float(life.dataset["life_passes"][number]))
    ]
    steep = [n for n in ends if _power(life.laws[n][0], float(life.dataset["largest_reading"][n])) > 0]
    if not steep:
        raise InputError(
            "no criterion that is asked for ever fails by a law whose passes fall steadily with its reading, so that "
            "no years scatter; give more passes, or a law in the place of a limit"
        )
    return steep, tuple(
        f"{names[number]}: its law, {life.laws[number][0]}, is a step, so that no probability of its years is told"
        for number in ends
        if number not in steep
    )


def _fatigue(
    life: Life, road: Pavement, chosen: Sequence[int], scatter: Scatter
) -> tuple[list[float], tuple[str, ...]]:
    """SN of every criterion, its law's or its mix's if none is fatigue; a sentence on those that have none."""
    fatigue = scatter.fatigue
    check_names(fatigue, [criterion.name for criterion in life.criteria])
    deviations, caveats = [], []
    for number in chosen:
        name, law = life.criteria[number].name, life.laws[number][0]
        deviation = fatigue.get(name) if isinstance(fatigue, Mapping) else fatigue
        mix = road.layers[life.criteria[number].number(road)].material
        law_scatter = getattr(law, "scatter", getattr(mix, "scatter", None)) if deviation is None else deviation
        if law_scatter is None:
            caveats.append(
                f"{name}: its law, {law}, has no SN, nor has its layer, so that its fatigue does not scatter; give "
                "fatigue, such as 0.3, under [reliability]"
            )
        deviations.append(float(law_scatter or 0.0))
    return deviations, tuple(caveats)


def _power(law: FatigueLaw, reading: float) -> float:
    """To which power damage grows with the reading; 0 where it does not grow steadily."""
    more, less = (float(law.allowable_passes(reading * factor)) for factor in (1.01, 1 / 1.01))
    steady = 0 < more < less < math.inf
    return math.log(less / more) / (2 * math.log(1.01)) if steady else 0.0


def _risk_factor(law: FatigueLaw) -> float:
    """k_r that a law has in it; 1 for none."""
    return float(getattr(law, "risk_factor", 1.0))


def _with_rest(
    constant: float, power: float, gradient: Array, curvature: Array, scatter: Scatter, fatigue: float, error: float
) -> Quadratic:
    """Ln D of a year over what was solved, then traffic, fatigue and the error of the surface."""
    rest = [lognormal(scatter.traffic), math.log(10) * fatigue, power * error]
    bent = np.zeros((len(gradient) + len(rest),) * 2)
    bent[: len(gradient), : len(gradient)] = power * curvature
    return Quadratic(constant, np.concatenate([power * gradient, rest]), bent)


@dataclass(frozen=True, eq=False)
class Fit:
    """Damage of a criterion over what scatters.

    number: of the criterion. deviation: SN. surface: ln D over the inputs, traffic, fatigue and the error. power: to
    which its damage grows with its strain.
    """

    number: int
    deviation: float
    surface: Quadratic
    power: float


def reliability_dataset(
    life: Life,
    inputs: Sequence[Input],
    scatter: Scatter,
    fitted_to: Sequence[Fit],
    risks: tuple[float, ...],
    sampling: MonteCarlo,
) -> xr.Dataset:
    """The dataset of a reliability, without what was solved for it. fitted_to: each criterion."""
    traffic, chosen = life.traffic, [fit.number for fit in fitted_to]
    surfaces, powers = [fit.surface for fit in fitted_to], np.array([fit.power for fit in fitted_to])
    every = drawn(surfaces, len(inputs) + 1, sampling.draws, sampling.seed)
    # Of a road that has failed as soon as one of its criteria has.
    road = np.sort(every.max(axis=0))
    every.sort(axis=1)
    at_risk = np.quantile(every, 1 - np.array(risks), axis=1).T
    point = [[first_order(surface, risk) for risk in risks] for surface in surfaces]
    median = np.quantile(every, 0.5, axis=1)
    names = [*(unsure.name for unsure in inputs), TRAFFIC, FATIGUE, INTERPOLATION]
    widths = np.array([unsure.width for unsure in inputs] + [math.nan] * 3)
    slopes = np.array([surface.gradient for surface in surfaces]) / powers[:, None] / math.log(10)
    with np.errstate(divide="ignore", invalid="ignore"):
        per_length = np.nanmin(np.where(np.isnan(widths), np.inf, slopes / widths), axis=1)
    years = _years(traffic, every)
    needed = np.array([-math.log(growth_factor(float(year), traffic.growth, traffic.kind)) for year in years])
    curves = np.array([[_first_order_of(surface, beta) for beta in _BETAS] for surface in surfaces])
    laws = [life.laws[number][0] for number in chosen]
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        "years_at_risk": (("criterion", "risk"), _in_years(traffic, at_risk)),
        "years_at_risk_first_order": (
            ("criterion", "risk"),
            _in_years(traffic, np.array([[damage for damage, _ in row] for row in point])),
        ),
        "risk_factor": (("criterion", "risk"), np.exp((median[:, None] - at_risk) / powers[:, None])),
        "failure_probability": (("criterion", "year"), np.array([_share_above(row, needed) for row in every])),
        "failure_probability_first_order": (
            ("criterion", "year"),
            np.array([ndtr(-np.interp(needed, row, _BETAS)) for row in curves]),
        ),
        "importance": (("criterion", "input"), np.array([row[0][1] ** 2 for row in point])),
        "road_years_at_risk": (("risk",), _in_years(traffic, np.quantile(road, 1 - np.array(risks)))),
        "road_failure_probability": (("year",), _share_above(road, needed)),
        "fatigue_scatter": (("criterion",), [fit.deviation for fit in fitted_to]),
        "law_risk": (("criterion",), [float(getattr(law, "risk", math.nan)) for law in laws]),
        "law_risk_factor": (("criterion",), [float(getattr(law, "risk_factor", math.nan)) for law in laws]),
        "law_years": (("criterion",), life.dataset["life_years"].to_numpy()[list(chosen)]),
        "thickness_slope": (("criterion",), np.where(np.isfinite(per_length), -per_length, np.nan)),
    }
    coordinates = {
        "criterion": [life.criteria[number].name for number in chosen],
        "risk": list(risks),
        "year": years,
        "input": names,
    }
    words = [*(unsure.deviation for unsure in inputs), f"{100 * scatter.traffic:g} %", "SN", "error of the surface"]
    return variables.dataset(
        fields,
        coordinates,
        deviations=json.dumps(words, ensure_ascii=False),
        ends=json.dumps([law.end_of_life for law in laws], ensure_ascii=False),
        **({} if traffic.years is None else {"design_years": traffic.years}),
    )


def _years(traffic: Traffic, every: Array) -> Array:
    """Years of the curves, evenly spaced in their logarithm, from the first to the last thousandth of all draws."""
    low, high = np.quantile(every, [0.999, 0.001])
    first, last = (min(max(year, 0.05), _LONGEST) for year in _in_years(traffic, np.array([low, high])))
    return np.geomspace(min(first, 0.5 * last), last, _YEARS)


def _in_years(traffic: Traffic, logarithms: Array) -> Array:
    """Years until damages of a year, by their logarithms, have added up to 1."""
    passes = traffic.passes_per_year * np.exp(-logarithms)
    return np.array([traffic.years_to(float(count)) for count in passes.ravel()]).reshape(passes.shape)


def _share_above(rising: Array, bounds: Array) -> Array:
    """Share of sorted values that lies above each bound."""
    share: Array = 1 - np.searchsorted(rising, bounds, side="right") / len(rising)
    return share


def _first_order_of(surface: Quadratic, beta: float) -> float:
    """Ln D at a distance β of the first order."""
    return first_order(surface, float(ndtr(-beta)))[0]
