"""What a worker does, here or on another machine: solve one case, and keep what the next one can use."""

from __future__ import annotations

import json
import threading
import time
from collections import OrderedDict, deque
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, TypeVar, Unpack

from treadload.case import Case
from treadload.case.keys import with_values
from treadload.contact import Contact
from treadload.errors import TreadloadError, one_line
from treadload.life.contacts import Contacts
from treadload.life.seasons import warmed
from treadload.pavement import Pavement
from treadload.steps.design import spacing_of
from treadload.steps.loaded import CellKeys, Progress, contact_of
from treadload.sweeps.parts import Parts
from treadload.sweeps.record import Record
from treadload.sweeps.selection import Selector, read
from treadload.tire import Tire

# Contacts and tires that a worker keeps for cases that share them.
_KEPT = 4
# Keys of rolling that leave where it is pressed on.
TANGENTIAL = ("friction", "tractive_force", "creepage_x", "lateral_force", "creepage_y", "spin")
# Keys of a traffic that no contact depends on.
_NO_CONTACT = ("passes_per_year", "growth", "growth_years", "kind", "years", "wander", "standard_axle")
# Spacing and offset of a contact's cells, None where they are the case's own.
Cells = tuple[float | None, tuple[float, float] | None]


@dataclass(frozen=True)
class Question:
    """What all cases of a study share.

    table: of the base case. folder: that its paths start from. selectors: what is kept.
    anchor: values of the keys of rolling that the study varies: a case starts from the contact with these.
    """

    table: Mapping[str, Any]
    folder: Path
    selectors: tuple[Selector, ...] = ()
    anchor: Mapping[str, Any] = field(default_factory=dict)


class Worker:
    """Solves cases of one question. Contacts that several of them share are solved once."""

    def __init__(self, question: Question) -> None:
        self.question = question
        # By what the cases share, on which cells.
        self._contacts: OrderedDict[str, dict[Cells, Contact | TreadloadError]] = OrderedDict()
        self._tires: OrderedDict[str, Tire] = OrderedDict()
        self._lives: deque[tuple[str, object, Contacts]] = deque(maxlen=_KEPT)

    def solve(self, number: int, values: Mapping[str, object]) -> Record:
        """The record of a case. What fails is recorded with its reason, and so is what nobody foresaw."""
        began = time.perf_counter()
        try:
            parts = self._parts(values)
            numbers, fields, coordinates = read(parts, self.question.selectors)
        except (TreadloadError, ArithmeticError, ValueError, LookupError, TypeError, AttributeError) as error:
            expected = isinstance(error, TreadloadError)
            reason = str(error) if expected else f"{type(error).__name__}: {error}"
            return Record(number, time.perf_counter() - began, failure=one_line(reason))
        except MemoryError:
            return Record(number, time.perf_counter() - began, failure="out of memory; use a larger spacing")
        seconds = time.perf_counter() - began
        return Record(number, seconds, numbers, fields, coordinates, parts.warnings)

    def _parts(self, values: Mapping[str, object]) -> Parts:
        question = self.question
        table = with_values(question.table, values)
        case = Case.from_dict(table, folder=question.folder)
        if case.rolling is None:
            return Parts(case, contacts=self._contacts_of_life(case))
        return Parts(case, contact=self._contact(case), touch=self._touch)

    def _contact(self, case: Case) -> Contact:
        """The contact of a case, which cases that only read it elsewhere share."""
        start = None
        if self.question.anchor:
            try:
                near = Case.from_dict(with_values(case.as_tables(), self.question.anchor), folder=case.folder)
                start = self._touch(near, None, _quiet)
            except TreadloadError:
                # A start is a help; a case is solved without it where there is none.
                start = None
        return self._touch(case, None, _quiet, start=start)

    def _touch(
        self,
        case: Case,
        road: Pavement | None,
        tell: Progress,
        *,
        start: Contact | None = None,
        **cells: Unpack[CellKeys],
    ) -> Contact:
        """What `contact_of` gives on `cells`, solved once for all cases that differ behind it.

        road: of the case; None where it is not built yet.
        """
        behind = {"title", *(step.name for step in case.steps if not step.shapes_contact)}
        key = json.dumps(
            {name: part for name, part in case.as_tables().items() if name not in behind}, sort_keys=True
        )
        solved = self._contacts.get(key, {})
        _remember(self._contacts, key, solved)
        on = (cells.get("spacing"), cells.get("offset"))
        if on not in solved:
            try:
                road = case.road() if road is None else road
                cells.setdefault("tire", self._tire(case))
                solved[on] = contact_of(case, road, tell, start=start, **cells)
            except TreadloadError as error:
                solved[on] = error
        earlier = solved[on]
        if isinstance(earlier, TreadloadError):
            raise earlier
        return earlier

    def _contacts_of_life(self, case: Case) -> Contacts | None:
        """The contacts of a service life, solved once for all cases whose traffic rolls on the same surface.

        None for a case without traffic. The road enters a contact by the material of its surface alone, so that the
        numbers are those of each case by itself.
        """
        if case.traffic is None or case.tire is None:
            return None
        table = case.as_tables()
        traffic = table["traffic"]
        assert isinstance(traffic, dict)
        traffic = {name: part for name, part in traffic.items() if name not in _NO_CONTACT}
        surface = warmed(case.road(), (), case.build_climate().seasons[0]).road.surface_material
        key = json.dumps([table["tire"], traffic, table["climate"], table.get("ageing"), spacing_of(case)],
                         sort_keys=True, default=str)  # fmt: skip
        for kept_key, kept_surface, contacts in self._lives:
            # Round-off would be lost in a text.
            if kept_key == key and kept_surface == surface:
                return contacts
        contacts = Contacts(case.build_tire(), spacing_of(case))
        self._lives.append((key, surface, contacts))
        return contacts

    def _tire(self, case: Case) -> Tire:
        """The tire of a case; its scan is read once, whatever inflates it."""
        whole = case.as_tables()["tire"]
        assert isinstance(whole, dict)
        table = {name: value for name, value in whole.items() if name != "inflation_pressure"}
        key = json.dumps(table, sort_keys=True)
        tire = self._tires.get(key) or case.build_tire()
        _remember(self._tires, key, tire)
        assert case.tire is not None
        return replace(tire, inflation_pressure=case.tire.inflation_pressure)


def _quiet(text: str) -> None:
    """Progress of a study is counted in cases."""


Kept = TypeVar("Kept")


def _remember(kept: OrderedDict[str, Kept], key: str, value: Kept) -> None:
    """Keep a value as the newest, and forget the oldest of too many."""
    kept[key] = value
    kept.move_to_end(key)
    while len(kept) > _KEPT:
        kept.popitem(last=False)


# Of a thread that works for another: its worker, by the name of the question that it is for.
_HERE = threading.local()


def solve_of(question: Question, name: str, number: int, values: Mapping[str, object]) -> Record:
    """The record of a case of a question.

    name: of the question; what its cases share is kept by the thread as long as it is asked the same.
    """
    if getattr(_HERE, "name", None) != name:
        _HERE.name, _HERE.worker = name, Worker(question)
    record: Record = _HERE.worker.solve(number, values)
    return record
