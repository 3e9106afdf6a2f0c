"""Published viscoelastic materials, by name, with their sources.

Another package adds its own by an entry point of the group `treadload.viscoelastic`: a function without arguments
that returns an iterable of PublishedMaterial, for one `lambda: read_materials(path)` of a file like ours.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, cast

from treadload.materials.kinds import Material, TemperatureDependent, Viscoelastic
from treadload.named import Catalogue, read_tables, sentence
from treadload.registry import MATERIALS
from treadload.units import Celsius

if TYPE_CHECKING:
    from treadload.read import TargetTable


@dataclass(frozen=True)
class PublishedMaterial:
    """A viscoelastic material of a paper.

    name: in the catalogue. material: Viscoelastic, or TemperatureDependent where the paper states how times shift.
    temperature: at which it holds, °C; None where it depends on temperature, or is not stated. source: the paper.
    caveats: what is not certain about it, a sentence each.

    >>> mix = tl.catalogue.materials["ViscoRoute"].material
    >>> [round(abs(complex(mix.at(t).complex_modulus(62.8))) / 1e9, 1) for t in (0, 15, 30)]  # |E*|, GPa, at 10 Hz
    [23.7, 11.4, 2.8]
    """

    name: str
    material: Viscoelastic | TemperatureDependent
    temperature: float | None = None
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)

    def __str__(self) -> str:
        at = "" if self.temperature is None else f" at {self.temperature:g} °C"
        return f"{self.name}{at}: {self.material}"


@MATERIALS.register("published")
def _of_a_case(name: str) -> Viscoelastic | TemperatureDependent:
    """A viscoelastic material of a paper.

    name: in the catalogue, see `treadload catalogue`.
    """
    return published[name].material


def read_materials(path: str | os.PathLike[str]) -> list[PublishedMaterial]:
    """Materials of a TOML file, a table each, as in a case: kind, numbers, shift; see `catalogue/data/viscoelastic`.

    temperature: at which the numbers hold. source: the paper. caveats: sentences.
    Raises InputError that names file and key.

    >>> from pathlib import Path
    >>> folder = Path(tl.catalogue.__file__).parent / "data"
    >>> materials = tl.catalogue.read_materials(folder / "viscoelastic" / "published.toml")
    >>> materials[0].name
    'ViscoRoute'
    """
    # pydantic is loaded when a file is read, not before.
    from treadload.materials.tables import shift_of, shifted
    from treadload.read import Choice, read

    def publish(material: Material, table: TargetTable, folder: Path) -> PublishedMaterial:
        law = cast("Viscoelastic | TemperatureDependent", shifted(material, table, folder))
        caveats = tuple(map(sentence, getattr(table, "caveats", None) or ()))
        return PublishedMaterial(
            "", law, getattr(table, "temperature", None), sentence(getattr(table, "source", None) or ""), caveats
        )

    more = {"temperature": Celsius, "source": str, "caveats": tuple[str, ...]}
    kinds = Choice(MATERIALS, more=lambda target: {**shift_of(target), **more}, finish=publish)
    file = Path(path)
    by_name = read(dict[str, Annotated[Any, kinds]], read_tables(file), str(file))
    return [replace(material, name=name) for name, material in by_name.items()]


def _words(entry: PublishedMaterial) -> str:
    at = "" if entry.temperature is None else f"at {entry.temperature:g} °C: "
    return f"{at}{entry.material}"


published: Catalogue[PublishedMaterial] = Catalogue(
    "viscoelastic material",
    (PublishedMaterial,),
    folder="viscoelastic",
    read=read_materials,
    words=_words,
    group="treadload.viscoelastic",
    use='material = { kind = "published", name = "ViscoRoute" } in a layer of a case',
)
"""Viscoelastic materials of papers."""
