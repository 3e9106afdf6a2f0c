"""Keys and numbers of a case as a person writes them: a name, a value, a unit, by the types of the case's fields."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Literal, TypeGuard, get_args, get_origin, get_type_hints

from treadload.plots.kit.style import power_of_ten, thousands
from treadload.read import Choice, Table, arms
from treadload.units import Unit
from treadload.us_units import us_unit

Convert = Callable[[float], float]
PURE = "–"
_MINUS = "\u2212"

# Unit of a field (`treadload.units.Unit`) → the unit that people use, and the factor to it.
SHOWN = {
    "": (PURE, 1.0),
    "strain": ("microstrain", 1e6),
    "share": ("%", 100.0),
    "years": ("years", 1.0),
    "1/year": ("per year", 1.0),
    "m": ("mm", 1e3),
    "radius": ("m", 1.0),
    "Pa": ("kPa", 1e-3),
    "modulus": ("MPa", 1e-6),
    "Pa/m": ("MPa/m", 1e-6),
    "1/m": ("1/m", 1.0),
    "m^2": ("mm²", 1e6),
    "N": ("kN", 1e-3),
    "N/m": ("N/mm", 1e-3),
    "N/m^3": ("kN/m³", 1e-3),
    "N m": ("N m", 1.0),
    "N/rad": ("kN/rad", 1e-3),
    "N m/rad": ("N m/rad", 1.0),
    "s": ("s", 1.0),
    "m/s": ("km/h", 3.6),
    "sliding speed": ("m/s", 1.0),
    "m/s^2": ("m/s²", 1.0),
    "rad": ("°", 180 / math.pi),
    "rad/m": ("rad/m", 1.0),
    "K": ("K", 1.0),
    "degC": ("°C", 1.0),
    "1/K": ("1/K", 1.0),
    "1/K^2": ("1/K²", 1.0),
    "Hz": ("Hz", 1.0),
    "1/Pa": ("1/MPa", 1e6),
    "J/mol": ("kJ/mol", 1e-3),
    "W/(m K)": ("W/(m K)", 1.0),
    "J/(m^3 K)": ("MJ/(m³ K)", 1e-6),
}

# Keys that do not say by themselves what they are; the rest only lose their underscores.
_NAMES = {
    "TrafficPart.kind": "kind of growth",
    "FootprintStep.units": "units of columns",
    "a1": "A₁",
    "a2": "A₂",
    "beta": "β",
    "bond": "bond to the layer below",
    "c1": "C₁",
    "c2": "C₂",
    "classes": "axles",
    "creepage_x": "longitudinal creepage",
    "creepage_y": "lateral creepage",
    "delta": "δ",
    "epsilon_6": "ε₆, strain at a million load repetitions",
    "extrapolate": "extrapolation beyond the materials' data",
    "fill_holes": "holes filled",
    "frequency": "frequency at which mixes are read",
    "friction": "coefficient of friction",
    "gear": "wheels",
    "glassy_modulus": "E∞, for fast loading",
    "growth": "annual growth of the traffic",
    "layers": "layer",
    "modulus": "Young's modulus",
    "months": "temperature, January to December",
    "passes_per_year": "load repetitions in the first year",
    "poisson": "Poisson's ratio",
    "reading_6": "r₆, evaluated value at a million load repetitions",
    "revolve": "meridian revolved",
    "road_compliance": "compliance of the road in the contact",
    "sigma_6": "σ₆, stress at a million load repetitions",
    "slope": "slope of the fatigue law",
    "spacing": "cell size of the grid",
    "static_modulus": "E₀, for slow loading",
    "structure": "structure from the catalogue",
    "tau": "τ at the reference of the shift",
    "terms": "terms (share, relaxation time)",
    "values": "temperatures at those depths",
    "years": "design life",
}
_VALUES = {
    "2s2p1d": "2S2P1D",
    "arrhenius": "Arrhenius",
    "half_space": "half-space",
    "huet-sayegh": "Huet-Sayegh",
    "in-plane": "in the horizontal plane",
    "power-law-creep": "power law of creep",
    "principal": "three-dimensional",
    "prony": "Prony series",
    "tandem-dual": "tandem, dual wheels",
    "tridem-dual": "tridem, dual wheels",
    "wlf": "WLF",
}
# Tables whose keys say enough without the table's name, and the name of what they are.
_SILENT = {"material": "material", "fatigue": "fatigue law"}
_KINDS = ("kind", "law")


@dataclass(frozen=True)
class Entry:
    """A given value.

    name: in words, after the tables it stands in. unit: "–" of a pure number, "" of words.
    """

    name: str
    unit: str
    text: str

    def __str__(self) -> str:
        return f"{self.name} {self.text}{'' if self.unit in ('', PURE) else f' {self.unit}'}"


def entries(
    model: type[Table] | None, table: Mapping[str, object], before: tuple[str, ...] = (), what: str = ""
) -> Iterator[Entry]:
    """What a table of a case gives, nested tables after their own names and those in a list numbered.

    model: the part of a case that the table is, or None where it is not known. what: the table's kind is one of.
    Lists of named things are left to `named_tables`.
    """
    for key, value in table.items():
        annotation = annotation_of(model, key)
        if isinstance(value, Mapping) and value:
            inside = () if key in _SILENT else (key.replace("_", " "),)
            yield from entries(part_of(annotation, value), value, (*before, *inside), _SILENT.get(key, ""))
        elif _is_tables(value):
            if is_named(annotation, value):
                continue
            for count, item in enumerate(value, start=1):
                yield from entries(part_of(annotation, item), item, (*before, f"{_single(key)} {count}"))
        else:
            text, unit = worded(value, annotation)
            name = what if what and key in _KINDS else name_of(key, model)
            yield Entry(": ".join([*before, name]), unit, text)


def named_tables(
    model: type[Table] | None, table: Mapping[str, object]
) -> Iterator[tuple[str, list[Mapping[str, object]], type[Table] | None]]:
    """Lists of things with a name of their own, wherever they stand: key, the tables, their part."""
    for key, value in table.items():
        annotation = annotation_of(model, key)
        if isinstance(value, Mapping):
            yield from named_tables(part_of(annotation, value), value)
        elif _is_tables(value) and is_named(annotation, value):
            yield key, value, part_of(annotation, value[0])


def columns(
    items: list[Mapping[str, object]], model: type[Table] | None
) -> tuple[tuple[str, ...], tuple[tuple[str, ...], ...]]:
    """Heading and rows of named things: a column for each key that one of them gives, with its unit."""
    order = list(model.model_fields) if model is not None else []
    present = dict.fromkeys(key for item in items for key in item)
    keys = [key for key in order if key in present] + [key for key in present if key not in order]
    heads, cells = [], []
    for key in keys:
        annotation = annotation_of(model, key)
        values = [item.get(key) for item in items]
        label, convert = shown_in(annotation, [value for value in values if value is not None])
        unit = f", {label}" if label not in ("", PURE) else ""
        heads.append(f"{name_of(key, model)}{unit}")
        cells.append([PURE if value is None else _text(value, annotation, convert) for value in values])
    return tuple(heads), tuple(zip(*cells, strict=True))


def sentence(model: type[Table] | None, table: Mapping[str, object]) -> str:
    """A table in a line: what it is, then its numbers with their units."""
    what = [str(table[key]) for key in ("name", *_KINDS) if isinstance(table.get(key), str)]
    rest = {key: value for key, value in table.items() if key not in ("name", *_KINDS)}
    texts = [str(entry) for entry in entries(model, rest)]
    first = _VALUES.get(what[0], what[0]) if what else ""
    return ": ".join(part for part in (first, ", ".join(texts)) if part)


def worded(value: object, annotation: object) -> tuple[str, str]:
    """A value and its unit."""
    label, convert = shown_in(annotation, value)
    return _text(value, annotation, convert), label


def shown_in(annotation: object, value: object) -> tuple[str, Convert]:
    """Unit in which numbers of a field are shown, and the conversion to it; "" of words and of several kinds."""
    if not any(True for _ in _numbers(value)):
        return "", _as_it_is
    symbols = list(dict.fromkeys(units_in(annotation)))
    if not symbols:
        return PURE, _as_it_is
    # A pair of unlike numbers: each carries its own unit.
    return ("", _as_it_is) if len(symbols) > 1 and isinstance(value, list) else _display(symbols[0])


def _display(symbol: str) -> tuple[str, Convert]:
    """Unit that people use for a unit of `SHOWN`, and the conversion from SI; US units to four digits."""
    label, factor = SHOWN[symbol]
    us = us_unit(label, symbol)
    if us is None:
        return label, lambda value: value * factor
    return us.symbol, lambda value: float(f"{us.number(value):.4g}")


def _as_it_is(value: float) -> float:
    return value


def name_of(key: str, model: type[Table] | None = None) -> str:
    """A key in words."""
    full_name = f"{model.__name__}.{key}" if model is not None else ""
    return _NAMES.get(full_name) or _NAMES.get(key) or key.replace("_", " ")


def number(value: float) -> str:
    """A number with at most six digits and a true minus."""
    value = round(value, 12)
    if value and abs(value) < 1e-4:
        return (_MINUS if value < 0 else "") + power_of_ten(abs(value))
    if abs(value) >= 1e4 and float(value).is_integer():
        return thousands(value).replace("-", _MINUS)
    return f"{value:.6g}".replace("-", _MINUS)


@cache
def _hints(model: type) -> dict[str, object]:
    return get_type_hints(model, include_extras=True)


def annotation_of(model: type[Table] | None, key: str) -> object:
    """Type of a field with its unit; None where the part or the key is not known.

    A case has the tables of its steps as fields that no annotation of its class names.
    """
    if model is None:
        return None
    hints = _hints(model)
    if key in hints:
        return hints[key]
    field = model.model_fields.get(key)
    return None if field is None else field.annotation


def units_in(annotation: object) -> Iterator[str]:
    """Symbols of the units in a type; the outermost where one stands around another, none inside tables."""
    for arm in arms(annotation):
        if get_origin(arm) is Annotated:
            inner, *marks = get_args(arm)
            symbols = [mark.symbol for mark in marks if isinstance(mark, Unit)]
            yield from symbols[-1:] or units_in(inner)
        else:
            for member in get_args(arm):
                yield from units_in(member)


def parts_in(annotation: object, table: Mapping[str, object]) -> Iterator[type[Table]]:
    """The tables of a case that a table of this type may be."""
    for arm in arms(annotation):
        if isinstance(arm, type) and issubclass(arm, Table):
            yield arm
        for inner in get_args(arm):
            part = inner.table_for(table) if isinstance(inner, Choice) else None
            if part is not None:
                yield part
            yield from parts_in(inner, table)


def part_of(annotation: object, table: Mapping[str, object]) -> type[Table] | None:
    """The table of a case that a table is: it knows its keys and its kind, and misses least."""
    fitting = [part for part in parts_in(annotation, table) if _fits(part, table)]
    return min(fitting, key=lambda part: _missing(part, table), default=None)


def is_named(annotation: object, items: list[Mapping[str, object]]) -> bool:
    """True for a list of things that must have a name."""
    part = part_of(annotation, items[0])
    return part is not None and "name" in part.model_fields and part.model_fields["name"].is_required()


def _fits(part: type[Table], table: Mapping[str, object]) -> bool:
    literals = {key: get_args(hint) for key, hint in _hints(part).items() if get_origin(hint) is Literal}
    return set(table) <= set(part.model_fields) and all(
        table[key] in words for key, words in literals.items() if key in table
    )


def _missing(part: type[Table], table: Mapping[str, object]) -> int:
    return sum(field.is_required() and key not in table for key, field in part.model_fields.items())


def _is_tables(value: object) -> TypeGuard[list[Mapping[str, object]]]:
    return isinstance(value, list) and bool(value) and all(isinstance(item, Mapping) for item in value)


def _single(key: str) -> str:
    return key.removesuffix("es") if key.endswith("sses") else key.removesuffix("s")


def _numbers(value: object) -> Iterator[float]:
    if isinstance(value, list | tuple):
        for item in value:
            yield from _numbers(item)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield float(value)


def _text(value: object, annotation: object, convert: Convert) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, Mapping):
        return sentence(part_of(annotation, value), value)
    if _is_tables(value):
        return "; ".join(_text(item, annotation, convert) for item in value)
    if isinstance(value, list | tuple):
        return ", ".join(
            f"({_pair(item, annotation, convert)})" if isinstance(item, list) else _text(item, annotation, convert)
            for item in value
        )
    if isinstance(value, int | float):
        return number(convert(value))
    return _VALUES.get(str(value), str(value))


def _pair(pair: list[object], annotation: object, convert: Convert) -> str:
    """Numbers in a bracket; each with its unit where they are of several kinds."""
    symbols = list(units_in(annotation))
    if len(set(symbols)) < 2 or len(symbols) != len(pair):
        return ", ".join(_text(item, annotation, convert) for item in pair)
    texts = []
    for item, symbol in zip(pair, symbols, strict=True):
        text, label = worded(item, Annotated[float, Unit(symbol)])
        texts.append(text if label == PURE else f"{text} {label}")
    return ", ".join(texts)
