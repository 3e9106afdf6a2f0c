"""What is wrong with a case, in words that name the key."""

from __future__ import annotations

import difflib
from typing import Any

from pydantic import BaseModel, ValidationError

from treadload.case.friction import LAW_PARTS
from treadload.case.materials import MATERIAL_PARTS
from treadload.case.road import BOND_TAGS

_TAGS = {
    "friction": (*LAW_PARTS, "number"),
    "base": (*LAW_PARTS, "number"),
    "material": tuple(MATERIAL_PARTS),
    "bond": BOND_TAGS,
}


def in_words(error: ValidationError, case: type[BaseModel]) -> str:
    """Every error of a case on one line. case: the model that was validated."""
    return "; ".join(_one_error(item, case) for item in error.errors())


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
    """Parts of a location without the names of friction laws and materials, by which tables are told apart."""
    before = ("", *location)
    return [str(part) for part, last in zip(location, before, strict=False) if part not in _TAGS.get(str(last), ())]


def _keys(location: tuple[Any, ...], case: type[BaseModel]) -> list[str]:
    """Keys that the table at this location knows."""
    model: Any = case
    for part in location:
        if isinstance(part, int) or part in ("number", *BOND_TAGS):
            continue
        tables = {**LAW_PARTS, **MATERIAL_PARTS}
        if part in tables and part not in model.model_fields:
            model = tables[part]
            continue
        annotation = model.model_fields[part].annotation
        candidates = [getattr(one, "__origin__", one) for one in (annotation, *getattr(annotation, "__args__", ()))]
        # The name of the law or material that follows says which of its tables is meant.
        model = next((one for one in candidates if isinstance(one, type) and issubclass(one, BaseModel)), model)
    return [name for name in model.model_fields if name != "folder"]
