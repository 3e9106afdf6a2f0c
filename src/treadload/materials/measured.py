"""Measured viscoelasticity: sweeps of frequency, relaxation tests, and the files that hold them."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from treadload.describing import as_call
from treadload.errors import InputError
from treadload.kernels.arrays import Array, ComplexArray


@dataclass(frozen=True, eq=False)
class FrequencySweep:
    """Complex modulus over frequency at one temperature: an isotherm, or a master curve.

    omega: (n,), rad/s, > 0, sorted here. storage, loss: (n,), E' > 0 and E'' ≥ 0, Pa. temperature: °C, of the test
    or of reference; None if not stated.
    Raises InputError.

    >>> sweep = tl.materials.FrequencySweep([6.3, 63.0], [4e9, 8e9], [3e9, 2e9], temperature=15.0)
    >>> [round(float(abs(modulus)) / 1e9, 2) for modulus in sweep.modulus]  # |E*|, GPa
    [5.0, 8.25]
    """

    omega: Array
    storage: Array
    loss: Array
    temperature: float | None = None

    def __post_init__(self) -> None:
        omega, storage, loss = _columns(omega=self.omega, storage=self.storage, loss=self.loss)
        if (loss < 0).any():
            raise InputError(f"the loss modulus cannot be negative, got {loss.min():g} Pa")
        for name, values in zip(("omega", "storage", "loss"), (omega, storage, loss), strict=True):
            object.__setattr__(self, name, values)

    @property
    def modulus(self) -> ComplexArray:
        """E* = E' + iE'', Pa."""
        return np.asarray(self.storage + 1j * self.loss)

    def shifted(self, factor: float, temperature: float | None) -> FrequencySweep:
        """The sweep at ω aT, as if measured at another temperature, °C."""
        return FrequencySweep(self.omega * factor, self.storage, self.loss, temperature)

    def __str__(self) -> str:
        at = "" if self.temperature is None else f" at {self.temperature:g} °C"
        return f"{self.omega.size} moduli from {self.omega[0]:.3g} to {self.omega[-1]:.3g} rad/s{at}"

    __repr__ = as_call


@dataclass(frozen=True, eq=False)
class RelaxationTest:
    """Relaxation modulus over time at one temperature: an isotherm, or a master curve.

    time: (n,), s, > 0, sorted here. modulus: (n,), E(t) > 0, Pa. temperature: °C, of the test or of reference; None
    if not stated.
    Raises InputError.

    >>> test = tl.materials.RelaxationTest([1.0, 10.0], [4e9, 2e9], temperature=15.0)
    >>> [round(float(t), 3) for t in test.shifted(0.01, 30.0).time]  # s: all times a hundredth at 30 °C
    [100.0, 1000.0]
    """

    time: Array
    modulus: Array
    temperature: float | None = None

    def __post_init__(self) -> None:
        time, modulus = _columns(time=self.time, modulus=self.modulus)
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "modulus", modulus)

    def shifted(self, factor: float, temperature: float | None) -> RelaxationTest:
        """The test at t / aT, as if measured at another temperature, °C."""
        return RelaxationTest(self.time / factor, self.modulus, temperature)

    def __str__(self) -> str:
        at = "" if self.temperature is None else f" at {self.temperature:g} °C"
        return f"{self.time.size} moduli from {self.time[0]:.3g} to {self.time[-1]:.3g} s{at}"

    __repr__ = as_call


Measured = FrequencySweep | RelaxationTest


def read_master_curve(path: str | PathLike[str], *, temperature: float | None = None) -> Measured:
    """A master curve from a CSV file: columns f, E_stor, E_loss, or t, E_relax.

    The second row holds the units (Hz or rad/s; s; Pa, kPa, MPa, GPa). temperature: of reference, °C.
    Raises InputError for a file that cannot be read, lacks columns or holds several temperatures.

    >>> _ = (folder / "mix.csv").write_text('''f,E_stor,E_loss
    ... Hz,MPa,MPa
    ... 1,4000,3000
    ... 10,8000,2000''')
    >>> curve = tl.materials.read_master_curve(folder / "mix.csv", temperature=15.0)
    >>> round(float(abs(curve.modulus[0])) / 1e9, 2)  # |E*|, GPa, at 1 Hz
    5.0
    """
    table = _read(path)
    if "T" in table:
        raise InputError(
            f"{path} has a column T: measurements at several temperatures; use read_isotherms and master_curve"
        )
    return _measured(path, table, np.ones(_length(table), dtype=bool), temperature)


