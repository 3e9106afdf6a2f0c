"""A study as its figures read it: inputs, dimensions, what failed, and how much of it one figure shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np

from treadload.composing import Source, dataset_of
from treadload.deferred import xarray as xr
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import BoolArray
from treadload.plots.kit.shown import shown
from treadload.results.schema import read_json
from treadload.variables import VARIABLES

UNSOLVED, FAILED = 0, 2
# Dimensions of maps.
PLANE = ("y", "x")
# What differs by less is round-off: of strains, the smallest quantities, and of forces, moments and stresses in SI.
_LEAST, _LEAST_FORCE = 1e-8, 1e-2
# What every study has and no figure draws.
_BOOKKEEPING = ("status", "seconds")
# What a reader looks for first, in this order; behind what was asked for by name.
_MAIN = (
    "worst_strain", "worst_passes", "governing_years", "life_years", "largest_extension", "slip_fraction",
    "largest_in_plane_extension", "largest_pressure", "creepage_x", "creepage_y", "tractive_force", "lateral_force",
    "approach", "net_area",
)  # fmt: skip
_STATISTICS = ("max_", "min_", "mean_")


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
        coordinates = [str(name) for name, coordinate in data.coords.items() if "key" in coordinate.attrs]
        # A store tells its arrays in an order of its own.
        order = [entry.get("name") for entry in read_json(data.attrs.get("design"), {}).get("inputs", ())]
        inputs = tuple(sorted(coordinates, key=lambda name: order.index(name) if name in order else len(order)))
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
        numeric = [name for name in self.inputs if self.data[name].dtype.kind in "fiu"]
        varied = [name for name in numeric if len(np.unique(self.data[name].to_numpy())) > 1]
        return tuple(sorted(varied, key=lambda name: -len(np.unique(self.data[name].to_numpy()))))

    def readings(self) -> tuple[str, ...]:
        """Names of numbers that every case has and that are not the same in all of them."""
        return tuple(
            str(name)
            for name, variable in self.data.data_vars.items()
            if name not in _BOOKKEEPING and set(self.dims) <= set(variable.dims)
            and not {"x", "y", "point"} & set(variable.dims)
            and variable.dtype.kind in "fiu" and _varies(variable)
        )  # fmt: skip

    def reading(self, name: str) -> xr.DataArray:
        """A result of every case, by its name, also where an input took it. Raises InputError."""
        names = [str(variable) for variable in self.data.data_vars if variable not in _BOOKKEEPING]
        full_name = name if name in names else f"solved_{name}"
        if full_name not in names:
            raise InputError(f"the study has no {name!r}; {nearest(name, names)[:400]}")
        field = self.data[full_name]
        if field.dtype.kind not in "fiu":
            raise InputError(f"{name} holds texts, which cannot be drawn; see them in `treadload study table`")
        return field

    def input(self, name: str) -> str:
        """The name of an input in the study, by its name, its key or the end of it. Raises InputError."""
        keys = {coordinate: str(self.data[coordinate].attrs["key"]) for coordinate in self.inputs}
        matches = [coordinate for coordinate in self.inputs if name in (coordinate, keys[coordinate])]
        matches = matches or [coordinate for coordinate in self.inputs if keys[coordinate].rpartition(".")[2] == name]
        if not matches:
            raise InputError(f"the study does not vary {name!r}; it varies {', '.join(self.inputs)}")
        return matches[0]

    def chosen(
        self, field: xr.DataArray, kept: Sequence[str], at: Mapping[str, object] | None
    ) -> tuple[dict[str, int], list[str]]:
        """Where a field is cut so that only some dimensions stay: index of each other one, and the cut in words.

        at: name of an input or a dimension → value, the nearest of which is taken; left out, the middle of an input
        and the first of a dimension of the result. Raises InputError for a name that the field is not over.
        """
        wanted = {}
        for name, value in (at or {}).items():
            dim = name if name in field.dims else str(self.data[self.input(name)].dims[0])
            if dim not in field.dims or dim in kept:
                raise InputError(f"this figure is not cut at {name}; it can be at {_free_dims(field, kept)}")
            wanted[dim] = value
        index, notes = {}, []
        for dim in (str(dim_name) for dim_name in field.dims if dim_name not in kept):
            axis = self.data[dim] if dim in self.data.coords else xr.DataArray(np.arange(field.sizes[dim]), dims=dim)
            index[dim] = nearest_index(axis, wanted[dim]) if dim in wanted else (
                field.sizes[dim] // 2 if dim in self.dims else 0
            )  # fmt: skip
            if field.sizes[dim] > 1 or dim in self.dims:
                notes.append(place_in_words(axis, index[dim], dim))
        return index, notes

    def counted(self, status: xr.DataArray | None = None) -> str:
        """How many cases failed or wait, for a line under a title; empty if none."""
        codes = (self.data["status"] if status is None else status).to_numpy()
        failed, waiting = int((codes == FAILED).sum()), int((codes == UNSOLVED).sum())
        notes = [f"{failed} of {codes.size} cases failed (×)"] if failed else []
        return ", ".join([*notes, *([f"{waiting} not solved yet"] if waiting else [])])

    def failed(self, index: Mapping[str, int]) -> BoolArray:
        """Which cases failed where the study is cut."""
        status = self.data["status"]
        failed: BoolArray = (
            status.isel({dim: k for dim, k in index.items() if dim in status.dims}).to_numpy() == FAILED
        )
        return failed


def nearest_index(axis: xr.DataArray, value: object) -> int:
    """Index of the value of an axis nearest to one; of texts of that very one. Raises InputError."""
    values = axis.to_numpy()
    if values.dtype.kind in "fiu":
        try:
            return int(np.argmin(np.abs(values - float(cast("float | str", value)))))
        except (TypeError, ValueError) as error:
            raise InputError(f"{axis.name} is a number in SI units, got {value!r}") from error
    names = [str(value) for value in values]
    if str(value) not in names:
        raise InputError(f"{axis.name} has no {value!r}; {nearest(str(value), names)[:300]}")
    return names.index(str(value))


def place_in_words(axis: xr.DataArray, number: int, name: str = "") -> str:
    """A place on an axis in words: "normal load 30 kN"."""
    how = shown(axis, name)
    value = axis.to_numpy()[number]
    return f"{how.words} {how.number(value.item() if hasattr(value, 'item') else value)}"


def beside(view: View, field: xr.DataArray) -> str:
    """What a result is read at besides a point of the study, in words: "criterion base", "depth 20 mm"; else empty.

    It is the first of what it is over, as in figures that show one line.
    """
    extra = [str(dim) for dim in field.dims if dim not in view.dims and dim in field.coords]
    return ", ".join(place_in_words(field[dim], 0, dim) for dim in extra)


def main_readings(view: View, most: int) -> list[str]:
    """Names of the results that a reader looks for first, those that differ between the cases."""
    varying = view.readings()
    statistics = [name for name in varying if name.startswith(_STATISTICS) and name not in VARIABLES]
    wanted = [*statistics, *(name for name in _MAIN if name in varying)]
    rest = [name for name in varying if name not in wanted and not name.startswith("solved_")]
    return (wanted or rest)[:most]


def _varies(field: xr.DataArray) -> bool:
    values = np.asarray(field.to_numpy(), dtype=float)
    finite = values[np.isfinite(values)]
    least = _LEAST_FORCE if field.attrs.get("units") in ("N", "Pa", "N m") else _LEAST
    return finite.size > 1 and float(np.ptp(finite)) > max(least, 1e-9 * float(np.abs(finite).max()))


def _free_dims(field: xr.DataArray, kept: Sequence[str]) -> str:
    return ", ".join(str(dim) for dim in field.dims if dim not in kept) or "nothing"
