"""The JSON schema of a case, by which editors complete and check a TOML file."""

from __future__ import annotations

import contextlib
import itertools
import os
from collections.abc import Iterator, Sequence
from typing import Any, TypedDict, cast

from treadload import catalogue
from treadload.case.fitted import FROM, OVERLAY
from treadload.case.model import Case
from treadload.case.step import Source, step_class, step_classes
from treadload.case.tire import EXAMPLE
from treadload.errors import InputError
from treadload.read import REFERENCE, Choice, choice_named, sentences
from treadload.registry import STEPS
from treadload.templates import check_kind

# Table and key whose text is, among others, one of these names.
_CATALOGUED = (
    ("TirePart", "profile", catalogue.tires),
    ("TirePart", "belt", catalogue.belts),
    ("TirePart", "scan", (EXAMPLE,)),
    ("PavementPart", "structure", catalogue.structures),
    ("LayerPart", "mix", catalogue.mixes),
)
_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_DEFINED = "#/$defs/"


_Marks = TypedDict(
    "_Marks",
    {"$schema": str, "$ref": str, "$defs": dict[str, "Schema"], "x-unit": str, "x-kind": str},
    total=False,
)


class Schema(_Marks, total=False):
    """A JSON schema, as far as those of cases go. x-unit, x-kind: see `json_schema`."""

    title: str
    description: str
    type: str
    const: object
    enum: list[object]
    examples: list[str]
    default: object
    pattern: str
    properties: dict[str, Schema]
    additionalProperties: Schema
    required: list[str]
    items: Schema
    prefixItems: list[Schema]
    minItems: int
    anyOf: list[Schema]
    oneOf: list[Schema]


