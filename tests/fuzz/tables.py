"""Height maps and recorded stress as files: other spellings give the same numbers, broken ones are refused.

What was written is known, so that a file which is taken must give these numbers to the last digit written.
"""

from __future__ import annotations

import math
import random
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from fuzz.runner import REFUSED, TAKEN, Refusal, WrongAnswer, ask
from treadload.response import GridLoad
from treadload.tire import Tire

_HOLES = ("", "NaN", "nan", "NoData", "NA", "N/A", "null")
_LENGTHS = {"m": 1.0, "mm": 1e-3, "cm": 1e-2}
_STRESSES = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "bar": 1e5, "N/mm^2": 1e6}
_ODD = ("ERR", "1.2.3", "0.0O1", "1e", "--", "#REF!", "#N/A", "1 2", "0x1", "inf", "-inf", "1e999", "∞", "٣", "1,2,3",
        "'1", '"', "0.5 m", "1_0", "+", ".", ",", "\x00", "é", "NaN NaN", "1e5e", "−1", "tru")  # fmt: skip
# A file is read to double precision; the units multiply it once.
_SAME = 1e-12


def attack(rng: random.Random, folder: Path) -> str:
    """Write numbers in some way, perhaps break the file, and read it."""
    return rng.choice((_map_as_text, _map_as_text, _stress_as_text, _stress_as_text, _matrix_of_numpy, _netcdf))(
        rng, folder
    )


def _map_as_text(rng: random.Random, folder: Path) -> str:
    unit = rng.choice(list(_LENGTHS))
    gap, cells = _numbers(rng, rng.uniform(1e-3, 0.02) / _LENGTHS[unit], holes=rng.random() < 0.4)
    text, plain = _text(rng, cells, [])
    path = folder / f"gap{rng.choice(('.csv', '.txt', '.dat', '.tsv'))}"
    broken = _write(rng, path, text)
    answer = ask(lambda: Tire.from_height_map(path, 5e-3, units={"gap": unit}))
    if isinstance(answer, Refusal):
        return _refused(answer, broken or not plain or not np.isfinite(gap).any(), path)
    got = answer.surface.gap
    if broken:
        holes = sum(len(re.findall(r"(?i)\b(?:nan|nodata|na|n/a|null)\b", line)) for line in _lines(path))
        empty = path.read_bytes().count(b"\n") + sum(len(re.split(r"[;,\t ]", line)) for line in _lines(path))
        if np.isnan(got).sum() > holes + empty:
            raise WrongAnswer("holes that the file does not hold")
        return "taken though changed"
    _check(got, (gap - np.nanmin(gap)) * _LENGTHS[unit], np.nanmax(np.abs(gap)) * _LENGTHS[unit])
    return TAKEN


def _stress_as_text(rng: random.Random, folder: Path) -> str:
    stress, length = rng.choice(list(_STRESSES)), rng.choice(list(_LENGTHS))
    pressure, cells = _numbers(rng, rng.uniform(1e5, 1e6) / _STRESSES[stress], holes=False)
    ny, nx = pressure.shape
    step = 0.005 / _LENGTHS[length]
    told: dict[str, Any] = {}
    if rng.random() < 0.5:
        text, plain = _text(rng, cells, [])
        told = {"units": {"pressure": stress}, "spacing": 0.005}
    else:
        points = [(f"{step * i:.6g}", f"{step * j:.6g}", cells[j][i]) for j in range(ny) for i in range(nx)]
        rng.shuffle(points)
        heading = [f"x [{length}]", f"y [{length}]", f"pressure [{stress}]"]
        text, plain = _text(rng, [list(point) for point in points], heading)
    path = folder / "stress.csv"
    broken = _write(rng, path, text)
    answer = ask(lambda: GridLoad.from_csv(path, **told))
    if isinstance(answer, Refusal):
        return _refused(answer, broken or not plain, path)
    if broken:
        if not np.isfinite(np.asarray(answer.array)).all():
            raise WrongAnswer("stress that is not a number")
        return "taken though changed"
    _check(np.asarray(answer.array)[0], pressure * _STRESSES[stress], np.abs(pressure).max() * _STRESSES[stress])
    return TAKEN


