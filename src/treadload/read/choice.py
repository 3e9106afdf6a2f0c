"""Annotations in terms that pydantic reads, and tables distinguished by their kind."""

from __future__ import annotations

import dataclasses
import functools
import inspect
import types
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import Strict, TypeAdapter, ValidationError, create_model
from pydantic_core import core_schema

from treadload import registry as registries
from treadload.errors import InputError, nearest
from treadload.read.signature import makes, parameters
from treadload.read.table import HERE, File, Mark, Table, TargetTable, in_words, settled
from treadload.registry import OURS, Entry, Registry
from treadload.units import Number, Unit

# Stands before the names of definitions in a JSON schema until `treadload.case.schema` puts them together.
REFERENCE = "https://treadload/"


@dataclass(frozen=True, eq=False)
class Choice(Mark):
    """One of what a registry knows, as an annotation: `Annotated[Any, Choice(MATERIALS, "road material")]`.

    title: of it in a JSON schema. only: types, one of which must be made. more: keys that a table of this target has
    besides those of the target, all optional unless in `needed`; finish: what becomes of the made thing by them, from
    the made, its table and the folder. lenient: True if no key of the target is needed; such a table is not built
    when it is read. keeps_number: True to leave a number as it is. hidden: annotations of parameters that are no
    keys. about: the keys in `more`, as a docstring describes them.
    """

    registry: Registry
    title: str = ""
    only: tuple[type, ...] = ()
    more: Callable[[Callable[..., Any]], Mapping[str, Any]] | None = None
    needed: tuple[str, ...] = ()
    finish: Callable[[Any, TargetTable, Path], Any] | None = None
    lenient: bool = False
    keeps_number: bool = False
    hidden: tuple[Any, ...] = ()
    about: str = ""
    base: type[TargetTable] = TargetTable

    def read(self, value: Any) -> Any:
        """The table, or the number or word that stands for one. Raises ValueError and ValidationError."""
        registry = self.registry
        if isinstance(value, TargetTable):
            return value
        if isinstance(value, Mapping):
            return self.table(self._kind(value)).model_validate(value)
        if registry.number:
            return reader(Number).validate_python(value)
        # A list where the name should stand has no place among names.
        if registry.words and isinstance(value, str) and value in self.names():
            self.table(value).model_validate({registry.key: value})
            return value
        if registry.words:
            plain = [name for name in registry.built_in() if not parameters(registry.find(name).target, self.hidden)]
            listed = ", ".join(map(repr, plain))
            raise ValueError(f"a {registry.noun} is {listed} or {registry.example}, got {value!r}")
        raise ValueError(f"a {registry.noun} is a table, got {value!r}")

    def table(self, kind: str) -> type[TargetTable]:
        """The table of a kind. Raises InputError for one that is not known, or whose package is broken."""
        entry = self.registry.find(kind)
        if not self.will_do(kind):
            raise InputError(self.registry.unknown(kind, self.names()))
        try:
            return _table_class(self, entry)
        except InputError as error:
            if entry.package == OURS:
                raise
            who = f"the {self.registry.noun} {entry.name!r} of {entry.package}"
            raise InputError(f"{who} cannot be read from a table: {error}; repair that package") from error

    def names(self) -> tuple[str, ...]:
        """Names that are accepted; all those of other packages, which are not loaded."""
        built_in = self.registry.built_in()
        return tuple(name for name in self.registry.names() if name not in built_in or self.will_do(name))

    def will_do(self, name: str) -> bool:
        """True if what has this name, perhaps of another package, which is loaded, is one of those wanted."""
        return not self.only or makes(self.registry.find(name).target, self.only)

    def knows(self, key: str) -> bool:
        """True if one of our kinds has this key."""
        return any(key in self.table(name).model_fields for name in self.names() if name in self.registry.built_in())

    def table_for(self, table: Mapping[str, Any]) -> type[TargetTable] | None:
        """The table that a kind names, if it is known and can be loaded; for whoever shows it."""
        try:
            return self.table(self._kind(table))
        except ValueError:
            return None

    def build(self, value: Any, folder: Path = HERE) -> Any:
        """What a value that was read stands for."""
        if isinstance(value, TargetTable):
            return value.build(folder)
        if isinstance(value, str):
            return self.table(value).model_validate({self.registry.key: value}).build(folder)
        return value if value is None or self.keeps_number else self.registry.find(self.registry.number).target(value)

    def check(self, product: Any, entry: Entry) -> None:
        """Refuse what another package makes if it is not one of the registry's. Raises InputError."""
        faces = self.only or self.registry.faces
        if entry.package != OURS and faces and not isinstance(product, faces):
            kinds = ", ".join(face.__name__ for face in faces)
            raise InputError(
                f"the {self.registry.noun} {entry.name!r} of {entry.package} must be {kinds}, got {product!r}"
            )

    def _kind(self, table: Mapping[str, Any]) -> str:
        registry = self.registry
        kind = table.get(registry.key, registry.default or None)
        if kind is None:
            raise ValueError(
                f"a {registry.noun} needs its name, {registry.key} = …; {nearest('', sorted(self.names()))}"
            )
        if not isinstance(kind, str) or kind not in self.names():
            raise ValueError(registry.unknown(kind, self.names()))
        return kind

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        return {"$ref": f"{REFERENCE}{_named(self)}"}


