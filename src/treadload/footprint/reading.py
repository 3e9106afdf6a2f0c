"""Footprints from files: recognised by their content, calibrated, turned into the axes of travel, with caveats."""

from __future__ import annotations

import inspect
import math
import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from treadload.errors import InputError, nearest
from treadload.footprint import image, pins, tekscan, text
from treadload.footprint.footprint import Footprint
from treadload.footprint.frames import Frames
from treadload.footprint.measures import filled, lone
from treadload.footprint.sensor_caveats import caveats_of, dead_in_words, peak_caveat
from treadload.footprint.spelling import pressure_factor
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.registry import FOOTPRINTS
from treadload.response import GridLoad, measured
from treadload.units import leading_number, quantity

Travel = Literal["right", "left", "up", "down"]
# Quarter turns, as numpy counts them, that bring travel to the right of the page.
_TURNS = {"right": 0, "left": 2, "up": -1, "down": 1}
_PICTURES = (".png", ".jpg", ".jpeg", ".tif", ".tiff", ".bmp", ".gif")
_CLOSED = {
    ".fsx": "Tekscan's binary format, which is closed; export it from I-Scan as ASCII (.asf or .csv)",
    ".xsn": "XSENSOR's format, of which nothing is public; export a plain matrix, and give units= and spacing=",
}
# Options that readers take of those that all files know.
_COMMON = ("spacing", "units", "noise", "counts")


def read_footprint(
    path: str | os.PathLike[str],
    *,
    format: str | None = None,
    units: str | Mapping[str, str] | None = None,
    spacing: float | str | tuple[float | str, float | str] | None = None,
    frame: int | Literal["peak", "mean"] = "peak",
    travel: Travel = "right",
    seen_from: Literal["above", "below"] = "above",
    calibration: float | str | None = None,
    load: float | str | None = None,
    threshold: float | str | None = None,
    saturation: float | str | None = None,
    dead: Literal["leave", "fill"] = "leave",
    shear_on: Literal["road", "tire"] = "road",
    **options: object,
) -> Footprint:
    """A footprint from a file, whose format is recognised by its content.

    Tekscan ASCII (.asf, .csv of I-Scan); a table with x, y, pressure and perhaps traction_x, traction_y; a table of
    pins that measure three components (`footprint.pins.read`); a plain matrix of pressures; NetCDF; a picture with a
    scale of colours; and what other packages read, by entry points of `treadload.footprints`.

    path: of the file. format: "tekscan", "text", "pins", "netcdf", "picture" or another package's, where the content
    misleads.
    units: of pressure, "kPa", "kgf/cm2"; or {"pressure": "kPa", "x": "mm"}; needed where the file names none.
    spacing: of the cells where the file does not state it, m or a text with a unit, or (between columns, between
    rows). frame: of several, the one that carries most ("peak"), their mean, or its number in the file.
    travel: where the wheel goes on the page, rows counted downwards. seen_from: the side of the sensor that the page
    shows; from below, left and right change places. A table has axes of its own, x travel, y right.
    calibration: pressure of one count, Pa or a text. load: known load, N or a text, to which everything is scaled.
    threshold: pressures below it are none. saturation: what a sensel reads at most. Both Pa or a text, before load=
    scales them; left out, what the file states. dead: sensels that read nothing amid loaded ones stay empty ("leave")
    or take the mean of their neighbours ("fill"); either way they are named.
    shear_on: the body that recorded shear acts on.
    options: of the format: decimal= of text; pin=, speed= of pins; colours=, scale=, bar=, crop=, steps=,
    background=, unclear= of pictures (`footprint.image.read`).
    Returns the footprint with what is doubtful in `.warnings`. Raises InputError for what cannot be read, is at odds
    with itself, has no unit, or is saturated everywhere.

    >>> _ = (folder / "print.csv").write_text('''0,200,300,0
    ... 0,600,650,0
    ... 0,580,610,0
    ... 0,210,190,0''')
    >>> footprint = tl.footprint.read_footprint(folder / "print.csv", units="kPa", spacing="10 mm")
    >>> f"{footprint.normal_load:.0f} N on {footprint.net_area * 1e4:.0f} cm²"
    '334 N on 8 cm²'
    """
    path = Path(path)
    if not os.path.isfile(path):
        raise InputError(f"there is no file {path} to read a footprint from")
    for name, value, choices in (
        ("travel", travel, tuple(_TURNS)),
        ("seen_from", seen_from, ("above", "below")),
        ("dead", dead, ("leave", "fill")),
    ):
        if value not in choices:
            raise InputError(f"{name} must be one of {', '.join(choices)}, got {value!r}")
    sign = measured.shear_sign(shear_on)
    units_by_name = {"pressure": units} if isinstance(units, str) else dict(units or {})
    options_of_file = {
        "spacing": spacing,
        "units": units_by_name,
        "noise": 0.0 if threshold is None else _pressure(threshold),
    }
    options_of_file["counts"] = calibration is not None or load is not None
    frames, has_units = _frames(path, _format_of(path, format), options_of_file, options)
    frames = _with_units(
        path, frames, None if has_units else units_by_name.get("pressure"), calibration, load is not None
    )
    frames = _with_spacing(path, frames, spacing)
    pressure, number = _frame(path, frames, frame)
    least = _limit(threshold, frames.threshold, frames, 0.0)
    most = _limit(saturation, frames.saturation, frames, math.inf)
    valid = ~np.isnan(pressure)
    pressure = _checked(path, np.where(valid, pressure, 0.0), least, most)
    caveats = [*frames.warnings, *caveats_of(path, pressure, valid, most, travel)]
    holes, stuck = lone(pressure, valid)
    caveats += dead_in_words(path, holes, stuck, dead)
    if dead == "fill":
        pressure = filled(pressure, holes, valid)
    else:
        valid = valid & ~holes
    footprint = _turned(path, frames, pressure, ~valid, sign, travel, seen_from, number)
    assert frames.law is not None
    caveats += peak_caveat(footprint, frames.law[0]) if load is None else []
    footprint = replace(footprint, threshold=least, saturation=most, warnings=tuple(caveats))
    return footprint if load is None else footprint.scaled_to(load)