def _matrix_of_numpy(rng: random.Random, folder: Path) -> str:
    """NPY and NPZ, whole, of odd types, and with bytes changed."""
    gap, _ = _numbers(rng, 0.01, holes=rng.random() < 0.3)
    odd: list[Callable[[Any], Any]] = [
        lambda a: a,
        lambda a: a,
        lambda a: a.astype(np.float32),
        lambda a: a.astype(str),
        lambda a: a.astype(complex),
        lambda a: a[0],
        lambda a: a[None],
        lambda a: a[:0],
        lambda a: a.astype("datetime64[s]"),
        lambda a: a > 0,
    ]
    which = rng.randrange(len(odd))
    with np.errstate(all="ignore"):
        values = odd[which](np.nan_to_num(gap) if which == 8 else gap)
    path = folder / rng.choice(("gap.npy", "gap.npz"))
    if path.suffix == ".npy":
        np.save(path, values)
    else:
        np.savez(path, **{rng.choice(("initial_gap", "a")): values, **({"b": gap} if rng.random() < 0.3 else {})})
    hit = rng.random() < 0.3
    if hit:
        content = bytearray(path.read_bytes())
        content[rng.randrange(min(len(content), 200))] = rng.randrange(256)
        path.write_bytes(content[: rng.randrange(1, len(content) + 1)] if rng.random() < 0.5 else content)
    answer = ask(lambda: Tire.from_height_map(path, 5e-3))
    if isinstance(answer, Refusal):
        return REFUSED
    if not hit and which <= 2 and answer.surface.gap.shape == gap.shape:
        _check(answer.surface.gap, gap - np.nanmin(gap), np.nanmax(gap), 1e-6 if which == 2 else _SAME)
    return TAKEN


def _netcdf(rng: random.Random, folder: Path) -> str:
    """NetCDF with every unit, with none, with strange ones, and of the wrong shape."""
    of_map = rng.random() < 0.5
    units = _LENGTHS if of_map else _STRESSES
    strange = ("", "odd", "K", "kg", 3, "degC", None, "m/m", "days since 2000-01-01")
    unit = rng.choice((*units, *units, *strange))
    length = rng.choice((*_LENGTHS, *_LENGTHS, *strange))
    known = unit in units and length in _LENGTHS
    values, _ = _numbers(rng, (0.01 if of_map else 5e5) / units.get(unit, 1.0), holes=False)
    ny, nx = values.shape
    step = 0.005 / _LENGTHS.get(length, 1.0)
    data = xr.Dataset(
        {"initial_gap" if of_map else "pressure": (("y", "x"), values, _named(unit))},
        {"x": ("x", step * np.arange(nx), _named(length)), "y": ("y", step * np.arange(ny), _named(length))},
    )
    change = rng.randrange(12)
    if change == 0:
        data = data.drop_vars("x")
    elif change == 1:
        data = data.isel(x=slice(0, 0))
    elif change == 2:
        data = data.transpose("x", "y")
    elif change == 3:
        data = data.assign_coords(x=[str(i) for i in range(nx)])
    elif change == 4:
        data = data.assign_coords(x=("x", np.full(nx, np.nan), _named(length)))
    path = folder / "field.nc"
    data.to_netcdf(path, engine="h5netcdf")
    cut = rng.random() < 0.1
    if cut:
        content = path.read_bytes()
        path.write_bytes(content[: rng.randrange(len(content))])
    answer = ask(lambda: Tire.from_height_map(path) if of_map else GridLoad.from_file(path))
    whole = known and not cut and change in (2, 5, 6, 7, 8, 9, 10, 11)
    if isinstance(answer, Refusal):
        return _refused(answer, not whole, path)
    if not known:
        raise WrongAnswer(f"units {unit!r} and {length!r} were taken")
    if whole:
        wanted = values * units[unit]
        wanted = wanted - wanted.min() if of_map else wanted
        got = answer.surface.gap if of_map else np.asarray(answer.array)[0]
        grid = answer.surface.grid if of_map else answer.grid
        _check(got, wanted, np.abs(values).max() * units[unit])
        if not math.isclose(grid.dx, 0.005, rel_tol=1e-9):
            raise WrongAnswer(f"cells of {grid.dx} m, 0.005 m were written")
    return TAKEN


