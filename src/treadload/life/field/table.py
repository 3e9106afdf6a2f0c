"""Road sections, the ages at which they were surveyed, and between which ages they cracked first."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import numpy as np

from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array, BoolArray, IntArray

Event = Literal["wheel-path", "wheel-path or alligator"]
EVENTS: tuple[Event, ...] = ("wheel-path", "wheel-path or alligator")
"""First longitudinal crack in the wheel path; the first of this crack and alligator cracking."""
FEWEST = 30
"""Sections that a fit needs at least: four parameters with intervals mean nothing for fewer."""


@dataclass(frozen=True, eq=False)
class Interval:
    """Ages between which the event of each section lies: low < age ≤ high, (n,), years.

    low: 0 where the first survey shows the crack. high: inf where the last survey shows none.
    """

    low: Array
    high: Array

    def at(self, rows: IntArray | BoolArray) -> Interval:
        """The intervals of some sections."""
        return Interval(self.low[rows], self.high[rows])


@dataclass(frozen=True, eq=False)
class SectionTable:
    """Road sections with what is known of each, in SI units.

    name: of the table. sections: names (n,). entry, last: ages at the first and the last survey (n,), years. events:
    the interval of each event that the table knows, see `EVENTS`. thickness: of the asphalt (n,), m; traffic:
    standard axles a year (n,); mean_air: of the year (n,), °C; NaN where it is missing. family: of the base (n,), ""
    where it is missing. surveys: ages of all surveys of each section, years. title, source, caveats: of the table.
    warnings: sentences about what is missing. predictions: file of ages
    that mechanics predicted for them. priors: keys of `Priors` where the table states them.

    >>> table = tl.life.field_tables["LTPP"]
    >>> thick = table.at(table.thickness > 0.2)
    >>> f"{len(thick.sections)} of {len(table.sections)} sections have more than 200 mm of asphalt"
    '38 of 149 sections have more than 200 mm of asphalt'
    """

    name: str
    sections: tuple[str, ...]
    entry: Array
    last: Array
    events: Mapping[Event, Interval]
    thickness: Array
    traffic: Array
    mean_air: Array
    family: tuple[str, ...]
    surveys: tuple[Array, ...]
    title: str = ""
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)
    warnings: tuple[str, ...] = field(default=(), repr=False)
    predictions: Path | None = field(default=None, repr=False)
    priors: Mapping[str, object] = field(default_factory=dict, repr=False)

    def __len__(self) -> int:
        return len(self.sections)

    def interval(self, event: Event) -> Interval:
        """The interval of an event. Raises InputError for one that the table does not know."""
        if event not in self.events:
            raise InputError(f"the table {self.name!r} has no event {event!r}; {nearest(event, self.events)}")
        return self.events[event]

    def at(self, rows: IntArray | BoolArray) -> SectionTable:
        """Some of the sections. rows: indices, or True for each that stays."""
        chosen = np.arange(len(self))[rows]
        return SectionTable(
            self.name,
            tuple(self.sections[k] for k in chosen),
            self.entry[chosen],
            self.last[chosen],
            {event: interval.at(chosen) for event, interval in self.events.items()},
            self.thickness[chosen],
            self.traffic[chosen],
            self.mean_air[chosen],
            tuple(self.family[k] for k in chosen),
            tuple(self.surveys[k] for k in chosen),
            self.title,
            self.source,
            self.caveats,
            self.warnings,
            self.predictions,
            self.priors,
        )

    def check_fit(self) -> None:
        """Raise InputError for fewer sections than a fit needs."""
        if len(self) < FEWEST:
            raise InputError(
                f"the table {self.name!r} has {len(self)} sections, and a fit needs at least {FEWEST}; add sections, "
                "or only look at it: `treadload field --look`, `tl.life.field_look`"
            )
