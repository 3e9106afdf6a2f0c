"""The reliability of a life: its years at a risk, from the scatter of its inputs and few more solves."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence

import numpy as np

from treadload import variables
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.life import Life
from treadload.damage.scatter import Scatter, check_risks
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.life.contacts import Progress
from treadload.life.design import Design
from treadload.life.halving import as_solved
from treadload.life.reliability.direct import Direct
from treadload.life.reliability.fields import Fit, reliability_dataset
from treadload.life.reliability.inputs import check_names, inputs_of, lognormal
from treadload.life.reliability.propagation import MonteCarlo, Quadratic
from treadload.life.reliability.solution import Reliability
from treadload.life.reliability.surface import designed, fitted
from treadload.life.threads import pool_of
from treadload.life.variants import most
from treadload.pavement import Pavement

_SAMPLING = MonteCarlo()
# An error of the surface, relative in strain, above which it is worth a sentence.
_CAVEATFUL = 0.03
# An error of the years that is worth a sentence.
_LOOSE = 0.1
# Of fewer direct solves no error of their mean follows.
FEWEST_HELD = 2


def life_reliability(
    design: Design,
    life: Life,
    *,
    risks: Sequence[float] = (0.05, 0.5, 0.95),
    criteria: Sequence[str] | None = None,
    coverage: float = 0.5,
    held_back: int = 4,
    sampling: MonteCarlo = _SAMPLING,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Reliability:
    """Years that a road lasts at given risks, the probability of failure against years, and what scatters most.

    life: of the design, whose scatter counts. risks: in (0, 1). criteria: names; all that ever fail if left out.
    coverage: share of a criterion's damage, in (0, 1], whose classes and seasons are solved again; the rest is taken
    to change as they do but along the likeliest line of failure, where it is solved too. held_back: direct solves at
    each risk from which the error of its years follows; 0 for none, and no error. sampling: the draws. workers,
    progress: as in `solve_passages`.

    The strain that does the damage of a year is solved at few points of thickness, moduli and temperature, and
    interpolated by a quadratic with cross terms in its logarithm; what cross-validation finds as its error scatters,
    too. Nearly all classes and seasons of some draws at each risk are solved directly: by how much the surface misses
    them, and what the number of draws leaves open, is the error of the years. A law that has k_r in it
    (`risk_factor`) is taken at its median, so that its risk does not count twice.
    Raises InputError for risks that are 0 or 1, and for a life that never ends; ConvergenceError of a contact.

    >>> from treadload.damage.scatter import Scatter
    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> scatter = Scatter(fatigue=0.25, thickness={"asphalt": 0.002})
    >>> road = tl.Pavement([asphalt, soil])
    >>> design = tl.Design(tire, road, traffic, climate, [base], spacing=0.01, scatter=scatter)
    >>> life, draws = tl.solve_life(design), tl.life.MonteCarlo(draws=10000)
    >>> reliability = tl.life.life_reliability(design, life, held_back=0, sampling=draws)
    >>> [f"{years:.1f}" for years in reliability.dataset.road_years_at_risk.values]  # at 5, 50 and 95 %
    ['0.4', '1.2', '4.0']
    """
    start = time.perf_counter()
    risk_levels = check_risks(risks)
    road, scatter = design.road, design.scatter or Scatter()
    if not 0 < coverage <= 1:
        raise InputError(f"coverage must lie in (0, 1], got {coverage}; 0.5 is the default")
    if held_back != 0 and held_back < FEWEST_HELD:
        raise InputError(f"held_back must be 0, for no error, or at least {FEWEST_HELD}, got {held_back}")
    chosen, caveats = _chosen(life, criteria)
    deviations, without = _fatigue(life, road, chosen, scatter)
    caveats += without
    inputs, skipped = inputs_of(road, scatter)
    caveats += skipped
    points = designed(len(inputs))
    fits: list[Fit] = []
    errors, covered = [], []
    with pool_of(workers) as pool:
        direct = Direct(as_solved(design, life), life, inputs, pool, progress)
        for number, deviation in zip(chosen, deviations, strict=True):
            pairs, share = most(life.dataset["damage_share"].to_numpy()[number], coverage)
            logarithms = direct.logarithms(number, coverage, points) if inputs else np.zeros(1)
            law = life.laws[number][pairs[0][1]]
            power = _power(law, float(life.dataset["largest_reading"][number]))
            _, gradient, curvature, error = fitted(points, logarithms / power)
            peak = float(life.dataset["damage_per_year"][number].max())
            constant = math.log(peak) + power * math.log(_risk_factor(law))
            surface = _with_rest(constant, power, gradient, curvature, scatter, deviation, error)
            missed = np.full(len(risk_levels), math.nan if held_back == 0 else 0.0)
            if inputs:
                surface, middle = direct.corrected(number, surface)
                if held_back:
                    missed = direct.held_back(number, surface, middle, risk_levels, held_back, sampling.seed)
            fits.append(Fit(number, deviation, surface, power, missed))
            errors.append(error)
            covered.append(share)
    dataset = reliability_dataset(life, inputs, scatter, fits, risk_levels, sampling)
    dataset = dataset.assign(
        surface_error=("criterion", np.expm1(errors), variables.attributes("surface_error")),
        coverage=("criterion", covered, variables.attributes("coverage")),
    )
    caveats += tuple(
        f"{life.criteria[k].name}: its strain is interpolated with an error of {100 * math.expm1(error):.1f} %, "
        "which scatters with the rest; a smaller scatter of the inputs makes it smaller"
        for k, error in zip(chosen, errors, strict=True)
        if error > _CAVEATFUL
    )
    caveats += _loose(dataset)
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
        "contacts": direct.contacts,
        "responses": direct.responses,
        "points": len(points) if inputs else 0,
        "held_back": held_back * len(risk_levels) * len(fits) if inputs else 0,
        "draws": sampling.draws,
        "seed": sampling.seed,
        "seconds": time.perf_counter() - start,
    }
    return Reliability(dataset, scatter, stats, tuple(dict.fromkeys(caveats)))


def _loose(dataset: xr.Dataset) -> tuple[str, ...]:
    """Sentences on criteria whose years err by much at some risk."""
    caveats = []
    for name, errors in zip(dataset["criterion"].to_numpy(), dataset["years_error"].to_numpy(), strict=True):
        worst = int(np.nan_to_num(errors).argmax())
        if errors[worst] > _LOOSE:
            caveats.append(
                f"{name}: its years at a risk of {100 * float(dataset['risk'][worst]):g} % may err by "
                f"{100 * errors[worst]:.0f} %, by direct solves held back: other classes, seasons or places than "
                "those that were solved again do the damage there; a larger coverage or less scatter makes it less"
            )
    return tuple(caveats)


def _weather_share(life: Life, number: int) -> float:
    return float(life.dataset["weather_share"][number].sum()) if "weather_share" in life.dataset else 0.0


def number_of_roads(road: Pavement, criteria: Sequence[Criterion], scatter: Scatter) -> int:
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
        f"{names[number]}: its law, {life.laws[number][0]}, is a step, so that its years have no probability"
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
