"""The form: it is a case. Tables as a TOML file holds them, which of their keys are the user's, and what is wrong."""

from __future__ import annotations

import copy
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath, PureWindowsPath
from typing import Self, cast

import tomli_w

from treadload.app.case_schema import CaseSchema, value_at
from treadload.app.form_field import Field
from treadload.app.form_parts import Group, form_of
from treadload.case import Case
from treadload.case.changes import changed, set_key
from treadload.case.keys import value_at as value_in
from treadload.errors import InputError
from treadload.files import parse_toml
from treadload.read import by_key
from treadload.tire import TreadProfile

# Texts that are never the path of a file.
_WORDS = ("title", "name", "source", "notes", "caveats")
# A road whose mixes wait for a temperature gets this one.
_TEMPERATURE, _USUAL = "pavement.temperature", 15


@dataclass(frozen=True)
class Checked:
    """What the reader of cases says of a form: the case, or sentences by the path of their key, "" of the whole."""

    case: Case | None
    wrong: Mapping[str, str]


@dataclass(frozen=True)
class Form:
    """Tables of a case, and the paths of the keys that are the user's own; the others are where the page began.

    command: that runs the case.
    """

    table: Mapping[str, object]
    yours: frozenset[str] = frozenset()
    command: str = "run"

    @classmethod
    def first(cls, command: str = "run") -> Self:
        """Where a page begins: the case that `treadload init` writes; that of a wheel on cells of 3 mm."""
        table = copy.deepcopy(dict(CaseSchema.of(command).first))
        if command == "run":
            table["spacing"] = "3 mm"
        return cls(table, command=command)

    @classmethod
    def from_text(cls, text: str, name: str, files: Mapping[str, str], command: str = "run") -> Self:
        """A form of the text of a TOML file, all of whose keys are the user's.

        files: name that the user knows → name under which an uploaded file is kept. Raises InputError, also for a
        case that names a file which was not uploaded.
        """
        table = parse_toml(text, name)
        _settle(table, files)
        form = cls(table, frozenset(_paths(table)), command)
        # Whatever else is wrong with it is said at its field; what has no field could not be repaired there.
        case = form.check(Path()).case
        if case is not None and case.command != command:
            raise InputError(
                f"{name} is not a case of this page: use `treadload {case.command}`, or the page that is for it"
            )
        return form

    def parts(self, folder: Path) -> Group:
        """The parts of the form on the page. folder: of uploaded files."""
        case = self.check(folder).case
        road = None if case is None else case.road()
        layers = [layer.name for layer in road.layers if layer.name] if road is not None else []
        return form_of(self.schema, self.table, layers)

    @property
    def schema(self) -> CaseSchema:
        """What its keys may be."""
        return CaseSchema.of(self.command)

    def with_text(self, field: Field, text: str) -> Self:
        """The form with what was typed into a field; nothing sets the default."""
        return self.with_values({field.path: field.read(text)})

    def with_values(self, values: Mapping[str, object]) -> Self:
        """The form with keys set, or removed where the value is None."""
        table, yours = copy.deepcopy(dict(self.table)), set(self.yours)
        for path, value in values.items():
            if value is not None:
                set_key(table, path, copy.deepcopy(value))
                yours.add(path)
                continue
            if value_at(table, path) is not None:
                table = changed(table, [f"{path}="])
            yours = {key for key in yours if key != path and not key.startswith(f"{path}.")}
        return replace(self, table=table, yours=frozenset(yours))

    def with_added(self, path: str, folder: Path, value: object = None, shape: str = "") -> Self:
        """The form with a key that it did not have; one that stands in its way gives way.

        value: left out, where the key begins. shape: of the value, as `CaseSchema` names it.
        """
        schema = self.schema
        if value is None:
            value = schema.start(path, schema.at(path, self.table), shape)
        before = value_at(self.table, path)
        if isinstance(before, Mapping):
            # What another kind of table has as well, such as its name and its share.
            value = _kept(value, before, schema, path, self.table)
        table, _, key = path.rpartition(".")
        form = self.with_values({path: value})
        siblings = value_at(self.table, table) if table else None
        if not isinstance(siblings, Mapping):
            return form.mended(folder)
        ways, needed = schema.ways_of(table, self.table)
        places = {sibling: f"{table}.{sibling}" for sibling in siblings if sibling != key}
        if key in ways:
            form = form.with_values({places[way]: None for way in ways if way in places})
        left = [where for name, where in places.items() if name not in (*ways, *needed)]
        return form.mended(folder, left, whole=key in ways)

    def with_row(self, path: str, folder: Path) -> Self:
        """The form with one more row of a list: at its end, or before the last where only that is a case."""
        rows = list(cast("Iterable[object]", value_at(self.table, path) or []))
        row = self.schema.start(f"{path}.{len(rows)}", self.schema.at(f"{path}.{len(rows)}", self.table))
        if isinstance(row, dict) and "name" in row:
            names = {row.get("name") for row in rows if isinstance(row, Mapping)}
            count = sum(str(name).startswith(row["name"]) for name in names)
            row["name"] += f" {count + 1}" if count else ""
        last = self.with_values({path: [*rows, row]})
        before = self.with_values({path: [*rows[:-1], row, *rows[-1:]]})
        return next((form for form in (last, before) if form.check(folder).case is not None), last)

    def without(self, path: str, folder: Path) -> Self:
        """The form without a key, or without a row of a list."""
        table, _, key = path.rpartition(".")
        rows = value_at(self.table, table) if table else None
        if isinstance(rows, list):
            form = self.with_values({table: [row for number, row in enumerate(rows) if number != int(key)]})
        else:
            form = self.with_values({path: None})
        return form.mended(folder)

    def mended(self, folder: Path, optional: Sequence[str] = (), *, whole: bool = False) -> Self:
        """The form, or one that is a case where this is none: without one of some keys, or with a warm road.

        optional: keys that may go. whole: True where more than one may. The form itself where none of these is one.
        """
        if self.check(folder).case is not None:
            return self
        tries = [self.with_values({path: None}) for path in optional]
        if self.command == "run" and isinstance(self.value("pavement"), Mapping):
            is_cold = self.value(_TEMPERATURE) is None
            tries.append(self.with_values({_TEMPERATURE: _USUAL if is_cold else None}))
        if whole:
            bare = self.with_values(dict.fromkeys(optional))
            for path in optional:
                back = bare.with_values({path: self.value(path)})
                bare = back if back.check(folder).case is not None else bare
            tries.append(bare)
        return next((form for form in tries if form.check(folder).case is not None), self)

    def value(self, path: str) -> object:
        """The value of a key as it is given; None where it is not."""
        return value_at(self.table, path)

    def is_yours(self, path: str) -> bool:
        """True where the user gave the value, or the table that it stands in."""
        return any(path == key or path.startswith(f"{key}.") for key in self.yours)

    def default_of(self, field: Field, case: Case | None) -> str:
        """What an empty field stands for, as text."""
        value = None if case is None else value_in(case, field.path)
        if value is None and case is not None and field.path == "tolerance":
            value = case.source.tolerance_of(case)
        return field.shown(value) if isinstance(value, str | int | float | tuple) else field.otherwise

    def check(self, folder: Path) -> Checked:
        """What the reader of `treadload run` says. folder: of uploaded files."""
        try:
            _settle(self.table, None)
            return Checked(Case.from_dict(dict(self.table), folder=folder, name="case"), {})
        except InputError as error:
            return Checked(None, by_key(error) or {"": str(error).removeprefix("case: ")})

    def refused(self) -> str:
        """Why no page may open a case with these tables; "" where one may."""
        try:
            _settle(self.table, None)
        except InputError as error:
            return str(error)
        return ""

    def to_toml(self) -> str:
        """The case as a TOML file, as it was typed."""
        return tomli_w.dumps(dict(self.table))


