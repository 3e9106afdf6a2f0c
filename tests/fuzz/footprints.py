"""Measured footprints as files, whole and with bytes changed: the right pressures in the right unit, or one sentence.

What was written is known. A changed file is read once more here, by a few lines that share nothing with the package:
where these can read it, and the package takes it, both must find the same pressures.
"""

from __future__ import annotations

import math
import random
import re
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from footprints import tekscan
from fuzz.runner import TAKEN, Refusal, WrongAnswer, ask
from fuzz.tables import _check, _numbers, _refused, _text, _write
from treadload.footprint import Footprint, read_footprint

_PASCALS = {"kPa": 1e3, "MPa": 1e6, "PSI": 6894.757293168361, "psi": 6894.757293168361, "kg/cm2": 98066.5, "bar": 1e5,
            "N/cm2": 1e4, "mmHg": 133.322387415, "Pa": 1.0}  # fmt: skip
_METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0, "milimeters": 1e-3, "centimeters": 1e-2, "meters": 1.0, "inches": 0.0254}
_CHANGED = "taken though changed"
_HEADER = ("ROWS", "COLS", "ROW_SPACING", "COL_SPACING", "UNITS", "SENSEL_AREA", "START_FRAME", "END_FRAME")
_SWAPS = ("", "0", "-1", "1e9", "nan", "B", "RAW", "mPa", "furlong", "99999999999", "0 mm", "-5 mm", "5", "kPa kPa")
_COLOURS = [("#000000", 0.0), ("#0000ff", 2e5), ("#00ff00", 5e5), ("#ff0000", 1e6)]
# The factors of two tables of units agree to what they print.
_SAME = 1e-9


def attack(rng: random.Random, folder: Path) -> str:
    """Write a footprint in some form, perhaps break it, and read it."""
    return rng.choice((_tekscan, _tekscan, _tekscan, _counts, _matrix, _picture))(rng, folder)


