"""What a class or a function takes and makes, by its annotations."""

from __future__ import annotations

import dataclasses
import inspect
import re
import types
from collections.abc import Callable, Collection
from typing import Any, Union, Unpack, get_args, get_origin, get_type_hints

from treadload.errors import InputError


def parameters(target: Callable[..., Any], hidden: tuple[Any, ...] = ()) -> dict[str, tuple[Any, Any]]:
    """Annotation and default (... if there is none) of what a class or a function takes, by name.

    hidden: annotations of parameters that are left out. Raises InputError for one without an annotation.
    """
    who = getattr(target, "__qualname__", str(target))
    try:
        source = target.__init__ if inspect.isclass(target) and not dataclasses.is_dataclass(target) else target
        hints = get_type_hints(source, include_extras=True)
        signature = inspect.signature(target)
    except (NameError, TypeError, ValueError) as error:
        raise InputError(f"the annotations of {who} cannot be read: {error}") from error
    fields = dataclasses.fields(target) if dataclasses.is_dataclass(target) else ()
    # The signature shows a mark in place of what a factory makes.
    factories = {
        field.name: field.default_factory for field in fields if field.default_factory is not dataclasses.MISSING
    }
    taken: dict[str, tuple[Any, Any]] = {}
    for name, parameter in signature.parameters.items():
        if parameter.kind is parameter.VAR_KEYWORD and get_origin(hints.get(name)) is Unpack:
            # Keys that several makers share, all of which may be left out.
            (shared,) = get_args(hints[name])
            taken |= {key: (hint, None) for key, hint in get_type_hints(shared, include_extras=True).items()}
        if parameter.kind in (parameter.VAR_POSITIONAL, parameter.VAR_KEYWORD):
            continue
        if name not in hints:
            raise InputError(f"the parameter {name} of {who} has no annotation; give it one, as Length or Number")
        if hints[name] not in hidden:
            default = ... if parameter.default is parameter.empty else parameter.default
            taken[name] = hints[name], factories[name]() if name in factories else default
    return taken


def made_by(target: Callable[..., Any]) -> tuple[Any, ...]:
    """Types that a maker returns: a class itself, those of a function's annotation."""
    if inspect.isclass(target):
        return (target,)
    hint = get_type_hints(target).get("return")
    return tuple(get_args(hint)) if get_origin(hint) in (Union, types.UnionType) else (hint,)


def makes(target: Callable[..., Any], only: tuple[type, ...]) -> bool:
    """True if a maker returns one of these types."""
    return any(inspect.isclass(kind) and issubclass(kind, only) for kind in made_by(target))


def words_of(target: Any) -> str:
    """Docstrings of a class and of those it comes from, or of a function."""
    kinds = target.__mro__ if inspect.isclass(target) else (target,)
    return "\n\n".join(inspect.cleandoc(kind.__doc__) for kind in kinds if kind.__doc__)


def descriptions(text: str, names: Collection[str]) -> dict[str, str]:
    """The descriptions of names in a docstring: the words behind "name: " or "name, other: ", up to the next."""
    alternatives = "|".join(map(re.escape, sorted(names, key=len, reverse=True)))
    if not alternatives:
        return {}
    words_by_name: dict[str, str] = {}
    for paragraph in re.split(r"\n\s*\n", text):
        line = " ".join(paragraph.split())
        heads = list(re.finditer(rf"(?:^|(?<=[.;:?)`] ))((?:(?:{alternatives}), )*(?:{alternatives})): ", line))
        ends = [*(head.start() for head in heads[1:]), len(line)]
        for head, end in zip(heads, ends, strict=False):
            words = line[head.end() : end]
            words = re.split(r" (?=Raises |Source: |Sources: |Build it )", words)[0].strip()
            for name in head[1].split(", "):
                words_by_name.setdefault(name, words)
    return words_by_name
