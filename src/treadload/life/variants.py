"""A life asked again with other inputs: thicker, stiffer, warmer roads, and what they share as they are solved."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np

from treadload.contact.friction import Coulomb
from treadload.contact.friction.laws import FrictionLaw
from treadload.damage.climate import Climate
from treadload.damage.criterion import Criterion
from treadload.damage.miner import damage_of, wander_of
from treadload.damage.traffic import AxleClass, Traffic
from treadload.kernels.arrays import Array
from treadload.life.contacts import Contacts, Counter, Progress
from treadload.life.passage import Passing, solve_passings, turns_of
from treadload.life.seasons import Warm, layer_temperatures, of_class, warmed
from treadload.life.wheels import Wheels, across, states_of, wheels_of
from treadload.pavement import Pavement
from treadload.response.basin import basin_reach

Question = tuple[Pavement, Traffic, Climate]


def thicker(road: Pavement, number: int, factor: float) -> Pavement:
    """The road with the thickness of a layer, from 0 at the surface, times a factor."""
    layers = list(road.layers)
    thickness = layers[number].thickness
    assert thickness is not None
    layers[number] = replace(layers[number], thickness=thickness * factor)
    return Pavement(layers, rigid_base=road.rigid_base)


def each_class(traffic: Traffic, change: Callable[[AxleClass], AxleClass]) -> Traffic:
    """The traffic with every class of axles changed."""
    return replace(traffic, classes=tuple(change(row) for row in traffic.classes))


def friction_number(friction: float | FrictionLaw) -> float | None:
    """The one coefficient of a friction; None for a law that has more numbers."""
    if isinstance(friction, Coulomb):
        return friction.number
    return float(friction) if isinstance(friction, int | float) else None


def most(shares: Array, coverage: float) -> tuple[list[tuple[int, int]], float]:
    """Pairs (class, season) that do most, down to those that make the coverage full, and what they cover."""
    order = np.argsort(shares, axis=None)[::-1]
    cover = np.cumsum(shares.ravel()[order])
    count = min(int(np.searchsorted(cover, coverage * (1 - 1e-9))) + 1, len(order))
    rows, columns = np.unravel_index(order[:count], shares.shape)
    return list(zip(rows.tolist(), columns.tolist(), strict=True)), float(cover[count - 1])


def in_seasons(
    question: Question, criterion: Criterion, pairs: Sequence[tuple[int, int]]
) -> dict[tuple[int, int], Warm]:
    """The road and the criterion of the pairs (class, season), shared by classes without a road of their own."""
    road, traffic, climate = question
    shared = {s: warmed(road, (criterion,), climate.seasons[s]) for s in dict.fromkeys(s for _, s in pairs)}
    classes_of = {pair: traffic.classes[pair[0]] for pair in pairs}
    return {
        pair: warmed(road, (criterion,), climate.seasons[pair[1]], row) if of_class(road, row) else shared[pair[1]]
        for pair, row in classes_of.items()
    }


class Solver:
    """Damage of the pairs under changed questions, with contacts and roads shared between them.

    solved, responses: how many contacts and responses it took.
    """

    def __init__(
        self, criterion: Criterion, pairs: list[tuple[int, int]], contacts: Contacts, progress: Progress | None
    ) -> None:
        self.tire, self.criterion, self.pairs, self.contacts = contacts.tire, criterion, pairs, contacts
        self.progress = progress
        self.solved = self.responses = 0

    def damages(self, questions: Sequence[Question], pool: ThreadPoolExecutor) -> list[float]:
        """The largest damage of a year across the wheel path in each question."""
        rows = list(dict.fromkeys(row for row, _ in self.pairs))
        classes = [[traffic.classes[row] for row in rows] for _, traffic, _ in questions]
        states = [state for several in classes for row in several for state in states_of(row, self.tire)]
        missing = len(self.contacts.missing(states))
        self.solved, self.responses = missing, len(questions) * len(self.pairs)
        count = Counter(missing + self.responses, self.progress)
        road, _, climate = questions[0]
        first = warmed(road, (self.criterion,), climate.seasons[self.pairs[0][1]])
        self.contacts.solve(states, first.road, pool, count)
        stand: dict[Any, Wheels] = {}
        tasks = []
        for question, several in zip(questions, classes, strict=True):
            warm_roads = in_seasons(question, self.criterion, self.pairs)
            by_class = [[self.contacts.of(state) for state in states_of(row, self.tire)] for row in several]
            reach = basin_reach(warm.road for warm in warm_roads.values())
            y = across([contacts_of_class[0] for contacts_of_class in by_class], several, reach)
            wheels = {}
            for row, contacts_of_class, traffic_class in zip(rows, by_class, several, strict=True):
                key = (row, *map(id, contacts_of_class), float(y[0]))
                if key not in stand:
                    stand[key] = wheels_of(contacts_of_class, traffic_class, y)
                wheels[row] = stand[key]
            turns = turns_of(wheels.values())
            tasks += [Passing(wheels[row], warm_roads[row, season], y, turns, reach) for row, season in self.pairs]
        read = iter(zip(tasks, solve_passings(tasks, pool, count), strict=True))
        return [self._damage(question, [next(read) for _ in self.pairs]) for question in questions]

    def _damage(self, question: Question, solved: Sequence[tuple[Passing, Array]]) -> float:
        road, traffic, climate = question
        task = solved[0][0]
        values = np.zeros((1, len(traffic.classes), len(climate.seasons), task.turns, len(task.y)))
        for (row, season), (_, read) in zip(self.pairs, solved, strict=True):
            values[0, row, season] = read[0, : task.turns]
        warmth = layer_temperatures(road, (self.criterion,), climate.seasons)[0]
        laws = [[self.criterion.law_at(float(t)) for t in warmth] for _ in traffic.classes]
        for (row, season), (passing, _) in zip(self.pairs, solved, strict=True):
            warm = passing.warm
            laws[row][season] = warm.criteria[0].law_on(warm.road, float(warmth[season]))
        damage = damage_of(values, [laws], traffic, climate).sum(axis=(0, 1, 2))
        return float(wander_of(laws[0][0], traffic).spread(damage, float(task.y[1] - task.y[0])).max())