def _named(unit: Any) -> dict[str, Any]:
    return {} if unit is None else {"units": unit}


def _numbers(rng: random.Random, size: float, *, holes: bool) -> tuple[Any, list[list[str]]]:
    """An array and its cells as text with points; NaN where a word stands for nothing."""
    ny, nx = rng.randrange(2, 8), rng.randrange(2, 8)
    digits = rng.choice((".4g", ".6g", ".9g", ".5e"))
    cells = [[f"{size * rng.random():{digits}}" for _ in range(nx)] for _ in range(ny)]
    if holes:
        for _ in range(rng.randrange(1, 4)):
            cells[rng.randrange(ny)][rng.randrange(nx)] = rng.choice(_HOLES)
    values = np.array([[float(cell) if cell not in _HOLES else math.nan for cell in row] for row in cells])
    return values, cells


def _text(rng: random.Random, cells: list[list[str]], heading: list[str]) -> tuple[str, bool]:
    """The cells as a file. True with it if nothing in it can be read in two ways, so that it must be taken."""
    separator = rng.choice((";", ",", "\t", " "))
    decimal = rng.choice((".", ","))
    holes = any(cell in _HOLES for row in cells for cell in row)
    # Whole numbers between commas may be decimal ones.
    whole = separator == "," and not any("." in cell for row in cells for cell in row)
    if separator == " ":
        cells = [[cell or "NaN" for cell in row] for row in cells]
    rows = [
        separator.join(cell.replace(".", decimal) if cell not in _HOLES else cell for cell in row) for row in cells
    ]
    lines = [separator.join(heading), *rows] if heading else rows
    if rng.random() < 0.2:
        lines.insert(0, "# written by a machine")
    if rng.random() < 0.2:
        lines.append("")
    text = rng.choice(("\n", "\r\n")).join(lines) + rng.choice(("", "\n"))
    return rng.choice(("", "", "\ufeff")) + text, decimal == "." and not holes and (bool(heading) or not whole)


def _write(rng: random.Random, path: Path, text: str) -> bool:
    """Write the text, one time in two broken; True if it was."""
    content = text.encode()
    if rng.random() < 0.5:
        path.write_bytes(content)
        return False
    for _ in range(rng.choice((1, 1, 3))):
        at = rng.randrange(len(content) + 1)
        which = rng.randrange(5)
        if which == 0:
            content = content[:at]
        elif which == 1:
            content = content[:at] + bytes([rng.randrange(256)]) + content[at + 1 :]
        elif which == 2:
            content = content[:at] + rng.choice(_ODD).encode() + content[at:]
        elif which == 3:
            content = content[:at] + content[at + rng.randrange(1, 6) :]
        else:
            spots = [found.span() for found in re.finditer(rb"[^;,\t\r\n ]+", content)]
            start, end = rng.choice(spots) if spots else (0, 0)
            content = content[:start] + rng.choice(_ODD).encode() + content[end:]
    path.write_bytes(content)
    return content != text.encode()


def _lines(path: Path) -> list[str]:
    return path.read_bytes().decode("utf-8-sig", errors="replace").splitlines()


def _refused(answer: Refusal, may_be: bool, path: Path) -> str:
    if not may_be:
        raise WrongAnswer(f"a right file was refused: {answer}")
    return REFUSED


def _check(got: Any, wanted: Any, size: float, share: float = _SAME) -> None:
    if got.shape != wanted.shape or not np.allclose(got, wanted, rtol=0, atol=share * size, equal_nan=True):
        raise WrongAnswer(f"other numbers than were written: {got} for {wanted}")
