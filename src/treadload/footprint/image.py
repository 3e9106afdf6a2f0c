"""Pictures of footprints: pressures from the colours of a scale, or a count of the pixels that have none of them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, cast

import numpy as np

from treadload.errors import InputError
from treadload.footprint.frames import Frames
from treadload.footprint.spelling import pressure_factor
from treadload.kernels.arrays import Array, BoolArray
from treadload.registry import COLOUR_MAPS
from treadload.units import leading_number, quantity

# Distance of two colours, of 255 a channel, within which they are taken for one: what JPEG leaves of a smooth scale.
TOLERANCE = 12.0
# Share of the scale by which two places that a colour fits may lie apart.
_APART = 0.06
# Colours of a colour map by its name, and pixels that a picture may have.
_SAMPLES, _LARGEST = 256, 4_000_000
_AT_ONCE = 4_000_000
_ROUND_OFF = 1e-6
_HEX = re.compile("#[0-9a-fA-F]{6}")

Colour = str | Sequence[int]
Box = tuple[int, int, int, int]


@dataclass(frozen=True, eq=False)
class Scale:
    """Colours (n, 3), 0 to 255, of pressures (n,), Pa, that rise; steps: nothing lies between two colours."""

    colours: Array
    pressures: Array
    steps: bool = False


def read(
    path: Path,
    *,
    spacing: object = None,
    colours: str | Sequence[tuple[Colour, float | str]] | None = None,
    scale: tuple[float | str, float | str] | None = None,
    bar: Box | None = None,
    crop: Box | None = None,
    steps: bool = False,
    background: Colour | None = None,
    unclear: Literal["error", "missing"] = "error",
) -> Frames:
    """The one frame of a picture (PNG, JPEG, TIFF, BMP), a cell a pixel.

    spacing: of the pixels, m or a text, or (dx, dy). colours: pairs of a colour, "#0000ff" or (0, 0, 255), and its
    pressure, Pa or a text; or the name of a colour map, "jet", with scale=(lowest, highest pressure). bar: left, top,
    right and bottom pixel of the colour bar in the picture, in place of colours, with scale=. crop: of the map
    itself. steps: the scale has so many colours and none between. background: a colour that means no pressure.
    unclear: pixels whose colour is not on the scale, or fits two places of it: "error", or "missing" for cells
    without a sensel. Raises InputError with their count.
    """
    if unclear not in ("error", "missing"):
        raise InputError(f'unclear must be "error" or "missing", got {unclear!r}')
    if spacing is None or (isinstance(spacing, tuple | list) and len(spacing) != 2):
        raise InputError(
            f'{path} is a picture and needs the size of a pixel, spacing="0.5 mm" or both of x and y, '
            f'("0.5 mm", "0.6 mm"), got {spacing!r}'
        )
    pixels = _pixels(path)
    legend = _scale(path, pixels, colours, scale, bar, steps)
    if bar is not None and crop is None:
        raise InputError(f"{path} holds its colour bar at {bar}; give crop=, the box of the map without it")
    chart = pixels if crop is None else _cut(path, pixels, crop, "crop")
    # Whole numbers sort in a tenth of the time of rows.
    packed, which = np.unique(chart.astype(np.int64) @ np.array([65536, 256, 1]), return_inverse=True)
    unique = np.stack([packed >> 16, packed >> 8 & 255, packed & 255], axis=1)
    pressures, fits = _pressures(unique.astype(float), legend)
    if background is not None:
        ground = np.linalg.norm(unique - np.asarray(_colour(background), dtype=float), axis=1) <= TOLERANCE
        pressures[ground], fits[ground] = 0.0, True
    which = which.reshape(chart.shape[:2])
    wrong: BoolArray = np.logical_not(fits)[which]
    if wrong.any() and unclear == "error":
        row, column = (int(k) for k in np.argwhere(wrong)[0])
        shown = "#" + "".join(f"{part:02x}" for part in chart[row, column])
        raise InputError(
            f"{path}: {int(wrong.sum())} of {wrong.size} pixels ({100 * wrong.mean():.3g} %) have a colour that is "
            f"not on the scale or fits two places of it, the first {shown} in row {row + 1}, column {column + 1}; "
            'crop the map, give its background= or its colours, or unclear="missing"'
        )
    values = np.where(wrong, np.nan, pressures[which])
    dx, dy = spacing if isinstance(spacing, tuple | list) else (spacing, spacing)
    source = (
        f"{path.name}: picture of {chart.shape[1]} x {chart.shape[0]} pixels, {len(legend.colours)} colours from "
    )
    source += f"{legend.pressures[0] / 1e3:g} to {legend.pressures[-1] / 1e3:g} kPa"
    top = float(legend.pressures[-1])
    return Frames(values[None], quantity(dy, "m"), quantity(dx, "m"), (1.0, 1.0), saturation=top, source=source)


def _pixels(path: Path) -> Array:
    """(rows, columns, 3) of 0 to 255; what is transparent lies on white."""
    # Pillow comes with matplotlib; nothing but pictures needs it.
    from PIL import Image

    try:
        with Image.open(path) as image:
            if image.width * image.height > _LARGEST:
                raise InputError(
                    f"{path} has {image.width} x {image.height} pixels, more than {_LARGEST:g}; make it smaller"
                )
            whole = image.convert("RGBA")
    except InputError:
        raise
    # What a picture breaks in Pillow is of every kind.
    except Exception as error:
        raise InputError(f"cannot read {path} as a picture: {error}; save it as PNG") from error
    values = np.asarray(whole, dtype=np.uint8)
    opaque = values[..., 3:].astype(np.uint16)
    mixed: Array = ((values[..., :3] * opaque + 255 * (255 - opaque) + 127) // 255).astype(np.uint8)
    return mixed


def _scale(
    path: Path,
    pixels: Array,
    colours: str | Sequence[tuple[Colour, float | str]] | None,
    scale: tuple[float | str, float | str] | None,
    bar: Box | None,
    steps: bool,
) -> Scale:
    if (colours is None) == (bar is None):
        raise InputError(
            f'{path} needs either colours=, the name of a colour map or pairs such as ("#0000ff", "100 kPa"), or '
            "bar=, the box of its colour bar"
        )
    if colours is not None and not isinstance(colours, str):
        pairs = _pairs(colours)
        values = np.array([_pressure(pair[1]) for pair in pairs])
        if not (np.diff(values) > 0).all():
            raise InputError(f"the pressures of colours must increase, got {[pair[1] for pair in pairs]!r}")
        return Scale(np.array([_colour(pair[0]) for pair in pairs], dtype=float), values, steps)
    if scale is None or len(scale) != 2:
        raise InputError('give scale=("0 kPa", "1000 kPa"), the pressures at both ends of the colours')
    low, high = (_pressure(number) for number in scale)
    if not 0 <= low < high:
        raise InputError(f"scale must increase from 0 Pa or more, got {low:g} to {high:g} Pa")
    if bar is not None:
        box = _cut(path, pixels, bar, "bar").astype(float)
        # Rows of an upright bar count from its upper end; a lying one rises to the right.
        line = np.median(box, axis=1)[::-1] if box.shape[0] >= box.shape[1] else np.median(box, axis=0)
        if len(line) < 2:
            raise InputError(f"the colour bar {bar} has {len(line)} pixel; give its box")
        return Scale(line, np.linspace(low, high, len(line)), steps)
    # matplotlib belongs to the figures' room.
    named = COLOUR_MAPS.find("matplotlib").target(str(colours))
    samples: Array = np.asarray(named(np.linspace(0, 1, _SAMPLES)), dtype=np.float64)
    return Scale(255 * samples[:, :3], np.linspace(low, high, _SAMPLES), steps)


def _pairs(colours: object) -> list[tuple[object, object]]:
    pairs = list(colours) if isinstance(colours, list | tuple) else []
    if len(pairs) < 2 or any(not isinstance(pair, list | tuple) or len(pair) != 2 for pair in pairs):
        raise InputError(
            'colours must be two or more pairs of a colour and its pressure, such as ("#0000ff", "100 kPa"), or the '
            f"name of a colour map, got {colours!r}"
        )
    return [(colour, pressure) for colour, pressure in pairs]


def _pressure(value: object) -> float:
    if isinstance(value, str):
        number, unit = leading_number(value)
        return number * pressure_factor(unit) if unit else quantity(value, "Pa")
    return quantity(value, "Pa")


def _colour(colour: object) -> tuple[int, int, int]:
    if isinstance(colour, str) and _HEX.fullmatch(colour):
        return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
    parts = cast("Sequence[int]", colour)
    if not isinstance(colour, str) and len(parts) == 3 and all(0 <= part <= 255 for part in parts):
        return int(parts[0]), int(parts[1]), int(parts[2])
    raise InputError(f'a colour is "#rrggbb" or (red, green, blue) of 0 to 255, got {colour!r}')


def _cut(path: Path, pixels: Array, box: Box, what: str) -> Array:
    rows, columns = pixels.shape[:2]
    whole = len(box) == 4 and all(isinstance(number, int | np.integer) for number in box)
    if not whole or not (0 <= box[0] < box[2] <= columns and 0 <= box[1] < box[3] <= rows):
        raise InputError(
            f"{what} must be left, top, right, bottom within the {columns} x {rows} pixels of {path}, got {box!r}"
        )
    cut: Array = pixels[box[1] : box[3], box[0] : box[2]]
    return cut


def _pressures(colours: Array, scale: Scale) -> tuple[Array, BoolArray]:
    """Pressure (n,), Pa, of colours (n, 3), and True where one place of the scale fits and no other."""
    pressures, fits = np.zeros(len(colours)), np.zeros(len(colours), dtype=bool)
    count = len(scale.colours)
    step = max(1, _AT_ONCE // (3 * count))
    apart = 0.0 if scale.steps else _APART * float(scale.pressures[-1] - scale.pressures[0])
    for start in range(0, len(colours), step):
        part = colours[start : start + step]
        if scale.steps:
            away = np.linalg.norm(part[:, None] - scale.colours[None], axis=2)
            values = np.broadcast_to(scale.pressures, away.shape)
        else:
            begin, edge = scale.colours[:-1], np.diff(scale.colours, axis=0)
            long = np.maximum((edge**2).sum(axis=1), 1e-12)
            at = np.clip(((part[:, None] - begin[None]) * edge[None]).sum(axis=2) / long, 0, 1)
            away = np.linalg.norm(part[:, None] - begin[None] - at[..., None] * edge[None], axis=2)
            values = scale.pressures[:-1] + at * np.diff(scale.pressures)
        best = away.argmin(axis=1)
        rows = np.arange(len(part))
        nearest = away[rows, best]
        # Some maps keep a colour for a while, as jet does its blue: the middle of it.
        same = (away <= nearest[:, None] + _ROUND_OFF) & (np.abs(values - values[rows, best][:, None]) <= apart)
        chosen = np.where(same, values, 0.0).sum(axis=1) / same.sum(axis=1)
        # A place that fits as well, but for rounding, and says something else.
        rival = (away <= np.maximum(nearest, 1.0)[:, None] * 1.05 + 1.0) & (np.abs(values - chosen[:, None]) > apart)
        pressures[start : start + step] = chosen
        fits[start : start + step] = (nearest <= TOLERANCE) & ~rival.any(axis=1)
    return pressures, fits