@dataclass(frozen=True)
class As(Mark):
    """An annotation: read as this type, by the rules of this module; `Annotated[Any, As(Wander)]`."""

    hint: Any

    def build(self, value: Any, folder: Path = HERE) -> Any:
        """What a value that was read stands for."""
        return settled(value, readable(self.hint), folder)

    def options(self) -> tuple[Any, ...]:
        """What the type may be."""
        return (readable(self.hint),)

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return core_schema.no_info_plain_validator_function(lambda value: reader(self.hint).validate_python(value))

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        return reader(self.hint).json_schema(ref_template=f"{REFERENCE}{{model}}")


@dataclass(frozen=True)
class _ByShape(Mark):
    """An annotation of one of several types, distinguished by whether the value is a list, a table or neither."""

    arms: tuple[Any, ...]

    def options(self) -> tuple[Any, ...]:
        """The types."""
        return self.arms

    def arm(self, value: Any) -> Any:
        shape = (
            "list" if isinstance(value, list | tuple) else "table" if isinstance(value, Mapping | Table) else "one"
        )
        return next((arm for arm in self.arms if _shape(arm) == shape), self.arms[0])

    def __get_pydantic_core_schema__(self, source: Any, handler: Any) -> Any:
        return core_schema.no_info_plain_validator_function(
            lambda value: _adapter(self.arm(value)).validate_python(value)
        )

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> dict[str, Any]:
        return {"anyOf": [_adapter(arm).json_schema(ref_template=f"{REFERENCE}{{model}}") for arm in self.arms]}


def table_of(target: Callable[..., Any]) -> type[TargetTable]:
    """The table that a dataclass or a function reads its arguments from. Raises InputError for one it cannot."""
    return _table_class(None, Entry("", target))


def read(hint: Any, value: Any, place: str, *, folder: Path = HERE) -> Any:
    """What a value of TOML is as a type, a dataclass of its table. place: of it, for errors. Raises InputError."""
    try:
        return settled(reader(hint).validate_python(value), readable(hint), folder)
    except ValidationError as error:
        raise InputError(f"{place}: {in_words(error)}") from error


@functools.cache
def _table_class(choice: Choice | None, entry: Entry) -> type[TargetTable]:
    """The table of what an entry makes, as one of a choice."""
    target = entry.target
    fields: dict[str, Any] = {}
    besides: dict[str, Any] = {}
    if choice is not None:
        key, default = choice.registry.key, choice.registry.default
        fields = dict.fromkeys(choice.needed)
        fields[key] = (Literal[entry.name], entry.name if entry.name == default else ...)
        besides = dict(choice.more(target)) if choice.more is not None else {}
        arguments = parameters(target, choice.hidden)
        besides = {name: hint for name, hint in besides.items() if name not in arguments}
        for name, hint in besides.items():
            fields[name] = (readable(hint), ... if name in choice.needed else None)
    for name, (hint, default) in parameters(target, choice.hidden if choice is not None else ()).items():
        hint_read = readable(hint, f"{name} of {entry.name or getattr(target, '__name__', target)!r}")
        fields[name] = (hint_read | None, None) if choice is not None and choice.lenient else (hint_read, default)
    name = f"{choice.title or choice.registry.noun}, {entry.name}" if choice is not None else _called(target)
    make: Any = create_model  # the types of pydantic's plug-in know the table by its fields alone
    model = make(
        "".join(letter if letter.isalnum() else "_" for letter in name),
        __base__=TargetTable if choice is None else choice.base,
        __doc__=inspect.getdoc(target) or "",
        **fields,
    )
    model.target = staticmethod(target)
    model.entry, model.kinds = entry, choice
    excluded = {*besides, choice.registry.key} if choice is not None else set()
    model.hints = {name: hint for name, (hint, _) in fields.items() if name not in excluded}
    if choice is not None and choice.finish is not None:
        model.finish = staticmethod(choice.finish)
    table: type[TargetTable] = model
    return table


