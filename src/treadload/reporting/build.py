"""One HTML file that tells what the cases asked, what came out, and how."""

from __future__ import annotations

import datetime
import functools
from collections.abc import Iterable, Mapping
from importlib import resources
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jinja2
import xarray as xr

from treadload._version import __version__
from treadload.errors import InputError
from treadload.files import HTML, check_suffix, check_writable, replacing
from treadload.reporting.figures import case_figures, comparison_figures
from treadload.reporting.inputs import input_lists, input_table
from treadload.reporting.life import COLUMNS as LIFE_COLUMNS
from treadload.reporting.life import life_report
from treadload.reporting.reading import ReportCase
from treadload.reporting.road import COLUMNS, road_tables
from treadload.reporting.tables import result_table, statistics_table

if TYPE_CHECKING:
    from treadload.contact import Contact
    from treadload.damage import Verdict
    from treadload.response import Response

_TITLE = "What a tire does to a road"


def write_report(cases: Mapping[str, xr.DataTree], path: str | PathLike[str], title: str = "") -> Path:
    """Write one self-contained HTML file about one or several cases.

    cases: name of each case → its tree of results, with any of the groups /contact, /response, /slice_along,
    /slice_across, /damage and /life; what is absent is left out. path: of the file. title: heading; the title of the
    case if left out. The file needs no other file and no network. Returns the path.
    Raises InputError without a case, for a tree that holds no results, or a path that cannot be written; the
    file appears whole or not at all.
    """
    if not cases:
        raise InputError("a report needs at least one case; give a name and a tree of results")
    # Found before minutes go into figures, not after.
    check_suffix(path, HTML, "the report")
    check_writable(path)
    read = [ReportCase.of(label, tree) for label, tree in cases.items()]
    html = _template().render(_content(read, title or _title(read)))
    with replacing(path) as temporary:
        # Half a character of a torn file is no text.
        temporary.write_text(html, encoding="utf-8", errors="replace")
    return Path(path)


def report(parts: Iterable[Contact | Response | Verdict], path: str | PathLike[str], *, title: str = "") -> Path:
    """Write a self-contained HTML file about one case from its results.

    parts: a Contact, Responses (maps, and slices of a single row or column) and a Verdict, those there are.
    path: of the file. title: heading. Returns the path. Raises InputError as `write_report`.
    """
    from treadload.results import to_tree

    tree = to_tree(parts, title=title)
    return write_report({title or _TITLE: tree}, path, title)


def _title(cases: list[ReportCase]) -> str:
    return cases[0].title or cases[0].label if len(cases) == 1 else _TITLE


@functools.cache
def _template() -> jinja2.Template:
    text = resources.files("treadload.reporting").joinpath("template.html.j2").read_text(encoding="utf-8")
    environment = jinja2.Environment(
        autoescape=True, trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined
    )
    return environment.from_string(text)


def _content(cases: list[ReportCase], title: str) -> dict[str, Any]:
    return {
        "title": title,
        "cases": [
            {"case": case, "anchor": f"case-{number}", "figures": case_figures(case, alone=len(cases) == 1)}
            for number, case in enumerate(cases, start=1)
        ],
        "labels": [case.label for case in cases],
        "lives": [life_report(case.label, data) for case in cases if (data := case.group("life")) is not None],
        "life_columns": LIFE_COLUMNS,
        "passes_of_one_place": any(case.group("damage") is not None for case in cases),
        "comparison": comparison_figures(cases),
        "road_columns": COLUMNS,
        "roads": road_tables(cases),
        "inputs": input_table(cases),
        "lists": input_lists(cases),
        "results": result_table(cases),
        "statistics": statistics_table(cases),
        "citations": list(dict.fromkeys(text for case in cases for text in case.citations)),
        "warnings": [(case.label, text) for case in cases for text in case.warnings],
        "version": __version__,
        "written": datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC"),
    }
