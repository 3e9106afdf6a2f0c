"""Contacts of a traffic: each state solved once, and near ones from each other."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from typing import TypeVar

from treadload.contact import Contact
from treadload.contact.maneuver import STRAIGHT
from treadload.life.wheels import State, contact_in_state, has_side_force
from treadload.pavement import Pavement
from treadload.tire import Tire

Solved = TypeVar("Solved")
# Cells of a tread from which on contacts gain from threads: smaller ones wait for each other at every step and take
# up to half as long again on two threads as on one, measured.
_MANY_CELLS = 80_000
Progress = Callable[[int, int, str], None]
"""Called with (done, of how many, what) after each solve of a contact or a response."""


class Counter:
    """How many solves of a total are done; threads may count at once."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self.total = total
        self._done = itertools.count(1)
        self._tell = progress or (lambda done, total, what: None)

    def after(self, result: Solved, what: str) -> Solved:
        """The result of one solve, counted."""
        self._tell(next(self._done), self.total, what)
        return result


@dataclass(frozen=True, eq=False)
class Contacts:
    """Contacts of a tire with a road, on cells of a spacing, m; those solved are known.

    halved: True where wheels with a side force stand on cells half as large, see `life.halving`.
    """

    tire: Tire
    spacing: float
    solved: dict[State, Contact] = field(default_factory=dict)
    halved: bool = False

    def on_halved_cells(self) -> Contacts:
        """The same contacts, where those with a side force are solved and read on cells half as large."""
        return replace(self, halved=True)

    def of(self, state: State) -> Contact:
        """The contact of a state, which is known."""
        return self.solved[self._on_its_cells(state)]

    def missing(self, states: Sequence[State]) -> list[State]:
        """Those of some states that are not known yet, each once, on their cells."""
        return [state for state in dict.fromkeys(map(self._on_its_cells, states)) if state not in self.solved]

    def solve(self, states: Sequence[State], road: Pavement, pool: Executor, count: Counter) -> None:
        """Make the missing ones known, each from the nearest one known before in the same maneuver.

        One maneuver under each load first: the others begin at its pressure, which shear hardly changes. road: in any
        season, its moduli do not matter. Which one is the nearest does not depend on the order in which threads come
        to their end.
        """

        def touch(pair: tuple[State, Contact | None]) -> Contact:
            solved = contact_in_state(self.tire, road, pair[0], self.spacing, start=pair[1])
            return count.after(solved, "contact")

        missing = self.missing(states)
        large = all(self._cells(state) > _MANY_CELLS for state in missing)
        each = pool.map if large else map
        firsts = list({state._replace(maneuver=STRAIGHT): state for state in reversed(missing)}.values())
        for wave in (firsts[::-1], missing):
            starts = [(state, self._near(state)) for state in self.missing(wave)]
            self.solved.update(zip((state for state, _ in starts), each(touch, starts), strict=True))

    def _cells(self, state: State) -> float:
        """About how many cells the tread of a state has."""
        return math.prod((state.tire or self.tire).extent) / state.cell(self.spacing) ** 2

    def _on_its_cells(self, state: State) -> State:
        """The state on halved cells where it has a side force and contacts are halved."""
        return state._replace(halved=True) if self.halved and has_side_force(state.maneuver) else state

    def _near(self, state: State) -> Contact | None:
        """The contact known whose load and pressure are nearest, relatively; None without one."""
        alike_cells = [earlier for earlier in self.solved if earlier.halved == state.halved]
        of_tire = [earlier for earlier in alike_cells if earlier.tire == state.tire]
        alike = [earlier for earlier in of_tire if earlier.maneuver == state.maneuver]
        # Of another maneuver the pressure alone serves, and that under the same load.
        alike = alike or [earlier for earlier in of_tire if earlier.numbers == state.numbers]

        def apart(candidate: State) -> float:
            pairs = zip(state.numbers, candidate.numbers, strict=True)
            return sum(abs(math.log(here / another)) for here, another in pairs)

        return self.solved[min(alike, key=apart)] if alike else None
