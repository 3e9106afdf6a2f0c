"""The catalogue of structures: one data file a source in `catalogue/data/structures`, and those of other packages.

Another package adds its own by an entry point of the group `treadload.structures`: a function without arguments
that returns Structures, for one `lambda: read_structures(path)` of a file like ours.
"""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from treadload.catalogue.named import Catalogue, data, read_tables
from treadload.errors import InputError
from treadload.materials.library import mix
from treadload.materials.mixture import Mix
from treadload.pavement import notation
from treadload.pavement.bonds import BONDED, BondLaw
from treadload.pavement.layer import Layer
from treadload.units import Length


@dataclass(frozen=True)
class Course:
    """A layer of a catalogued structure: the name of its mix, thickness, m, and bond to the layer below."""

    mix: str
    thickness: Length | None = None
    bond: BondLaw = BONDED


@dataclass(frozen=True)
class Structure:
    """A catalogued road: layers by the names of their mixes.

    name: in the catalogue. title: in words. courses: from the surface down. source: where it is from.
    """

    name: str
    title: str
    courses: tuple[Course, ...]
    source: str = ""

    def layers(self, *, frequency: float | None = None) -> list[Layer]:
        """The layers of the road, see `Pavement.from_catalogue`; bituminous ones wait for their temperature.

        frequency: of loading, Hz, at which they are read; left out, that of their data. Raises InputError for an
        unknown mix.
        """
        layers = []
        for course in self.courses:
            material = mix(course.mix)
            if frequency is not None and isinstance(material, Mix):
                material = material.with_frequency(frequency)
            layers.append(Layer(material, course.thickness, name=course.mix, bond=course.bond))
        return layers

    def __str__(self) -> str:
        return f"{self.name} ({self.title})"


def find_structure(name: str) -> Structure:
    """A catalogued structure by name, or one written out as layers, see `pavement.notation`.

    Raises InputError that names the nearest known one, and says what is wrong with the layers.
    """
    try:
        return _catalogue().find(name)
    except InputError as unknown:
        if not isinstance(name, str):
            raise
        if "/" not in name:
            raise InputError(f'{unknown}; or write its layers, "{notation.EXAMPLE}"') from unknown
        try:
            layers = notation.read_layers(name)
        except InputError as error:
            raise InputError(f"{unknown}; as layers it cannot be read: {error}") from error
    held = notation.bonds([material for material, _ in layers])
    courses = tuple(Course(one.name, deep, bond) for (one, deep), bond in zip(layers, held, strict=True))
    return Structure(notation.in_words(layers), "layers as written", courses)


def structures() -> dict[str, Structure]:
    """All catalogued structures by name: ours, and those that other packages bring by `treadload.structures`.

    Raises InputError for an entry point that fails, and for a name that stands twice.
    """
    return _catalogue().all()


def read_structures(path: str | os.PathLike[str]) -> list[Structure]:
    """Structures of a TOML file; see `catalogue/data/structures`. Raises InputError that names file and key."""
    # pydantic is loaded when a file is read, not before.
    from treadload.read import read

    tables: _File = read(_File, read_tables(Path(path)), str(Path(path)))
    return [Structure(one.name, one.title, one.layers, " ".join(one.source.split())) for one in tables.structures]


@dataclass(frozen=True)
class _Row:
    """A structure of a file."""

    name: str
    title: str
    source: str
    layers: tuple[Course, ...]


@dataclass(frozen=True)
class _File:
    """A file of structures."""

    structures: tuple[_Row, ...]


@cache
def _own() -> tuple[Structure, ...]:
    return tuple(item for file in data("structures") for item in read_structures(file))


def _catalogue() -> Catalogue[Structure]:
    return Catalogue("structure", (Structure,), _own, "treadload.structures")
