"""Tire property files (.tir) as text: the Magic Formula 6.1 in SI units, its system of axes stated in a comment."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping

import numpy as np

from treadload.files import check_suffix
from treadload.kernels.arrays import Array

_AXES = {
    "ISO": "Signs: ISO, the W-axis system of TYDEX: x ahead, y to the left, z up.",
    "SAE": "Signs: SAE, x ahead, y to the right, z down.",
    "adapted SAE": "Signs: adapted SAE, x ahead, y to the right, z down, slip angle positive to the left.",
}
_UNITS = ("LENGTH = 'meter'", "FORCE = 'newton'", "ANGLE = 'radians'", "MASS = 'kg'", "TIME = 'second'",
          "PRESSURE = 'pascal'")  # fmt: skip
_WIDTH = 78


def check_tir_name(path: str | os.PathLike[str]) -> None:
    """Raise InputError for a name that does not end in .tir."""
    check_suffix(path, {".tir": "a tire property file"}, "a tire")


def tir_text(
    sections: Mapping[str, Mapping[str, float]],
    *,
    signs: str,
    side: str = "",
    comments: Iterable[str] = (),
    deflection: Array | None = None,
) -> str:
    """The text of a .tir file of version 6.1. Numbers are written so that they are read back to the last digit.

    sections: numbers by section and key, SI; signs: "ISO", "SAE" or "adapted SAE". side: "left", "right" or "".
    comments: sentences for its head. deflection: vertical deflection and load, m and N, (2, n).
    """
    lines = ["$ Tire property file of the Magic Formula, version 6.1", f"$ {_AXES[signs]}"]
    lines += [f"$ {line}" for comment in comments for line in _folded(comment)]
    lines += ["[UNITS]", *_UNITS, "[MODEL]", "PROPERTY_FILE_FORMAT = 'MF61'", "FITTYP = 61"]
    lines += [f"TYRESIDE = '{side.capitalize()}'"] if side else []
    model = {key: value for key, value in sections.get("MODEL", {}).items() if key != "FITTYP"}
    lines += _entries(model)
    for section, entries in sections.items():
        if section not in ("UNITS", "MODEL") and entries:
            lines += [f"[{section}]", *_entries(entries)]
    if deflection is not None:
        lines += ["[DEFLECTION_LOAD_CURVE]", "{pen fz}"]
        lines += [f"{depth!r} {load!r}" for depth, load in np.asarray(deflection, dtype=float).T.tolist()]
    return "\n".join(lines) + "\n"


def _entries(entries: Mapping[str, float]) -> list[str]:
    return [f"{key:<22} = {float(value)!r}" for key, value in entries.items()]


def _folded(text: str) -> list[str]:
    """A sentence in lines that fit a screen."""
    lines = [""]
    for word in text.split():
        if lines[-1] and len(lines[-1]) + len(word) >= _WIDTH:
            lines.append("")
        lines[-1] = f"{lines[-1]} {word}".strip()
    return lines
