"""What is kept of each case: its numbers always, fields by their names, and the largest or smallest of fields."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from treadload import variables
from treadload.case import Case
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.sweeps.parts import Parts, parts_of
from treadload.sweeps.record import Values

REDUCTIONS: Mapping[str, Callable[..., Any]] = {"max": np.nanmax, "min": np.nanmin, "mean": np.nanmean}
_WORDS = {"max": "largest", "min": "smallest", "mean": "mean"}
# Prefixes of names: a mean_stress is something else.
_LABELS = {"max": "max", "min": "min", "mean": "mean_of"}
_SELECTOR = re.compile(r"(?:(?P<how>\w+)\()?(?:(?P<part>\w+)\.)?(?P<name>\w+)\)?")
# Sections, whose places and depths are not those of the maps.
_SECTIONS = ("slice_along", "slice_across", "bowl")
# Dimensions that a reduction leaves: it goes over the places of a plane, or of a way.
_PLACES = ("y", "x", "point", "position", "road_x")


@dataclass(frozen=True)
class Selector:
    """A field that is kept. text: as the user wrote it. how: "max", "min", "mean" or "". part: of a result, or ""."""

    text: str
    how: str
    part: str
    name: str

    @property
    def label(self) -> str:
        """Its name in the results of a study."""
        return (
            f"{_LABELS[self.how]}_{self.name}" if self.how else f"{self.part}.{self.name}" if self.part else self.name
        )


def selectors_for(texts: Sequence[str], case: Case) -> tuple[Selector, ...]:
    """What texts ask for: "pressure", "slice_along.strain_xx", "max(principal_strain_1)". Raises InputError."""
    if isinstance(texts, str):
        raise InputError(f"fields are a list of names, got the text {texts!r}; write [{texts!r}]")
    return tuple(_selector(str(text).strip(), case) for text in dict.fromkeys(texts))


def _selector(text: str, case: Case) -> Selector:
    parts = parts_of(case)
    match = _SELECTOR.fullmatch(text)
    if match is None or text.endswith(")") != bool(match["how"]):
        raise InputError(
            f"cannot ask for {text!r}: write a name, such as pressure, slice_along.strain_xx or "
            "max(principal_strain_1)"
        )
    how, part, name = (match[key] or "" for key in ("how", "part", "name"))
    if how and how not in REDUCTIONS:
        raise InputError(f"cannot ask for {text!r}: {how} is not one of {', '.join(REDUCTIONS)}")
    if part and part not in parts:
        raise InputError(f"cannot ask for {text!r}: this case has no part {part!r}; {nearest(part, parts)}")
    if name not in variables.VARIABLES:
        raise InputError(f"no result has a field {name!r}; {nearest(name, variables.VARIABLES, 'see')[:300]}")
    return Selector(text, how, part, name)


def attributes(label: str) -> dict[str, object]:
    """Units and long name of what a study holds under a label."""
    for how, prefix in _LABELS.items():
        name = label.removeprefix(f"{prefix}_")
        if label not in variables.VARIABLES and name in variables.VARIABLES and name != label:
            about = variables.attributes(name)
            return {**about, "long_name": f"{_WORDS[how]} over the plane: {about['long_name']}"}
    name = label.rpartition(".")[2]
    return variables.attributes(name) if name in variables.VARIABLES else {}


def read(
    parts: Parts, readings: Sequence[Selector]
) -> tuple[dict[str, Values], dict[str, Values], dict[str, np.ndarray]]:
    """Numbers and fields of a case, and the coordinates of both. Raises InputError for a field that it lacks."""
    numbers: dict[str, Values] = dict(parts.numbers())
    fields: dict[str, Values] = {}
    coordinates: dict[str, np.ndarray] = dict(parts.coordinates())
    for reading in readings:
        array = _find(parts, reading)
        if reading.how:
            over = [dim for dim in array.dims if dim in _PLACES]
            array = array.reduce(REDUCTIONS[reading.how], over) if over else array
        elif reading.part in _SECTIONS:
            # Where a section crosses the wheel differs from case to case; worst_x and worst_y say it.
            array = array.squeeze([dim for dim in array.dims if array.sizes[dim] == 1], drop=True)
            array = array.rename({dim: f"{reading.part}_{dim}" for dim in array.dims})
        for dim in map(str, array.dims):
            if dim in array.coords:
                array = _aligned(array, dim, coordinates)
        is_field = not reading.how and (array.ndim > 1 or any(dim in _PLACES for dim in array.dims))
        (fields if is_field else numbers)[reading.label] = (tuple(map(str, array.dims)), array.to_numpy())
    return numbers, fields, coordinates


def _aligned(array: xr.DataArray, dim: str, coordinates: dict[str, np.ndarray]) -> xr.DataArray:
    """The array on the places that the case has along a dimension; new ones are added to these."""
    axis, earlier = array[dim].to_numpy(), coordinates.get(dim)
    if earlier is None or np.array_equal(axis, earlier):
        coordinates[dim] = axis
        return array
    if axis.dtype.kind == "f" and np.isin(axis.round(9), earlier.round(9)).all():
        return array.reindex({dim: earlier}, method="nearest", tolerance=1e-9)
    return _aligned(array.rename({dim: f"{array.name}_{dim}"}), f"{array.name}_{dim}", coordinates)


def _find(parts: Parts, reading: Selector) -> xr.DataArray:
    looked = [reading.part] if reading.part else parts.searched
    for part in looked:
        data = parts.dataset(part)
        if data is not None and reading.name in data:
            return data[reading.name]
    have = sorted({str(name) for part in looked if (data := parts.dataset(part)) is not None for name in data})
    raise InputError(f"this case has no field {reading.text!r}; {nearest(reading.name, have, 'it has')}")


def check_varied(case: Case) -> None:
    """Raise InputError for what is not a case, or one whose numbers no study keeps."""
    if not isinstance(case, Case):
        raise InputError(f"a study varies a Case, got {type(case).__name__}")
    if not any(step.swept for step in case.steps):
        raise InputError(
            "a study varies the case of a wheel or of a service life, and this case has "
            f"[{case.source.name}], of which no numbers are kept"
        )
