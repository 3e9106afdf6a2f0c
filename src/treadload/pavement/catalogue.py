"""The catalogue of structures: one data file a source in `catalogue/data/structures`, and those of other packages.

Another package adds its own by an entry point of the group `treadload.structures`: a function without arguments
that returns Structures, for one `lambda: read_structures(path)` of a file like ours.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from treadload.catalogue.named import Catalogue, data, only, read_tables
from treadload.errors import InputError
from treadload.materials.library import mix
from treadload.materials.mixture import Mix
from treadload.pavement import notation
from treadload.pavement.bonds import BONDED, Bond, BondLaw
from treadload.pavement.layer import Layer
from treadload.registry import BONDS


@dataclass(frozen=True)
class Course:
    """A layer of a catalogued structure: the name of its mix, thickness, m, and bond to the layer below."""

    mix: str
    thickness: float | None = None
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
    file = Path(path)
    tables = only(read_tables(file), ("structures",), str(file))
    try:
        return [_structure(table, file) for table in tables["structures"]]
    except KeyError as error:
        raise InputError(f"{file}: key {error.args[0]!r} is missing") from error
    except InputError:
        raise
    except (TypeError, ValueError, AttributeError) as error:
        raise InputError(
            f"{file}: {error}; take the files of treadload/catalogue/data/structures as a pattern"
        ) from error


@cache
def _own() -> tuple[Structure, ...]:
    return tuple(item for file in data("structures") for item in read_structures(file))


def _catalogue() -> Catalogue[Structure]:
    return Catalogue("structure", (Structure,), _own, "treadload.structures")


def _structure(table: dict[str, Any], file: Path) -> Structure:
    place = f"{file}, {table['name']}"
    only(table, ("name", "title", "source", "layers"), place)
    layers: Sequence[dict[str, Any]] = [only(layer, ("mix", "thickness", "bond"), place) for layer in table["layers"]]
    courses = tuple(
        Course(layer["mix"], layer.get("thickness"), _bond(layer.get("bond", "bonded"), place)) for layer in layers
    )
    return Structure(table["name"], table["title"], courses, " ".join(str(table["source"]).split()))


def _bond(value: str | float, place: str) -> BondLaw:
    if not isinstance(value, str):
        return Bond(float(value))
    words = [name for name in BONDS.names() if name != BONDS.default]
    if value not in words:
        raise InputError(f"{place}: bond must be {', '.join(words)} or a stiffness in Pa/m, got {value!r}")
    bond: BondLaw = BONDS.find(value).target()
    return bond
