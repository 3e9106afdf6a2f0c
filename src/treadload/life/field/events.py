"""Between which ages the first crack of a section lies, from its surveys or from the ages that a table states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array, BoolArray
from treadload.life.field.table import EVENTS, Event, Interval

Events = tuple[dict[Event, Interval], BoolArray, list[str]]
"""Intervals of the events, whether each section has any, and sentences."""
_AFTER = "after the last survey"


@dataclass(frozen=True, eq=False)
class Surveyed:
    """Surveys of a section in order of age. age: years (m,). wheelpath: m of crack, alligator: m² (m,); NaN where it
    was not recorded.
    """

    age: Array
    wheelpath: Array
    alligator: Array


class Columns(Protocol):
    """Cells of a table of sections by what their columns mean."""

    names: list[str]

    def has(self, meaning: str) -> bool:
        """True if there is such a column."""

    def texts(self, meaning: str) -> list[str]:
        """Cells as they stand there."""

    def numbers(self, meaning: str) -> Array:
        """Numbers (n,), NaN in empty cells."""


def first_between(age: Array, cracked: BoolArray) -> tuple[float, float]:
    """Ages between which a crack came first: of the survey before and of the survey that shows it."""
    if not cracked.any():
        return float(age[-1]), np.inf
    first = int(np.argmax(cracked))
    return (float(age[first - 1]) if first else 0.0), float(age[first])


def events_of_surveys(surveys: Sequence[Surveyed]) -> Events:
    """The events from every survey; a crack that a later survey does not show was there all the same."""
    intervals: dict[Event, list[tuple[float, float]]] = {event: [] for event in EVENTS}
    kept = np.ones(len(surveys), dtype=bool)
    has_alligator = not all(np.isnan(survey.alligator).all() for survey in surveys)
    for k, survey in enumerate(surveys):
        amounts = {EVENTS[0]: survey.wheelpath, EVENTS[1]: np.fmax(survey.wheelpath, survey.alligator)}
        for event, amount in amounts.items():
            recorded = ~np.isnan(amount)
            kept[k] &= bool(recorded.any())
            between = first_between(survey.age[recorded], amount[recorded] > 0) if recorded.any() else (0.0, np.inf)
            intervals[event].append(between)
    events = {event: Interval(*np.array(rows).T) for event, rows in intervals.items()}
    if not has_alligator:
        del events[EVENTS[1]]
    return events, kept, _left_out(kept)


def events_of_columns(rows: Columns, entry: Array, last: Array, empty_crack: str) -> Events:
    """The events from the ages that a table of sections states. Raises InputError for an empty cell that can mean
    that no crack was seen, or that it was not recorded.
    """
    first, without = rows.numbers("first_crack"), rows.numbers("last_without")
    if not rows.has("first_crack"):
        raise InputError(
            "the table has no age of the first crack and no file of surveys; name its column in [columns] as "
            'first_crack = "…", or give surveys = "….csv"'
        )
    kinds = rows.texts("first_crack_is") if rows.has("first_crack_is") else [""] * len(entry)
    empty = np.isnan(first)
    unclear = empty & np.array([kind != _AFTER for kind in kinds])
    if unclear.any() and not empty_crack:
        name = rows.names[int(np.argmax(unclear))]
        raise InputError(
            f"{int(unclear.sum())} sections have no age of a first crack, {name!r} first: none seen until the last "
            'survey, or not recorded? Say so: empty_crack = "none seen", or "not recorded"'
        )
    kept = ~unclear if empty_crack == "not recorded" else np.ones(len(entry), dtype=bool)
    before = np.where(np.isnan(without), entry, without)
    low = np.where(empty, last, np.where(first <= entry, 0.0, np.minimum(before, first)))
    wheel = Interval(low, np.where(empty, np.inf, first))
    events = {EVENTS[0]: wheel}
    if rows.has("first_alligator"):
        alligator = rows.numbers("first_alligator")
        earlier = alligator < wheel.high
        # Of the survey before the alligator cracking only the first is known.
        since_entry = np.where(alligator <= entry, 0.0, np.minimum(entry, alligator))
        high = np.fmin(alligator, wheel.high)
        events[EVENTS[1]] = Interval(np.where(earlier, since_entry, np.minimum(wheel.low, high)), high)
    return events, kept, _left_out(kept)


def _left_out(kept: BoolArray) -> list[str]:
    lost = int((~kept).sum())
    return [f"{lost} of {len(kept)} sections are left out: their cracks were not recorded"] if lost else []
