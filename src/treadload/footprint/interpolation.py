"""Contact stress between the cases of a study: interpolated fields that are footprints again.

Pressure and shear are interpolated cell by cell over the inputs that vary. Corrections then give them what a contact
has: pressure of at least zero with its load and its moments, and shear of at most friction times pressure.
"""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from types import MappingProxyType

import numpy as np

from treadload.composing import Source
from treadload.errors import InputError
from treadload.footprint.stress_cases import INPUTS, StressCases, stress_cases
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.radial_basis import RadialBasis, fit
from treadload.response import GridLoad
from treadload.units import quantity

# Solved cases that an interpolation needs at least, for each input and one more.
_FEWEST = 4
# Modes are kept until the rest has this share of the variance.
_REST = 1e-7
# Pressure below this share of the mean one is ripple of the interpolation outside of the contact.
_RIPPLE = 0.01
# A correction of shear by this share of the room that friction leaves cannot exceed it.
_ROOM = 0.5
# How far beyond a range round-off of units may lie, over the range.
_ROUND_OFF = 1e-9
_NAMES = ("pressure_error", "traction_x_error", "traction_y_error")


@dataclass(frozen=True, eq=False)
class _Modes:
    """Fields (m,) as their mean and modes, whose amounts are interpolated."""

    mean: Array
    modes: Array
    amounts: RadialBasis

    def __call__(self, at: Array) -> Array:
        return np.asarray(self.mean + self.amounts(at) @ self.modes)


