"""Passes of one load by criterion: what the laws that the layers of a road have allow of the load of a case."""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass, replace

import numpy as np

from treadload.case import Case
from treadload.case.criteria import CRITERION
from treadload.damage import Verdict
from treadload.damage.answer import Answer, listed, place_in_words, repetitions_answer
from treadload.damage.border import beyond_the_map
from treadload.damage.criterion import Criterion
from treadload.damage.laws.fatigue import FatigueLaw
from treadload.damage.laws.french import RISK
from treadload.damage.laws.validity import outside, warnings_of
from treadload.damage.quantity import Quantity
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.largest import index_of_largest
from treadload.life.wheels import MARGIN
from treadload.materials import HydraulicMix, Mix, Unbound
from treadload.materials.kinds import elastic_part
from treadload.pavement import Pavement, is_bituminous
from treadload.response import solve_response
from treadload.response.basin import basin_reach
from treadload.response.superposition import common_grid
from treadload.steps.loaded import Loaded
from treadload.units import repetitions_in_words

# Class of traffic whose probability of failure the laws of layers take, 5 %: that of the first case of a life too.
_TRAFFIC = "T1"
# Points this part of the depth apart miss the peak of a field that bends over a depth by 1/3200 of it.
_PER_DEPTH = 20
_ANY_TEMPERATURE = 15.0