def is_sensor_file(path: str | os.PathLike[str]) -> bool:
    """True for the text of a sensor's export, False for a table, a matrix, and what cannot be read.

    >>> _ = (folder / "matrix.csv").write_text("0,200,300,0")
    >>> tl.footprint.is_sensor_file(folder / "matrix.csv")
    False
    """
    try:
        return os.path.isfile(path) and tekscan.looks_like(_text(Path(path)))
    except InputError:
        return False


def is_pin_table(path: str | os.PathLike[str]) -> bool:
    """True for a table of pins that measure three components, False for all else and what cannot be read.

    >>> _ = (folder / "matrix.csv").write_text("0,200,300,0")
    >>> tl.footprint.is_pin_table(folder / "matrix.csv")
    False
    """
    try:
        return os.path.isfile(path) and pins.looks_like(_text(Path(path)))
    except InputError:
        return False


@FOOTPRINTS.register("tekscan")
def _tekscan(path: Path) -> Frames:
    return tekscan.read(path, _text(path))


FOOTPRINTS.register("text")(text.read)
FOOTPRINTS.register("pins")(pins.read)
FOOTPRINTS.register("picture")(image.read)


@FOOTPRINTS.register("netcdf")
def _netcdf(path: Path, *, units: Mapping[str, str] | None = None) -> Frames:
    read = measured.read_netcdf(path, units)
    grid = read.grid
    along, across = (None if part is None else np.nan_to_num(part) for part in (read.traction_x, read.traction_y))
    return Frames(
        read.pressure[None], grid.dy, grid.dx, (1.0, 1.0), traction_x=along, traction_y=across, x0=grid.x0,
        y0=grid.y0, source=read.source,
    )  # fmt: skip


def _text(path: Path) -> str:
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}") from error
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        # Names of people and places in a header; its keys and numbers are ASCII.
        return content.decode("latin-1")


def _format_of(path: Path, name: str | None) -> str:
    if name is not None:
        return name
    suffix = path.suffix.lower()
    # Another package may read what is closed to this one.
    if suffix[1:] in FOOTPRINTS.names():
        return suffix[1:]
    if suffix in _CLOSED:
        raise InputError(
            f"{path} is in {_CLOSED[suffix]}; or install a package with a reader of {suffix} files (entry point "
            f"{suffix[1:]!r} of {FOOTPRINTS.group})"
        )
    if suffix in _PICTURES:
        return "picture"
    if suffix in (".nc", ".nc4", ".h5"):
        return "netcdf"
    content = _text(path)
    return "tekscan" if tekscan.looks_like(content) else "pins" if pins.looks_like(content) else "text"


