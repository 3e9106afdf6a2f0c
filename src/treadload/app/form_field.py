"""A field of the form: a key of a case with the unit that a person types in."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass

from treadload.case.schema import Schema
from treadload.errors import InputError
from treadload.units import leading_number, quantity

NUMBER, TEXT, LIST, FREE = "number", "text", "list", "free"


@dataclass(frozen=True)
class ShownUnit:
    """A unit on the page. shown: beside the field. si: of the case. start: a value of a key that is added."""

    shown: str = ""
    si: str = ""
    start: object = 1


# By the kind of quantity, or else the SI unit, that the schema names.
_SHOWN = {
    "m": ("mm", "10 mm"), "radius": ("m", "25 m"), "Pa": ("kPa", "100 kPa"), "modulus": ("MPa", "1000 MPa"),
    "Pa/m": ("MPa/m", "1000 MPa/m"), "N/m": ("N/mm", "400 N/mm"), "N/rad": ("kN/rad", "200 kN/rad"),
    "N m/rad": ("kN m/rad", "9 kN m/rad"), "N": ("kN", "10 kN"), "s": ("s", "1 s"), "m/s": ("km/h", "70 km/h"),
    "sliding speed": ("m/s", "1 m/s"), "m/s^2": ("m/s^2", "2.5 m/s^2"), "rad": ("deg", "0 deg"), "K": ("K", "10 K"),
    "rad/m": ("rad/m", 0.05), "1/m": ("1/m", "5 1/m"), "m^2": ("cm^2", "500 cm^2"), "degC": ("°C", 15),
    "Hz": ("Hz", "10 Hz"), "strain": ("microstrain", "120 microstrain"), "share": ("", 0.1), "years": ("", 20),
    "1/year": ("", 100000), "": ("", 1),
}  # fmt: skip
_OF_KEYS = {"inflation_pressure": ("bar", "8 bar"), "poisson": ("", 0.35)}


def unit_of(schema: Schema, path: str, value: object) -> ShownUnit:
    """The unit of a field: the one that its value is written in, else that of its kind of quantity."""
    si = str(schema.get("x-unit", ""))
    shown, start = _SHOWN.get(str(schema.get("x-kind", si)), _SHOWN.get(si, (si, 1)))
    shown, start = _OF_KEYS.get(path.rpartition(".")[2], (shown, start))
    if isinstance(value, str) and si != "degC":
        try:
            written = leading_number(value)[1]
            quantity(f"1 {written}", si)
            shown = written
        except InputError:
            pass
    return ShownUnit(shown, si, start)


@dataclass(frozen=True)
class Field:
    """A field. path: of its key in the case. unit: shown beside it and meant by a bare number, "" of a pure one.

    si: the unit of the case. kind: "number", "text", "free" for a number or a text, "list", "choice" or "flag".
    choices: what is chosen from → label. values: what a choice stands for in the case. words: what it is. otherwise:
    what an empty field stands for.
    """

    path: str
    label: str
    unit: str = ""
    si: str = ""
    kind: str = NUMBER
    choices: Mapping[str, str] | None = None
    values: Mapping[str, object] | None = None
    words: str = ""
    otherwise: str = ""

    def shown(self, value: object) -> str:
        """A value of a case as the field shows it, in its unit."""
        if value is None or value == "":
            return ""
        if self.values is not None:
            words = (label for label, word in self.values.items() if word == value)
            return next(words, str(value))
        if isinstance(value, list | tuple):
            return ", ".join(map(self._shown, value))
        return self._shown(value)

    def _shown(self, value: object) -> str:
        if self.kind in (TEXT, FREE) or (not self.unit and isinstance(value, str)):
            return str(value)
        try:
            return f"{quantity(value, self.si) / self._factor:.10g}"
        except ValueError:
            return str(value)

    @functools.cached_property
    def _factor(self) -> float:
        return quantity(f"1 {self.unit}", self.si) if self.unit and self.si != "degC" else 1.0

    def read(self, text: str) -> object:
        """What a text means as a value of the case: a bare number is in the field's unit. None for nothing."""
        bare = text.strip()
        if not bare:
            return None
        if self.values is not None:
            return self.values.get(bare, bare)
        if self.kind == LIST:
            return [self._value(part.strip()) for part in bare.replace(";", ",").split(",") if part.strip()]
        return self._value(bare)

    def _value(self, bare: str) -> object:
        if self.kind == TEXT:
            return bare
        if not self.unit or self.si == "degC":
            # A pure number; or what is none, for the reader to say so.
            return _number(bare)
        # What ends in a digit has no unit: it is in that of the field.
        return f"{bare} {self.unit}" if bare[-1].isdigit() or bare[-1] in ".," else bare


def _number(bare: str) -> object:
    for kind in (int, float):
        try:
            return kind(bare)
        except ValueError:
            continue
    return bare
