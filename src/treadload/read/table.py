"""A table of TOML, and the messages about a wrong one."""

from __future__ import annotations

import types
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, ClassVar, Protocol, Union, get_args, get_origin

from pydantic import BaseModel, ConfigDict, ValidationError, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from treadload.errors import InputError, nearest
from treadload.read.signature import descriptions, words_of
from treadload.registry import OURS, Entry, Registry

# Errors reported at once: a reader repairs the first, and the rest may follow from it.
_MOST_ERRORS = 4
HERE = Path(".")
_KINDS = {
    "tuple_type": "a list",
    "string_type": "text",
    "bool_type": "true or false",
    "bool_parsing": "true or false",
    "int_type": "a whole number",
    "dict_type": "a table of keys and values",
    "model_type": "a table of keys and values",
}


class Table(BaseModel):
    """A table: frozen, and no key that it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")
    # Keys of which a table has exactly one; stated in the schema for editors.
    one_of: ClassVar[tuple[str, ...]] = ()

    def __repr_args__(self) -> Any:
        """What was given; the rest stands at its default."""
        return [(name, value) for name, value in super().__repr_args__() if name in self.model_fields_set]

    @classmethod
    def known_keys(cls) -> tuple[str, ...]:
        """Keys that the table knows."""
        return tuple(name for name, field in cls.model_fields.items() if not field.exclude)

    @classmethod
    def as_table(cls, value: Any) -> Any:
        """What is read in place of a value."""
        return value

    @classmethod
    def unknown(cls, key: str) -> str:
        """The message about an unknown key."""
        return nearest(key, cls.known_keys(), "known here:")

    @classmethod
    def about(cls) -> dict[str, str]:
        """What the keys are, in the words of the docstring."""
        kinds = (kind for kind in cls.__mro__ if issubclass(kind, Table))
        return descriptions("\n\n".join(kind.__doc__ or "" for kind in kinds), cls.known_keys())

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: Any, handler: Any) -> dict[str, Any]:
        """The keys with their words; those of their units stand with the numbers."""
        reference: dict[str, Any] = handler(schema)
        table = handler.resolve_ref_schema(reference)
        about = cls.about()
        for key in [key for key in table["properties"] if key not in cls.known_keys()]:
            del table["properties"][key]
        for key, part in table["properties"].items():
            part["description"] = sentences(about.get(key), part.get("description"))
        table["description"] = first_words(cls)
        if cls.one_of:
            table["oneOf"] = [{"required": [key]} for key in cls.one_of]
        return reference

    @model_validator(mode="wrap")
    @classmethod
    def _explained(cls, value: Any, handler: Any) -> Any:
        """Suggest the key that was meant by an unknown one, while the table is known."""
        value = cls.as_table(value)
        try:
            return handler(value)
        except ValidationError as error:
            details: list[InitErrorDetails] = []
            for detail in error.errors():
                strange = detail["type"] == "extra_forbidden" and len(detail["loc"]) == 1
                text = cls.unknown(str(detail["loc"][0])) if strange else _plainly(detail)
                kind: Any = PydanticCustomError(detail["type"], text.removeprefix("Value error, "))
                details.append({"type": kind, "loc": detail["loc"], "input": detail["input"]})
            raise ValidationError.from_exception_data(cls.__name__, details) from error


class Mark:
    """An annotation that states how a value is read, and what it stands for."""

    def options(self) -> tuple[Any, ...]:
        """Types that the value may have; none if the annotation itself is the type."""
        return ()

    def build(self, value: Any, folder: Path = HERE) -> Any:
        """What a value that was read stands for; files start from the folder."""
        return value


@dataclass(frozen=True)
class File(Mark):
    """The path of a file, from the folder of the case."""

    def build(self, value: Any, folder: Path = HERE) -> Any:
        """The path from here."""
        return folder / value if isinstance(value, str) else value


class Kinds(Protocol):
    """What a table that is one of several kinds asks of them."""

    @property
    def registry(self) -> Registry:
        """What makes them."""

    @property
    def about(self) -> str:
        """What the keys are that all of them have, as a docstring describes them."""

    def knows(self, key: str) -> bool:
        """True if one of them has this key."""

    def check(self, product: Any, entry: Entry) -> None:
        """Refuse what is not one of them. Raises InputError."""


class TargetTable(Table):
    """The table of what a class or a function makes; see `table_of`."""

    target: ClassVar[Callable[..., Any]]
    entry: ClassVar[Entry | None] = None
    hints: ClassVar[Mapping[str, Any]]
    # Keys that the target does not take, and what makes use of them.
    besides: ClassVar[tuple[str, ...]] = ()
    finish: ClassVar[Callable[[Any, TargetTable, Path], Any] | None] = None
    kinds: ClassVar[Kinds | None] = None

    @classmethod
    def unknown(cls, key: str) -> str:
        """Which key was meant; of one that belongs to another kind, what this one takes."""
        if cls.kinds is not None and cls.entry is not None and cls.kinds.knows(key):
            listed = ", ".join(name for name in cls.model_fields if name != cls.kinds.registry.key) or "none"
            return f"{key} is not a key of the {cls.kinds.registry.noun} {cls.entry.name!r}, which takes {listed}"
        return super().unknown(key)

    @classmethod
    def about(cls) -> dict[str, str]:
        """What the keys are, in the words of the target's docstring and of those that all kinds share."""
        shared = "" if cls.kinds is None else cls.kinds.about
        texts = descriptions(words_of(cls.target), cls.known_keys())
        first = first_words(cls)
        kind = {} if cls.kinds is None else {cls.kinds.registry.key: first}
        return {**descriptions(shared, cls.known_keys()), **texts, **kind}

    @classmethod
    def as_table(cls, value: Any) -> Any:
        """The arguments of an object that is made already."""
        if isinstance(cls.target, type) and isinstance(value, cls.target):
            return {name: getattr(value, name) for name in cls.hints}
        return value

    @classmethod
    def needs_more(cls) -> bool:
        """True if its name alone is not enough."""
        key = "" if cls.kinds is None else cls.kinds.registry.key
        return any(field.is_required() for name, field in cls.model_fields.items() if name != key)

    def arguments(self, folder: Path = HERE) -> dict[str, Any]:
        """Arguments of the target that the table gives; files start from the folder."""
        names = [name for name in self.hints if name in self.model_fields_set and name not in self.besides]
        return {name: settled(getattr(self, name), self.hints[name], folder) for name in names}

    def build(self, folder: Path = HERE) -> Any:
        """The object; files start from the folder. Raises InputError and ValueError."""
        product = guarded(self.entry, self.target, **self.arguments(folder))
        if self.kinds is not None and self.entry is not None:
            self.kinds.check(product, self.entry)
        finish = type(self).finish
        return product if finish is None else finish(product, self, folder)

    @property
    def waits(self) -> bool:
        """True if it cannot be built as it is read: a file is read for it, or it asks for more than its table."""
        return any(_reads_file(getattr(self, name), self.hints[name]) for name in self.hints)

    @model_validator(mode="after")
    def _can_be_built(self) -> TargetTable:
        # What is cheap to build is built where its key is known.
        if not self.waits:
            self.build()
        return self