class FootprintSet:
    """Contact stresses of one tire over load, inflation pressure and slip, from the cases of a study.

    Opened by `from_store`. ranges: name ("load", "pressure", "slip") → lowest and highest value, SI. errors: over all
    cases, each left out in turn: rms of "pressure_error", "traction_x_error", "traction_y_error" inside the
    footprint over the mean pressure there, and the largest of a single case as "largest_pressure_error" and so on.
    left_out: the same of each case (n, 3). warnings: sentences, such as which cases failed.
    """

    def __init__(self, cases: StressCases) -> None:
        count, sides = cases.points.shape
        if not sides:
            raise InputError(f"the study varies none of {', '.join(key for key, _ in INPUTS.values())}")
        if count < _FEWEST * (sides + 1):
            raise InputError(
                f"an interpolation over {sides} input{'s' * (sides > 1)} needs {_FEWEST * (sides + 1)} solved cases "
                f"or more, got {count}; sample more, 200 are usual"
            )
        self._cases = cases
        self._low, self._high = cases.points.min(0), cases.points.max(0)
        self.ranges: Mapping[str, tuple[float, float]] = MappingProxyType(
            {
                name: (float(low), float(high))
                for name, low, high in zip(cases.varied, self._low, self._high, strict=True)
            }
        )
        self.warnings: tuple[str, ...] = (cases.failures,) if cases.failures else ()
        shape = cases.grid.shape
        loaded: BoolArray = np.any(cases.fields[:, 0] > 0, axis=0)
        self._loaded = loaded
        pressure = cases.fields[:, 0][:, loaded]
        shear = cases.fields[:, 1:][:, :, loaded].reshape(count, -1)
        points = self._scaled(cases.points)
        try:
            self._pressure, without = _modes(points, pressure)
            self._shear, shear_without = _modes(points, shear)
        except np.linalg.LinAlgError as error:
            raise InputError(
                "two cases of the study have the same inputs, or all lie in a plane, so that nothing is between "
                "them; sample distinct values"
            ) from error
        self._across = _Resultants(cases.grid, loaded)
        fields = [
            self._physical(without[k], shear_without[k].reshape(2, -1), float(pressure[k].sum()))
            for k in range(count)
        ]
        solved = np.concatenate([pressure[:, None], shear.reshape(count, 2, -1)], 1)
        self.left_out: Array = _errors(np.array(fields), solved)
        rms = np.sqrt(np.square(self.left_out).mean(0))
        self.errors: Mapping[str, float] = MappingProxyType(
            {name: float(value) for name, value in zip(_NAMES, rms, strict=True)}
            | {f"largest_{name}": float(self.left_out[:, k].max()) for k, name in enumerate(_NAMES)}
        )
        self._shape = shape

    @classmethod
    def from_store(cls, store: str | os.PathLike[str] | Source, *, version: str | None = None) -> FootprintSet:
        """The set of a study's store that varies normal_load, inflation_pressure and creepage_x, or some of them.

        store: path of the Zarr store, the study itself (`tl.sweeps.open_sweep`, which compares checksums), or its
        dataset. version: of treadload that solved it, where it is not this one. It takes about a second; `at` is
        then a matter of milliseconds. Raises InputError for a store that is half-written, of another version,
        without fields, of friction other than one coefficient, or with too few cases.
        """
        return cls(stress_cases(store, version))

    def at(
        self,
        *,
        load: float | str | None = None,
        pressure: float | str | None = None,
        slip: float | str | None = None,
    ) -> GridLoad:
        """Pressure and shear of a wheel inside the ranges; see `Footprint.interpolate`."""
        inputs = {"load": load, "pressure": pressure, "slip": slip}
        values = {name: None if value is None else quantity(value, INPUTS[name][1]) for name, value in inputs.items()}
        at = self._scaled(self._point(values))
        wanted = values["load"] if values["load"] is not None else self._cases.fixed["load"]
        total = wanted / self._cases.grid.cell_area
        raw = self._shear(at).reshape(2, -1)
        parts = np.zeros((3, *self._shape))
        parts[:, self._loaded] = self._physical(self._pressure(at), raw, total)
        source = f"interpolated between {len(self._cases.points)} cases of {self._cases.title}"
        return GridLoad(
            self._cases.grid, parts[0], parts[1], parts[2], source=source, rib_sides=self._cases.rib_sides
        )

    @property
    def friction(self) -> float:
        """Coulomb's coefficient of all cases."""
        return self._cases.friction

    def _scaled(self, points: Array) -> Array:
        """Inputs from -1 to 1."""
        return np.asarray(2 * (points - self._low) / (self._high - self._low) - 1)

    def _point(self, values: Mapping[str, float | None]) -> Array:
        """The inputs that vary. Raises InputError for one that is missing or outside of what was sampled."""
        for name, value in values.items():
            key, unit = INPUTS[name]
            of = f" {unit}" if unit else ""
            if name not in self.ranges:
                base = self._cases.fixed.get(name)
                if value is not None and not (base is not None and math.isclose(value, base, rel_tol=1e-6)):
                    has = f"has {base:g}{of} alone" if base is not None else "does not prescribe it"
                    raise InputError(
                        f"{name} = {value:g}{of} is not in the set, which {has} ({key}); leave {name} out"
                    )
                continue
            low, high = self.ranges[name]
            if value is None:
                raise InputError(f"give {name}: the set varies {key} from {low:g} to {high:g}{of}")
            slack = _ROUND_OFF * (high - low)
            if not low - slack <= value <= high + slack:
                side, bound = ("below the lowest", low) if value < low else ("above the highest", high)
                raise InputError(
                    f"{name} = {value:g}{of} lies {side} of the set, {bound:g}{of} ({key} was sampled from {low:g} "
                    f"to {high:g}{of}); nothing is extrapolated: solve this case, or a set that contains it"
                )
        return np.array([values[name] for name in self.ranges], dtype=float)

    def _physical(self, pressure: Array, shear: Array, total: float) -> Array:
        """(3, m): pressure ≥ 0 with a sum and the moments of the interpolated one; shear ≤ μp with its resultants.

        pressure: (m,), shear: (2, m), Pa, as interpolated. total: sum of the pressures, Pa.
        """
        sums = self._across
        positive = np.maximum(pressure, 0.0)
        positive[positive < _RIPPLE * total / max(1, int((positive > 0).sum()))] = 0.0
        wanted = sums.of_pressure @ pressure
        moments = wanted[1:] * (total / wanted[0])
        amounts = np.linalg.solve(
            (sums.of_pressure * positive) @ sums.of_pressure.T,
            np.concatenate([[total], moments]) - sums.of_pressure @ positive,
        )
        factor = 1 + amounts @ sums.of_pressure
        if not factor[positive > 0].min() > 0:
            raise InputError("the cases of the set lie too far apart to interpolate between them; sample more")
        positive *= factor
        bound = self._cases.friction * positive
        size = np.sqrt(np.square(shear).sum(0))
        bounded = shear * np.where(size > bound, bound / np.maximum(size, bound + 1e-300), 1.0)
        return np.concatenate([positive[None], self._with_forces(bounded, bound, shear)])

    def _with_forces(self, bounded: Array, bound: Array, shear: Array) -> Array:
        """Shear inside its bound, with the resultants of the interpolated one as far as friction allows."""
        rows = self._across.of_shear
        for _ in range(3):
            missing = rows @ (shear - bounded).ravel()
            share = np.sqrt(np.square(bounded).sum(0)) / np.where(bound > 0, bound, 1.0)
            room = np.tile(bound * np.maximum(0.0, 1 - share**2), 2)
            system = (rows * room) @ rows.T
            if np.linalg.cond(system) > 1e12:
                break
            change = (np.linalg.solve(system, missing) @ rows).reshape(2, -1)
            largest = float(np.sqrt(np.square(change).sum(0)).max())
            bounded = bounded + min(1.0, _ROOM / max(largest, _ROOM)) * change * room.reshape(2, -1)
            if largest <= _ROOM:
                break
        return bounded


