"""The answer of an assessment: label and number, governing criterion, place, direction, why; for all who show it.

A summary contains the answer as a sentence; the page's card and the report show its headline and its facts.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from treadload.damage.cracks import nothing_opens
from treadload.deferred import xarray as xr
from treadload.rows import Row
from treadload.units import COUNTLESS, LASTS, repetitions_in_words, years_in_words

State = Literal["meets", "short", "open"]
SERVICE_LIFE, REPETITIONS, NOT = "Service life", "Allowable load repetitions", "Does not govern"
_CRITERION, _GOVERNING = "Criterion", "Governing criterion"
RUT = "rut"
"""What a life calls its rut among what ends it."""
# Criteria beside the governing one that an answer lists.
_MOST = 5


@dataclass(frozen=True)
class Answer:
    """The answer of an assessment, in SI units.

    label: `SERVICE_LIFE`, `REPETITIONS` or `NOT`. value: the number, or why nothing governs. state: "meets" or
    "short" of the design life, "open" where none is given. facts: (term, text). further: criteria that do not govern.
    """

    label: str
    value: str
    state: State
    facts: tuple[tuple[str, str], ...] = ()
    further: str = ""

    @property
    def headline(self) -> str:
        """Label and value."""
        return f"{self.label}: {self.value}"

    @property
    def first_line(self) -> str:
        """The headline and the criterion that it is about."""
        facts = dict(self.facts)
        criterion = facts.get(_GOVERNING, facts.get(_CRITERION))
        return f"{self.headline} ({criterion})" if criterion else self.headline

    @property
    def sentence(self) -> str:
        """All of it as text."""
        parts = [self.headline, *(f"{term}: {text}" for term, text in self.facts)]
        return f"{'. '.join([*parts, *filter(None, [self.further])])}."

    def written(self, write: Callable[[str], str]) -> Answer:
        """The answer with each of its texts as another writes it, as in other units."""
        facts = tuple((term, write(text)) for term, text in self.facts)
        return replace(self, value=write(self.value), facts=facts, further=write(self.further))


def life_answer(data: xr.Dataset, rows: Sequence[Row]) -> Answer:
    """The answer of a service life. data: of a `Life`. rows: of it, from its criteria to "governing_years"."""
    alone = {row.key: row for row in rows if not row.group}
    governing, years = str(alone["governing"].value), float(alone["governing_years"].value)
    by_criterion: dict[str, dict[str, Row]] = {}
    for row in rows:
        if row.group:
            by_criterion.setdefault(row.group, {})[row.key] = row
    further = [_years(name, of) for name, of in by_criterion.items() if name != governing]
    if math.isinf(years):
        return Answer(NOT, "no criterion fails under this traffic", "meets", (), listed(further))
    lasts = years > LASTS
    design = data.attrs.get("design_years")
    state: State = "open" if design is None else "short" if years < float(design) else "meets"
    of = by_criterion.get(governing, {})
    facts = list(_design(design, years, of))
    facts.append((_CRITERION if lasts else _GOVERNING, governing))
    facts += _rut(alone) if governing == RUT else _of_criterion(of)
    if governing in json.loads(data.attrs.get("surface_lines", "{}")):
        facts.append(("Caveat", "years at the surface rank alternatives and are no forecast, see what roads show"))
    words = years_in_words(years)
    label, value = (NOT, f"service life of {words}") if lasts else (SERVICE_LIFE, words)
    return Answer(label, value, state, tuple(facts), listed(further))


def _design(design: float | None, years: float, of: dict[str, Row]) -> Iterator[tuple[str, str]]:
    """How a service life compares with the design life."""
    if design is None:
        return
    whole = f"{float(design):g} years"
    if years < float(design):
        yield "Design life", f"{whole}, not reached: {years_in_words(float(design) - years)} too short"
    else:
        damage = f" with a damage of {of['design_damage'].text}" if "design_damage" in of else ""
        yield "Design life", f"{whole}, reached{damage}"


def _rut(alone: dict[str, Row]) -> Iterator[tuple[str, str]]:
    yield "Why", "; ".join(f"{alone[key].label} {alone[key].sentence}" for key in ("rut_years", "rut_depth"))


def _of_criterion(of: dict[str, Row]) -> Iterator[tuple[str, str]]:
    """Place, direction and cause of a criterion of a life. of: its rows by key."""
    if "worst_y" in of:
        layer, depth = (of["read_depth"].note, float(of["read_depth"].value)) if "read_depth" in of else ("", None)
        yield "Place", place_in_words(layer, depth, None, float(of["worst_y"].value))
    if "first_crack" in of:
        yield "Direction", of["first_crack"].text
    if "largest_reading" in of:
        reading = of["largest_reading"]
        by = f"; most damage by {of['damage_by'].text}" if "damage_by" in of else ""
        yield "Why", f"{reading.note or reading.label}: {reading.text}{by}"


def _years(name: str, of: dict[str, Row]) -> str:
    years, passes = (float(of[key].value) if key in of else math.nan for key in ("life_years", "life_passes"))
    repetitions = f" or {repetitions_in_words(passes)} load repetitions" if math.isfinite(passes) else ""
    return f"{name} with {years_in_words(years)}{repetitions}"


def listed(criteria: Sequence[str]) -> str:
    """Criteria that do not govern, in words; empty without any."""
    more = [f"and {len(criteria) - _MOST} more"] if len(criteria) > _MOST else []
    return f"{NOT}: {'; '.join([*criteria[:_MOST], *more])}" if criteria else ""


def fatigue_answer(data: xr.Dataset, rows: Sequence[Row]) -> Answer:
    """The answer of an assessment by one fatigue law. data: of a `Verdict`. rows: of it."""
    of = {row.key: row for row in rows}
    law, worst = of["law"].text, of.get("worst_strain")
    if worst is None or worst.place is None:
        why = nothing_opens(float(data.attrs.get("largest_unread", 0.0))).rstrip(".")
        facts = (_CRITERION, law), ("Why", why)
        return Answer(NOT, "no tensile stress where the strain is tensile", "meets", facts)
    trace = f", trace {of['worst_crack_angle'].number}° from travel" if "worst_crack_angle" in of else ""
    facts_of = (
        ("Place", place_in_words("", worst.place.depth, worst.place.x, worst.place.y)),
        ("Direction", f"{of['worst_crack_orientation'].text}{trace}"),
        ("Why", f"{of['evaluation'].text.partition(', at depth')[0]}: {worst.text}, {of['strain_ratio'].text} of the "
                "strain that is allowable a million times"),
    )  # fmt: skip
    return repetitions_answer(float(of["worst_passes"].value), law, facts_of)


def repetitions_answer(
    repetitions: float, criterion: str, facts: Sequence[tuple[str, str]], not_governing: Sequence[str] = ()
) -> Answer:
    """The answer of allowable load repetitions by the criterion that allows the fewest. facts: without its name."""
    if repetitions >= COUNTLESS:
        more = "more than 10¹⁰ load repetitions are allowable"
        return Answer(NOT, more, "meets", ((_CRITERION, criterion), *facts), listed(not_governing))
    words, named = repetitions_in_words(repetitions), (_GOVERNING, criterion)
    return Answer(REPETITIONS, words, "open", (named, *facts), listed(not_governing))


def place_in_words(layer: str, depth: float | None, x: float | None, y: float) -> str:
    """A place of a road. layer: its name and where in it, may be empty. depth, x, y: m, None where not known."""
    deep = "" if depth is None else "surface" if depth == 0 else f"{1e3 * depth:.4g} mm deep"
    along = "" if x is None else f"x = {1e3 * x:z.0f} mm, "
    at = f"{along}y = {1e3 * y:z.0f} mm"
    return "; ".join(filter(None, (", ".join(filter(None, (layer, deep))), at)))