def _called(target: Callable[..., Any]) -> str:
    return str(getattr(target, "__qualname__", type(target).__name__))


def reader(hint: Any) -> TypeAdapter[Any]:
    """What reads a value of a type by the rules of this module."""
    return _adapter(readable(hint))


@functools.cache
def _adapter(hint: Any) -> TypeAdapter[Any]:
    return TypeAdapter(hint)


@functools.cache
def readable(hint: Any, where: str = "") -> Any:
    """An annotation of the mechanics in terms that pydantic reads. Raises InputError for one that no table can be."""
    if hint is float:
        return Number
    if hint is int:
        return Annotated[int, Strict()]
    if hint is Path:
        return Annotated[str, File()]
    if hint in (bool, str, Any) or get_origin(hint) is Literal:
        return hint
    if get_origin(hint) is dict:
        return dict[str, readable(get_args(hint)[1], where)]  # type: ignore[misc]
    if get_origin(hint) is Annotated:
        inner, *marks = get_args(hint)
        if any(isinstance(mark, Unit | Mark) for mark in marks):
            return hint
        return Annotated[(readable(inner, where), *marks)]
    options = get_args(hint) if get_origin(hint) in (Union, types.UnionType) else (hint,)
    registry = next((registry for registry in registries.ALL for arm in options if arm in registry.faces), None)
    if registry is not None:
        keeps = float in options
        chosen = Annotated[Any, _choice(registry, keeps)]
        return chosen | None if type(None) in options else chosen
    if len(options) > 1:
        readables = [readable(arm, where) for arm in options if arm is not type(None)]
        if len(readables) > 1 and any(_shape(arm) != "one" for arm in readables):
            readables = [Annotated[Any, _ByShape(tuple(readables))]]
        together = (*readables, type(None)) if type(None) in options else tuple(readables)
        return Union[together]  # noqa: UP007  # of a tuple
    if get_origin(hint) in (tuple, list) or getattr(get_origin(hint), "__name__", "") == "Sequence":
        within = get_args(hint)
        if get_origin(hint) is not tuple:
            within = (*within, ...)
        return tuple[tuple(member if member is ... else readable(member, where) for member in within)]  # type: ignore[misc]
    if inspect.isclass(hint) and dataclasses.is_dataclass(hint):
        return table_of(hint)
    if inspect.isclass(hint):
        return hint
    raise InputError(f"{where or hint}: the annotation {hint} is not one that a table can hold; see treadload.read")


@functools.cache
def _choice(registry: Registry, keeps_number: bool) -> Choice:
    return Choice(registry, keeps_number=keeps_number)


def _shape(hint: Any) -> str:
    """What a type is in TOML: "list", "table" or "one"."""
    if get_origin(hint) is tuple:
        return "list"
    marks = get_args(hint)[1:] if get_origin(hint) is Annotated else ()
    table = inspect.isclass(hint) and issubclass(hint, Table)
    return "table" if table or get_origin(hint) is dict or any(isinstance(mark, Choice) for mark in marks) else "one"


_CHOICES: dict[str, Choice] = {}


def _named(choice: Choice) -> str:
    """The name of a choice in a JSON schema; the same choice stands under it once."""
    name = (choice.title or choice.registry.noun).replace(" ", "-")
    _CHOICES.setdefault(name, choice)
    return name


def choice_named(name: str) -> Choice | None:
    """The choice that a JSON schema refers to by this name."""
    return _CHOICES.get(name)