class _Resultants:
    """Rows whose products with fields on the loaded cells are their resultants, over the area of a cell.

    of_pressure: (3, m): sum, and sums times x and y over a length. of_shear: (3, 2m): forces, and the moment about z.
    """

    def __init__(self, grid: Grid, loaded: BoolArray) -> None:
        x = np.broadcast_to(grid.x[None], grid.shape)[loaded]
        y = np.broadcast_to(grid.y[:, None], grid.shape)[loaded]
        # Over a length, so that sums and moments are of one size.
        length = max(float(np.ptp(x)), float(np.ptp(y)), grid.dx)
        ones, none = np.ones_like(x), np.zeros_like(x)
        self.of_pressure = np.stack([ones, x / length, y / length])
        self.of_shear = np.stack(
            [np.concatenate([ones, none]), np.concatenate([none, ones]), np.concatenate([-y, x]) / length]
        )


def _modes(points: Array, fields: Array) -> tuple[_Modes, Array]:
    """Fields (n, m) by their modes, and the fields (n, m) that are interpolated at each point without its case."""
    mean = fields.mean(0)
    left, sizes, right = np.linalg.svd(fields - mean, full_matrices=False)
    shares = np.cumsum(sizes**2)
    count = int(np.searchsorted(shares, (1 - _REST) * shares[-1])) + 1 if shares[-1] > 0 else 1
    amounts, without = fit(points, left[:, :count] * sizes[:count])
    return _Modes(mean, right[:count], amounts), mean + without @ right[:count]


def _errors(fields: Array, solved: Array) -> Array:
    """(n, 3): rms of the difference where either pressure is above 0, over the mean pressure of the solved one."""
    inside = (fields[:, 0] > 0) | (solved[:, 0] > 0)
    squares = (np.square(fields - solved) * inside[:, None]).sum(2) / inside.sum(1)[:, None]
    mean = solved[:, 0].sum(1) / (solved[:, 0] > 0).sum(1)
    return np.asarray(np.sqrt(squares) / mean[:, None])


def opened_set(store: str | os.PathLike[str] | Source | FootprintSet, version: str | None = None) -> FootprintSet:
    """The set of a store; that of a path is kept while its files are the same."""
    if isinstance(store, FootprintSet):
        return store
    if isinstance(store, str | os.PathLike):
        path = os.path.abspath(os.fspath(store))
        stamps = []
        for name in (".current", ".zmetadata", "zarr.json"):
            file = os.path.join(path, name)
            stamps.append(os.stat(file).st_mtime_ns if os.path.exists(file) else 0)
        return _of_path(path, tuple(stamps), version)
    return FootprintSet.from_store(store, version=version)


@lru_cache(maxsize=4)
def _of_path(path: str, stamps: tuple[int, ...], version: str | None) -> FootprintSet:
    return FootprintSet.from_store(path, version=version)
