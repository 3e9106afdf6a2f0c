"""Quantities of studies as people read them: words, a unit and a factor for an axis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import xarray as xr

from treadload.kernels.arrays import Array

# SI unit → units of figures with their factors; the last whose least shown value the largest one reaches.
_UNITS: dict[str, tuple[tuple[float, float, str], ...]] = {
    "Pa": ((0, 1e-3, "kPa"), (2e6, 1e-6, "MPa")),
    "N": ((0, 1.0, "N"), (1e3, 1e-3, "kN")),
    "m": ((0, 1e3, "mm"), (5.0, 1.0, "m")),
    "m^2": ((0, 1e4, "cm²"),),
    "m/s": ((0, 3.6, "km/h"),),
    "rad": ((0, 180 / np.pi, "°"),),
    "degC": ((0, 1.0, "°C"),),
    "J/m^3": ((0, 1.0, "J/m³"),),
    "W/m^2": ((0, 1e-3, "kW/m²"),),
    "Pa/m": ((0, 1e-6, "MPa/m"),),
}
_STRAINS = ("strain", "extension", "compression", "epsilon")
_SHARES = ("fraction", "share", "coverage")
# What is less than this in the unit of a figure is nothing.
_NOTHING = 1e-6
# Names that do not say what they are.
_CALLED = {"life_years": "years to failure", "governing_years": "years to the first failure"}
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
        return f"{scaled:.4g}{unit}".replace("-", "\u2212")


def shown(field: xr.DataArray, name: str = "") -> Shown:
    """How a quantity of a study is drawn. name: of the quantity; left out, that of the field."""
    name = name or str(field.name)
    leaf = name.rpartition(".")[2]
    words = _words(name)
    if field.dtype.kind not in "fiu":
        return Shown(words, "", 1.0)
    unit = str(field.attrs.get("units", "1"))
    if unit in ("1", ""):
        if any(part in leaf for part in _LOGARITHMIC) and not leaf.endswith("per_year"):
            return Shown(words, "" if "years" in leaf else "–", 1.0, True)
        if any(part in leaf for part in _STRAINS) and "damage" not in leaf:
            return Shown(words, "microstrain", 1e6)
        if any(part in leaf for part in _SHARES):
            return Shown(words, "%", 100.0)
        return Shown(words, "–", 1.0)
    values = np.abs(numbers(field))
    largest = float(values[np.isfinite(values)].max(initial=0.0))
    steps = _UNITS.get(unit, ((0, 1.0, unit),))
    _, factor, told = [step for step in steps if largest >= step[0]][-1]
    return Shown(words, told, factor)


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
    words = _CALLED.get(parts[-1]) or parts[-1].replace("_", " ").replace("in plane", "in-plane")
    # The first of the principal ones is the largest.
    words = words.removesuffix(" 1") if words.startswith("max ") else words
    for short, whole in (("max ", "largest "), ("min ", "smallest ")):
        words = whole + words.removeprefix(short) if words.startswith(short) else words
    return words