def _frames(
    path: Path, name: str, common: Mapping[str, object], options: Mapping[str, object]
) -> tuple[Frames, bool]:
    """What the reader of a format makes of the file, and whether the units were given."""
    entry = FOOTPRINTS.find(name)
    takes = list(inspect.signature(entry.target).parameters)[1:]
    extra = [name for name in takes if name not in _COMMON]
    for option in options:
        if option not in extra:
            hint = nearest(option, extra, "it takes") if extra else "it takes none"
            raise InputError(f"the {name} reader of footprints knows no option {option!r}; {hint}")
    accepted = {key: value for key, value in common.items() if key in takes}
    frames = entry.target(path, **accepted, **options)
    if not isinstance(frames, Frames):
        raise InputError(
            f"{entry.package} brings the {FOOTPRINTS.noun} {name!r}, which returned {type(frames).__name__} and no "
            "Frames; repair that package"
        )
    if frames.values.ndim != 3 or not frames.values.size:
        raise InputError(f"{path} holds no map: its frames have shape {frames.values.shape}; export it again")
    return frames, "units" in takes


def _with_units(
    path: Path, frames: Frames, unit: str | None, calibration: float | str | None, scaled: bool
) -> Frames:
    """Frames with a law from values to pascals: the file's, the caller's, or that of counts under a known load."""
    if calibration is not None and (frames.calibrated or unit is not None):
        raise InputError(
            f"{path} has pressures with their unit, and calibration= is for counts; leave it out, or give load= to "
            "scale to a known load"
        )
    if calibration is not None:
        factor = _pressure(calibration)
        if not factor > 0:
            raise InputError(f"calibration must be the pressure of one count, above 0 Pa, got {calibration!r}")
        return replace(frames, law=(factor, 1.0))
    if unit is not None:
        worth = pressure_factor(unit)
        if frames.law is not None and not (frames.calibrated and math.isclose(frames.law[0], worth)):
            meaning = f"in a unit of {frames.law[0]:g} Pa" if frames.calibrated else "counts with a calibration"
            raise InputError(f"{path} states that its values are {meaning}, and units= {unit!r}; leave units= out")
        return replace(frames, law=(worth, 1.0))
    if frames.law is None and not scaled:
        raise InputError(
            f'{path}: its values have no unit; give units="kPa" or whatever they are, calibration= for the pressure '
            "of a count, or load= for the load that they carry"
        )
    return frames if frames.law is not None else replace(frames, law=(1.0, 1.0))


def _with_spacing(path: Path, frames: Frames, spacing: object) -> Frames:
    if frames.row_spacing is not None and frames.column_spacing is not None:
        return frames
    if spacing is None:
        raise InputError(f'{path} does not give the spacing of its sensels; give spacing="5 mm", or (columns, rows)')
    both = spacing if isinstance(spacing, tuple | list) else (spacing, spacing)
    if len(both) != 2:
        raise InputError(f"spacing must be one length or (columns, rows), got {len(both)} values")
    dx, dy = (quantity(step, "m") for step in both)
    return replace(frames, row_spacing=dy, column_spacing=dx)


def _pressure(value: float | str) -> float:
    """Pascals of a number or a text, spelled as sensors do."""
    if not isinstance(value, str):
        return quantity(value, "Pa")
    number, unit = leading_number(value)
    return number * pressure_factor(unit) if unit else quantity(value, "Pa")


def _limit(limit: float | str | None, limit_in_file: float | None, frames: Frames, otherwise: float) -> float:
    """A threshold or a saturation, Pa: of the caller, else of the file, in its unit."""
    if limit is not None:
        return _pressure(limit)
    if limit_in_file is None or frames.law is None:
        return otherwise
    return float(frames.law[0] * limit_in_file ** frames.law[1])


