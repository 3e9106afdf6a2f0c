"""The parts of a form, made from the schema of a case: a field for each key, tables and lists as their parts."""

from __future__ import annotations

import copy
import functools
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from treadload.app.form_field import FREE, LIST, NUMBER, TEXT, Field, unit_of
from treadload.case.first import first_case
from treadload.case.schema import json_schema
from treadload.files import parse_toml, text_of

_REFERENCE = "#/$defs/"
_WAY = "required"
_STARTS = Path(__file__).parent / "starts.toml"
_YES = {True: "yes", False: "no"}
_SHAPES = {NUMBER: "a number", TEXT: "another name or file", LIST: "a list", "table": "a table", "names": "by name"}


@dataclass(frozen=True)
class Choosing:
    """What a table is given by, or what stands at a key: one of several. options: name → words. chosen: a name or "".

    is_key: True where the options are keys of the table at the path.
    """

    path: str
    label: str
    options: Mapping[str, str]
    chosen: str
    words: str = ""
    is_key: bool = False


@dataclass(frozen=True)
class Absent:
    """A table or list that the case does not give."""

    path: str
    label: str
    words: str = ""


@dataclass(frozen=True)
class Group:
    """A table. parts: what is given or needed. rest: what else it may give. is_inline: True without a frame."""

    path: str
    label: str
    parts: tuple[Part, ...]
    rest: tuple[Part, ...] = ()
    words: str = ""
    can_go: bool = False
    is_inline: bool = False


@dataclass(frozen=True)
class Rows:
    """A list, each of whose rows is shown as its parts."""

    path: str
    label: str
    rows: tuple[Group, ...]
    words: str = ""
    can_go: bool = False


Part = Field | Choosing | Absent | Group | Rows


@dataclass(frozen=True)
class Shape:
    """One of the forms that a value may have. name: of the form. word: of a value that is one of a few."""

    name: str
    label: str
    schema: Mapping[str, Any]
    word: Any = None

    @property
    def is_scalar(self) -> bool:
        """True for one number or text."""
        return self.word is None and self.name in (NUMBER, TEXT)


