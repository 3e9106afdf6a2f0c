"""The figures of a report with their captions under the results that they are of: what is registered."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass

from treadload.deferred import xarray as xr
from treadload.describing import class_in_words
from treadload.errors import InputError
from treadload.figure_registry import comparisons
from treadload.registry import RESULTS
from treadload.reporting.network import network_tables
from treadload.reporting.pictures import Picture, draw_all, negligible_of, pictures_of
from treadload.reporting.reading import Extra, ReportCase, groups_in_columns
from treadload.reporting.studies import study_tables
from treadload.reporting.tables import NamedTable, tables_of
from treadload.rows import from_json

# Tables of results that need more than their rows.
_TABLES: dict[str, Callable[[xr.Dataset], tuple[NamedTable, ...]]] = {
    "Sweep": study_tables,
    "Network": network_tables,
}


@dataclass(frozen=True)
class Section:
    """Results of a class under their title.

    question: of the result in a line. tables: its rows. negligible: figures that would show nothing, in sentences.
    """

    heading: str
    pictures: tuple[Picture, ...]
    question: str = ""
    tables: tuple[NamedTable, ...] = ()
    negligible: tuple[str, ...] = ()

    @property
    def is_filled(self) -> bool:
        """True where it has anything to show."""
        return bool(self.pictures or self.question or self.tables or self.negligible)


def case_sections(case: ReportCase, compared: Collection[Callable[..., object]]) -> list[Section]:
    """A section for each class of results of a case. compared: figures that show several cases already."""
    beside = _beside(case)
    by_class: dict[str, list[xr.Dataset]] = {}
    for kind in groups_in_columns():
        data = case.group(kind)
        # The years stand at the head of the page.
        if data is not None and kind != "life":
            by_class.setdefault(case.class_of(kind), []).append(data)
    sections = [
        Section(
            title_of(result),
            tuple(pictures_of(result, datasets, beside, compared)),
            negligible=tuple(negligible_of(result, datasets, beside)),
        )
        for result, datasets in by_class.items()
    ]
    sections += [_other_section(extra, beside, compared) for extra in case.extras]
    return [section for section in sections if section.is_filled]


def comparison_figures(cases: list[ReportCase]) -> tuple[list[Picture], set[Callable[..., object]]]:
    """Figures that hold several cases on one scale, none for a single case; and the functions that drew them."""
    pictures: list[Picture] = []
    compared: set[Callable[..., object]] = set()
    for comparison in comparisons():
        labelled = [(data, case.label) for case in cases if (data := _first_of(case, comparison.result)) is not None]
        if len(labelled) > 1:
            datasets = [data for data, _ in labelled]
            drawn = draw_all(comparison, datasets, [label for _, label in labelled])
            compared |= {comparison.draw} if drawn else set()
            pictures += drawn
    return pictures, compared


def title_of(result: str) -> str:
    """What a class of results is in words; of a package that is not installed, its name."""
    try:
        return str(getattr(RESULTS.find(result).target, "title", class_in_words(result)))
    except InputError:
        return class_in_words(result)


def _other_section(
    extra: Extra, beside: dict[str, xr.Dataset], compared: Collection[Callable[..., object]]
) -> Section:
    title = title_of(extra.result)
    heading = title if extra.name == extra.kind else f"{title}: {extra.name}"
    pictures = pictures_of(extra.result, [extra.dataset], {**beside, **extra.inside}, compared)
    about, special = extra.dataset.attrs, _TABLES.get(extra.result)
    tables = (*(special(extra.dataset) if special else ()), *tables_of(from_json(about.get("rows"))))
    negligible = negligible_of(extra.result, [extra.dataset], {**beside, **extra.inside})
    return Section(heading, tuple(pictures), str(about.get("heading", "")), tables, tuple(negligible))


def _beside(case: ReportCase) -> dict[str, xr.Dataset]:
    """The results of a case by kind; "case" holds its label."""
    datasets = {extra.kind: extra.dataset for extra in reversed(case.extras)} | dict(case.groups)
    if case.wheels_placed:
        # The contact lies at the origin; the stress at the surface shows the outlines of all wheels.
        datasets.pop("contact", None)
    return datasets | {"case": xr.Dataset(attrs={"label": case.label})}


def _first_of(case: ReportCase, result: str) -> xr.Dataset | None:
    """The first result of a class in a case that has the name of the class's group."""
    try:
        group = str(getattr(RESULTS.find(result).target, "group", ""))
    except InputError:
        # A comparison of results whose package is not installed.
        return None
    of_class = (extra.dataset for extra in case.extras if extra.result == result and extra.kind == group)
    data = case.group(group)
    return next(of_class, None) if data is None else data
