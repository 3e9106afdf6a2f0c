"""Viscoelastic materials of papers, by name, with their sources.

Another package adds its own by an entry point of the group `treadload.viscoelastic`: a function without arguments
that returns an iterable of PublishedMaterial, for one `lambda: read_published(path)` of a file like ours.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Annotated, Any

from treadload.catalogue.named import Catalogue, data, read_tables
from treadload.materials.kinds import TemperatureDependent, Viscoelastic
from treadload.registry import MATERIALS
from treadload.units import Celsius


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
    """Materials of a TOML file, a table each, as in a case: kind, numbers, shift; see `catalogue/data/viscoelastic`.

    temperature: at which the numbers hold. source: the paper. Raises InputError that names file and key.
    """
    # pydantic is loaded when a file is read, not before.
    from treadload.materials.tables import shift_of, shifted
    from treadload.read import Choice, read

    def publish(material: Any, table: Any, folder: Path) -> PublishedMaterial:
        source = " ".join((table.source or "").split())
        made: Any = shifted(material, table, folder)
        return PublishedMaterial("", made, table.temperature, source)

    more = {"temperature": Celsius, "source": str}
    kinds = Choice(MATERIALS, more=lambda target: {**shift_of(target), **more}, finish=publish)
    file = Path(path)
    found = read(dict[str, Annotated[Any, kinds]], read_tables(file), str(file))
    return [replace(one, name=name) for name, one in found.items()]


@cache
def _own() -> tuple[PublishedMaterial, ...]:
    return tuple(item for file in data("viscoelastic") for item in read_published(file))


def _catalogue() -> Catalogue[PublishedMaterial]:
    return Catalogue("material", (PublishedMaterial,), _own, "treadload.viscoelastic")
