"""The parts of a form, made from the schema of a case: a field for each key, tables and lists as their parts."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

from treadload.app.case_schema import WAY, CaseSchema, Shape, join, label_of, ways_of
from treadload.app.form_field import FREE, LIST, NUMBER, TEXT, Field, unit_of
from treadload.case.schema import Schema


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
class _Parts:
    """Makes the parts of one case. layers: names of those of its road."""

    schema: CaseSchema
    layers: tuple[str, ...] = field(default=())

    def group(
        self, path: str, label: str, schema: Schema, table: Mapping[str, object], *, can_go: bool = False
    ) -> Group:
        properties, needed, ways = schema.get("properties", {}), schema.get(WAY, ()), ways_of(schema)
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
                    join(path, key),
                    part,
                    table.get(key),
                    in_table=in_table,
                    can_go=key not in needed and key not in ways,
                )
            )
        more = schema.get("additionalProperties") or {}
        for key in table:
            if key not in properties:
                parts.extend(self.key(join(path, key), more, table[key], in_table=True, can_go=True))
        words = str(schema.get("description", ""))
        return Group(path, label, tuple(parts), tuple(rest), words, can_go)

    def key(self, path: str, schema: Schema, value: object, *, in_table: bool, can_go: bool) -> list[Part]:
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
            and not any(isinstance(item, Mapping) for item in (value if isinstance(value, list | tuple) else ()))
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

    def _row(self, path: str, schema: Schema, value: object) -> Group:
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


def form_of(schema: CaseSchema, table: Mapping[str, object], layers: Sequence[str] = ()) -> Group:
    """The parts of a case. layers: names of those of its road."""
    return _Parts(schema, tuple(layers)).group("", "", schema.root, table)