def keys_of_kind(name: str, broken: list[str] | None = None) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Keys of the cases that a command runs, and those that each must give. broken: see `json_schema`."""
    kinds = step_classes()
    for step in [step for step in STEPS.names() if step not in STEPS.built_in()]:
        with _noted(broken):
            kinds.append(step_class(step))
    Case.take_steps(kind.name for kind in kinds)
    sources = [kind for kind in kinds if issubclass(kind, Source) and kind.command == name]
    groups = {group for kind in sources for group in kind.makes}
    tables = [kind.name for kind in sources if kind.has_table]
    used = {key for kind in sources for key in kind.uses}
    steps = [kind for kind in kinds if not issubclass(kind, Source)]
    while reached := [kind for kind in steps if groups.issuperset(kind.after)]:
        groups |= {group for kind in reached for group in kind.makes}
        tables += [kind.name for kind in reached if kind.has_table]
        steps = [kind for kind in steps if kind not in reached]
    keys = tuple(key for key in Case.known_keys() if key in used or key in tables)
    needs = set.intersection(*(set(kind.needs) | ({kind.name} & set(tables)) for kind in sources))
    return keys, tuple(key for key in keys if key in needs)


def hidden_of_kind(name: str) -> set[str]:
    """Keys of tables that no case that a command runs gives."""
    kinds = [kind for kind in step_classes() if issubclass(kind, Source) and kind.command == name]
    return set.intersection(*(set(kind.hidden) for kind in kinds))


def _prune(root: Schema) -> None:
    """Leave out definitions that nothing refers to."""
    defined = root.get("$defs", {})
    kept: dict[str, Schema] = {}
    while True:
        names = {ref.removeprefix(REFERENCE) for ref in _references([root["properties"], kept])}
        new = names.intersection(defined) - set(kept)
        if not new:
            root["$defs"] = kept
            return
        kept |= {name: defined[name] for name in sorted(new)}


def read_case(path: str | os.PathLike[str], *, changes: Sequence[str] = ()) -> Case:
    """A case from a TOML file. changes: see `Case.from_toml`. Raises InputError."""
    return Case.from_toml(path, changes=changes)


def json_schema(name: str = "run", *, broken: list[str] | None = None) -> Schema:
    """JSON schema (draft 2020-12) of a case, with what other packages bring.

    name: "run", "life" or "calibrate", the command that runs the case. Every key has its words and unit ("x-unit",
    SI; "x-kind" of a quantity with units of its own), and the names of the catalogue that it may be as examples. The
    rules that hold between keys are the reader's: a file that the schema takes may still be refused, with a sentence.
    broken: a list that takes a sentence about each law, material or step whose package cannot be loaded, which the
    schema then leaves out. Raises InputError for another name, and without the list for such a package.
    """
    check_kind(name)
    keys, needs = keys_of_kind(name, broken)
    root = Case.model_json_schema(ref_template=f"{REFERENCE}{{model}}")
    root["properties"] = {key: root["properties"][key] for key in keys}
    root["required"] = list(needs)
    for path in hidden_of_kind(name):
        table, _, key = path.rpartition(".")
        part = next(iter(_references(root["properties"][table]))).removeprefix(REFERENCE)
        root["$defs"][part]["properties"].pop(key)
    _prune(cast("Schema", root))
    defined: dict[str, Any] = {}
    _gather(root, defined)
    for wanted in _wanted(root, defined):
        choice = choice_named(wanted)
        # What is not a choice is a table, whose definition comes with the one that holds it.
        assert choice is not None, wanted
        defined[wanted] = _one_of(choice, broken)
        _gather(defined[wanted], defined)
    for table, key, names in _CATALOGUED:
        if table in defined:
            defined[table]["properties"][key]["examples"] = list(names)
    if "PavementPart" in defined:
        _with_fitted(defined["PavementPart"])
    first = (Case.__doc__ or "").strip().splitlines()[0]
    whole = {**root, "title": f"A case of `treadload {name}`", "description": first, "$defs": defined}
    return cast("Schema", {"$schema": _DIALECT, **cast("dict[str, object]", _plain(whole))})


def _with_fitted(road: dict[str, object]) -> None:
    """Let a road come from a backcalculation as well, in place of what a case else needs of it."""
    properties, ways = road["properties"], road.get("oneOf", [])
    assert isinstance(properties, dict)
    assert isinstance(ways, list)
    properties[FROM] = {
        "type": "string",
        "pattern": "#",
        "description": "A result of `treadload backcalculate` and a station of it, whose fitted layers are the road.",
        "examples": ["moduli.nc#km 1.2"],
    }
    properties[OVERLAY] = {
        "$ref": f"{REFERENCE}LayerPart",
        "description": "A layer laid on top of such a road.",
    }
    road["oneOf"] = [*ways, {"required": [FROM]}]


def _wanted(root: dict[str, object], defined: dict[str, object]) -> Iterator[str]:
    """Names that are referred to and not yet defined, until there are none."""
    while True:
        named = {ref.removeprefix(REFERENCE) for ref in itertools.chain(_references(root), _references(defined))}
        missing = sorted(named - set(defined))
        if not missing:
            return
        yield missing[0]


@contextlib.contextmanager
def _noted(broken: list[str] | None) -> Iterator[None]:
    """Take what is wrong with a package into a list; raise it without one."""
    try:
        yield
    except InputError as error:
        if broken is None:
            raise
        broken.append(str(error))


def _one_of(choice: Choice, broken: list[str] | None) -> dict[str, object]:
    """What may stand for a choice: a number, a word, or the table of one of its kinds."""
    registry = choice.registry
    arms: list[dict[str, Any]] = []
    if registry.number:
        arms.append(
            {"type": ["number", "string"], "description": f"The same as {registry.key} = {registry.number!r}."}
        )
    tables: dict[str, Any] = {}
    for name in choice.names():
        with _noted(broken):
            if choice.will_do(name):
                tables[name] = choice.table(name)
    if registry.words:
        arms.append({"enum": [name for name, table in tables.items() if not table.needs_more()]})
    arms += [table.model_json_schema(ref_template=f"{REFERENCE}{{model}}") for table in tables.values()]
    return {"oneOf": arms}


def _gather(schema: object, defined: dict[str, object]) -> None:
    """Take the definitions out of a schema and of what it holds."""
    if isinstance(schema, dict):
        for name, definition in schema.pop("$defs", {}).items():
            if name not in defined:
                defined[name] = definition
                _gather(definition, defined)
        for part in schema.values():
            _gather(part, defined)
    elif isinstance(schema, list):
        for item in schema:
            _gather(item, defined)


def _references(schema: object) -> Iterator[str]:
    if isinstance(schema, dict):
        if isinstance(schema.get("$ref"), str):
            yield schema["$ref"]
        for part in schema.values():
            yield from _references(part)
    elif isinstance(schema, list):
        for item in schema:
            yield from _references(item)


def _plain(schema: object, *, keys: bool = False) -> object:
    """Without what adds nothing: names that repeat the key, and null, which TOML does not have.

    keys: True where the schema is a table of keys, whose names are the user's.
    """
    if isinstance(schema, list):
        return [_plain(item) for item in schema]
    if not isinstance(schema, dict):
        return schema.replace(REFERENCE, _DEFINED) if isinstance(schema, str) else schema
    if keys:
        return {key: _plain(part) for key, part in schema.items()}
    kept: dict[str, Any] = {key: _plain(part, keys=key in ("properties", "$defs")) for key, part in schema.items()}
    if "$defs" not in kept:
        kept.pop("title", None)
    if kept.get("default", ...) is None or isinstance(kept.get("default"), dict):
        del kept["default"]
    arms = [arm for arm in kept.get("anyOf", ()) if arm != {"type": "null"}]
    if len(arms) == 1:
        del kept["anyOf"]
        text = sentences(*(arm.get("description") for arm in (kept, *arms)))
        kept |= {**arms[0], "description": text}
    elif arms:
        kept["anyOf"] = arms
    if not kept.get("description", ...):
        del kept["description"]
    return kept