def read_isotherms(path: str | PathLike[str]) -> tuple[Measured, ...]:
    """Measurements at several temperatures from a CSV file, coldest first.

    Columns as for read_master_curve, T (°C or K), and Set: rows of one number are one isotherm, at the mean of its
    temperatures. Without Set rows of the same temperature, to 1 K, are one.
    Raises InputError for a file that cannot be read or lacks columns.

    >>> _ = (folder / "mix.csv").write_text('''T,t,E_relax
    ... C,s,MPa
    ... 10,1,8000
    ... 10,10,4000
    ... 20,1,4000
    ... 20,10,2000''')
    >>> [test.temperature for test in tl.materials.read_isotherms(folder / "mix.csv")]
    [10.0, 20.0]
    """
    table = _read(path)
    if "T" not in table:
        raise InputError(f"{path} has no column T; of a master curve use read_master_curve")
    group = table.get("Set", np.round(table["T"]))
    isotherms = [
        _measured(path, table, group == key, float(table["T"][group == key].mean())) for key in np.unique(group)
    ]
    return tuple(sorted(isotherms, key=lambda data: data.temperature or 0.0))


def read_shift_factors(path: str | PathLike[str]) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """(temperatures in °C, log₁₀ aT) from a CSV file with columns T and log_aT. Raises InputError.

    >>> _ = (folder / "shift.csv").write_text('''T,log_aT
    ... C,-
    ... 5,1.4
    ... 15,0
    ... 25,-1.2''')
    >>> shift = tl.materials.TabulatedShift(*tl.materials.read_shift_factors(folder / "shift.csv"), reference=15)
    >>> f"{shift.factor(20.0):.2f}"
    '0.24'
    """
    table = _read(path)
    if missing := {"T", "log_aT"} - set(table):
        raise InputError(f"{path} lacks the column {missing.pop()}; it needs T and log_aT")
    return tuple(table["T"].tolist()), tuple(table["log_aT"].tolist())


_PASCAL = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9}
# Factors to SI; temperatures to °C, less 273.15 where they are in K.
_UNITS = {
    "f": {"Hz": 2 * math.pi, "rad/s": 1.0},
    "t": {"s": 1.0, "min": 60.0, "h": 3600.0},
    "T": {"C": 1.0, "°C": 1.0, "K": 1.0},
    "E_stor": _PASCAL,
    "E_loss": _PASCAL,
    "E_relax": _PASCAL,
}


def _read(path: str | PathLike[str]) -> dict[str, Array]:
    """Columns in SI units, temperatures in °C."""
    try:
        # utf-8-sig takes off the mark that spreadsheets put first.
        rows = list(csv.reader(Path(path).read_text(encoding="utf-8-sig").splitlines()))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"cannot read {path}: {error}") from error
    rows = [[cell.strip() for cell in row] for row in rows if any(row)]
    if len(rows) < 3:
        raise InputError(f"{path} needs a row of names, a row of units and rows of numbers, got {len(rows)} rows")
    names, units = rows[0], rows[1]
    if any(len(row) != len(names) for row in rows):
        short = next(i for i, row in enumerate(rows, 1) if len(row) != len(names))
        raise InputError(f"row {short} of {path} has {len(rows[short - 1])} cells; the first row names {len(names)}")
    try:
        numbers = np.array([[float(cell) for cell in row] for row in rows[2:]])
    except ValueError as error:
        raise InputError(f"{path} holds a cell that is not a number: {error}; the second row is for units") from error
    table = {}
    for name, unit, values in zip(names, units, numbers.T, strict=True):
        factors = _UNITS.get(name)
        if factors is not None and unit not in factors:
            raise InputError(f"{path} gives {name} in {unit!r}; use one of {', '.join(factors)}")
        table[name] = values * (factors[unit] if factors else 1.0) - (273.15 if (name, unit) == ("T", "K") else 0.0)
    return table


def _measured(path: object, table: dict[str, Array], rows: Array, temperature: float | None) -> Measured:
    if {"f", "E_stor", "E_loss"} <= set(table):
        return FrequencySweep(table["f"][rows], table["E_stor"][rows], table["E_loss"][rows], temperature)
    if {"t", "E_relax"} <= set(table):
        return RelaxationTest(table["t"][rows], table["E_relax"][rows], temperature)
    raise InputError(f"{path} has the columns {', '.join(table)}; it needs f, E_stor, E_loss, or t, E_relax")


def _length(table: dict[str, Array]) -> int:
    return next(iter(table.values())).size


def _columns(**table: ArrayLike) -> Sequence[Array]:
    """Arrays of one length in the order of the first; all but a third finite and positive. Raises InputError."""
    arrays = {name: np.asarray(values, dtype=float) for name, values in table.items()}
    lengths = {values.shape for values in arrays.values()}
    if len(lengths) != 1 or any(values.ndim != 1 or values.size < 2 for values in arrays.values()):
        raise InputError(f"{', '.join(arrays)} must be lists of one length, 2 or more, got {sorted(lengths)}")
    for name, values in arrays.items():
        bad = values[~(np.isfinite(values) & ((values > 0) | (name == "loss")))]
        if bad.size:
            raise InputError(f"{name} must be positive and finite, got {bad[0]:g}")
    first = next(iter(arrays.values()))
    order = np.argsort(first, kind="stable")
    return [values[order] for values in arrays.values()]
