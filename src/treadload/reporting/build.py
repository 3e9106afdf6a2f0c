"""One HTML file with the inputs of the cases, their results, and the methods."""

from __future__ import annotations

import datetime
import functools
from collections.abc import Iterable, Mapping
from importlib import resources
from os import PathLike
from pathlib import Path
from typing import Any, cast

import jinja2

from treadload._version import __version__
from treadload.composing import result_classes
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.files import HTML, check_suffix, check_writable, write_whole
from treadload.reporting.answer import answer_of, with_picture
from treadload.reporting.figures import case_sections, comparison_figures
from treadload.reporting.first import first_of_response
from treadload.reporting.inputs import input_lists, input_table
from treadload.reporting.life import least_work, life_report, work_columns
from treadload.reporting.reading import ReportCase, kind_of
from treadload.reporting.road import road_columns, road_tables
from treadload.reporting.tables import result_table, statistics_table
from treadload.results import Study, as_tree, bibtex, to_tree
from treadload.results.tree import QUESTIONS
from treadload.us_units import sentence_in_display_units

_TITLE = "What a tire does to a road"


def write_report(cases: Mapping[str, object], path: str | PathLike[str], title: str = "") -> Path:
    """Write one self-contained HTML file about one or several cases.

    cases: name of each case → its tree of results, or whatever `save_results` takes; several results of a kind in
    one tree stand side by side as cases. path: of the file. title: heading; the title of the case if left out. The
    file needs no other file and no network. A figure that cannot be drawn leaves a sentence that states why. Returns
    the path.
    Raises InputError without a case, for a tree that holds no results, or a path that cannot be written; the
    file appears whole or not at all.
    """
    if not cases:
        raise InputError("a report needs at least one case; give a name and a tree of results")
    # Found before minutes go into figures, not after.
    check_suffix(path, HTML, "the report")
    check_writable(path)
    read = [case for label, source in cases.items() for case in ReportCase.all_of(label, as_tree(source))]
    html = _template().render(_content(read, title or _title(read)))
    return write_whole(path, html)


def report(results: object, path: str | PathLike[str], *, title: str = "") -> Path:
    """Write a self-contained HTML file about results.

    results: of any verb: one, a list, or a mapping of names to them; contacts, responses, assessments, lives, the
    result of a case, what `open_results` read. Results of a case, trees and opened files stand side by side as cases
    of their own. path: of the file. title: heading. Returns the path. Raises InputError as `write_report`.

    >>> tl.report([], "report.html")
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: a report needs at least one case; give a name and a tree of results
    """
    named: Mapping[str, object]
    if isinstance(results, Mapping):
        named = results
    else:
        several = (
            isinstance(results, Iterable) and not _is_whole(results) and not isinstance(results, xr.Dataset | str)
        )
        members: list[object] = list(cast("Iterable[object]", results)) if several else [results]
        named = {f"{number}": result for number, result in enumerate(members)}
    cases: dict[str, Any] = {}
    single: dict[str, Any] = {}
    for name, result in named.items():
        if _is_whole(result):
            tree = as_tree(result)
            label = name if named is results else str(tree.attrs.get("title") or title or _TITLE)
            cases[label if label not in cases else f"{label} ({name})"] = tree
        else:
            single[name] = result
    if single:
        tree = to_tree(single if named is results else list(single.values()), title=title)
        cases = {title or _untitled(tree): tree} | cases
    return write_report(cases, path, title)


def _is_whole(source: object) -> bool:
    """True for what holds several results of one question."""
    return isinstance(source, xr.DataTree | Study)


def _untitled(tree: xr.DataTree) -> str:
    """What results without a case are about: by the one kind that they are of."""
    nodes = [(str(name), node.attrs) for name, node in tree.children.items() if node.data_vars and name != QUESTIONS]
    kinds = {kind_of(name, attrs) for name, attrs in nodes if not attrs.get("part_of")}
    subjects = {kind.group: kind.subject for kind in result_classes().values()}
    return (subjects.get(kinds.pop()) if len(kinds) == 1 else "") or _TITLE


def _title(cases: list[ReportCase]) -> str:
    return cases[0].title or cases[0].label if len(cases) == 1 else _TITLE


@functools.cache
def _template() -> jinja2.Template:
    text = resources.files("treadload.reporting").joinpath("template.html.j2").read_text(encoding="utf-8")
    environment = jinja2.Environment(
        autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined
    )
    # Sentences in the units of display.
    environment.filters["sentence"] = sentence_in_display_units
    return environment.from_string(text)


def _content(cases: list[ReportCase], title: str) -> dict[str, object]:
    side_by_side, compared = comparison_figures(cases)
    # On one scale: a picture of all cases answers for each of them.
    drawn = [picture for picture in side_by_side if not picture.missing]
    of_all = max(drawn, key=lambda picture: picture.rank, default=None)
    answers, lives, sections = [], [], []
    for case in cases:
        data = case.group("life")
        life = life_report(case.label, data) if data is not None else None
        of_case, answer = case_sections(case, compared), answer_of(case, life)
        if answer is not None and (of_all is None or life is not None):
            answer, life, of_case = with_picture(answer, life, of_case)
        answers += [answer] if answer is not None else []
        lives += [life] if life is not None else []
        sections.append(of_case)
    return {
        "title": title,
        "answers": answers,
        "answer_of_all": of_all,
        "cases": [
            {
                "case": case,
                "anchor": f"case-{number}",
                "sections": sections[number - 1],
            }
            for number, case in enumerate(cases, start=1)
        ],
        "labels": [case.label for case in cases],
        "lives": lives,
        "work_columns": work_columns(),
        "least_work": least_work(),
        "passes_of_one_place": any(case.group("damage") is not None for case in cases),
        "firsts": [
            (case.label, page)
            for case in cases
            if case.group("life") is None
            and (data := case.group("response")) is not None
            and (page := first_of_response(data)) is not None
        ],
        "comparison": [picture for picture in side_by_side if picture is not of_all],
        "road_columns": road_columns(),
        "roads": road_tables(cases),
        "inputs": input_table(cases),
        "lists": input_lists(cases),
        "results": result_table(cases),
        "statistics": statistics_table(cases),
        "citations": list(dict.fromkeys(text for case in cases for text in case.citations)),
        "bibtex": bibtex(text for case in cases for text in case.citations),
        "warnings": [(case.label, text) for case in cases for text in case.warnings],
        "version": __version__,
        "written": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC"),
    }
