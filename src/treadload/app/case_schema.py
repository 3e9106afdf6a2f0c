"""The schema of a case as its form reads it: what a place takes, which shapes it can have, how it starts."""

from __future__ import annotations

import copy
import functools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, cast

from treadload.app.form_field import LIST, NUMBER, TEXT, unit_of
from treadload.case.schema import Schema, json_schema
from treadload.files import parse_toml, text_of
from treadload.templates import first_case

_REFERENCE = "#/$defs/"
WAY: Final = "required"
_STARTS = Path(__file__).parent / "starts.toml"
_YES = {True: "yes", False: "no"}
_SHAPES = {NUMBER: "a number", TEXT: "another name or file", LIST: "a list", "table": "a table", "names": "by name"}


@dataclass(frozen=True)
class Shape:
    """One of the forms that a value may have. name: of the form. word: of a value that is one of a few."""

    name: str
    label: str
    schema: Schema
    word: object = None

    @property
    def is_scalar(self) -> bool:
        """True for one number or text."""
        return self.word is None and self.name in (NUMBER, TEXT)


@dataclass(frozen=True)
class CaseSchema:
    """The schema of the cases that a command runs. broken: sentences on packages that it had to leave out."""

    root: Schema
    first: Mapping[str, object]
    broken: tuple[str, ...] = ()

    @classmethod
    @functools.cache
    def of(cls, command: str) -> CaseSchema:
        """The schema by the command: "run" or "life"."""
        broken: list[str] = []
        return cls(json_schema(command, broken=broken), parse_toml(first_case(command), "case"), tuple(broken))

    def at(self, path: str, table: Mapping[str, object]) -> Schema:
        """The schema of a key; {} of one that is not known."""
        schema = self.root
        here: object = table
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
        return ways_of(schema), schema.get(WAY, ())

    def resolved(self, schema: Schema) -> Schema:
        """A schema in place of its reference."""
        if "$ref" not in schema:
            return schema
        name = str(schema["$ref"]).removeprefix(_REFERENCE)
        rest = {key: value for key, value in schema.items() if key != "$ref"}
        return cast("Schema", {**self.resolved(self.root["$defs"][name]), **rest})

    def shapes(self, schema: Schema) -> list[Shape]:
        """The forms that a value may have, words first."""
        schema = self.resolved(schema)
        arms = schema.get("anyOf") or [arm for arm in schema.get("oneOf", ()) if set(arm) != {WAY}]
        shapes = [shape for arm in arms for shape in self.shapes(arm)] or list(self._shapes(schema))
        words = [Shape(f"={name}", name, schema, name) for name in schema.get("examples", ())]
        words += [shape for shape in shapes if shape.word is not None]
        names = {shape.label for shape in words}
        # The table of a kind that its name alone stands for.
        return [*words, *(replace(shape, label=f"{shape.label}, as a table") if shape.label in names else shape
                          for shape in shapes if shape.word is None)]  # fmt: skip

    def _shapes(self, schema: Schema) -> Iterator[Shape]:
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
            kind = str(schema["properties"][constant]["const"]) if constant else ""
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

    def start(self, path: str, schema: Schema, name: str = "") -> object:
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

    def _start_of(self, path: str, shape: Shape) -> object:
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
        needed = [key for key in schema.get(WAY, ()) if key not in kind]
        ways = ways_of(schema)[:1]
        return {**kind, **{key: self.start(f"{path}.{key}", properties[key]) for key in (*needed, *ways)}}


def label_of(key: str) -> str:
    """A key in words, as a label."""
    words = key.replace("_", " ")
    return f"{words[:1].upper()}{words[1:]}"


def value_at(table: object, path: str) -> object:
    """The value of a key in tables; None where it is not."""
    here: object = table
    for part in path.split("."):
        if isinstance(here, list):
            here = here[int(part)] if part.isdigit() and int(part) < len(here) else None
        else:
            here = _get(here, part)
    return here


def _get(table: object, key: str) -> object:
    return table.get(key) if isinstance(table, Mapping) else None


def ways_of(schema: Schema) -> list[str]:
    """Keys of which a table gives exactly one."""
    return [arm[WAY][0] for arm in schema.get("oneOf", ()) if set(arm) == {WAY}]


def join(path: str, key: str) -> str:
    """The path of a key in a table."""
    return f"{path}.{key}" if path else key


@functools.cache
def _starts() -> dict[str, object]:
    return parse_toml(text_of(_STARTS, "starts"), _STARTS.name)