def _frame(path: Path, frames: Frames, frame: int | str) -> tuple[Array, str]:
    """Pressure (rows, columns), Pa, of the frame that was asked for, and which it is, in words."""
    assert frames.law is not None
    scale, exponent = frames.law
    with np.errstate(over="ignore", invalid="ignore"):
        values = frames.values if exponent == 1.0 else np.maximum(frames.values, 0.0) ** exponent
        pressure = scale * values
        endless = np.isinf(pressure)
        top = float(np.nanmax(pressure, initial=0.0))
        endless |= not math.isfinite(top * pressure.size)
    if endless.any():
        raise InputError(f"{path} holds a pressure of {top:g} Pa, beyond all numbers; check its values and its unit")
    numbers = frames.numbers or tuple(range(1, len(pressure) + 1))
    if frame not in ("peak", "mean"):
        if isinstance(frame, bool) or not isinstance(frame, int | np.integer) or frame not in numbers:
            raise InputError(
                f'frame must be "peak", "mean" or one of {numbers[0]} to {numbers[-1]} in {path}, got {frame!r}'
            )
        return pressure[numbers.index(int(frame))], f"frame {frame}"
    if len(pressure) == 1:
        return pressure[0], ""
    if frame == "mean":
        # Where no frame has a sensel there is none.
        valid = ~np.isnan(pressure)
        count = valid.sum(axis=0)
        total = np.where(valid, pressure, 0.0).sum(axis=0)
        return np.where(count > 0, total / np.maximum(count, 1), np.nan), f"mean of {len(pressure)} frames"
    best = int(np.nansum(pressure, axis=(1, 2)).argmax())
    return pressure[best], f"frame {numbers[best]} of {len(pressure)}, which carries most"


def _checked(path: Path, pressure: Array, least: float, most: float) -> Array:
    """Pressure without what lies below the threshold. Raises InputError for what is no footprint."""
    if not (math.isfinite(least) and least >= 0):
        raise InputError(f"the threshold must be >= 0 Pa, got {least:g}")
    if not most > least:
        raise InputError(f"the saturation of {most:g} Pa must lie above the threshold of {least:g} Pa")
    low = float(pressure.min())
    if low < -least:
        row, column = (int(k) + 1 for k in np.unravel_index(int(pressure.argmin()), pressure.shape))
        raise InputError(
            f"{path}: row {row}, column {column} has a pressure of {low:g} Pa; compression counts positive, and "
            "threshold= gives how far around zero a sensor strays"
        )
    pressure = np.where((pressure < least) | (pressure <= 0), 0.0, pressure)
    loaded = int((pressure > 0).sum())
    if not loaded:
        raise InputError(f"{path}: nothing presses, no value lies above {least:g} Pa; check frame= and threshold=")
    full = int((pressure >= most * (1 - 1e-9)).sum())
    if full == loaded:
        raise InputError(
            f"{path}: all {loaded} loaded sensels read the saturation of {most / 1e3:g} kPa, so that nothing is "
            "known of the load; measure with a sensor of a higher range or a lower sensitivity"
        )
    return pressure


def _turned(
    path: Path,
    frames: Frames,
    pressure: Array,
    holes: BoolArray,
    sign: float,
    travel: str,
    seen_from: str,
    number: str,
) -> Footprint:
    """The footprint in the axes of travel."""
    assert frames.column_spacing is not None
    assert frames.row_spacing is not None
    dx, dy = frames.column_spacing, frames.row_spacing
    axes = frames.x0 is not None or frames.traction_x is not None or frames.traction_y is not None
    if axes and (travel != "right" or seen_from != "above"):
        raise InputError(
            f"{path} has axes of its own, x along travel and y to the right; leave travel= and seen_from= out"
        )
    if _TURNS[travel] % 2:
        dx, dy = dy, dx

    pressure, holes = np.rot90(pressure, _TURNS[travel]), np.rot90(holes, _TURNS[travel])
    if seen_from == "below":
        pressure, holes = pressure[::-1], holes[::-1]
    grid: Grid = measured.grid_of(pressure.shape, (dx, dy), frames.x0, frames.y0)
    along, across = (
        None if part is None else np.where(holes, 0.0, sign * part) for part in (frames.traction_x, frames.traction_y)
    )
    how = [number] if number else []
    how += [f"travel {travel} on the page"] if travel != "right" else []
    how += ["seen from below"] if seen_from == "below" else []
    source = ", ".join([frames.source or path.name, *how])
    return Footprint(GridLoad(grid, pressure, along, across, source=source), missing=holes, pin=frames.pin)
