"""How a scan is to be read."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from treadload.errors import InputError, positive
from treadload.tire.scan.surface import Choice
from treadload.tire.scan.units import POSSIBLE_DIAMETERS, unit_name
from treadload.units import quantity

Smooth = Literal[False, "auto"] | float
Outliers = Literal["remove", "refuse", "keep"]

ROUNDNESS = 0.02
SMOOTHING = (0.5e-3, 0.05)


@dataclass(frozen=True)
class ScanOptions:
    """How a scan is to be read; the words are those of `Tire.from_scan`. Raises InputError."""

    units: str | None = None
    nominal_diameter: float | None = None
    rotation: float = 0.0
    camber: float = 0.0
    revolve: Choice = "auto"
    fill_holes: Choice = "auto"
    smooth: Smooth = False
    outliers: Outliers = "remove"
    roundness: float = ROUNDNESS
    scale: float | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "units", unit_name(self.units))
        diameter = self.nominal_diameter
        if diameter is not None and not POSSIBLE_DIAMETERS[0] <= diameter <= POSSIBLE_DIAMETERS[1]:
            raise InputError(
                f"nominal_diameter must lie between {POSSIBLE_DIAMETERS[0]} and {POSSIBLE_DIAMETERS[1]} m, "
                f"got {diameter:g}; give it in m, a 315/80R22.5 has 1.076"
            )
        if self.scale is not None:
            remedy = "take a known length in m over what it measures in the file"
            positive("scale", self.scale, "m per unit of the file", remedy)
            if self.units is not None:
                raise InputError(
                    f"give either units ({self.units!r}) or scale, not both: each sets how long a unit is"
                )
        if not math.isfinite(self.rotation):
            raise InputError(f"rotation must be a finite angle in rad, got {self.rotation}")
        if not abs(self.camber) <= math.radians(15):
            raise InputError(f"camber must lie within ±0.262 rad (15°), got {self.camber}; give it in rad")
        for name in ("revolve", "fill_holes"):
            if getattr(self, name) not in (True, False, "auto"):
                raise InputError(f'{name} must be True, False or "auto", got {getattr(self, name)!r}')
        if self.outliers not in ("remove", "refuse", "keep"):
            raise InputError(f'outliers must be "remove", "refuse" or "keep", got {self.outliers!r}')
        low, high = SMOOTHING
        if self.smooth is not False and self.smooth != "auto" and not _is_between(self.smooth, low, high):
            raise InputError(
                f'smooth must be False, "auto" or a length between {low:g} and {high:g} m, got {self.smooth!r}'
            )
        if not _is_between(self.roundness, 0, 1):
            raise InputError(
                f"roundness must lie between 0 and 1, got {self.roundness!r}: the share of the radius by which it "
                f"may vary round the tire, {ROUNDNESS} if left out"
            )


def _is_between(value: object, low: float, high: float) -> bool:
    return not isinstance(value, bool) and isinstance(value, int | float | np.floating) and bool(low <= value <= high)


def yes_no_auto(option: str, word: str) -> Choice:
    """The value of an option from a word: True, False or "auto". Raises InputError."""
    words: dict[str, Choice] = {"yes": True, "true": True, "no": False, "false": False, "auto": "auto"}
    if word.strip().lower() not in words:
        raise InputError(f"{option} must be yes, no or auto, got {word!r}")
    return words[word.strip().lower()]


def smooth_choice(word: str) -> Smooth:
    """The smoothing that a word asks for: none, auto or a length with its unit. Raises InputError."""
    plain = word.strip().lower()
    if plain in ("no", "false"):
        return False
    return "auto" if plain == "auto" else quantity(word, "m")


def scale_choice(words: str) -> float:
    """M per unit of the file, from "0.8123 = 1000 mm": what a length measures in the file, and what it is."""
    measured, mark, true = words.partition("=")
    try:
        length = float(measured.strip().replace(",", "."))
    except ValueError:
        length = math.nan
    if not mark or not 0 < length < math.inf:
        raise InputError(
            f'a reference length is its measure in the file and its length, "0.8123 = 1000 mm", got {words!r}'
        )
    return quantity(true.strip(), "m") / length
