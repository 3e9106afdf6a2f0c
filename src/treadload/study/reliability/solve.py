"""The reliability of a life: its years at a risk, from the scatter of its inputs and few more solves."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from scipy.special import ndtr

from treadload import variables
from treadload.contact.solve import DEFAULT_SPACING
from treadload.damage.criterion import Criterion
from treadload.damage.laws.equivalence import growth_factor
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.miner import Life
from treadload.damage.scatter import Scatter, check_risks
from treadload.damage.traffic import Traffic
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.pavement import Pavement
from treadload.study.altered import Solver, most
from treadload.study.contacts import Contacts, Progress
from treadload.study.reliability.inputs import (
    FATIGUE,
    INTERPOLATION,
    TRAFFIC,
    Input,
    asked_at,
    check_names,
    inputs_of,
    lognormal,
)
from treadload.study.reliability.propagation import Quadratic, drawn, first_order
from treadload.study.reliability.solution import Reliability
from treadload.study.reliability.surface import designed, fitted
from treadload.study.threads import pool_of
from treadload.tire import Tire

# Years of the curves; distances β of the first order between which its probabilities are interpolated.
_YEARS, _BETAS = 80, np.linspace(-4.5, 4.5, 73)
_LONGEST = 1e4
_FEWEST, _MOST = 1000, 10_000_000
# An error of the surface, relative in strain, above which it is worth a sentence.
_DOUBTFUL = 0.03


def life_reliability(
    tire: Tire,
    road: Pavement,
    life: Life,
    *,
    scatter: Scatter | None = None,
    risks: Sequence[float] = (0.05, 0.5, 0.95),
    criteria: Sequence[str] | None = None,
    coverage: float = 0.5,
    draws: int = 100_000,
    seed: int = 1,
    spacing: float = DEFAULT_SPACING,
    workers: int | None = None,
    progress: Progress | None = None,
    contacts: Contacts | None = None,
) -> Reliability:
    """Years that a road lasts at given risks, the probability of failure against years, and what scatters most.

    tire, road: those of the life; materials may depend on temperature. scatter: of the inputs; left out, fatigue and
    thickness by the laws and the rule of the French method, and nothing else. risks: in (0, 1). criteria: names; all
    that ever fail if left out. coverage: share of a criterion's damage, in (0, 1], whose classes and seasons are
    solved again; the rest is taken to change as they do. draws: of the Monte Carlo, from the seed. spacing, workers,
    progress, contacts: as in `solve_passages`.

    The strain that does the damage of a year is solved at few points of thickness, moduli and temperature, and
    interpolated by a quadratic with cross terms in its logarithm; what cross-validation finds as its error scatters,
    too. A law that has k_r in it (`risk_factor`) is taken at its median, so that its risk does not count twice.
    Raises InputError for risks that are 0 or 1, and for a life that never ends; ConvergenceError of a contact.
    """
    start = time.perf_counter()
    asked = check_risks(risks)
    scatter = Scatter() if scatter is None else scatter
    if not 0 < coverage <= 1:
        raise InputError(f"coverage must lie in (0, 1], got {coverage}; 0.5 is the default")
    if not _FEWEST <= draws <= _MOST:
        raise InputError(f"draws must lie in [{_FEWEST}, {_MOST}], got {draws}; 100 000 is the default")
    chosen, said = _chosen(life, criteria)
    deviations, without = _fatigue(life, road, chosen, scatter)
    said += without
    inputs, skipped = inputs_of(road, scatter)
    said += skipped
    points = designed(len(inputs))
    contacts = contacts or Contacts(tire, spacing)
    surfaces, errors, covered, powers = [], [], [], []
    solved = responses = 0
    with pool_of(workers) as pool:
        for number, deviation in zip(chosen, deviations, strict=True):
            criterion = life.criteria[number]
            pairs, share = most(life.dataset["damage_share"].to_numpy()[number], coverage)
            solver = Solver(criterion, pairs, contacts, progress)
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
            surfaces.append(_with_rest(constant, power, gradient, curvature, scatter, deviation, error))
            errors.append(error)
            covered.append(share)
            powers.append(power)
            solved += solver.solved if inputs else 0
            responses += solver.responses if inputs else 0
    dataset = told(life, chosen, inputs, scatter, deviations, surfaces, np.array(powers), asked, draws, seed)
    dataset = dataset.assign(
        surface_error=("criterion", np.expm1(errors), variables.attributes("surface_error")),
        coverage=("criterion", covered, variables.attributes("coverage")),
    )
    said += tuple(
        f"{life.criteria[k].name}: its strain is interpolated with an error of {100 * math.expm1(error):.1f} %, "
        "which scatters with the rest; a smaller scatter of the inputs makes it smaller"
        for k, error in zip(chosen, errors, strict=True)
        if error > _DOUBTFUL
    )
    if math.isfinite(life.rut_years):
        said += (
            f"the rut, which is at its limit after {life.rut_years:.3g} years, is not among what is drawn: neither "
            "the scatter of its law nor that of its inputs is known here",
        )
    said += tuple(
        f"{life.criteria[k].name}: daily thermal stress does {100 * share:.2g} % of its damage, which scatters and "
        "grows here as that of the traffic does"
        for k in chosen
        if (share := _weather_share(life, k)) > 0
    )
    stats = {
        "contacts": solved,
        "responses": responses,
        "points": len(points) if inputs else 0,
        "draws": draws,
        "seed": seed,
        "seconds": time.perf_counter() - start,
    }
    return Reliability(dataset, scatter, stats, tuple(dict.fromkeys(said)))


def _weather_share(life: Life, number: int) -> float:
    return float(life.dataset["weather_share"][number].sum()) if "weather_share" in life.dataset else 0.0


def roads_asked(road: Pavement, criteria: Sequence[Criterion], scatter: Scatter) -> int:
    """How many roads a reliability solves for each criterion; InputError for a scatter of what is not there."""
    check_names(scatter.fatigue, [one.name for one in criteria])
    inputs, _ = inputs_of(road, scatter)
    return len(designed(len(inputs))) if inputs else 0


def _chosen(life: Life, criteria: Sequence[str] | None) -> tuple[list[int], tuple[str, ...]]:
    """Numbers of the criteria that are asked for and ever fail, and a sentence on those whose law has no power."""
    names = [one.name for one in life.criteria]
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
    check_names(fatigue, [one.name for one in life.criteria])
    deviations, said = [], []
    for number in chosen:
        name, law = life.criteria[number].name, life.laws[number][0]
        given = fatigue.get(name) if isinstance(fatigue, Mapping) else fatigue
        mix = road.layers[life.criteria[number].number(road)].material
        own = getattr(law, "scatter", getattr(mix, "scatter", None)) if given is None else given
        if own is None:
            said.append(
                f"{name}: its law, {law}, has no SN, nor has its layer, so that its fatigue does not scatter; give "
                "fatigue, such as 0.3, under [reliability]"
            )
        deviations.append(float(own or 0.0))
    return deviations, tuple(said)


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


def told(
    life: Life,
    chosen: Sequence[int],
    inputs: Sequence[Input],
    scatter: Scatter,
    deviations: Sequence[float],
    surfaces: list[Quadratic],
    powers: Array,
    risks: tuple[float, ...],
    draws: int,
    seed: int,
) -> Any:
    """The dataset of a reliability, without what was solved for it.

    chosen: numbers of the criteria. deviations: SN of each; surfaces: ln D of each, over the inputs, traffic, fatigue
    and the error; powers: to which its damage grows with its strain.
    """
    traffic = life.traffic
    every = drawn(surfaces, len(inputs) + 1, draws, seed)
    # Of a road that has failed as soon as one of its criteria has.
    road = np.sort(every.max(axis=0))
    every.sort(axis=1)
    at_risk = np.quantile(every, 1 - np.array(risks), axis=1).T
    point = [[first_order(one, risk) for risk in risks] for one in surfaces]
    median = np.quantile(every, 0.5, axis=1)
    names = [*(one.name for one in inputs), TRAFFIC, FATIGUE, INTERPOLATION]
    widths = np.array([one.width for one in inputs] + [math.nan] * 3)
    slopes = np.array([one.gradient for one in surfaces]) / powers[:, None] / math.log(10)
    with np.errstate(divide="ignore", invalid="ignore"):
        per_length = np.nanmin(np.where(np.isnan(widths), np.inf, slopes / widths), axis=1)
    years = _years(traffic, every)
    needed = np.array([-math.log(growth_factor(float(year), traffic.growth, traffic.kind)) for year in years])
    curves = np.array([[_first_order_of(one, beta) for beta in _BETAS] for one in surfaces])
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
        "fatigue_scatter": (("criterion",), list(deviations)),
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
    words = [*(one.deviation for one in inputs), f"{100 * scatter.traffic:g} %", "SN", "error of the surface"]
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
    return np.array([traffic.years_to(float(one)) for one in passes.ravel()]).reshape(passes.shape)


def _share_above(rising: Array, bounds: Array) -> Array:
    """Share of sorted values that lies above each bound."""
    share: Array = 1 - np.searchsorted(rising, bounds, side="right") / len(rising)
    return share


def _first_order_of(surface: Quadratic, beta: float) -> float:
    """Ln D at a distance β of the first order."""
    return first_order(surface, float(ndtr(-beta)))[0]
