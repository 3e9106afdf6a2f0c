"""What is wrong with a case, in words that name the key."""

from __future__ import annotations

import difflib
from typing import Any

from pydantic import BaseModel, ValidationError

from treadload.case.asphalt import ROAD_PARTS
from treadload.case.friction import LAW_PARTS
from treadload.case.materials import TIRE_PARTS
from treadload.case.road import BOND_TAGS, TEMPERATURE_TAGS, BondPart, ProfilePart
from treadload.case.shift import SHIFT_PARTS

# Names by which the tables of a key are told apart; they stand in a location behind the key.
_TAGS = {
    "friction": (*LAW_PARTS, "number"),
    "base": (*LAW_PARTS, "number"),
    "material": tuple(ROAD_PARTS),
    "shift": tuple(SHIFT_PARTS),
    "bond": BOND_TAGS,
    "temperature": TEMPERATURE_TAGS,
}
_TABLES: dict[str, type[BaseModel]] = {
    **LAW_PARTS,
    **ROAD_PARTS,
    **SHIFT_PARTS,
    "spring": BondPart,
    "depths": ProfilePart,
}


# Errors told at once: a reader repairs the first, and the rest may follow from it.
_TOLD = 4


def in_words(error: ValidationError, case: type[BaseModel]) -> str:
    """The first errors of a case on one line. case: the model that was validated."""
    found = error.errors()
    told = [_one_error(item, case) for item in found[:_TOLD]]
    return "; ".join([*told, f"and {len(found) - _TOLD} more"] if len(found) > _TOLD else told)


def _one_error(item: Any, case: type[BaseModel]) -> str:
    place = ".".join(_without_tags(item["loc"]))
    message = str(item["msg"]).removeprefix("Value error, ")
    if item["type"] == "extra_forbidden":
        known = _keys(item["loc"][:-1], case)
        near = difflib.get_close_matches(str(item["loc"][-1]), known, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known here: {', '.join(known)}"
        return f"unknown key {place!r}; {hint}"
    if item["type"] == "missing":
        return f"{place!r} is missing"
    return f"{place}: {message}" if place else message


def _without_tags(location: tuple[Any, ...]) -> list[str]:
    """Parts of a location without the names by which tables are told apart."""
    before = ("", *location)
    return [str(part) for part, last in zip(location, before, strict=False) if part not in _TAGS.get(str(last), ())]


def _keys(location: tuple[Any, ...], case: type[BaseModel]) -> list[str]:
    """Keys that the table at this location knows."""
    model: Any = case
    for before, part in zip(("", *location), location, strict=False):
        if part in _TAGS.get(str(before), ()):
            model = (TIRE_PARTS if location[0] == "tire" else _TABLES).get(part, model)
        elif not isinstance(part, int):
            annotation = model.model_fields[part].annotation
            model = next(
                (one for one in _within(annotation) if isinstance(one, type) and issubclass(one, BaseModel)), model
            )
    return [name for name in model.model_fields if name != "folder"]


def _within(annotation: Any) -> list[Any]:
    """The types that an annotation is built of, outermost first."""
    parts = [getattr(annotation, "__origin__", annotation)]
    for part in getattr(annotation, "__args__", ()):
        parts += _within(part)
    return parts
