"""Friction that differs from place to place: a wet or polished wheel path, a painted line."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from treadload.contact.friction.laws import FrictionLaw, Interface, check_base
from treadload.errors import InputError, one_line
from treadload.kernels.arrays import Array
from treadload.registry import FRICTION
from treadload.tables import read_table, real_array
from treadload.units import Length

_CLEARANCE = 1e-9


@dataclass(frozen=True, eq=False)
class FrictionMap(FrictionLaw):
    """Friction over the patch, linear between the centres of its cells and constant in their outer halves.

    values: (ny, nx) ≥ 0: μ, or on a base, factors of its coefficient. spacing: of the cells, m, or (dx, dy), the
    map's middle being the origin of the contact; or x (nx,), y (ny,): centres of the cells, m, ascending.
    A map of one column holds all along travel, of one row all across it. Rolling is steady: the map moves
    with the wheel, so that only what lies along travel, such as a wheel path, stays true as it rolls on.
    Raises InputError for a wrong shape, NaN, a negative value, and later for a contact that it does not cover.
    """

    values: Array
    spacing: float | tuple[float, float] | None = None
    x: Array | None = None
    y: Array | None = None
    base: FrictionLaw | None = None
    _centres: tuple[Array, Array] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        values = _numbers("friction map", self.values, 2)
        bad = np.argwhere(~np.isfinite(values))
        if bad.size:
            raise InputError(
                f"a friction map must hold finite numbers; row {bad[0][0]}, column {bad[0][1]} of {values.shape} "
                f"is {values[tuple(bad[0])]} ({len(bad)} such cells): fill them"
            )
        if values.min() < 0:
            row, column = np.unravel_index(int(values.argmin()), values.shape)
            raise InputError(
                f"a friction map must hold numbers >= 0, got {values.min():g} in row {row}, column {column}"
            )
        check_base("a map", self.base)
        centres = self._place(values.shape)
        values.setflags(write=False)
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "_centres", centres)

    def _place(self, shape: tuple[int, ...]) -> tuple[Array, Array]:
        if (self.spacing is None) == (self.x is None and self.y is None):
            raise InputError("give a friction map either spacing (m) or x and y (m, centres of its cells)")
        if self.spacing is not None:
            step = real_array(self.spacing, "spacing of a friction map")
            if step.size > 2 or step.ndim > 1:
                raise InputError(f"spacing of a friction map is one number of metres or (dx, dy), got {self.spacing}")
            step = np.broadcast_to(step, 2)
            if not (np.isfinite(step).all() and (step > 0).all()):
                raise InputError(f"spacing of a friction map must be a positive number of metres, got {self.spacing}")
            counts = shape[1], shape[0]
            x, y = (d * (np.arange(n) - (n - 1) / 2) for d, n in zip(step, counts, strict=True))
            return x, y
        if self.x is None or self.y is None:
            raise InputError("give a friction map both x and y (m, centres of its cells)")
        for name, coordinates, count in (("x", self.x, shape[1]), ("y", self.y, shape[0])):
            axis = _numbers(f"{name} of a friction map", coordinates, 1)
            if axis.size != count:
                raise InputError(f"a friction map of {shape} (ny, nx) needs {count} of {name}, got {axis.size}")
            if not np.isfinite(axis).all() or (np.diff(axis) <= 0).any():
                raise InputError(f"{name} of a friction map must be finite and ascending, got {axis[:4]} …")
            axis.setflags(write=False)
            object.__setattr__(self, name, axis)
        return self.x, self.y

    @classmethod
    def from_file(
        cls,
        path: str | os.PathLike[str],
        spacing: float | tuple[float, float],
        base: FrictionLaw | None = None,
        decimal: str | None = None,
    ) -> FrictionMap:
        """Map from a file: NPY, or a table of numbers (CSV, TXT, TSV), rows along y from left to right.

        spacing: of the cells, m, or (dx, dy). decimal: "." or ",", where a text can be read in two ways.
        Raises InputError.
        """
        path = Path(path)
        if path.suffix.lower() == ".npy":
            try:
                with path.open("rb") as stream:
                    values = np.load(stream, allow_pickle=False)
            except OSError as error:
                raise InputError(f"cannot read the friction map {path}: {error.strerror or error}") from error
            except Exception as error:
                raise InputError(
                    f"the friction map {path} is not a table of numbers: {one_line(str(error))}"
                ) from error
        elif path.suffix.lower() in (".csv", ".txt", ".tsv", ".dat"):
            try:
                table = read_table(path, decimal=decimal)
            except InputError as error:
                raise InputError(f"cannot read the friction map: {error}") from error
            try:
                values, _ = table.values(name=lambda column: "the friction")
            except InputError as error:
                raise InputError(f"the friction map is not a table of numbers: {error}") from error
        else:
            raise InputError(f"{path.name!r} is not a friction map; use .npy, .csv, .txt, .tsv or .dat")
        return cls(values, spacing, base=base)

    @property
    def axes(self) -> tuple[float, float]:
        """As the base."""
        return (1.0, 1.0) if self.base is None else self.base.axes

    @property
    def needs_speed(self) -> bool:
        """As the base."""
        return self.base is not None and self.base.needs_speed

    @property
    def largest(self) -> float:
        """Largest value of the map, times that of the base."""
        return float(self.values.max()) * (1.0 if self.base is None else self.base.largest)

    def coefficient(self, at: Interface) -> Array:
        """μ (ny, nx), interpolated. Raises InputError where the contact lies beyond the map."""
        self._check_cover(at)
        here = _interpolate(self.values, self._centres[1], at.y, 0)
        here = _interpolate(here, self._centres[0], at.x, 1)
        return here if self.base is None else here * self.base.coefficient(at)

    def _check_cover(self, at: Interface) -> None:
        contact = at.pressure > 0
        for name, cells, touching, centres in (
            ("x", at.x, contact.any(0), self._centres[0]),
            ("y", at.y, contact.any(1), self._centres[1]),
        ):
            if centres.size == 1 or not touching.any():
                continue
            low = centres[0] - 0.5 * (centres[1] - centres[0])
            high = centres[-1] + 0.5 * (centres[-1] - centres[-2])
            first, last = cells[touching][[0, -1]]
            if first < low - _CLEARANCE or last > high + _CLEARANCE:
                raise InputError(
                    f"the friction map does not cover the contact: {name} of the contact is {first * 1e3:.1f} to "
                    f"{last * 1e3:.1f} mm, of the map {low * 1e3:.1f} to {high * 1e3:.1f} mm; give a larger map"
                )

    def __eq__(self, friction_map: object) -> bool:
        if not isinstance(friction_map, FrictionMap):
            return NotImplemented
        mine, theirs = (self.values, *self._centres), (friction_map.values, *friction_map._centres)
        return self.base == friction_map.base and all(np.array_equal(a, b) for a, b in zip(mine, theirs, strict=True))

    def __hash__(self) -> int:
        return hash((self.values.shape, self.values.tobytes(), self.base))

    def __str__(self) -> str:
        low, high = self.values.min(), self.values.max()
        text = f"map {self.values.shape[1]} x {self.values.shape[0]}, {low:g} to {high:g}"
        return text if self.base is None else f"({text}) x {self.base}"


@FRICTION.register("map")
def _of_a_file(file: Path, cell: Length, base: FrictionLaw | None = None) -> FrictionMap:
    """Friction that differs from place to place.

    file: NPY, or a table of numbers, rows along y from left to right. cell: size of its cells. base: law that it
    multiplies.
    """
    return FrictionMap.from_file(file, cell, base)


def _numbers(what: str, array_like: object, dimensions: int) -> Array:
    values = real_array(array_like, what)
    if values.ndim != dimensions or values.size == 0:
        shape = "(ny, nx)" if dimensions == 2 else "(n,)"
        raise InputError(f"{what} must be an array {shape} with at least one cell, got the shape {values.shape}")
    return values


def _interpolate(values: Array, centres: Array, at: Array, axis: int) -> Array:
    """Values along an axis, linear between the centres and constant beyond."""
    if centres.size == 1:
        return np.repeat(values, at.size, axis=axis)
    lower = np.clip(np.searchsorted(centres, at) - 1, 0, centres.size - 2)
    weight = np.clip((at - centres[lower]) / (centres[lower + 1] - centres[lower]), 0.0, 1.0)
    weight = weight[:, None] if axis == 0 else weight
    return (1 - weight) * values.take(lower, axis) + weight * values.take(lower + 1, axis)