def sentences(*texts: str | None) -> str:
    """Texts one behind the other, each ended by a full stop."""
    return " ".join(text if text.endswith((".", "?", "!")) else f"{text}." for text in texts if text)


def first_words(kind: Any) -> str:
    """The first paragraph of a docstring, in one line."""
    return " ".join((kind.__doc__ or "").strip().split("\n\n")[0].split())


def _plainly(error: Any) -> str:
    """The message about a value of the wrong kind, in the words of TOML."""
    if error["type"] in _KINDS:
        return f"must be {_KINDS[error['type']]}, got {error['input']!r}"
    return str(error["msg"])


def guarded(entry: Entry | None, target: Callable[..., Any], *args: Any, **arguments: Any) -> Any:
    """What a target returns; what goes wrong in another package is reported as its failure. Raises InputError."""
    if entry is None or entry.package == OURS:
        return target(*args, **arguments)
    try:
        return target(*args, **arguments)
    except ValueError:
        raise
    except Exception as error:
        raise InputError(f"{entry.name!r} of {entry.package} fails: {error!r}; repair that package") from error


def in_words(error: ValidationError) -> str:
    """The first errors of a table on one line, each with the path of its key."""
    # A key that was misspelt is missing, too: what was meant is said first.
    errors = sorted(error.errors(), key=lambda detail: detail["type"] != "extra_forbidden")
    texts = [_one_error(item) for item in errors[:_MOST_ERRORS]]
    return "; ".join([*texts, f"and {len(errors) - _MOST_ERRORS} more"] if len(errors) > _MOST_ERRORS else texts)