def profile_of(form: Form) -> TreadProfile | None:
    """The profile of a form as it stands, for its cross-section; None where it is none or wrong."""
    table = form.value("tire.profile")
    try:
        return TreadProfile.from_dict(table) if isinstance(table, Mapping) else None
    except (InputError, ValueError):
        return None


def _kept(
    value: object, before: Mapping[str, object], schema: CaseSchema, path: str, table: Mapping[str, object]
) -> object:
    shapes = schema.shapes(schema.at(path, table))
    if not isinstance(value, Mapping):
        # A name alone has no keys beside it; its table has.
        named = [shape for shape in shapes if shape.word is None and shape.name.partition(":")[2] == value]
        properties = schema.resolved(named[0].schema)["properties"] if named else {}
        kept = {key: item for key, item in before.items() if key in properties and "const" not in properties[key]}
        return {**kept, named[0].name.partition(":")[0]: value} if kept else value
    properties = schema.resolved(schema.fitting(shapes, value).schema).get("properties", {})
    kept = {
        key: item
        for key, item in before.items()
        if key in properties and key in value and "const" not in properties[key]
    }
    kept |= {key: before[key] for key in ("name", "share", "layer") if key in properties and key in before}
    return {**value, **{key: item for key, item in kept.items() if type(item) is type(value.get(key, item))}}


def leaves_of(table: Mapping[str, object]) -> dict[str, object]:
    """Values by their paths; lists of numbers whole, rows of tables by their number."""
    return {path: value_at(table, path) for path in _paths(table)}


def _paths(table: Mapping[str, object] | list[object], before: str = "") -> Iterator[str]:
    members = enumerate(table) if isinstance(table, list) else table.items()
    for key, value in members:
        path = f"{before}{key}"
        if isinstance(value, Mapping) or (
            isinstance(value, list) and any(isinstance(item, Mapping) for item in value)
        ):
            yield from _paths(value, f"{path}.")
        else:
            yield path


def _settle(table: Mapping[str, object] | list[object], files: Mapping[str, str] | None) -> None:
    """Put the kept names of uploaded files in a table, and refuse whatever would lead out of their folder."""
    members = enumerate(table) if isinstance(table, list) else table.items()
    for key, value in list(members):
        if isinstance(value, Mapping | list):
            _settle(value, files)
        elif isinstance(value, str) and key not in _WORDS:
            if files is not None and value in files:
                cast("dict[object, object]", table)[key] = files[value]
            elif _leads_out(value):
                raise InputError(
                    f"{key} = {value!r} names a file of the machine that this page runs on, which no page may open; "
                    "upload the file and give its bare name"
                )


def _leads_out(text: str) -> bool:
    here, there = PurePosixPath(text.strip()), PureWindowsPath(text.strip())
    parts = {*here.parts, *there.parts}
    return here.is_absolute() or bool(there.drive or there.root) or ".." in parts or text.strip().startswith("~")
