"""Viscoelastic materials of papers, by name, with their sources.

Another package adds its own by an entry point of the group `treadload.viscoelastic`: a function without arguments
that returns an iterable of PublishedMaterial, for one `lambda: read_published(path)` of a file like ours.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any

from treadload.catalogue.named import Catalogue, data, only, read_tables
from treadload.errors import InputError
from treadload.materials.huet_sayegh import HuetSayegh, Model2S2P1D
from treadload.materials.kinds import TemperatureDependent, Viscoelastic
from treadload.materials.power_law import PowerLawCreep
from treadload.materials.temperature import QuadraticShift, Thermorheological
from treadload.materials.viscoelastic import Prony
from treadload.registry import MATERIALS


@dataclass(frozen=True)
class PublishedMaterial:
    """A viscoelastic material of a paper.

    name: in the catalogue. material: Viscoelastic, or TemperatureDependent where the paper says how times shift.
    temperature: at which it holds, °C; None where it depends on temperature, or is not said. source: the paper.
    """

    name: str
    material: Viscoelastic | TemperatureDependent
    temperature: float | None = None
    source: str = field(default="", repr=False)

    def __str__(self) -> str:
        at = "" if self.temperature is None else f" at {self.temperature:g} °C"
        return f"{self.name}{at}: {self.material}"


def published_material(name: str) -> PublishedMaterial:
    """A viscoelastic material by its name, e.g. "ViscoRoute", "ELLVA1", "SBS-AC13".

    Raises InputError that names the nearest known one.
    """
    return _catalogue().find(name)


@MATERIALS.register("published")
def _of_a_case(name: str) -> Viscoelastic | TemperatureDependent:
    """A viscoelastic material of a paper.

    name: in the catalogue, see `treadload catalogue`.
    """
    return published_material(name).material


def published_materials() -> dict[str, PublishedMaterial]:
    """All of them by name: ours, and those that other packages bring along by `treadload.viscoelastic`."""
    return _catalogue().all()


def read_published(path: str | os.PathLike[str]) -> list[PublishedMaterial]:
    """Materials of a TOML file, a table each: law, its numbers, source; see `catalogue/data/viscoelastic`.

    law: HuetSayegh or Model2S2P1D with tau (s), or log_tau (A₀, A₁, A₂ of ln τ over °C); PowerLawCreep; Prony with
    shares and times (s). temperature: °C, at which the numbers hold. Raises InputError that names file and table.
    """
    file = Path(path)
    return [_material(name, table, f"{file}, {name}") for name, table in read_tables(file).items()]


_FRACTIONAL = ("glassy_modulus", "static_modulus", "delta", "k", "h")
_KEYS = {
    "HuetSayegh": (*_FRACTIONAL, "tau", "log_tau"),
    "Model2S2P1D": (*_FRACTIONAL, "beta", "tau", "log_tau"),
    "PowerLawCreep": ("instantaneous_compliance", "long_term_compliance", "tau", "exponent"),
    "Prony": ("modulus", "shares", "times"),
}


def _material(name: str, table: dict[str, Any], place: str) -> PublishedMaterial:
    law = table.get("law")
    if law not in _KEYS:
        raise InputError(f"{place}: law must be one of {', '.join(_KEYS)}, got {law!r}")
    own = dict(only(table, (*_KEYS[law], "law", "poisson", "temperature", "source"), place))
    del own["law"]
    source, temperature = " ".join(str(own.pop("source", "")).split()), own.pop("temperature", None)
    try:
        return PublishedMaterial(name, _built(law, own), temperature, source)
    except KeyError as error:
        raise InputError(f"{place}: key {error.args[0]!r} is missing") from error
    except (InputError, TypeError, ValueError) as error:
        raise InputError(f"{place}: {error}") from error


def _built(law: str, own: dict[str, Any]) -> Viscoelastic | TemperatureDependent:
    if law == "Prony":
        terms = tuple(zip(own["shares"], own["times"], strict=True))
        return Prony(own["modulus"], terms, own["poisson"])
    if law == "PowerLawCreep":
        return PowerLawCreep(**own)
    coefficients = own.pop("log_tau", None)
    build = HuetSayegh if law == "HuetSayegh" else Model2S2P1D
    if coefficients is None:
        return build(**own)
    a0, a1, a2 = coefficients
    return Thermorheological(build(tau=math.exp(a0), **own), QuadraticShift(a1, a2))


@cache
def _own() -> tuple[PublishedMaterial, ...]:
    return tuple(item for file in data("viscoelastic") for item in read_published(file))


def _catalogue() -> Catalogue[PublishedMaterial]:
    return Catalogue("material", (PublishedMaterial,), _own, "treadload.viscoelastic")
