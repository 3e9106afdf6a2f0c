"""What a report begins with: the answer of each case in a sentence, why, and the picture that shows it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import xarray as xr

from treadload.plots.sweeps.reading import View, main_readings
from treadload.reporting.figures import Section
from treadload.reporting.life import LifeReport
from treadload.reporting.pictures import Picture
from treadload.reporting.reading import ReportCase
from treadload.reporting.studies import extremes_of
from treadload.reporting.typesetting import typeset, with_minus
from treadload.rows import Row
from treadload.units import COUNTLESS, LASTS, years_in_words
from treadload.us_units import sentence_in_display_units

_NOT = "Does not govern"
_RUT = "rut"
# Letters of a fact from which on it takes the width of the card.
_LONG = 40


@dataclass(frozen=True)
class Answer:
    """The answer of a case.

    label: of the case. headline: the service life, the allowable load repetitions, or that nothing governs. sentence:
    the assessment. why: criterion, place, direction and cause. facts: (term, value, whether it is long). is_bad: the
    road fails too early. picture: shows it; None where another case's shows both.
    """

    label: str
    headline: str
    sentence: str
    why: str
    facts: tuple[tuple[str, str, bool], ...]
    is_bad: bool
    picture: Picture | None = None


def answer_of(case: ReportCase, life: LifeReport | None) -> Answer | None:
    """The answer of a case; None of results that have no assessment and no study. life: of the case, or None."""
    study = next((extra.dataset for extra in case.extras if extra.result == "Sweep"), None)
    if life is not None:
        rows = case.rows("life")
        facts, headline, why = life.facts, _of_life(rows), _why_of_life(rows)
    elif case.groups:
        rows = case.rows("damage")
        facts, headline, why = tuple(case.facts), _of_verdict(case, rows), _why_of_verdict(rows)
    elif study is not None:
        facts, (headline, why) = (), _of_study(study)
    elif case.verdict:
        facts, headline, why = (), "", ""
    else:
        return None
    sentence = case.verdict or ("" if study is not None else "The case gives no fatigue law to assess it by.")
    marked = tuple((term, value, len(value) > _LONG) for term, value in facts)
    return Answer(case.label, headline, sentence, sentence_in_display_units(why), marked, case.exhausted)


def with_picture(
    answer: Answer, life: LifeReport | None, sections: list[Section]
) -> tuple[Answer, LifeReport | None, list[Section]]:
    """An answer with its picture, which the life or the section that had it then lacks."""
    if life is not None:
        chosen, rest = _first(life.pictures)
        return replace(answer, picture=chosen), replace(life, pictures=rest), sections
    pictures = [picture for section in sections for picture in section.pictures]
    chosen, _ = _first(pictures)
    left = [
        replace(section, pictures=tuple(picture for picture in section.pictures if picture is not chosen))
        for section in sections
    ]
    return replace(answer, picture=chosen), life, [section for section in left if section.is_filled]


def _first(pictures: Sequence[Picture]) -> tuple[Picture | None, tuple[Picture, ...]]:
    """The picture that answers best, of the assessment or else a main one, and the others."""
    drawn = [picture for picture in pictures if not picture.missing]
    chosen = max(drawn, key=lambda picture: picture.rank, default=None)
    return chosen, tuple(picture for picture in pictures if picture is not chosen)


def _number(rows: Sequence[Row], key: str) -> Row | None:
    return next((row for row in rows if row.key == key and not isinstance(row.value, str)), None)


def _of_life(rows: Sequence[Row]) -> str:
    """Service life, or that no criterion governs within what roads last."""
    years = _number(rows, "governing_years")
    if years is None:
        return ""
    value = float(years.value)
    if math.isinf(value):
        return f"{_NOT}: no criterion fails under this traffic"
    return f"{_NOT}: service life of {years_in_words(value)}" if value > LASTS else f"Service life: {typeset(years)}"


def _why_of_life(rows: Sequence[Row]) -> str:
    """Place, direction and cause of what governs."""
    governing = next((str(row.value) for row in rows if row.key == "governing"), "")
    of = {row.key: row for row in rows if row.group == governing}
    if governing == _RUT or not of:
        return ""
    parts = []
    if "read_depth" in of:
        deep = float(of["read_depth"].value)
        parts.append("at the surface" if deep == 0 else f"{typeset(of['read_depth'])} deep")
    if "worst_y" in of:
        parts.append(f"y = {typeset(of['worst_y'])}")
    if "largest_reading" in of:
        parts.append(f"evaluated value {typeset(of['largest_reading'])}")
    if "first_crack" in of:
        parts.append(f"first crack {typeset(of['first_crack'])}")
    if "damage_by" in of:
        parts.append(f"most damage by {typeset(of['damage_by'])}")
    return f"{governing[:1].upper()}{governing[1:]}: {'; '.join(parts)}."


def _of_verdict(case: ReportCase, rows: Sequence[Row]) -> str:
    """Allowable load repetitions, or that the law does not govern."""
    if case.group("damage") is None:
        return "No assessment"
    passes = _number(rows, "worst_passes")
    if passes is None:
        return f"{_NOT}: no tensile stress where the strain is tensile"
    if float(passes.value) >= COUNTLESS:
        return f"{_NOT}: more than 10¹⁰ load repetitions are allowable"
    return f"Allowable load repetitions: {typeset(passes)}"


def _why_of_verdict(rows: Sequence[Row]) -> str:
    """The evaluated strain with its place, what the law allows, and the law."""
    by_key = {row.key: row for row in rows}
    if "worst_strain" not in by_key:
        return ""
    worst, ratio, law = (by_key.get(key) for key in ("worst_strain", "strain_ratio", "law"))
    assert worst is not None
    text = f"Evaluated tensile strain {typeset(worst)}"
    if worst.place is not None:
        place = with_minus(str(replace(worst.place, depth=worst.place.depth or None)))
        text += f" at {place}" + (" at the surface" if worst.place.depth == 0 else "")
    if ratio is not None:
        text += f", {typeset(ratio)} of the strain that is allowable a million times"
    return f"{text}; {typeset(law)}." if law is not None else f"{text}."


def _of_study(data: xr.Dataset) -> tuple[str, str]:
    """How many cases were solved, and the range of the first result with the cases at its ends."""
    view = View.of(data)
    solved, count = int((data["status"].to_numpy() == 1).sum()), int(data["status"].size)
    headline = f"{solved} of {count} cases solved"
    names = list(main_readings(view, 1))
    if not names or not solved:
        return headline, ""
    what, low, low_case, high, high_case = extremes_of(view, names[0])
    return headline, f"{what}: from {low} ({low_case}) to {high} ({high_case})."
