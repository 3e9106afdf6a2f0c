"""What would help a road: every remedy solved as a design of its own, and ranked by the years that it wins."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from treadload import variables
from treadload.damage.answer import RUT
from treadload.damage.laws.validity import outside
from treadload.damage.life import Life
from treadload.damage.miner import miner
from treadload.errors import InputError, TreadloadError
from treadload.kernels.arrays import Array
from treadload.life.caveats import beyond_tables, traffic_caveats
from treadload.life.contacts import Counter, Progress
from treadload.life.design import Design
from treadload.life.equivalents import Equivalents, life_equivalents
from treadload.life.halving import as_solved
from treadload.life.remedy import road_changes, traffic_changes
from treadload.life.remedy.changes import Changes, NotApplicable, Remedy, changes_of
from treadload.life.remedy.solution import Remedies
from treadload.life.remedy.steps import Kind, RemedySteps
from treadload.life.solve import solve_sum, with_rut
from treadload.life.thermal import daily_cycles

BY_KIND: Mapping[Kind, Changes] = {
    "thickness": road_changes.thicker_layers,
    "mix": road_changes.other_mixes,
    "bond": road_changes.bonded_interfaces,
    "wander": traffic_changes.more_wander,
    "load": traffic_changes.lighter_wheels,
    "tire": traffic_changes.other_tires,
    "pressure": traffic_changes.softer_tires,
    "speed": traffic_changes.other_speeds,
    "braking": traffic_changes.gentler_braking,
    "turning": traffic_changes.wider_turns,
    "friction": traffic_changes.other_friction,
}
"""What makes the remedies of each kind."""


@dataclass(frozen=True)
class _Solved:
    """A remedy with the life after it, and how much was solved for it."""

    remedy: Remedy
    life: Life
    contacts: int
    responses: int


def remedies_of(design: Design, steps: RemedySteps) -> tuple[list[Remedy], list[NotApplicable]]:
    """Remedies of a design, not yet solved, and changes that it does not allow. Raises InputError."""
    return changes_of(design, steps, BY_KIND)


def remedies(
    design: Design,
    life: Life,
    steps: RemedySteps | None = None,
    *,
    equivalents: Equivalents | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Remedies:
    """What would help a road: each change that an agency can make, by one step, ranked by the years that it wins.

    life: of the design. steps: see `RemedySteps`; left out, its defaults. equivalents: of the life, for its standard
    axles; solved if left out. workers, progress: as in `solve_life`. Each remedy is a design of its own whose
    contacts, responses and sum are solved as those of the life are; only wander, which leaves every evaluated value
    as it is, is summed again from the values of the life. Nothing is linearised. A change that the design does not
    allow, or that ends in an error, is in `skipped` with the reason. A remedy under which what does most damage
    leaves the range of its law has a warning. Raises InputError for a life that never ends or is not of the design.

    >>> tire = tl.Tire.from_profile(tl.tire.TreadProfile(0.3, 0.3, 0.06), inflation_pressure=8e5)
    >>> axle = tl.damage.AxleClass("cart", 1.0, wheel_load=500.0, inflation_pressure=8e5)
    >>> traffic, climate = tl.damage.Traffic((axle,), passes_per_year=1e7), tl.damage.Climate.constant(15.0)
    >>> base = tl.damage.Criterion("base", tl.FatigueLine(120e-6, -0.2), 0, "bottom")
    >>> asphalt, soil = tl.Layer(tl.Elastic(5e9, 0.35), 0.03, "asphalt"), tl.Layer(tl.Elastic(60e6, 0.4), name="soil")
    >>> design = tl.Design(tire, tl.Pavement([asphalt, soil]), traffic, climate, [base], spacing=0.01)
    >>> life = tl.solve_life(design)
    >>> answer = tl.life.remedies(design, life, tl.life.RemedySteps(only=("thickness",)))
    >>> [str(remedy) for remedy in answer.dataset.remedy.values]
    ['2 cm more asphalt']
    """
    start = time.perf_counter()
    steps = RemedySteps() if steps is None else steps
    names = [criterion.name for criterion in design.criteria]
    if names != [criterion.name for criterion in life.criteria]:
        raise InputError(
            f"the life has the criteria {', '.join(c.name for c in life.criteria)}, the design {', '.join(names)}; "
            "give the life of this design"
        )
    if not math.isfinite(life.years(life.governing)):
        raise InputError("no criterion ever fails, so that nothing lengthens the life; give more passes")
    candidates, refused = remedies_of(as_solved(design, life), steps)
    skipped = [str(change) for change in refused]
    count = _counter(candidates, life, progress)
    solved: list[_Solved] = []
    for remedy in candidates:
        try:
            solved.append(_solve(remedy, life, workers, count))
        except TreadloadError as error:
            skipped.append(str(NotApplicable(remedy.name, str(error))))
    axles = life_equivalents(design, life, workers=workers) if equivalents is None else equivalents
    stats = {
        "contacts": sum(each.contacts for each in solved),
        "responses": sum(each.responses for each in solved),
        "seconds": time.perf_counter() - start,
    }
    return _ranked(design, life, solved, axles, tuple(skipped), stats)


def _counter(candidates: Sequence[Remedy], life: Life, progress: Progress | None) -> Counter:
    """Counts the solves of all remedies; about as many for each as the life took."""
    each = int(life.stats.get("responses", life.readings.sizes["axle_class"] * life.readings.sizes["season"]))
    contacts = int(life.stats.get("contacts", 0))
    total = sum(each for remedy in candidates if not remedy.same_responses)
    touching = sum(contacts for remedy in candidates if remedy.layer is None and not remedy.same_responses)
    return Counter(total + touching, progress)


def _solve(remedy: Remedy, life: Life, workers: int | None, count: Counter) -> _Solved:
    design = remedy.design
    if remedy.same_responses:
        weather = daily_cycles(design.road, design.climate, design.criteria, design.traffic)
        again = miner(
            life.readings, design.criteria, design.traffic, design.climate, laws=life.class_laws, weather=weather,
            layer_temperatures=np.zeros((len(design.criteria), len(design.climate.seasons))),
        )  # fmt: skip
        return _Solved(remedy, again, 0, 0)
    summed = solve_sum(design, workers=workers, progress=lambda done, total, what: count.after(None, what))
    after, _ = with_rut(summed.life, design, summed.passages.wheels)
    return _Solved(remedy, after, summed.passages.contacts, summed.passages.responses)


def _ranked(
    design: Design,
    life: Life,
    solved: Sequence[_Solved],
    axles: Equivalents,
    skipped: tuple[str, ...],
    stats: Mapping[str, float],
) -> Remedies:
    ends = [criterion.name for criterion in life.criteria]
    if "rut_limit" in life.dataset.attrs:
        ends.append(RUT)
    before = np.array([life.years(name) for name in ends])
    after = np.array([[each.life.years(name) for name in ends] for each in solved]).reshape(len(solved), len(ends))
    road = after.min(axis=1) if len(solved) else np.zeros(0)
    won = road - float(before.min())
    order = sorted(range(len(solved)), key=lambda k: -won[k])
    standard, mean = (axles.dataset[name].to_numpy() for name in ("standard_axles", "mean_standard_axles"))
    padding = len(ends) - len(standard)
    dataset = variables.dataset(
        {
            "remedy_years": (("remedy", "criterion"), after[order]),
            "road_years": (("remedy",), road[order]),
            "years_won": (("remedy",), won[order]),
            "solved_anew": (("remedy",), [0 if solved[k].remedy.same_responses else 1 for k in order]),
            "life_years": (("criterion",), before),
            "standard_axles": (
                ("criterion", "axle_class"),
                np.pad(standard, ((0, padding), (0, 0)), constant_values=np.nan),
            ),
            "mean_standard_axles": (("criterion",), np.pad(mean, (0, padding), constant_values=np.nan)),
        },
        {
            "remedy": [solved[k].remedy.name for k in order],
            "criterion": ends,
            "axle_class": [row.name for row in life.traffic.classes],
        },
        kinds=json.dumps([solved[k].remedy.kind for k in order]),
        governing=json.dumps([ends[int(after[k].argmin())] for k in order], ensure_ascii=False),
        standard_axle=str(axles.dataset.attrs["standard_axle"]),
    )
    warnings = [text for k in order for text in _warned(design, life, solved[k])]
    return Remedies(dataset, skipped, stats, tuple(dict.fromkeys(warnings)))


def _warned(design: Design, life: Life, solved: _Solved) -> list[str]:
    """Sentences on a remedy: what it does to laws, ranges that it leaves, values that no road sees."""
    remedy, changed = solved.remedy, solved.remedy.design
    texts = [remedy.remark] if remedy.remark else []
    for number, criterion in enumerate(life.criteria):
        before, after = _outside(life, number), _outside(solved.life, number)
        if after and not before:
            texts.append(f"{remedy.name}: it leaves the range of the law of {criterion.name}: {after}")
    before_too = {
        *traffic_caveats(design.tire, design.traffic, design.climate),
        *beyond_tables(design.road, design.climate),
    }
    fresh = (
        *traffic_caveats(changed.tire, changed.traffic, changed.climate),
        *beyond_tables(changed.road, changed.climate),
    )
    return texts + [f"{remedy.name}: {text}" for text in fresh if text not in before_too]


def _outside(life: Life, number: int) -> str:
    """Which bound of a law the value that does most of a criterion's damage is beyond, in words; empty if none."""
    share: Array = life.dataset["damage_share"].to_numpy()[number]
    if not share.max() > 0:
        return ""
    row, season = (int(k) for k in np.unravel_index(int(share.argmax()), share.shape))
    return outside(life.class_laws[number][row][season], float(life.readings.to_numpy()[number, row, season].max()))