@dataclass(frozen=True)
class CaseSchema:
    """The schema of the cases that a command runs. broken: sentences on packages that it had to leave out."""

    root: Mapping[str, Any]
    first: Mapping[str, Any]
    broken: tuple[str, ...] = ()

    @classmethod
    @functools.cache
    def of(cls, command: str) -> CaseSchema:
        """The schema by the command: "run" or "life"."""
        broken: list[str] = []
        return cls(json_schema(command, broken=broken), parse_toml(first_case(command), "case"), tuple(broken))

    def form(self, table: Mapping[str, object], layers: Sequence[str] = ()) -> Group:
        """The parts of a case. layers: names of those of its road."""
        return _Parts(self, tuple(layers)).group("", "", self.root, table)

    def at(self, path: str, table: Mapping[str, object]) -> Mapping[str, Any]:
        """The schema of a key; {} of one that is not known."""
        schema, here = self.root, table
        for key in path.split("."):
            schema = self.resolved(self.fitting(self.shapes(schema), here).schema)
            members = schema.get("prefixItems", ())
            here = value_at(here, key)
            if key.isdigit() and "type" in schema and schema["type"] == "array":
                schema = members[int(key)] if int(key) < len(members) else schema.get("items", {})
            else:
                schema = schema.get("properties", {}).get(key, schema.get("additionalProperties") or {})
        return self.resolved(schema)

    def ways_of(self, path: str, table: Mapping[str, object]) -> tuple[list[str], Sequence[str]]:
        """Keys of which the table at a path gives exactly one, and those that it needs."""
        schema = self.resolved(self.fitting(self.shapes(self.at(path, table)), value_at(table, path)).schema)
        return _ways(schema), schema.get(_WAY, ())

    def resolved(self, schema: Mapping[str, object]) -> Mapping[str, Any]:
        """A schema in place of its reference."""
        if "$ref" not in schema:
            return schema
        name = str(schema["$ref"]).removeprefix(_REFERENCE)
        rest = {key: value for key, value in schema.items() if key != "$ref"}
        return {**self.resolved(self.root["$defs"][name]), **rest}

    def shapes(self, schema: Mapping[str, Any]) -> list[Shape]:
        """The forms that a value may have, words first."""
        schema = self.resolved(schema)
        arms = schema.get("anyOf") or [arm for arm in schema.get("oneOf", ()) if set(arm) != {_WAY}]
        shapes = [shape for arm in arms for shape in self.shapes(arm)] or list(self._shapes(schema))
        words = [Shape(f"={name}", name, schema, name) for name in schema.get("examples", ())]
        words += [shape for shape in shapes if shape.word is not None]
        names = {shape.label for shape in words}
        # The table of a kind that its name alone stands for.
        return [*words, *(replace(shape, label=f"{shape.label}, as a table") if shape.label in names else shape
                          for shape in shapes if shape.word is None)]  # fmt: skip

    def _shapes(self, schema: Mapping[str, Any]) -> Iterator[Shape]:
        kinds = schema.get("type", ())
        words = schema.get("enum") or ([schema["const"]] if "const" in schema else [])
        if kinds == "boolean":
            words = [True, False]
        for word in words:
            label = _YES[word] if isinstance(word, bool) else str(word)
            yield Shape(f"={label}", label, schema, word)
        if words:
            return
        if kinds == "object" or "properties" in schema:
            constant = next((key for key, part in schema.get("properties", {}).items() if "const" in part), "")
            name = "table" if "properties" in schema else "names"
            kind = schema["properties"][constant]["const"] if constant else ""
            yield Shape(f"{constant}:{kind}" if kind else name, kind or _SHAPES[name], schema)
        elif kinds == "array":
            yield Shape(LIST, _SHAPES[LIST], schema)
        elif kinds:
            name = TEXT if kinds == "string" else NUMBER
            yield Shape(name, _SHAPES[name], schema)

    def fitting(self, shapes: Sequence[Shape], value: object) -> Shape:
        """The form that a value has; one of its own where it has none of them."""
        for shape in shapes:
            if (
                shape.word is not None
                and shape.word == value
                and isinstance(value, bool) == isinstance(shape.word, bool)
            ):
                return shape
        wanted: tuple[str, ...] = (NUMBER, TEXT)
        if isinstance(value, Mapping):
            wanted = (*(f"{key}:{item}" for key, item in value.items()), *self._usual(shapes), "table", "names")
        elif isinstance(value, list | tuple):
            wanted = (LIST,)
        elif isinstance(value, str):
            wanted = (TEXT, NUMBER)
        fits = (shape for name in wanted for shape in shapes if shape.name == name)
        return next(fits, Shape("", "as it stands", {}))

    @staticmethod
    def _usual(shapes: Sequence[Shape]) -> list[str]:
        """The kind of a table that names none."""
        split = [(shape, *shape.name.partition(":")) for shape in shapes]
        return [shape.name for shape, key, sign, _ in split if sign and "default" in shape.schema["properties"][key]]

    def start(self, path: str, schema: Mapping[str, object], name: str = "") -> Any:
        """What a key begins with that is added: as in the first case, or as `starts.toml` says, or by its unit.

        name: of its form; left out, the first.
        """
        plain = ".".join(part for part in path.split(".") if not part.isdigit())
        place = f"{plain}.row" if path.rpartition(".")[2].isdigit() else plain
        shapes = self.shapes(schema)
        kind = f"{place.rpartition('.')[2]}:{name.partition(':')[2] or name}"
        usual = [value_at(self.first, path), *(_starts().get(key) for key in (f"{place}:{name}", place, kind))]
        for value in usual:
            if value is not None and (not name or self.fitting(shapes, value).name == name):
                return copy.deepcopy(value)
        shape = next((shape for shape in shapes if shape.name == name), shapes[0])
        return self._start_of(path, shape)

    def _start_of(self, path: str, shape: Shape) -> Any:
        schema = self.resolved(shape.schema)
        if shape.word is not None:
            return shape.word
        if shape.name == LIST:
            members = schema.get("prefixItems") or [schema.get("items", {})] * schema.get("minItems", 1)
            return [self.start(f"{path}.{number}", member) for number, member in enumerate(members)]
        if shape.name == NUMBER:
            return unit_of(schema, path, None).start
        if shape.name == TEXT:
            return path.rpartition(".")[2]
        properties = schema.get("properties", {})
        kind = {key: part["const"] for key, part in properties.items() if "const" in part}
        needed = [key for key in schema.get(_WAY, ()) if key not in kind]
        ways = _ways(schema)[:1]
        return {**kind, **{key: self.start(f"{path}.{key}", properties[key]) for key in (*needed, *ways)}}


