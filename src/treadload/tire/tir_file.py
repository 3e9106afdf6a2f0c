"""Tire property files (.tir) of the Magic Formula: their text, units, version and signs."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.kernels.magic_formula import DEFAULTS
from treadload.units import PSI

SIGNS = ("ISO", "SAE", "adapted SAE")
"""Systems of axes: ISO 8855 (y left, z up), SAE J670 (y right, z down), and SAE with α positive to the left, which
the book of Pacejka calls adapted."""

_HEADING = re.compile(r"\[\s*([A-Za-z0-9_ ]+?)\s*\]")
_ENTRY = re.compile(r"([A-Za-z][A-Za-z0-9_]*)\s*=\s*(.*)")
_NUMBERS = re.compile(r"[-+0-9.eE,;\s]+")
# Words of a comment or a key that state the signs; "adapted SAE" before "SAE". Standards of measurement such as
# ISO 28580 or SAE J2452 state none.
_STATED = (
    ("adapted SAE", re.compile(r"\badapted[ -]SAE\b", re.IGNORECASE)),
    ("SAE", re.compile(r"(?<!adapted[ -])\bSAE\b(?![ -]?J? ?(?!670)\d)", re.IGNORECASE)),
    ("ISO", re.compile(r"\bISO(?:-?W)?\b(?![ :/-]*(?:TS|TR|PAS)?[ :/-]*(?!8855)\d)|\bW[ -]axis\b", re.IGNORECASE)),
)
_UNITS: Mapping[str, Mapping[str, float]] = {
    "LENGTH": {
        "meter": 1.0, "metre": 1.0, "m": 1.0, "centimeter": 1e-2, "cm": 1e-2, "millimeter": 1e-3, "mm": 1e-3,
        "kilometer": 1e3, "km": 1e3, "inch": 0.0254, "in": 0.0254, "foot": 0.3048, "ft": 0.3048, "mile": 1609.344,
    },
    "FORCE": {
        "newton": 1.0, "n": 1.0, "kilonewton": 1e3, "knewton": 1e3, "kn": 1e3, "kilogram_force": 9.80665,
        "kgf": 9.80665, "pound_force": 4.4482216152605, "lbf": 4.4482216152605,
    },
    "TIME": {"second": 1.0, "sec": 1.0, "s": 1.0, "millisecond": 1e-3, "ms": 1e-3, "minute": 60.0, "hour": 3600.0},
    "PRESSURE": {
        "pascal": 1.0, "pa": 1.0, "kilopascal": 1e3, "kpascal": 1e3, "kpa": 1e3, "megapascal": 1e6, "mpa": 1e6,
        "bar": 1e5, "psi": PSI,
    },
}  # fmt: skip
_RADIANS = ("rad", "radian", "radians")
# Powers of length, force, time and pressure of what has a unit; coefficients have none, angles are in radians.
_POWERS: Mapping[str, Mapping[str, int]] = {
    name: powers
    for names, powers in (
        ("UNLOADED_RADIUS WIDTH RIM_RADIUS RIM_WIDTH BOTTOMING_RADIUS BOTTOM_OFFST", {"LENGTH": 1}),
        ("FNOMIN FZMIN FZMAX", {"FORCE": 1}),
        ("VERTICAL_STIFFNESS BOTTOM_STIFF LONGITUDINAL_STIFFNESS LATERAL_STIFFNESS", {"FORCE": 1, "LENGTH": -1}),
        ("VERTICAL_DAMPING", {"FORCE": 1, "TIME": 1, "LENGTH": -1}),
        ("YAW_STIFFNESS", {"FORCE": 1, "LENGTH": 1}),
        ("LONGVL VXLOW", {"LENGTH": 1, "TIME": -1}),
        ("GRAVITY", {"LENGTH": 1, "TIME": -2}),
        ("NOMPRES INFLPRES IP IP_NOM PRESMIN PRESMAX", {"PRESSURE": 1}),
        ("FREQ_LONG FREQ_LAT FREQ_YAW FREQ_WINDUP", {"TIME": -1}),
    )
    for name in names.split()
}
# Numbers in units of mass, which the Magic Formula does not read.
_UNREAD = frozenset({"MASS", "BELT_MASS", "MBELT", "IXX", "IYY", "BELT_IXX", "BELT_IYY"})
# FITTYP of the file, and formats of files that have none.
_VERSIONS = {5: "5.2", 6: "5.2", 21: "5.2", 51: "5.2", 52: "5.2", 61: "6.1"}
_FORMATS = {"PAC2002": "5.2", "MF_05": "5.2", "MF-TYRE 5.2": "5.2", "MF52": "5.2", "MF61": "6.1"}
_AFRESH = "it may be cut off: copy or export it again"


@dataclass(frozen=True)
class TirText:
    """A .tir file as it stands there.

    where: its name, for errors. sections: by name → key → (text, line). tables: by name → rows of numbers.
    comments: their text. notes: what a reader should know.
    """

    where: str
    sections: Mapping[str, Mapping[str, tuple[str, int]]]
    tables: Mapping[str, tuple[tuple[float, ...], ...]]
    comments: tuple[str, ...]
    notes: tuple[str, ...] = ()

    def text(self, section: str, key: str) -> str | None:
        """The text of a key; None where the file has none, or leaves it empty."""
        entry = self.sections.get(section, {}).get(key)
        return (entry[0] or None) if entry else None

    def number(self, section: str, key: str) -> float | None:
        """A number as it stands there; None where the file has none. Raises InputError for anything else."""
        text = self.text(section, key)
        if text is None:
            return None
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            line = self.sections[section][key][1]
            raise InputError(f"{self.where}, line {line}: {key} is {text!r}, not a finite number; {_AFRESH}")
        return value

    @property
    def version(self) -> str:
        """Version of the formula, "5.2" or "6.1". Raises InputError for another one."""
        fit = self.number("MODEL", "FITTYP")
        form = (self.text("MODEL", "PROPERTY_FILE_FORMAT") or "").strip()
        formats = "FITTYP 5, 6, 21 or 52 (5.2), 61 (6.1), or the format 'PAC2002'"
        if fit is not None:
            if fit not in _VERSIONS:
                raise InputError(
                    f"{self.where}: FITTYP = {fit:g} is another version of the Magic Formula than 5.2 and 6.1; "
                    f"read are {formats}; export the tire in one of these"
                )
            return _VERSIONS[int(fit)]
        if form.upper() not in _FORMATS:
            what = f"the format {form!r}" if form else "no FITTYP and no PROPERTY_FILE_FORMAT"
            raise InputError(f"{self.where} has {what} in [MODEL]; read are {formats}")
        return _FORMATS[form.upper()]

    def signs(self, stated: str | None) -> str:
        """System of axes that the caller states, else the file. Raises InputError for neither, or two."""
        heading = self.text("MODEL", "TYDEX_AXES") or ""
        texts = [*self.comments, heading, self.text("MODEL", "COORDINATE_SYSTEM") or ""]
        named = [name for name, pattern in _STATED if any(pattern.search(text) for text in texts)]
        if stated is not None:
            by_name = {name.casefold(): name for name in SIGNS}
            if stated.casefold() not in by_name:
                raise InputError(f"signs must be one of {', '.join(SIGNS)}; {nearest(stated, SIGNS)}")
            wanted = by_name[stated.casefold()]
            if len(named) == 1 and named[0] != wanted:
                raise InputError(
                    f"{self.where} states {named[0]} signs and the caller {wanted}; leave signs out, or "
                    "correct the file"
                )
            return wanted
        if len(named) != 1:
            what = f"states {' and '.join(named)} signs" if named else "does not state its signs"
            raise InputError(
                f'{self.where} {what}; give signs="ISO" (y left, z up: PAC2002 and MF-Tyre), signs="SAE" or '
                'signs="adapted SAE", or write the name into a comment of the file'
            )
        return named[0]

    def factors(self) -> Mapping[str, float]:
        """What lengths, forces, times and pressures are multiplied by to be SI. Raises InputError."""
        if "UNITS" not in self.sections:
            raise InputError(f"{self.where} has no section [UNITS]; {_AFRESH}")
        angle = self.text("UNITS", "ANGLE")
        if angle is None or angle.casefold() not in _RADIANS:
            raise InputError(
                f"{self.where}: the unit of angles is {angle!r}; coefficients are per radian, and a file in degrees "
                "does not state which of its numbers are angles: export the tire with ANGLE = 'radian'"
            )
        factors: dict[str, float] = {}
        for name, units in _UNITS.items():
            text = self.text("UNITS", name)
            usual = next(iter(units))
            if text is None:
                if name != "PRESSURE":
                    raise InputError(f"{self.where}: [UNITS] has no {name}; write {name} = {usual!r}")
                # Without a unit of its own it is force over length squared, where that is the pascal.
                if factors["LENGTH"] == factors["FORCE"] == 1:
                    factors[name] = 1.0
                continue
            if text.casefold() not in units and text.casefold().removesuffix("s") not in units:
                raise InputError(
                    f"{self.where}, line {self.sections['UNITS'][name][1]}: {name} = {text!r} cannot be read; write "
                    f"one of {', '.join(units)}"
                )
            factors[name] = units.get(text.casefold()) or units[text.casefold().removesuffix("s")]
        return factors

    def numbers(self) -> Mapping[str, Mapping[str, float]]:
        """All numbers in SI, by section and key; texts and empty entries are left out. Raises InputError."""
        factors = self.factors()
        out: dict[str, dict[str, float]] = {}
        for section, entries in self.sections.items():
            if section == "UNITS":
                continue
            out[section] = {}
            for key, (text, _) in entries.items():
                # What the formula reads must be a number; whatever else stands there may be a text.
                if key not in _UNREAD and (key in DEFAULTS or key in _POWERS or _is_number(text)):
                    value = self.number(section, key)
                    if value is not None:
                        out[section][key] = value * self._factor(key, factors)
        return out

    def _factor(self, key: str, factors: Mapping[str, float]) -> float:
        product = 1.0
        for name, power in _POWERS.get(key, {}).items():
            if name not in factors:
                raise InputError(
                    f"{self.where}: {key} has no unit; write {name} = {next(iter(_UNITS[name]))!r} into [UNITS]"
                )
            product *= factors[name] ** power
        return product


def read_tir(path: str | os.PathLike[str]) -> TirText:
    """The text of a .tir file, taken apart. Raises InputError for a file that is no such file, or cut off."""
    where = Path(path).name
    try:
        raw = Path(path).read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {os.fspath(path)}: {error.strerror or error}") from error
    if b"\0" in raw:
        raise InputError(f"{where} is not a text file; give a .tir file of the Magic Formula")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        # Only comments have such letters.
        text = raw.decode("latin-1")
    draft = _Draft(where)
    for number, line in enumerate(text.splitlines(), start=1):
        draft.add(number, line)
    if not draft.sections:
        raise InputError(f"{where} has no section such as [MODEL]; give a .tir file of the Magic Formula")
    return TirText(where, draft.sections, draft.tables, tuple(draft.comments), tuple(draft.notes))


def deflection_of(text: TirText) -> Array | None:
    """Deflection and load of the table of a file, SI."""
    rows = text.tables.get("DEFLECTION_LOAD_CURVE")
    if rows is None:
        return None
    if any(len(line) != 2 for line in rows):
        raise InputError(f"{text.where}: [DEFLECTION_LOAD_CURVE] must have two numbers in each row, pen and fz")
    factors = text.factors()
    curve: Array = np.array(rows).T * np.array([[factors["LENGTH"]], [factors["FORCE"]]])
    return curve


def remarks_of(text: TirText) -> tuple[str, ...]:
    """What a reader of the forces should know."""
    remarks = []
    if text.number("MODEL", "FITTYP") == 5:
        remarks.append("FITTYP = 5 is version 5.0, whose coefficients are evaluated by the equations of 5.2")
    if any("Default value" in comment for comment in text.comments):
        remarks.append('a comment of the file marks part of the coefficients as "Default value": they are not fitted')
    return tuple(remarks)


@dataclass
class _Draft:
    """What was read so far; `skipped`: in a table that stands there for the second time."""

    where: str
    sections: dict[str, dict[str, tuple[str, int]]] = field(default_factory=dict)
    tables: dict[str, tuple[tuple[float, ...], ...]] = field(default_factory=dict)
    comments: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    section: str = ""
    skipped: bool = False

    def add(self, number: int, line: str) -> None:
        """Take in a line."""
        body, comment = _parted(line)
        if comment:
            self.comments.append(comment)
        if not body:
            return
        place = f"{self.where}, line {number}"
        if heading := _HEADING.fullmatch(body):
            self.section = heading[1].upper()
            self.skipped = self.section in self.tables
            if self.skipped:
                self.notes.append(
                    f"[{self.section}] is given twice in {self.where}, again in line {number}; the first is taken"
                )
            self.sections.setdefault(self.section, {})
        elif not self.section:
            raise InputError(f"{place}: {body[:40]!r} comes before the first section; give a .tir file")
        elif entry := _ENTRY.fullmatch(body):
            key, value = entry[1].upper(), entry[2].strip().strip("'\"").strip()
            entries = self.sections[self.section]
            if key in entries and entries[key][0] != value:
                raise InputError(
                    f"{place}: {key} = {value} is already given in line {entries[key][1]} as {entries[key][0]}; "
                    "remove either"
                )
            entries.setdefault(key, (value, number))
        elif _NUMBERS.fullmatch(body):
            if not self.skipped:
                self.tables[self.section] = (*self.tables.get(self.section, ()), _row(place, body))
        elif not body.startswith("{"):
            raise InputError(f"{place}: {body[:40]!r} is neither KEY = value nor a row of numbers; {_AFRESH}")


def _parted(line: str) -> tuple[str, str]:
    """What a line states, and its comment, which starts with $ or ! outside of quotes."""
    quote = ""
    for place, letter in enumerate(line):
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "'\"":
            quote = letter
        elif letter in "$!":
            return line[:place].strip(), line[place + 1 :].strip()
    return line.strip(), ""


def _row(place: str, text: str) -> tuple[float, ...]:
    try:
        return tuple(float(cell) for cell in re.split(r"[,;\s]+", text.strip(" ,;")))
    except ValueError:
        raise InputError(f"{place}: {text[:40]!r} is not a row of numbers; {_AFRESH}") from None


def _is_number(text: str) -> bool:
    try:
        return math.isfinite(float(text))
    except ValueError:
        return False
