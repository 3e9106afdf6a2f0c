"""The JSON schema of a case, by which editors complete and check a TOML file."""

from __future__ import annotations

import itertools
import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from treadload.case.calibration import CalibrationCase
from treadload.case.changes import changed
from treadload.case.file import A_CASE, FilePart
from treadload.case.life import LifeCase
from treadload.case.model import Case
from treadload.errors import InputError, nearest
from treadload.files import parse_toml, text_of
from treadload.read import REFERENCE, Choice, choice_named, sentences

KINDS: dict[str, type[FilePart]] = {"run": Case, "life": LifeCase, "calibrate": CalibrationCase}
"""Cases by the command that runs them."""
_DIALECT = "https://json-schema.org/draft/2020-12/schema"
_DEFINED = "#/$defs/"


def kind_of_case(name: str) -> type[FilePart]:
    """A kind of case by the command that runs it, "run", "life" or "calibrate". Raises InputError."""
    if name not in KINDS:
        raise InputError(f"no kind of case {name!r}; {nearest(name, KINDS)}")
    return KINDS[name]


def kind_of_table(table: Mapping[str, Any]) -> type[FilePart]:
    """The kind of case that a table with its own tables is; Case where none tells."""
    return next((kind for kind in KINDS.values() if any(key in table for key in kind.own_tables)), Case)


def read_case(path: str | os.PathLike[str], *, changes: Sequence[str] = ()) -> FilePart:
    """A case of whatever kind from a TOML file. changes: see `FilePart.from_toml`. Raises InputError."""
    table = changed(parse_toml(text_of(path, A_CASE), str(path)), changes)
    return kind_of_table(table).from_dict(table, folder=Path(path).parent, name=str(path))


def json_schema(name: str = "run") -> dict[str, Any]:
    """JSON schema (draft 2020-12) of a case, with what other packages bring.

    name: "run", "life" or "calibrate", the command that runs the case. Every key has its words and unit. The rules
    that hold between keys are the reader's: a file that the schema takes may still be refused, with a sentence.
    Raises InputError for another name, and for a package whose law or material cannot be loaded.
    """
    case = kind_of_case(name)
    root = case.model_json_schema(ref_template=f"{REFERENCE}{{model}}")
    defined: dict[str, Any] = {}
    _gather(root, defined)
    for wanted in _wanted(root, defined):
        choice = choice_named(wanted)
        # What is not a choice is a table, whose definition comes with the one that holds it.
        assert choice is not None, wanted
        defined[wanted] = _one_of(choice)
        _gather(defined[wanted], defined)
    first = (case.__doc__ or "").strip().splitlines()[0]
    whole = {**root, "title": f"A case of `treadload {name}`", "description": first, "$defs": defined}
    return {"$schema": _DIALECT, **_plain(whole)}


def _wanted(root: dict[str, Any], defined: dict[str, Any]) -> Iterator[str]:
    """Names that are referred to and not yet defined, until there are none."""
    while True:
        named = {ref.removeprefix(REFERENCE) for ref in itertools.chain(_references(root), _references(defined))}
        missing = sorted(named - set(defined))
        if not missing:
            return
        yield missing[0]


def _one_of(choice: Choice) -> dict[str, Any]:
    """What may stand for a choice: a number, a word, or the table of one of its kinds."""
    registry = choice.registry
    arms: list[dict[str, Any]] = []
    if registry.number:
        arms.append(
            {"type": ["number", "string"], "description": f"The same as {registry.key} = {registry.number!r}."}
        )
    tables = [choice.table(name) for name in choice.names() if choice.will_do(name)]
    if registry.words:
        words = [name for name, table in zip(choice.names(), tables, strict=True) if not table.needs_more()]
        arms.append({"enum": words})
    arms += [table.model_json_schema(ref_template=f"{REFERENCE}{{model}}") for table in tables]
    return {"oneOf": arms}


def _gather(schema: Any, defined: dict[str, Any]) -> None:
    """Take the definitions out of a schema and of what it holds."""
    if isinstance(schema, dict):
        for name, one in schema.pop("$defs", {}).items():
            if name not in defined:
                defined[name] = one
                _gather(one, defined)
        for one in schema.values():
            _gather(one, defined)
    elif isinstance(schema, list):
        for one in schema:
            _gather(one, defined)


def _references(schema: Any) -> Iterator[str]:
    if isinstance(schema, dict):
        if isinstance(schema.get("$ref"), str):
            yield schema["$ref"]
        for one in schema.values():
            yield from _references(one)
    elif isinstance(schema, list):
        for one in schema:
            yield from _references(one)


def _plain(schema: Any, *, keys: bool = False) -> Any:
    """Without what says nothing: names that repeat the key, and null, which TOML does not have.

    keys: True where the schema is a table of keys, whose names are the user's.
    """
    if isinstance(schema, list):
        return [_plain(one) for one in schema]
    if not isinstance(schema, dict):
        return schema.replace(REFERENCE, _DEFINED) if isinstance(schema, str) else schema
    if keys:
        return {key: _plain(one) for key, one in schema.items()}
    kept = {key: _plain(one, keys=key in ("properties", "$defs")) for key, one in schema.items()}
    if "$defs" not in kept:
        kept.pop("title", None)
    if kept.get("default", ...) is None or isinstance(kept.get("default"), dict):
        del kept["default"]
    arms = [one for one in kept.get("anyOf", ()) if one != {"type": "null"}]
    if len(arms) == 1:
        del kept["anyOf"]
        said = sentences(*(one.get("description") for one in (kept, *arms)))
        kept |= {**arms[0], "description": said}
    elif arms:
        kept["anyOf"] = arms
    if not kept.get("description", ...):
        del kept["description"]
    return kept
