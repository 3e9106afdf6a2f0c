"""What a criterion can read, and by which laws: each with its source, unit, needs, and what calibrates it."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from typing import Any, get_args

from treadload.damage.laws.fatigue import USERS
from treadload.damage.laws.of_layer import OnLayer
from treadload.damage.quantity import UNCALIBRATED, Quantity
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.read import made_by, parameters
from treadload.registry import CRITERIA, QUANTITIES, Registry
from treadload.units import Unit

_FIELDS = (("stress", "stress"), ("strain", "strain"), ("dissipated", "energy of a passage over a viscoelastic road"))


@dataclass(frozen=True)
class Listed:
    """A quantity or a law by its word in a case.

    words: what it is. unit: of a reading, as people read it. asks: numbers that must be given, in brackets those that
    may be left out, and which fields of a response are read. source: who proposed it, or where its numbers stand.
    calibrated: what ties it to roads, and what does not. ends: what a damage of 1 means, of laws. package: that
    brings it, "" for ours.
    """

    name: str
    words: str
    unit: str
    asks: str
    source: str
    calibrated: str
    ends: str = ""
    package: str = ""

    def __str__(self) -> str:
        rows = {
            "what it is": self.words, "unit": self.unit or "–", "asks for": self.asks, "source": self.source,
            "calibrated": self.calibrated, "a damage of 1 means": self.ends, "package": self.package,
        }  # fmt: skip
        return "\n".join([self.name, *(f"  {name}: {text}" for name, text in rows.items() if text)])


def quantities_listed() -> tuple[Listed, ...]:
    """What a criterion can read. Raises InputError for a package that cannot be loaded.

    >>> [quantity.name for quantity in tl.damage.quantities_listed() if quantity.unit == "J/m³"]
    ['distortion_energy', 'dissipated_energy']
    """
    return tuple(_quantity(name, package) for name, package in QUANTITIES.packages().items())


def laws_listed() -> tuple[Listed, ...]:
    """The laws of criteria. Raises InputError for a package that cannot be loaded.

    >>> [law.name for law in tl.damage.laws_listed() if "reads the tensile strain at the surface" in law.asks]
    ['mepdg-top-down']
    """
    return tuple(_law(name, package) for name, package in CRITERIA.packages().items())


def listed(name: str) -> Listed:
    """A quantity or a law by its word. Raises InputError for a word that is neither.

    >>> tl.damage.listed("mepdg-top-down").asks
    'reads the tensile strain at the surface; modulus (Pa), thickness (m), air_voids, binder_volume, [calibration]'
    """
    for registry, describe in ((QUANTITIES, _quantity), (CRITERIA, _law)):
        packages = registry.packages()
        if name in packages:
            return describe(name, packages[name])
    raise InputError(f"no quantity and no law {name!r}; {nearest(name, (*QUANTITIES.names(), *CRITERIA.names()))}")


def _quantity(name: str, package: str) -> Listed:
    target = QUANTITIES.find(name).target
    asks_more = any(default is ... for _, default in parameters(target).values())
    # What needs its numbers first tells what all of its kind have.
    kind: Any = made_by(target)[0] if asks_more else target()
    needs = kind.needs if isinstance(kind.needs, tuple) else ()
    fields = " and ".join(words for start, words in _FIELDS if any(need.startswith(start) for need in needs))
    fixed = "; ".join(filter(None, (_numbers(QUANTITIES, name), fields)))
    return Listed(name, _first(target), _unit(kind), fixed, kind.source, kind.calibrated or UNCALIBRATED, "", package)


def _law(name: str, package: str) -> Listed:
    target = CRITERIA.find(name).target
    kinds = [text for text in made_by(target) if inspect.isclass(text)]
    kind: Any = kinds[0] if kinds else target
    reads = getattr(kind, "reads", None)
    has_quantity = isinstance(reads, Quantity)
    reads_text = f"reads the {reads}" if has_quantity else "reads any quantity"
    if has_quantity and "reads" in parameters(target, (OnLayer,)):
        reads_text += ", or another of its kind"
    arguments = "; ".join(filter(None, (reads_text, _numbers(CRITERIA, name))))
    source, ends = (_text(kind, key) for key in ("source", "end_of_life"))
    unit = _unit(reads) if isinstance(reads, Quantity) else "any"
    return Listed(name, _first(target), unit, arguments, source, _text(kind, "calibrated") or USERS, ends, package)


def _numbers(registry: Registry, name: str) -> str:
    """Its numbers with their units; those in brackets may be left out."""
    texts = []
    taken = parameters(registry.find(name).target, (OnLayer,))
    for key, (hint, default) in taken.items():
        if key in ("reads", "caveat"):
            continue
        units = [mark.si for mark in _marks(hint) if isinstance(mark, Unit)]
        text = f"{key} ({units[0]})" if units and units[0] else key
        texts.append(text if default is ... else f"[{text}]")
    return ", ".join(texts)


def _marks(hint: object) -> list[Array]:
    """All that stands in an annotation, at any depth."""
    return [mark for member in get_args(hint) for mark in (member, *_marks(member))]


def _first(target: object) -> str:
    """The line of purpose of a class or a function."""
    return (inspect.getdoc(target) or "").split("\n")[0].rstrip(".")


def _unit(quantity: Quantity) -> str:
    return str(quantity.shown or ("" if quantity.unit == "1" else quantity.unit))


def _text(kind: object, name: str) -> str:
    """A text that all of a kind have; empty where it is another thing or missing."""
    text = getattr(kind, name, "")
    return text if isinstance(text, str) else ""
