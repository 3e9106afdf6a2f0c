"""What a report begins with: the answer of each case and the picture that shows it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from treadload.damage.answer import Answer, fatigue_answer, life_answer
from treadload.deferred import xarray as xr
from treadload.plots.sweeps.reading import View, main_readings
from treadload.reporting.figures import Section
from treadload.reporting.life import LifeReport
from treadload.reporting.pictures import Picture
from treadload.reporting.reading import ReportCase
from treadload.reporting.studies import extremes_of
from treadload.reporting.typesetting import typeset_text

# Letters of a fact from which on it takes the width of the card.
_LONG = 40


@dataclass(frozen=True)
class CaseAnswer:
    """The answer of a case.

    label: of the case. headline: the service life, the allowable load repetitions, or that nothing governs. sentence:
    on a case without such an assessment. facts: (term, value, whether it is long). further: criteria that do not
    govern. is_bad: the road fails too early. picture: shows it; None where another case's shows both.
    """

    label: str
    headline: str
    sentence: str
    facts: tuple[tuple[str, str, bool], ...]
    further: str
    is_bad: bool
    picture: Picture | None = None


def answer_of(case: ReportCase, life: LifeReport | None) -> CaseAnswer | None:
    """The answer of a case; None of results that have no assessment and no study. life: of the case, or None."""
    study = next((extra.dataset for extra in case.extras if extra.result == "Sweep"), None)
    answer, headline, sentence, further = _assessed(case), "", case.verdict, ""
    facts = list(case.facts if life is None else life.facts)
    if answer is not None:
        shown = answer.written(typeset_text)
        headline, sentence, further, facts = shown.headline, "", shown.further, [*shown.facts, *facts]
    elif case.groups:
        headline, sentence = "No assessment", sentence or "The case gives no fatigue law to assess it by."
    elif study is not None:
        headline, sentence = _of_study(study)
    elif not case.verdict:
        return None
    marked = tuple((term, value, len(value) > _LONG) for term, value in facts)
    return CaseAnswer(case.label, headline, sentence, marked, further, case.exhausted)


def _assessed(case: ReportCase) -> Answer | None:
    """The answer of the service life of a case, else that of its fatigue law."""
    life, damage = case.group("life"), case.group("damage")
    # Files of another writer may have no rows.
    if life is not None:
        return life_answer(life, rows) if (rows := case.rows("life")) else None
    return None if damage is None else fatigue_answer(damage, case.rows("damage"))


def with_picture(
    answer: CaseAnswer, life: LifeReport | None, sections: list[Section]
) -> tuple[CaseAnswer, LifeReport | None, list[Section]]:
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
