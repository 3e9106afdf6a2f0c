"""The catalogue of tires: parametric treads and meshes, each a data file in `catalogue/data/tires`.

Another package adds its own by an entry point of the group `treadload.tires`: a function without arguments that
returns TreadProfile and TireMesh, for one `lambda: read_tires(path)` of a file like ours.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from pathlib import Path

from treadload.describing import as_call
from treadload.errors import InputError
from treadload.named import Catalogue, read_tables, sentence
from treadload.tire.tread import TreadProfile


@dataclass(frozen=True)
class TireMesh:
    """A mesh of a tire in a file; `Tire.from_scan` takes it like a path.

    name: in the catalogue. path: of the file. title: in words. source: where it is from. caveats: what is not certain
    about it, a sentence each. ribs: that its circumferential grooves leave; 0 for none.

    >>> mesh = tl.catalogue.tires["335/65R22.5"]
    >>> f"{mesh.ribs} ribs, from a file {mesh.path.suffix}"
    '4 ribs, from a file .obj'
    """

    name: str
    path: Path
    title: str = ""
    source: str = field(default="", repr=False)
    caveats: tuple[str, ...] = field(default=(), repr=False)
    ribs: int = field(default=0, repr=False)

    def __fspath__(self) -> str:
        return str(self.path)

    def __str__(self) -> str:
        return f"{self.title or 'mesh'}, {self.path.name}"

    __repr__ = as_call


CataloguedTire = TreadProfile | TireMesh
"""What the catalogue of tires holds."""


def read_tires(path: str | os.PathLike[str]) -> list[CataloguedTire]:
    """The tire of a TOML file, in a list; see `catalogue/data/tires`. Raises InputError that names file and key.

    A mesh has the keys name, mesh (its file, from the folder of the TOML file), title, source, caveats and ribs; a
    parametric tread those of TreadProfile.

    >>> from pathlib import Path
    >>> folder = Path(tl.catalogue.__file__).parent / "data"
    >>> (tire,) = tl.catalogue.read_tires(folder / "tires" / "385_65R22.5.toml")
    >>> f"{tire.name}: {tire.width * 1e3:.0f} mm wide with {len(tire.grooves)} grooves"
    '385/65R22.5: 300 mm wide with 4 grooves'
    """
    # pydantic is loaded when a file is read, not before.
    from treadload.read import read

    file = Path(path)
    tables = read_tables(file)
    if "mesh" not in tables:
        return [TreadProfile.from_toml(file)]
    mesh_table: _Mesh = read(_Mesh, tables, str(file), folder=file.parent)
    if not mesh_table.mesh.is_file():
        raise InputError(
            f"{file}: no mesh file {str(mesh_table.mesh)!r}; give its path from the folder of the TOML file"
        )
    return [
        TireMesh(
            mesh_table.name,
            mesh_table.mesh,
            mesh_table.title,
            sentence(mesh_table.source),
            tuple(map(sentence, mesh_table.caveats)),
            mesh_table.ribs,
        )
    ]


@dataclass(frozen=True)
class _Mesh:
    """A mesh of a file."""

    name: str
    mesh: Path
    title: str
    source: str
    caveats: tuple[str, ...] = ()
    ribs: int = 0


def example_mesh() -> Path:
    """Path of the truck tire mesh that ships with treadload (335/65R22.5, metres, BSD-3-Clause licence beside it).

    >>> tl.example_mesh().exists()
    True
    """
    mesh = tires[EXAMPLE]
    assert isinstance(mesh, TireMesh)
    return mesh.path


def tread_named(name: str) -> TreadProfile:
    """The parametric tread of this name in the catalogue. Raises InputError, also where the name is a mesh's."""
    tire = tires[name]
    if isinstance(tire, TireMesh):
        raise InputError(
            f"{tire.name!r} is a mesh, not a parametric tread; use Tire.from_scan(catalogue.tires[{tire.name!r}])"
        )
    return tire


def in_a_line(tire: CataloguedTire) -> str:
    """A tire in words, with its ribs where circumferential grooves leave them."""
    ribs = f'; {tire.ribs} ribs between circumferential grooves, for tread = "ribs"' if tire.ribs else ""
    return f"{tire}{ribs}"


EXAMPLE = "335/65R22.5"

tires: Catalogue[CataloguedTire] = Catalogue(
    "tire",
    (TreadProfile, TireMesh),
    folder="tires",
    read=read_tires,
    words=in_a_line,
    group="treadload.tires",
    use='profile = "315/80R22.5" in [tire] of a case for a tread, scan = "example" for the mesh',
)
"""Treads, for `Tire.from_profile`, and meshes, for `Tire.from_scan`."""
