"""Rows of results as the page shows them: those of `result.rows()`, each under the name of its result."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Iterable, Iterator, Mapping

from treadload.app.answers import PageRow
from treadload.app.case_schema import label_of
from treadload.case.step import step_classes
from treadload.composing import BaseResult
from treadload.contact import Contact
from treadload.damage import Life
from treadload.rows import Place, Row, row
from treadload.steps.allowed import PassesAllowed
from treadload.units import repetitions_in_words
from treadload.us_units import sentence_in_display_units
from treadload.variables import Display

"""key, label, value with its unit, heading, about (of the heading), group, note; x, y, depth, m, where it holds."""

# Shares of the damage below this are left out.
_LEAST = 0.005
# Dimension, key and heading of what the damage is shared out by.
_SHARED_OUT = (("axle_class", "by_class", "Damage by axle class"), ("season", "by_season", "Damage by season"))


@functools.cache
def quiet_groups() -> frozenset[str]:
    """Names of results that are for figures alone."""
    return frozenset(group for kind in step_classes() if kind.is_quiet for group in kind.makes)


def rows_of(parts: Mapping[str, BaseResult], criterion: str = "") -> list[PageRow]:
    """The rows of all results but those for figures alone.

    criterion: of a service life, whose damage is shared out; left out, the governing one.
    """
    quiet = quiet_groups()
    shown: list[PageRow] = []
    for name, part in parts.items():
        if name in quiet:
            continue
        about = (inspect.getdoc(type(part)) or "").partition("\n")[0]
        shown += page_rows(part.rows(), label_of(name), about)
        if isinstance(part, Life):
            for dim, key, heading in _SHARED_OUT:
                shares = _shares(part, criterion or part.governing_criterion, dim, key)
                shown += page_rows(shares, heading)
    contact = parts.get("contact")
    if isinstance(contact, Contact):
        shown += page_rows(_solver(contact), "Solver")
    keys: set[str] = set()
    for entry in shown:
        # Two results may state the same number.
        entry["key"] = f"{entry['heading']}:{entry['key']}:{entry['label']}" if entry["key"] in keys else entry["key"]
        keys.add(entry["key"])
    return shown


def page_rows(rows: Iterable[Row], heading: str, about: str = "") -> list[PageRow]:
    """Rows of one result."""
    return [_page_row(line, heading, about) for line in rows]


def warnings_of(*parts: BaseResult) -> list[str]:
    """Warnings of some results, each once, in the units of display."""
    texts = dict.fromkeys(text for part in parts for text in part.warnings)
    return [sentence_in_display_units(text) for text in texts]


def _page_row(line: Row, heading: str, about: str) -> PageRow:
    place: PageRow = {} if line.place is None else {"x": line.place.x, "y": line.place.y, "depth": line.place.depth}
    return {
        "key": f"{line.key}:{line.group}" if line.group else line.key,
        "label": sentence_in_display_units(label_of(line.label)),
        "value": line.text, "heading": heading, "about": about,
        "group": sentence_in_display_units(line.group), "note": line.remark, **place,
    }  # fmt: skip


def allowed_rows(allowed: PassesAllowed) -> list[PageRow]:
    """Load repetitions by criterion, each with its place and what is evaluated there in "detail"."""
    shown: list[PageRow] = []
    for number, line in enumerate(allowed.rows):
        is_harmed = line.reading > 0
        beyond = ", extrapolated" if line.extrapolated else ""
        reading = f"{line.reads.in_words(line.reading)}{beyond}" if is_harmed else "nothing there does harm"
        deep = "surface" if line.depth == 0 else f"{line.depth * 1e3:g} mm deep"
        place = ", ".join(part for part in (line.layer, line.place, deep) if part)
        (page_line,) = page_rows(
            [row(f"allowed:{number}", repetitions_in_words(line.passes), label=line.name,
                 place=Place(line.x, line.y) if is_harmed else None)],
            "Allowable load repetitions by criterion",
        )  # fmt: skip
        note = sentence_in_display_units(". ".join((str(line.law), *line.warnings)))
        detail = sentence_in_display_units(f"{place}: {reading}")
        shown.append({**page_line, "label": line.name, "note": note, "detail": detail})
    return shown


def _shares(life: Life, criterion: str, dim: str, key: str) -> Iterator[Row]:
    """Shares of the damage by a criterion. dim: of the damage. key: of the rows."""
    share = life.dataset["damage_share"].sel(criterion=criterion)
    totals = share.sum([name for name in share.dims if name != dim])
    for name, value in zip(totals[dim].to_numpy(), totals.to_numpy(), strict=True):
        if value >= _LEAST:
            yield row(f"{key}:{name}", value, note=f"of {criterion}", display=Display(str(name), "%", ".0f"))


def _solver(contact: Contact) -> Iterator[Row]:
    """How the contact was solved."""
    for key, label, count, steps in (
        ("normal", "normal contact", "normal_iterations", "iterations"),
        ("rolling", "rolling", "newton_iterations", "Newton steps"),
    ):
        if f"{key}_residual" in contact.stats:
            residual = f"residual {contact.stats[f'{key}_residual']:.1e}"
            yield row(key, residual, label=label, note=f"{contact.stats[count]} {steps}")
