"""What a page and the process that solves tell each other: questions and answers as JSON holds them."""

from __future__ import annotations

from typing import TypedDict

from treadload.templates import KINDS

SOLVES = (*KINDS, "sweep", "network")
"""Questions that solve, one at a time in a process; all others are answered meanwhile."""

MOST_CASES = 200
"""Cases of a study that a page starts; more are solved by the command line, which goes on after an interruption."""


class PageRow(TypedDict, total=False):
    """A row of a panel. key: of the row. label, value, note: as shown. heading, about: of its block and a tip on it.

    group: of rows under one label. x, y, depth: of its place, m. detail: a sentence below it.
    """

    key: str
    label: str
    value: str
    note: str
    heading: str
    about: str
    group: str
    x: float
    y: float
    depth: float | None
    detail: str


class Picture(TypedDict, total=False):
    """A figure as a picture. url: of it, "" where it could not be drawn, of which `missing` states the reason."""

    title: str
    wide: bool
    url: str
    missing: str


class Allowed(TypedDict, total=False):
    """Load repetitions by criterion, and sentences on them."""

    rows: list[PageRow]
    notes: list[str]


class Card(TypedDict):
    """The answer at a glance. state: "meets" or "short" of the design life, "open" where none is given.

    facts: term and text each. further: criteria that do not govern, "" without any. map: what the brightest spot of
    the map is, "" of a run without one.
    """

    state: str
    headline: str
    facts: list[tuple[str, str]]
    further: str
    map: str


class Dimension(TypedDict):
    """A dimension of a study. words: what it is. values: in words."""

    name: str
    words: str
    values: list[str]


class RankedSection(TypedDict):
    """A section of a network as its table shows it, in words. station: km. governing: or why it failed."""

    number: int
    rank: str
    section: str
    station: str
    age: str
    remaining: str
    service_life: str
    governing: str


class Drop(TypedDict):
    """A drop of a result of basins, as a list shows it."""

    number: int
    station: str
    load: str
    misfit: str
    status: str


class View(TypedDict, total=False):
    """What the maps show: both fields, the number of the depth, pixels across, the ends of the slice, m."""

    left: str
    right: str
    depth: int
    width: float
    line: list[float] | None


class Answer(TypedDict, total=False):
    """An answer of the process, with what its question asks for.

    done, error, stopped: of the last to a question. stage, seconds, process: of progress, with the time and the
    processor time since the question. part, ready: a result that is there, all of them. figures: JSON of plotly.
    dims, readings, fields, summary: of a study. drops: of basins. sections: of a network.
    """

    id: int
    done: bool
    error: str
    stopped: bool
    stage: str
    seconds: float
    process: float
    part: str
    ready: bool
    run: str
    figures: dict[str, str]
    rows: list[PageRow]
    warnings: list[str]
    choices: dict[str, str]
    depths: list[float]
    criteria: list[str]
    allowed: Allowed
    card: Card | None
    pictures: dict[str, Picture]
    picture: Picture
    titles: dict[str, str]
    lacks_section: bool
    file: str
    dims: list[Dimension]
    drops: list[Drop]
    sections: list[RankedSection]
    readings: dict[str, str]
    fields: dict[str, str]
    summary: list[str]