@dataclass(frozen=True)
class _Parts:
    """Makes the parts of one case. layers: names of those of its road."""

    schema: CaseSchema
    layers: tuple[str, ...] = field(default=())

    def group(
        self, path: str, label: str, schema: Mapping[str, Any], table: Any, *, can_go: bool = False,
        is_inline: bool = False,
    ) -> Group:  # fmt: skip
        properties, needed, ways = schema.get("properties", {}), schema.get(_WAY, ()), _ways(schema)
        chosen = next((way for way in ways if way in table), "")
        parts: list[Part] = []
        rest: list[Part] = []
        if ways:
            parts.append(
                Choosing(path, "Given by", {way: label_of(way).lower() for way in ways}, chosen, is_key=True)
            )
        for key, part in properties.items():
            if "const" in part or (key in ways and key != chosen):
                continue
            in_table = key in table or key in needed
            (parts if in_table else rest).extend(
                self.key(
                    _join(path, key),
                    part,
                    table.get(key),
                    in_table=in_table,
                    can_go=key not in needed and key not in ways,
                )
            )
        more = schema.get("additionalProperties") or {}
        for key in table:
            if key not in properties:
                parts.extend(self.key(_join(path, key), more, table[key], in_table=True, can_go=True))
        words = str(schema.get("description", ""))
        return Group(path, label, tuple(parts), tuple(rest), words, can_go, is_inline)

    def key(self, path: str, schema: Mapping[str, Any], value: Any, *, in_table: bool, can_go: bool) -> list[Part]:
        """The parts of one key."""
        schema = self.schema.resolved(schema)
        shapes = self.schema.shapes(schema)
        words, label = str(schema.get("description", "")), label_of(path.rpartition(".")[2])
        plain = Field(path, label, words=words)
        usual = None if in_table and not can_go else schema.get("default")
        if all(shape.is_scalar for shape in shapes) and not isinstance(value, Mapping | list):
            return [self._scalar(plain, shapes, value, usual)]
        if all(shape.word is not None for shape in shapes) and shapes and not isinstance(value, Mapping | list):
            return [self._words(plain, shapes, schema.get("default"), can_go or not in_table)]
        if (
            len(shapes) == 1
            and self._is_plain_list(shapes[0])
            and not any(isinstance(item, Mapping) for item in value or ())
        ):
            return [self._list(plain, shapes[0], value, usual)]
        if not in_table:
            return [Absent(path, label, words)]
        shape = self.schema.fitting(shapes, value)
        if len(shapes) == 1 or not shape.name:
            return [self._whole(path, label, shape, value, words, can_go=can_go)]
        options = {
            entry.name: entry.label for entry in shapes if not entry.label.endswith(", as a table") or entry is shape
        }
        if can_go:
            options = {"": "left out", **options}
        kinds = [entry.name.partition(":") for entry in shapes if ":" in entry.name]
        if path.rpartition(".")[2].isdigit() and kinds:
            label = label_of(kinds[0][0])
        elif any(entry.is_scalar or entry.name == LIST for entry in shapes):
            label = f"{label}, as"
        choosing = Choosing(path, label, options, "" if value is None else shape.name, words)
        label = label.removesuffix(", as")
        if shape.word is not None or value is None:
            return [choosing]
        if shape.is_scalar:
            return [choosing, self._scalar(plain, [shape], value, usual)]
        if self._is_plain_list(shape):
            return [choosing, self._list(plain, shape, value, usual)]
        inner = self._whole(path, label, shape, value, "", can_go=False)
        return [choosing, replace(inner, is_inline=True) if isinstance(inner, Group) else inner]

    def _whole(self, path: str, label: str, shape: Shape, value: object, words: str, *, can_go: bool) -> Part:
        schema = self.schema.resolved(shape.schema)
        if isinstance(value, list | tuple) or (value is None and shape.name == LIST):
            members = schema.get("prefixItems", ())
            rows = tuple(
                self._row(f"{path}.{k}", members[k] if k < len(members) else schema.get("items", {}), item)
                for k, item in enumerate(value or ())
            )
            return Rows(path, label, rows, words, can_go)
        if isinstance(value, Mapping) or value is None:
            return replace(self.group(path, label, schema, value or {}, can_go=can_go), words=words)
        return Field(path, label, kind=TEXT, words=words)

    def _row(self, path: str, schema: Mapping[str, object], value: object) -> Group:
        parts = self.key(path, schema, value, in_table=True, can_go=False)
        if len(parts) == 1 and isinstance(parts[0], Group):
            (whole,) = parts
            assert isinstance(whole, Group)
        else:
            whole = Group(path, "", tuple(parts))
        number = int(path.rpartition(".")[2]) + 1
        called = (value.get("name") or value.get("mix") or "") if isinstance(value, Mapping) else ""
        return replace(whole, label=f"{number}  {called}", can_go=True, is_inline=False)

    def _scalar(self, plain: Field, shapes: Sequence[Shape], value: object, usual: object) -> Field:
        numbers = [entry.schema for entry in shapes if "x-unit" in entry.schema]
        scalar = replace(plain, kind=TEXT if [entry.name for entry in shapes] == [TEXT] else FREE)
        if numbers:
            unit = unit_of(numbers[0], plain.path, value)
            scalar = replace(scalar, unit=unit.shown, si=unit.si, kind=NUMBER)
        if re.fullmatch(r"criteria\.\d+\.layer", plain.path) and self.layers:
            scalar = replace(scalar, choices={"": "by the law", **{name: name for name in self.layers}})
        return replace(scalar, otherwise=scalar.shown(usual))

    def _words(self, plain: Field, shapes: Sequence[Shape], default: object, can_go: bool) -> Field:
        usual = next((entry.label for entry in shapes if entry.word == default), "")
        choices = {entry.label: entry.label for entry in shapes}
        if can_go:
            choices = {"": f"{usual}, by default" if usual else "left out", **choices}
        kind = "flag" if usual and all(isinstance(entry.word, bool) for entry in shapes) else "choice"
        values = {entry.label: entry.word for entry in shapes}
        return replace(plain, kind=kind, choices=choices, values=values, otherwise=usual)

    def _list(self, plain: Field, shape: Shape, value: object, usual: object) -> Field:
        schema = self.schema.resolved(shape.schema)
        members = schema.get("prefixItems") or [schema.get("items", {})]
        alike = members[0] if all(member == members[0] for member in members) else {}
        unit = unit_of(alike, plain.path, value[0] if isinstance(value, list | tuple) and value else None)
        listed = replace(plain, unit=unit.shown, si=unit.si, kind=LIST)
        return replace(listed, otherwise=listed.shown(usual))

    def _is_plain_list(self, shape: Shape) -> bool:
        """True for a list of numbers, which one line can hold."""
        schema = self.schema.resolved(shape.schema)
        members = schema.get("prefixItems") or ([schema["items"]] if "items" in schema else [])
        inner = [inner_shape for member in members for inner_shape in self.schema.shapes(member)]
        return shape.name == LIST and bool(inner) and all(inner_shape.name == NUMBER for inner_shape in inner)


def parts_in(part: Part) -> Iterator[Part]:
    """A part and all within it."""
    yield part
    within: tuple[Part, ...] = ()
    if isinstance(part, Group):
        within = (*part.parts, *part.rest)
    elif isinstance(part, Rows):
        within = part.rows
    for section in within:
        yield from parts_in(section)


def label_of(key: str) -> str:
    """A key in words, as a label."""
    words = key.replace("_", " ")
    return f"{words[:1].upper()}{words[1:]}"


def value_at(table: object, path: str) -> Any:
    """The value of a key in tables; None where it is not."""
    here = table
    for part in path.split("."):
        if isinstance(here, list):
            here = here[int(part)] if part.isdigit() and int(part) < len(here) else None
        else:
            here = _get(here, part)
    return here


def _get(table: object, key: str) -> object:
    return table.get(key) if isinstance(table, Mapping) else None


def _ways(schema: Mapping[str, Any]) -> list[str]:
    """Keys of which a table gives exactly one."""
    return [arm[_WAY][0] for arm in schema.get("oneOf", ()) if set(arm) == {_WAY}]


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


@functools.cache
def _starts() -> dict[str, object]:
    return parse_toml(text_of(_STARTS, "starts"), _STARTS.name)
