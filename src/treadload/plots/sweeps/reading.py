"""A study as its figures read it: inputs, dimensions, what failed, and how much of it one figure shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from treadload.composing import Source, dataset_of
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import BoolArray
from treadload.plots.kit.shown import shown
from treadload.results.schema import read_json

UNSOLVED, FAILED = 0, 2
# Dimensions of maps.
PLANE = ("y", "x")
# What differs by less is round-off: of strains, the smallest quantities, and of forces, moments and stresses in SI.
_LEAST, _LEAST_FORCE = 1e-8, 1e-2
# What every study has and no figure draws.
_OWN = ("status", "seconds")


@dataclass(frozen=True, eq=False)
class View:
    """A study. dims: of its design. inputs: names of what was varied."""

    data: xr.Dataset
    dims: tuple[str, ...]
    inputs: tuple[str, ...]

    @classmethod
    def of(cls, source: Source) -> View:
        """The study in a result or a dataset. Raises InputError for anything else."""
        data = dataset_of(source)
        found = [str(name) for name, one in data.coords.items() if "key" in one.attrs]
        # A store tells its arrays in an order of its own.
        told = [one.get("name") for one in read_json(data.attrs.get("design"), {}).get("inputs", ())]
        inputs = tuple(sorted(found, key=lambda name: told.index(name) if name in told else len(told)))
        if "status" not in data or not inputs:
            raise InputError("this figure needs a study, such as what `tl.sweep` returned or `open_sweep` read")
        return cls(data, tuple(map(str, data["status"].dims)), inputs)

    @property
    def is_product(self) -> bool:
        """True if every input has a dimension of its own: all combinations were solved."""
        return all(self.data[name].dims == (name,) for name in self.inputs)

    @property
    def numeric(self) -> tuple[str, ...]:
        """Inputs that are numbers, those of most values first."""
        found = [name for name in self.inputs if self.data[name].dtype.kind in "fiu"]
        varied = [name for name in found if len(np.unique(self.data[name].to_numpy())) > 1]
        return tuple(sorted(varied, key=lambda name: -len(np.unique(self.data[name].to_numpy()))))

    def readings(self) -> tuple[str, ...]:
        """Names of numbers that every case has and that are not the same in all of them."""
        return tuple(
            str(name)
            for name, one in self.data.data_vars.items()
            if name not in _OWN and set(self.dims) <= set(one.dims) and not {"x", "y", "point"} & set(one.dims)
            and one.dtype.kind in "fiu" and _varies(one)
        )  # fmt: skip

    def reading(self, name: str) -> xr.DataArray:
        """A result of every case, by its name, also where an input took it. Raises InputError."""
        known = [str(one) for one in self.data.data_vars if one not in _OWN]
        found = name if name in known else f"solved_{name}"
        if found not in known:
            raise InputError(f"the study has no {name!r}; {nearest(name, known)[:400]}")
        field = self.data[found]
        if field.dtype.kind not in "fiu":
            raise InputError(f"{name} holds texts, which cannot be drawn; see them in `treadload study table`")
        return field

    def input(self, name: str) -> str:
        """The name of an input in the study, by its name, its key or the end of it. Raises InputError."""
        keys = {one: str(self.data[one].attrs["key"]) for one in self.inputs}
        found = [one for one in self.inputs if name in (one, keys[one])]
        found = found or [one for one in self.inputs if keys[one].rpartition(".")[2] == name]
        if not found:
            raise InputError(f"the study does not vary {name!r}; it varies {', '.join(self.inputs)}")
        return found[0]

    def chosen(
        self, field: xr.DataArray, kept: Sequence[str], at: Mapping[str, Any] | None
    ) -> tuple[dict[str, int], list[str]]:
        """Where a field is cut so that only some dimensions stay: index of each other one, and the cut in words.

        at: name of an input or a dimension → value, the nearest of which is taken; left out, the middle of an input
        and the first of a dimension of the result. Raises InputError for a name that the field is not over.
        """
        asked = {}
        for name, value in (at or {}).items():
            dim = name if name in field.dims else str(self.data[self.input(name)].dims[0])
            if dim not in field.dims or dim in kept:
                raise InputError(f"this figure is not cut at {name}; it can be at {_others(field, kept)}")
            asked[dim] = value
        index, told = {}, []
        for dim in (str(one) for one in field.dims if one not in kept):
            axis = self.data[dim] if dim in self.data.coords else xr.DataArray(np.arange(field.sizes[dim]), dims=dim)
            index[dim] = nearest_index(axis, asked[dim]) if dim in asked else (
                field.sizes[dim] // 2 if dim in self.dims else 0
            )  # fmt: skip
            if field.sizes[dim] > 1 or dim in self.dims:
                told.append(said(axis, index[dim], dim))
        return index, told

    def counted(self, status: xr.DataArray | None = None) -> str:
        """How many cases failed or wait, for a line under a title; empty if none."""
        codes = (self.data["status"] if status is None else status).to_numpy()
        failed, waiting = int((codes == FAILED).sum()), int((codes == UNSOLVED).sum())
        told = [f"{failed} of {codes.size} cases failed (×)"] if failed else []
        return ", ".join([*told, *([f"{waiting} not solved yet"] if waiting else [])])

    def failed(self, index: Mapping[str, int]) -> BoolArray:
        """Which cases failed where the study is cut."""
        status = self.data["status"]
        found: BoolArray = (
            status.isel({dim: k for dim, k in index.items() if dim in status.dims}).to_numpy() == FAILED
        )
        return found


def nearest_index(axis: xr.DataArray, value: Any) -> int:
    """Index of the value of an axis nearest to one; of texts of that very one. Raises InputError."""
    values = axis.to_numpy()
    if values.dtype.kind in "fiu":
        try:
            return int(np.argmin(np.abs(values - float(value))))
        except (TypeError, ValueError) as error:
            raise InputError(f"{axis.name} is a number in SI units, got {value!r}") from error
    names = [str(one) for one in values]
    if str(value) not in names:
        raise InputError(f"{axis.name} has no {value!r}; {nearest(str(value), names)[:300]}")
    return names.index(str(value))


def said(axis: xr.DataArray, number: int, name: str = "") -> str:
    """A place on an axis in words: "normal load 30 kN"."""
    how = shown(axis, name)
    value = axis.to_numpy()[number]
    return f"{how.words} {how.number(value.item() if hasattr(value, 'item') else value)}"


def beside(view: View, field: xr.DataArray) -> str:
    """What a result is read at besides a point of the study, in words: "criterion base", "depth 20 mm"; else empty.

    It is the first of what it is over, as in figures that show one line.
    """
    own = [str(dim) for dim in field.dims if dim not in view.dims and dim in field.coords]
    return ", ".join(said(field[dim], 0, dim) for dim in own)


def _varies(field: xr.DataArray) -> bool:
    values = np.asarray(field.to_numpy(), dtype=float)
    known = values[np.isfinite(values)]
    least = _LEAST_FORCE if field.attrs.get("units") in ("N", "Pa", "N m") else _LEAST
    return known.size > 1 and float(np.ptp(known)) > max(least, 1e-9 * float(np.abs(known).max()))


def _others(field: xr.DataArray, kept: Sequence[str]) -> str:
    return ", ".join(str(dim) for dim in field.dims if dim not in kept) or "nothing"
