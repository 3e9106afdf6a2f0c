"""The catalogue of structures: one data file per source in `catalogue/data/structures`, and those of other packages.

Another package adds its own by an entry point of the group `treadload.structures`: a function without arguments
that returns Structures, for one `lambda: read_structures(path)` of a file like ours.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from treadload.describing import as_call
from treadload.errors import InputError
from treadload.materials.library import mixes
from treadload.materials.mixture import Mix
from treadload.named import Catalogue, read_tables, sentence
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
    caveats: what is not certain about it, a sentence each.

    >>> road = tl.catalogue.structures["6 BBSG3 / 15 GB3 / PF3"]
    >>> [layer.name for layer in road.layers()]
    ['EB-BBSG3', 'EB-GB3', 'PF3']
    """

    name: str
    title: str
    courses: tuple[Course, ...]
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)

    def layers(self, *, frequency: float | None = None) -> list[Layer]:
        """The layers of the road, see `Pavement.from_catalogue`; bituminous ones wait for their temperature.

        frequency: of loading, Hz, at which they are read; left out, that of their data. Raises InputError for an
        unknown mix.
        """
        layers = []
        for course in self.courses:
            material = mixes[course.mix]
            if frequency is not None and isinstance(material, Mix):
                material = material.with_frequency(frequency)
            layers.append(Layer(material, course.thickness, name=course.mix, bond=course.bond))
        return layers

    def __str__(self) -> str:
        return f"{self.name} ({self.title})"

    __repr__ = as_call


def find_structure(name: str) -> Structure:
    """A catalogued structure by name, or one written out as layers, see `pavement.notation`.

    Raises InputError that names the nearest known one, and states what is wrong with the layers.
    """
    try:
        return structures[name]
    except InputError as unknown:
        if not isinstance(name, str):
            raise
        if "/" not in name:
            raise InputError(f'{unknown}; or write its layers, "{notation.EXAMPLE}"') from unknown
        try:
            layers = notation.read_layers(name)
        except InputError as error:
            raise InputError(f"{unknown}; as layers it cannot be read: {error}") from error
    interfaces = notation.bonds([material for material, _ in layers])
    courses = tuple(Course(course.name, deep, bond) for (course, deep), bond in zip(layers, interfaces, strict=True))
    return Structure(notation.in_words(layers), "layers as written", courses)


def read_structures(path: str | os.PathLike[str]) -> list[Structure]:
    """Structures of a TOML file; see `catalogue/data/structures`. Raises InputError that names file and key.

    >>> from pathlib import Path
    >>> folder = Path(tl.catalogue.__file__).parent / "data"
    >>> structures = tl.catalogue.read_structures(folder / "structures" / "nf_p98_086.toml")
    >>> f"{len(structures)} structures, the first is {structures[0].name}"
    '6 structures, the first is 6 BBSG3 / 15 GB3 / PF3'
    """
    # pydantic is loaded when a file is read, not before.
    from treadload.read import read

    tables: _File = read(_File, read_tables(Path(path)), str(Path(path)))
    return [
        Structure(
            structure.name,
            structure.title,
            structure.layers,
            sentence(structure.source),
            tuple(map(sentence, structure.caveats)),
        )
        for structure in tables.structures
    ]


@dataclass(frozen=True)
class _Row:
    """A structure of a file."""

    name: str
    title: str
    source: str
    layers: tuple[Course, ...]
    caveats: tuple[str, ...] = ()


@dataclass(frozen=True)
class _File:
    """A file of structures."""

    structures: tuple[_Row, ...]


def _words(structure: Structure) -> str:
    layers = ", ".join(
        course.mix if course.thickness is None else f"{course.thickness * 1e3:g} mm {course.mix}"
        for course in structure.courses
    )
    return f"{structure.title}: {layers}"


structures: Catalogue[Structure] = Catalogue(
    "structure",
    (Structure,),
    folder="structures",
    read=read_structures,
    words=_words,
    group="treadload.structures",
    use='structure = "6 BBSG3 / 15 GB3 / PF3" in [pavement] of a case, or any layers written so',
)
"""Roads by the names of their layers; `Pavement.from_catalogue` builds them."""
