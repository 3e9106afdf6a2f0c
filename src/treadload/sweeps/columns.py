"""Values of an input of a study as arrays: what is a number, and the labels of what is none."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from typing import TypeGuard

import numpy as np

from treadload.deferred import xarray as xr
from treadload.errors import InputError

# Text that stands for a table or a list, at most so long.
_LABEL = 60


def is_finite(value: object) -> bool:
    """True for a number that is neither infinite nor NaN."""
    return is_number(value) and math.isfinite(value)


def is_number(value: object) -> TypeGuard[float]:
    """True for a number, and not for a truth."""
    return isinstance(value, int | float | np.number) and not isinstance(value, bool | np.bool_)


def listed_values(name: str, values: object) -> list[object]:
    """The values of an input. Raises InputError for what is no list, and for an empty one."""
    if isinstance(values, str | bytes | Mapping) or not isinstance(values, Sequence | np.ndarray | xr.DataArray):
        raise InputError(f"{name} needs a list of values, got {values!r}")
    numbers = values.tolist() if hasattr(values, "tolist") else list(values)
    if not numbers:
        raise InputError(f"{name} has no values; give at least one")
    return numbers


def objects(values: Sequence[object]) -> np.ndarray:
    """Values of any kind as an array of one dimension."""
    array = np.empty(len(values), dtype=object)
    array[:] = list(values)
    return array


def objects_like(values: np.ndarray) -> np.ndarray:
    """An array of any kind as one of Python's values, of the same shape."""
    return objects([item.item() if hasattr(item, "item") else item for item in values.flat]).reshape(values.shape)


def labels_of(values: np.ndarray) -> np.ndarray:
    """Values as coordinates: numbers, or texts that differ where they do."""
    flat = list(values.flat)
    if all(is_number(value) or value is None for value in flat):
        numbers = np.array([math.nan if item is None else item for item in flat], dtype=float).reshape(values.shape)
        if not np.isfinite(numbers[values != None]).all():  # noqa: E711  of each
            raise InputError(f"values must be finite numbers, got {numbers[~np.isfinite(numbers)][0]}")
        return numbers
    texts = ["" if item is None else item if isinstance(item, str) else _short(item) for item in flat]
    whole = {text: [repr(v) for t, v in zip(texts, flat, strict=True) if t == text] for text in texts}
    numbers_of = {text: itertools.count(1) for text, members in whole.items() if len(set(members)) > 1}
    distinct = [f"{text} ({next(numbers_of[text])})" if text in numbers_of else text for text in texts]
    return np.array(distinct, dtype=str).reshape(values.shape)


def _short(value: object) -> str:
    if isinstance(value, Mapping):
        named = next((value[key] for key in ("name", "structure", "profile", "law", "kind") if key in value), None)
        if isinstance(named, str):
            return named
    text = "true" if value is True else "false" if value is False else str(value)
    return text if len(text) <= _LABEL else f"{text[: _LABEL - 1]}…"