@dataclass(frozen=True)
class Allowed:
    """What a criterion allows of the passes of a load.

    name: of its law, as a case names it. layer: its name. place: in it, "top", "bottom" or "" of a depth that a
    assessment found. depth: m. law. reading: the largest that a passage does, SI, 0 where nothing does harm; at x,
    y, m.
    """

    name: str
    layer: str
    place: str
    depth: float
    law: FatigueLaw
    reading: float
    x: float
    y: float

    @property
    def reads(self) -> Quantity:
        """What its law reads."""
        return self.law.reads

    @property
    def passes(self) -> float:
        """Passes of this load, at this temperature, that its law allows; inf where nothing does harm."""
        return self.law.allowable_passes(self.reading)

    @property
    def extrapolated(self) -> bool:
        """True if the reading lies outside of what tests or roads behind the law have seen."""
        return bool(outside(self.law, self.reading))

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user, see `warnings_of`."""
        return warnings_of(self.law, self.reading)


@dataclass(frozen=True)
class PassesAllowed:
    """Passes of a load by criterion, from the surface down. without: why layers have no row, a sentence each."""

    rows: tuple[Allowed, ...]
    without: tuple[str, ...] = ()

    def answer(self, alone: Answer | None) -> Answer:
        """The answer by all criteria. alone: that of the fatigue law of the case, whose row is the first, or None."""
        first = min(self.rows, key=lambda line: line.passes)
        count = Counter(line.name for line in self.rows)
        # One law of several layers is named with the layer.
        further = [
            f"{line.name}{f', {line.layer}' if count[line.name] > 1 else ''}{_repetitions(line)}"
            for line in self.rows
            if line is not first
        ]
        if alone is not None and first is self.rows[0]:
            return replace(alone, further=listed(further))
        place = place_in_words(", ".join(filter(None, (first.layer, first.place))), first.depth, first.x, first.y)
        beyond = ", outside the range of its tests" if first.extrapolated else ""
        why = f"{first.reads}: {first.reads.in_words(first.reading)}{beyond}"
        if not first.reading > 0:
            place, why = "", "no criterion evaluates a harmful value under this load"
        facts = [("Place", place)] if place else []
        return repetitions_answer(first.passes, first.name, [*facts, ("Why", why)], further)


def _repetitions(line: Allowed) -> str:
    words = repetitions_in_words(line.passes)
    return f" with {words} load repetitions" if line.reading > 0 else ", whose value is not harmful"


def criteria_of_layers(case: Case) -> tuple[list[Criterion], list[str]]:
    """Criteria of the French method that the road of a case has numbers for, and why the other layers have none.

    The bottom of each bituminous or hydraulic layer whose mix is in the catalogue, at the risk of the class of
    traffic T1; the top of each unbound layer of the catalogue; the top of the soil, which is a last layer that is
    none of them. A road of one material has none. Their names are those of their laws.
    """
    assert case.pavement is not None
    road = case.pavement.untempered()
    criteria: list[Criterion] = []
    plain, refused = [], []
    if len(road.layers) == 1:
        return [], ["This road is one material; laws are of layers."]
    for number in range(len(road.layers)):
        law = _law_of(road, number)
        if not law:
            plain.append(_name(road, number))
            continue
        try:
            criteria.append(_criterion(law, road, number))
        except InputError as error:
            refused.append(f"{_name(road, number)}: {str(error).removeprefix(f'{law!r}: ')}.")
    if plain:
        single = len(plain) == 1
        names = plain[0] if single else f"{', '.join(plain[:-1])} and {plain[-1]}"
        refused.insert(
            0,
            f"No law for {names}, of which only the modulus is known: choose {'a mix' if single else 'mixes'} of the "
            "catalogue, or give laws on the life page.",
        )
    return criteria, refused


def passes_allowed(load: Loaded, verdict: Verdict | None = None) -> PassesAllowed:
    """Passes of the load of a case by criterion: its own assessment, then the laws that the road's layers have.

    load: a road under its wheels, at its temperature. verdict: of the case, see `judge`; left out, none.
    A reading is the largest of one passage, anywhere across the wheels, or further as far as the basin reaches where
    the largest lies at the end of what is evaluated: no wander, no season, no other axle.
    """
    criteria, without = criteria_of_layers(load.case)
    rows = [] if verdict is None else [_judged(verdict, load.road)]
    rows += [_read(load, criterion) for criterion in criteria]
    return PassesAllowed(tuple(rows), tuple(without))


def _law_of(road: Pavement, number: int) -> str:
    """The law of a layer by its name; empty if none."""
    material = elastic_part(road.layers[number].material)
    if isinstance(material, Mix):
        return "french-bituminous"
    if isinstance(material, HydraulicMix):
        return "french-hydraulic"
    soil = number == len(road.layers) - 1 and not road.rigid_base and is_bituminous(material) is not True
    return "french-subgrade" if soil or isinstance(material, Unbound) else ""


def _criterion(law: str, road: Pavement, number: int) -> Criterion:
    """The criterion of a layer, as a life case would have it. Raises InputError."""
    material = road.layers[number].material
    if isinstance(material, HydraulicMix) and material.joints is None:
        raise InputError("joints, k_d, depend on the structure; give them on the life page")
    risk = {"french-bituminous": RISK["bituminous"][_TRAFFIC], "french-hydraulic": RISK["hydraulic"][_TRAFFIC]}
    table = {"name": law, "law": law, "layer": number + 1, **({"risk": risk[law]} if law in risk else {})}
    criterion: Criterion = CRITERION.read(table).on(road)
    criterion.depth(road)
    return criterion


def _read(load: Loaded, criterion: Criterion) -> Allowed:
    road, number = load.road, criterion.number(load.road)
    depth, grid = criterion.depth(road), common_grid(load.wheels)
    x, y = (_along(at, depth) for at in (grid.x, grid.y))
    speed = load.case.speed if road.is_viscoelastic else None

    def values_at(more_x: Array, more_y: Array) -> Array:
        data = solve_response(
            load.wheels, road, depths=[depth], x=more_x, y=more_y, side=criterion.side, speed=speed,
            mean_over=criterion.mean_over, progress=load.tell,
        ).dataset  # fmt: skip
        return criterion.read(data)

    values = values_at(x, y)
    _, row, column = index_of_largest(values)
    largest, place = float(values.max()), (float(x[column]), float(y[row]))
    beyond = beyond_the_map(values, x, y, values_at, basin_reach([road]))
    if beyond is not None and beyond.value > largest:
        largest, place = beyond.value, (beyond.x, beyond.y)
    assert load.case.pavement is not None
    temperature = load.case.pavement.layer_temperatures()[number]
    law = criterion.law_at(_ANY_TEMPERATURE if temperature is None else temperature)
    return Allowed(
        criterion.name, _name(road, number), str(criterion.place), depth, law, max(largest, 0.0), *place,
    )  # fmt: skip


def _along(at: Array, depth: float) -> Array:
    """Points, m, on the lattice of the wheels and as far beyond as a life reads: a road that bends extends there."""
    cell = float(at[1] - at[0])
    step = max(1, int(depth / _PER_DEPTH / cell))
    beyond = int(np.ceil(MARGIN / (step * cell)))
    return np.asarray(at[0] + step * cell * np.arange(-beyond, len(at) // step + beyond + 1))


def _judged(verdict: Verdict, road: Pavement) -> Allowed:
    data = verdict.dataset
    x, y, depth = (float(data[f"worst_{name}"]) for name in ("x", "y", "depth"))
    number = int(np.searchsorted(road.interfaces, depth - 1e-9)) if len(road.layers) > 1 else 0
    reading = float(data["worst_strain"])
    return Allowed(
        verdict.line.noun, _name(road, number), "", depth, verdict.line, 0.0 if math.isnan(reading) else reading, x, y
    )


def _name(road: Pavement, number: int) -> str:
    return road.layers[number].name or f"layer {number + 1}"
