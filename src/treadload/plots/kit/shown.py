"""Quantities of studies as people read them: words, a unit and a factor for an axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array
from treadload.variables import SCALES, axis_display_of

# What is less than this in the unit of a figure is nothing.
_NOTHING = 1e-6
# Numbers with a unit have a power of ten from here on.
_LONG = 1e7
# Quantities of which a tenth and ten times are alike far from the middle.
_LOGARITHMIC = ("passes", "years")


@dataclass(frozen=True)
class Shown:
    """A quantity in a figure. words: its name. unit: of the figure, "" of texts. factor: from SI."""

    words: str
    unit: str
    factor: float
    logarithmic: bool = False

    @property
    def label(self) -> str:
        """Of an axis: "normal load (kN)"."""
        return f"{self.words} ({self.unit})" if self.unit else self.words

    def number(self, value: object) -> str:
        """A value with its unit: "32.5 kN"."""
        if not isinstance(value, int | float | np.number):
            return str(value)
        unit = "" if self.unit in ("", "–") else self.unit if self.unit == "°" else f" {self.unit}"
        scaled = self.factor * float(value)
        if unit and abs(scaled) < _NOTHING:
            # Round-off of a place on an axis of symmetry, and the like.
            scaled = 0.0
        # 28110 mm², not 2.811e+04 mm².
        is_whole = 1e4 <= abs(scaled) < _LONG
        text = f"{float(f'{scaled:.4g}'):.0f}" if is_whole and unit else f"{scaled:.4g}"
        return f"{text}{unit}".replace("-", "\u2212")


def shown(field: xr.DataArray, name: str = "") -> Shown:
    """How a quantity of a study is drawn. name: of the quantity; left out, that of the field."""
    name = name or str(field.name)
    leaf = name.rpartition(".")[2]
    if field.dtype.kind not in "fiu":
        return Shown(_words(name), "", 1.0)
    values = np.abs(numbers(field))
    unit = str(field.attrs.get("units", "1"))
    display = axis_display_of(_whole_name(leaf), unit, float(values[np.isfinite(values)].max(initial=0.0)))
    wide = unit in ("1", "") and any(part in leaf for part in _LOGARITHMIC) and not leaf.endswith("per_year")
    return Shown(_words(name), display.unit or "–", SCALES.get(display.unit, 1.0), wide)


def numbers(field: xr.DataArray) -> Array:
    """Values of a field of numbers as floats."""
    return np.asarray(field.to_numpy(), dtype=float)


def _words(name: str) -> str:
    """A key or a name in words: "thickness of layer 1", "largest principal strain"."""
    parts = name.split(".")
    if len(parts) > 2 and parts[-2].isdigit():
        of = parts[-3].rstrip("s").replace("classe", "class")
        return f"{parts[-1].replace('_', ' ')} of {of} {int(parts[-2]) + 1}"
    if len(parts) > 3 and parts[-3].isdigit():
        of = parts[-4].rstrip("s").replace("classe", "class")
        return f"{parts[-1].replace('_', ' ')} of {of} {int(parts[-3]) + 1}"
    return axis_display_of(_whole_name(parts[-1]), "1").label


def _whole_name(name: str) -> str:
    """A reduced reading by its whole name; the first of the principal ones is the largest."""
    for short, whole in (("max_", "largest_"), ("min_", "smallest_")):
        if name.startswith(short):
            return whole + name.removeprefix(short).removesuffix("_1")
    return name