def _tekscan(rng: random.Random, folder: Path) -> str:
    """An export with its unit, of one frame or several; the header or any byte may be broken."""
    unit, length = rng.choice(list(_PASCALS)), rng.choice(list(_METRES))
    rows, columns, count = rng.randrange(1, 7), rng.randrange(1, 7), rng.choice((1, 1, 3))
    size = rng.uniform(1e5, 1e6) / _PASCALS[unit]
    frames = [np.array([[size * rng.random() for _ in range(columns)] for _ in range(rows)]) for _ in range(count)]
    holes = rng.random() < 0.3
    for frame in frames if holes else ():
        frame[rng.randrange(rows), rng.randrange(columns)] = math.nan
    frames = [np.array([[float(f"{value:.6g}") for value in row] for row in frame]) for frame in frames]
    pitch = f"{rng.choice((4, 5, 6.25)) * 1e-3 / _METRES[length]:.6g} {length}"
    text = tekscan(frames, units=unit, pitch=pitch, end=rng.choice(("\r\n", "\n")), digits="%.6g",
                   movie=rng.choice(("", ',0.1,"0:00:01"')))  # fmt: skip
    spoiled = rng.random() < 0.15
    if spoiled:
        key = rng.choice(_HEADER)
        text = re.sub(rf"(?m)^{key} .*?(\r?)$", lambda found: f"{key} {rng.choice(_SWAPS)}{found[1]}", text)
    path = folder / rng.choice(("print.asf", "print.csv", "print.txt"))
    broken = _write(rng, path, text) or spoiled
    asked: Any = rng.choice(("peak", "mean", 1))
    answer = ask(lambda: read_footprint(path, frame=asked))
    whole = not broken and any(np.nansum(frame) > 0 for frame in frames)
    if isinstance(answer, Refusal):
        pressing = np.nansum(frames[0] if asked == 1 else frames) > 0
        return _refused(answer, not (whole and pressing), path)
    again = _read_again(path.read_bytes())
    if not broken and again is None:
        raise WrongAnswer("the few lines of this attack cannot read what it wrote")
    if again is None:
        _sane(answer)
        return _CHANGED
    maps, spacing = again
    if asked == "mean":
        known = ~np.isnan(maps)
        wanted = np.where(known, maps, 0.0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
    else:
        wanted = np.nan_to_num(maps[0] if asked == 1 else maps[np.nansum(maps, axis=(1, 2)).argmax()])
    got = np.asarray(answer.pressure)
    # Sums of frames that are equal but for round-off.
    if broken and got.shape == wanted.shape and asked == "peak" and len(maps) > 1:
        wanted = min((np.nan_to_num(one) for one in maps), key=lambda one: float(np.abs(one - got).sum()))
    # Noise about zero is none.
    _check(got, np.maximum(wanted, 0.0), float(np.abs(wanted).max()), _SAME)
    if not math.isclose(answer.grid.dx, spacing[1], rel_tol=_SAME) or not math.isclose(
        answer.grid.dy, spacing[0], rel_tol=_SAME
    ):
        raise WrongAnswer(f"cells of {answer.grid.dx} x {answer.grid.dy} m, {spacing} m were written")
    return _CHANGED if broken else TAKEN


def _read_again(content: bytes) -> tuple[Any, tuple[float, float]] | None:
    """Pressures (frames, rows, columns), Pa, and spacing of rows and columns, m; None where a line is odd."""
    lines = re.split(r"\r\n|\r|\n", content.decode("latin-1").removeprefix("\xef\xbb\xbf"))
    header = [line for line in lines[: next((n for n, line in enumerate(lines) if "ASCII_DATA" in line), 0)]]
    keys = {found[1]: found[2].strip() for line in header if (found := re.fullmatch(r"([A-Z_]+) (.*)", line.strip()))}
    if len(keys) != len([line for line in header if line.strip()]):
        return None
    spacing = []
    for key in ("ROW_SPACING", "COL_SPACING"):
        found = re.fullmatch(r"([0-9.]+(?:e-?[0-9]+)?) ([a-z]+)", keys.get(key, ""))
        if not found or found[2] not in _METRES or found[1].count(".") > 1:
            return None
        spacing.append(float(found[1]) * _METRES[found[2]])
    unit = keys.get("UNITS", "")
    if unit not in _PASCALS:
        return None
    frames: list[list[list[float]]] = []
    for line in lines[len(header) + 1 :]:
        bare = line.strip(" \t")
        if bare == "@@":
            break
        if bare.startswith("Frame"):
            frames.append([])
        elif bare:
            cells = [cell.strip() for cell in bare.rstrip(",").split(",")]
            if not frames or not all(
                re.fullmatch(r"[+-]?[0-9]*\.?[0-9]+(?:e[+-]?[0-9]+)?|B", cell) for cell in cells
            ):
                return None
            frames[-1].append([math.nan if cell == "B" else float(cell) for cell in cells])
    if (
        not frames
        or len({(len(frame), *map(len, frame)) for frame in frames}) != 1
        or len(set(map(len, frames[0]))) != 1
    ):
        return None
    return np.array(frames) * _PASCALS[unit], (spacing[0], spacing[1])


def _counts(rng: random.Random, folder: Path) -> str:
    """Raw counts: with the header's law, a factor, a known load, or nothing, which is refused."""
    rows, columns = rng.randrange(2, 6), rng.randrange(2, 6)
    raw = np.array([[float(rng.randrange(0, 255)) for _ in range(columns)] for _ in range(rows)])
    scale, power = rng.uniform(1, 5), rng.uniform(0.8, 1.4)
    lines = [
        f"SCALE_FACTOR {scale:.9g}",
        f"EXPONENT {power:.9g}",
        f"SATURATION_PRESSURE {scale * 255**power:.9g} kPa",
    ]
    with_law = rng.random() < 0.5
    path = folder / "raw.asf"
    broken = _write(rng, path, tekscan([raw], units="RAW", lines=lines if with_law else ()))
    told: dict[str, Any] = rng.choice(({}, {"calibration": "2.5 kPa"}, {"load": "3 kN"}))
    answer = ask(lambda: read_footprint(path, **told))
    may_fail = broken or not raw.any() or not (with_law or told)
    if isinstance(answer, Refusal):
        return _refused(answer, may_fail, path)
    if "load" in told and not math.isclose(answer.normal_load, 3e3, rel_tol=1e-9):
        raise WrongAnswer(f"a load of 3 kN became {answer.normal_load} N")
    if broken:
        _sane(answer)
        return _CHANGED
    if not (with_law or told):
        raise WrongAnswer("counts without a calibration were taken")
    if "calibration" in told:
        wanted = 2500.0 * raw
    else:
        wanted = 1e3 * scale * raw**power if with_law else raw
        wanted = wanted * 3e3 / (wanted.sum() * 25e-6) if told else wanted
    _check(np.asarray(answer.pressure), wanted, wanted.max(), 1e-7)
    return TAKEN


def _matrix(rng: random.Random, folder: Path) -> str:
    """A plain matrix with its unit told, or not told."""
    unit = rng.choice(list(_PASCALS))
    pressure, cells = _numbers(rng, rng.uniform(1e5, 1e6) / _PASCALS[unit], holes=rng.random() < 0.3)
    text, plain = _text(rng, cells, [])
    path = folder / "matrix.csv"
    broken = _write(rng, path, text)
    told = rng.random() < 0.85
    answer = ask(lambda: read_footprint(path, spacing="5 mm", **({"units": unit} if told else {})))
    if isinstance(answer, Refusal):
        return _refused(answer, broken or not plain or not told or not np.nansum(pressure) > 0, path)
    if not told:
        raise WrongAnswer("pressures without a unit were taken")
    if broken:
        _sane(answer)
        return _CHANGED
    wanted = np.nan_to_num(pressure * _PASCALS[unit])
    _check(np.asarray(answer.pressure), wanted, wanted.max(), _SAME)
    if answer.missing is not None and (answer.missing & ~np.isnan(pressure) & (pressure > 0)).any():
        raise WrongAnswer("a sensel that reads something is missing")
    return TAKEN


def _picture(rng: random.Random, folder: Path) -> str:
    """A picture of known colours; some of other colours; some with bytes changed."""
    rows, columns = rng.randrange(1, 9), rng.randrange(1, 9)
    at = np.array([[rng.random() for _ in range(columns)] for _ in range(rows)])
    places = np.array([pressure / 1e6 for _, pressure in _COLOURS])
    parts = np.array([[int(name[k : k + 2], 16) for k in (1, 3, 5)] for name, _ in _COLOURS])
    pixels = np.stack([np.interp(at, places, parts[:, k]) for k in range(3)], axis=-1)
    strange = rng.random() < 0.2
    if strange:
        pixels[rng.randrange(rows), rng.randrange(columns)] = (255, 0, 255)
    path = folder / rng.choice(("print.png", "print.bmp", "print.tif"))
    Image.fromarray(np.round(pixels).astype(np.uint8)).save(path)
    content = bytearray(path.read_bytes())
    broken = rng.random() < 0.5
    if broken:
        for _ in range(rng.choice((1, 3))):
            content[rng.randrange(len(content))] = rng.randrange(256)
        path.write_bytes(content[: rng.randrange(1, len(content) + 1)] if rng.random() < 0.3 else content)
    answer = ask(lambda: read_footprint(path, colours=_COLOURS, spacing="1 mm"))
    if isinstance(answer, Refusal):
        return _refused(answer, broken or strange or not (at > 0.01).any(), path)
    if broken:
        _sane(answer)
        return _CHANGED
    if strange:
        raise WrongAnswer("a colour that is not on the scale was taken")
    # 255 steps of a channel over the longest part of the scale.
    _check(np.asarray(answer.pressure), 1e6 * at, 1e6, 0.51 / 255 * 0.5 * 2)
    return TAKEN


def _sane(answer: Footprint) -> None:
    """Whatever was taken is a footprint: finite, not negative, with a load."""
    pressure = np.asarray(answer.pressure)
    if not (np.isfinite(pressure).all() and pressure.min() >= 0 and answer.normal_load > 0):
        raise WrongAnswer(f"a footprint of {pressure}")
    answer.summary()
