"""The question of each case as tables: from its TOML text, or what the results remember."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping

from treadload.case import Case
from treadload.case.criteria import CRITERION, CriterionTable, quantity_of
from treadload.case.step import step_classes
from treadload.damage.quantity import Quantity
from treadload.reporting.reading import ReportCase
from treadload.reporting.tables import MISSING, NamedTable, Row, Section
from treadload.reporting.words import annotation_of, columns, entries, named_tables, part_of
from treadload.rows import Row as StatedRow

_HEADINGS = {
    "": "Computation",
    "tire": "Tire",
    "pavement": "Road",
    "rolling": "Rolling",
    "classes": "Axles",
    "criteria": "Criteria asked for",
}
_DROPPED = {"title"}
_CRITERION = ("criterion", "law", "layer", "place", "what it reads", "parameters given")
_CRITERION_KEYS = ("name", "law", "layer", "place", "strain", "reads")

Key = tuple[str, str, str]


def input_table(cases: list[ReportCase]) -> list[Section]:
    """What was asked: a row for each key that a case gives, a column for each case."""
    inputs = [_inputs_of(case) for case in cases]
    keys = list(dict.fromkeys(key for case in inputs for key in case))
    headings = list(dict.fromkeys(heading for heading, _, _ in keys))
    # The computation's own settings close the table.
    headings.sort(key=lambda heading: heading == _HEADINGS[""])
    return [
        Section(
            heading,
            tuple(
                Row(name, unit, tuple(case.get((heading, name, unit), MISSING) for case in inputs))
                for of, name, unit in keys
                if of == heading
            ),
        )
        for heading in headings
    ]


def input_lists(cases: list[ReportCase]) -> list[NamedTable]:
    """The named things that the cases ask about: axles, seasons, criteria."""
    tables = []
    for case in cases:
        table = _table(case)
        of = f": {case.label}" if len(cases) > 1 else ""
        for key, items, part in named_tables(Case, table):
            heading = _HEADINGS.get(key, key.capitalize()) + of
            if part is not None and issubclass(part, CriterionTable):
                tables.append(NamedTable(heading, _CRITERION, tuple(_criterion(case, item) for item in items)))
            else:
                tables.append(NamedTable(heading, *columns(items, part)))
    return tables


def _table(case: ReportCase) -> dict[str, object]:
    try:
        return tomllib.loads(case.toml)
    except tomllib.TOMLDecodeError:
        return {}


def _inputs_of(case: ReportCase) -> dict[Key, str]:
    rows = dict(_rows(_table(case)))
    contact = case.group("contact")
    if contact is not None:
        headings = {"tire": "Tire", "road": "Road", "rolling": "Rolling"}
        # The results' own words stand where the case is silent.
        silent = {key: heading for key, heading in headings.items() if not any(of == heading for of, _, _ in rows)}
        for key, heading in silent.items():
            if contact.attrs.get(key):
                rows[heading, "as solved", ""] = str(contact.attrs[key])
        if contact.attrs.get("tire") and "tire" not in silent:
            rows["Tire", "as solved", ""] = str(contact.attrs["tire"])
        cells = f"{contact.sizes['x']} × {contact.sizes['y']}"
        if "dx" in contact.attrs and "dy" in contact.attrs:
            dx, dy = (StatedRow(key, key, float(contact.attrs[key]), "mm", "g") for key in ("dx", "dy"))
            cells += f" of {dx.number} × {dy.text}"
        rows[_HEADINGS[""], "contact grid", ""] = cells
    return rows


def _rows(table: Mapping[str, object]) -> Iterator[tuple[Key, str]]:
    model = Case
    for section, value in table.items():
        if section in _DROPPED:
            continue
        if isinstance(value, Mapping):
            heading = _heading_of(section)
            items = entries(part_of(annotation_of(model, section), value), value)
        else:
            heading, items = _HEADINGS[""], entries(model, {section: value})
        for entry in items:
            yield (heading, entry.name, entry.unit), entry.text


def _heading_of(table: str) -> str:
    """Heading of the keys of a table of a case."""
    steps = {kind.name: kind.heading for kind in step_classes()}
    return _HEADINGS.get(table) or steps.get(table) or table.replace("_", " ").capitalize()


def _criterion(case: ReportCase, table: Mapping[str, object]) -> tuple[str, ...]:
    """Cells of `_CRITERION`; what the table leaves to the law is filled in."""
    name = str(table.get("name", ""))
    quantity = quantity_of(table)
    rest = {key: value for key, value in table.items() if key not in _CRITERION_KEYS}
    numbers = [str(entry) for entry in entries(CRITERION.table_for(table), rest)]
    place = table.get("place") or (MISSING if quantity is None else quantity.where.places[0])
    return (
        name,
        case.laws.get(name) or str(table.get("law", MISSING)).replace("-", " "),
        _layer(case, table.get("layer"), None if quantity is None else quantity.where.layer),
        str(place),
        _read(quantity, table.get("strain")),
        ", ".join(numbers) or "those of the layer",
    )


def _read(quantity: Quantity | None, strain: object) -> str:
    """What a criterion reads; of an extension whether in space or in the plane."""
    if quantity is None:
        return MISSING
    if not quantity.extends:
        return quantity.words
    space = (strain or quantity.strain) == "principal"
    return "three-dimensional tensile strain" if space else "tensile strain in the horizontal plane"


def _layer(case: ReportCase, wanted: object, usual: int | None) -> str:
    """Name of a layer, asked for by its name or its number, 1 the top one; else that which its law usually reads."""
    names = [str(layer.get("name") or f"layer {number}") for number, layer in enumerate(case.layers, start=1)]
    index = wanted - 1 if isinstance(wanted, int) else usual if wanted is None else None
    if index is None:
        return str(wanted or MISSING)
    if not names:
        return f"layer {index + 1}" if index >= 0 else "the last"
    return names[index] if -len(names) <= index < len(names) else MISSING
