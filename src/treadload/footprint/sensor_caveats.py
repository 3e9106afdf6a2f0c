"""What is doubtful about a footprint, in sentences."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from treadload.footprint.footprint import Footprint
from treadload.footprint.spelling import KGF_CM2
from treadload.kernels.arrays import Array, BoolArray
from treadload.plausible import load_caveat
from treadload.units import PSI

# Peaks of footprints, Pa, beyond which the unit is doubted, and what they usually are; units that were meant.
_PEAKS, _USUAL = (3e4, 2e7), (2e5, 4e6)
_UNITS = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "kgf/cm2": KGF_CM2, "bar": 1e5, "psi": PSI}
# The largest pressure, read by so many sensels and this share of them, may be where the sensor was cut off.
_EQUAL, _EQUAL_SHARE = 5, 0.02
# Named one by one, of dead sensels.
_NAMED = 6


def caveats_of(path: Path, pressure: Array, valid: BoolArray, most: float, travel: str) -> list[str]:
    """Sentences about saturation, the sensor's edge, and lines that read nothing."""
    sentences = []
    loaded = pressure > 0
    full = pressure >= most * (1 - 1e-9)
    if full.any():
        sentences.append(
            f"{path.name}: {int(full.sum())} of {int(loaded.sum())} loaded sensels read the saturation of "
            f"{most / 1e3:g} kPa; load and peak are lower bounds"
        )
    top = int((pressure >= pressure.max() * (1 - 1e-9)).sum())
    if math.isinf(most) and _EQUAL <= top < loaded.sum() and top > _EQUAL_SHARE * loaded.sum():
        sentences.append(
            f"{path.name}: {top} sensels read the same largest pressure, {pressure.max() / 1e3:g} kPa, as if they "
            "were saturated; give saturation= if they are"
        )
    rim = np.zeros(pressure.shape, dtype=bool)
    rim[[0, -1]], rim[:, [0, -1]] = True, True
    share = float(pressure[rim & loaded].sum() / pressure.sum())
    if min(pressure.shape) > 4 and share > 0.01:
        sentences.append(
            f"{path.name}: the outermost sensels carry {100 * share:.2g} % of the load; the footprint goes on beyond "
            "the sensor"
        )
    # Lines across travel: those along it are grooves of the tread.
    upright = travel in ("right", "left")
    lines = pressure.T if upright else pressure
    there = valid.T if upright else valid
    empty = [
        n
        for n in range(1, len(lines) - 1)
        if not lines[n].any() and there[n].any() and lines[n - 1].any() and lines[n + 1].any()
    ]
    if empty:
        named = ", ".join(str(n + 1) for n in empty[:_NAMED]) + (", …" if len(empty) > _NAMED else "")
        sentences.append(
            f"{path.name}: {'column' if upright else 'row'} {named} reads zero between loaded ones, a dead line of "
            "the sensor or a groove across the tread; write NaN there if it is dead"
        )
    return sentences


def dead_in_words(path: Path, holes: BoolArray, stuck: BoolArray, dead: str) -> list[str]:
    """Sentences that name dead and stuck sensels. dead: what was done with them."""
    sentences = []
    if holes.any():
        done = "filled from their neighbours" if dead == "fill" else 'left empty (dead="fill" fills them)'
        sentences.append(f"{path.name}: dead sensels, which read nothing amid loaded ones: {_places(holes)}; {done}")
    if stuck.any():
        sentences.append(
            f"{path.name}: sensels that read pressure amid empty ones, as stuck ones do: {_places(stuck)}"
        )
    return sentences


def _places(mask: BoolArray) -> str:
    places = [f"row {row + 1} column {column + 1}" for row, column in np.argwhere(mask)[:_NAMED]]
    more = int(mask.sum()) - len(places)
    return ", ".join(places) + (f" and {more} more" if more > 0 else "")


def peak_caveat(footprint: Footprint, unit: float) -> list[str]:
    """A sentence about a peak, or else a load, that no tire has. unit: of the file, Pa."""
    peak = footprint.peak_pressure
    if _PEAKS[0] <= peak <= _PEAKS[1]:
        return list(load_caveat(footprint.normal_load, footprint.width, "the footprint"))
    meant = [name for name, worth in _UNITS.items() if _USUAL[0] <= peak / unit * worth <= _USUAL[1]]
    return [
        f"the footprint peaks at {peak / 1e3:.3g} kPa; footprints of tires usually do at {_USUAL[0] / 1e3:g} to "
        f"{_USUAL[1] / 1e3:g} kPa" + (f": are its values in {' or '.join(meant)}?" if meant else "; check its unit")
    ]