def by_key(error: BaseException) -> dict[str, str]:
    """The messages of the reader, by the path of the key; "" of the whole. Empty for another error."""
    cause = error.__cause__
    texts: dict[str, str] = {}
    for detail in cause.errors() if isinstance(cause, ValidationError) else ():
        path = ".".join(map(str, detail["loc"]))
        text = _plainly(detail).removeprefix("Value error, ")
        if detail["type"] == "missing":
            text = "this is missing"
        elif detail["type"] == "extra_forbidden":
            text = f"unknown key; {text}"
        texts[path] = f"{texts[path]}; {text}" if path in texts else text
    return texts


def _one_error(item: Any) -> str:
    place = ".".join(map(str, item["loc"]))
    message = _plainly(item).removeprefix("Value error, ")
    if item["type"] == "extra_forbidden":
        return f"unknown key {place!r}; {message}"
    if item["type"] == "missing":
        return f"{place!r} is missing"
    return f"{place}: {message}" if place else message


def arms(hint: Any) -> list[Any]:
    """The types that a value may have."""
    if get_origin(hint) in (Union, types.UnionType):
        return [arm for member in get_args(hint) for arm in arms(member)]
    if get_origin(hint) is Annotated:
        options = [option for mark in get_args(hint)[1:] if isinstance(mark, Mark) for option in mark.options()]
        if options:
            return [arm for option in options for arm in arms(option)]
    return [hint]


def _marks(hint: Any) -> list[Mark]:
    marks = (mark for arm in arms(hint) if get_origin(arm) is Annotated for mark in get_args(arm)[1:])
    return [mark for mark in marks if isinstance(mark, Mark)]


def _members(hint: Any, count: int) -> list[Any]:
    """Types of the members of a list."""
    within = next((get_args(arm) for arm in arms(hint) if get_origin(arm) is tuple), (Any, ...))
    return [within[0]] * count if within[-1] is ... else list(within)


def settled(value: Any, hint: Any, folder: Path) -> Any:
    """The argument that a value of a table stands for."""
    if isinstance(value, TargetTable):
        return value.build(folder)
    if isinstance(value, Mapping):
        within = next((get_args(arm)[1] for arm in arms(hint) if get_origin(arm) is dict), Any)
        return {key: settled(item, within, folder) for key, item in value.items()}
    if isinstance(value, list | tuple):
        members = zip(value, _members(hint, len(value)), strict=True)
        return tuple(settled(item, of, folder) for item, of in members)
    for mark in _marks(hint):
        value = mark.build(value, folder)
    return value


def _reads_file(value: Any, hint: Any) -> bool:
    if isinstance(value, TargetTable):
        return value.waits
    if isinstance(value, Mapping):
        return any(isinstance(item, TargetTable) and item.waits for item in value.values())
    if isinstance(value, list | tuple):
        return any(_reads_file(item, of) for item, of in zip(value, _members(hint, len(value)), strict=True))
    return value is not None and any(isinstance(mark, File) for mark in _marks(hint))
