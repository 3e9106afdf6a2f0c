"""Contact stresses as loads of finite elements, for Abaqus and CalculiX: pressure and both shears.

Sources of the keywords: CalculiX CrunchiX USER'S MANUAL 2.20, *CLOAD, *DLOAD, *NODE, *ELEMENT, element type C3D8
(face 1 is 1-2-3-4), which are those of Abaqus.
"""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import Literal

import numpy as np

from treadload.composing import Source, dataset_of
from treadload.errors import InputError
from treadload.files import check_suffix, write_all
from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.results.tractions import UNITS, cell_size, stresses_on_cells

ELEMENTS = {".inp": "loads of finite elements for Abaqus and CalculiX"}
"""Suffixes of loads of finite elements."""

SURFACE, BOTTOM, PATCH = "TREADLOAD_SURFACE", "TREADLOAD_BOTTOM", "TREADLOAD_PATCH"
"""Sets in the file of the mesh: nodes on the road's surface, nodes below them, and elements."""

_DIGITS = "%.9e"


def write_elements(
    contact: Source,
    path: str | os.PathLike[str],
    *,
    units: str = "mm",
    pressure: Literal["faces", "nodes"] = "faces",
    first: int = 1,
) -> tuple[Path, Path]:
    """Write a layer of C3D8 elements under the loaded cells, and their loads as a file of its own beside it.

    contact: a contact or a footprint on even cells, with pressure (y, x), Pa; traction_x, traction_y, Pa, zero where
    they are missing. path: of the mesh, such as print.inp; the loads go into print_loads.inp. The mesh is included
    among the data of a model, the loads within a step; tie the nodes of TREADLOAD_BOTTOM to the road. units: "mm"
    (mm, MPa, N) or "SI" (m, Pa, N). pressure: as *DLOAD on the faces of the elements, or with the shears as *CLOAD on
    their nodes. first: number of the first node and of the first element, so that they fit into a model.

    Axes are those of the results: x along travel, y to the right, z down into the road; a pressure acts along +z, and
    shear is that which the tire exerts on the road. A quarter of the force of a cell goes to each of its nodes, which
    is what a uniform stress on a bilinear face gives; the sums over the nodes are the forces of the contact. Returns
    both paths. Raises InputError for unknown units, a contact without pressure or load, and uneven cells.

    >>> patch = tl.response.GridLoad.from_arrays([[400e3, 800e3, 400e3]] * 2, spacing=0.05)
    >>> mesh, loads = tl.results.write_elements(tl.Footprint(patch), "print.inp")
    >>> mesh.name, loads.name
    ('print.inp', 'print_loads.inp')
    """
    path = Path(path)
    check_suffix(path, ELEMENTS, "loads of finite elements")
    if units not in UNITS or pressure not in ("faces", "nodes"):
        raise InputError(f'units are "SI" or "mm" and pressure "faces" or "nodes", got {units!r} and {pressure!r}')
    if isinstance(first, bool) or not isinstance(first, int) or not 1 <= first <= 10**8:
        raise InputError(f"the first number of nodes and elements must be 1 to 100000000, got {first!r}")
    data = dataset_of(contact)
    p, qx, qy = stresses_on_cells(data, path)
    x, y = (data[name].to_numpy().astype(float) for name in ("x", "y"))
    dx, dy = cell_size(x, "x"), cell_size(y, "y")
    loaded = (p != 0) | (qx != 0) | (qy != 0)
    if not loaded.any():
        raise InputError(f"cannot write {path}: no cell of this contact has a load")
    length, per_m, stress, per_pa = UNITS[units]
    numbers, corners = _numbered(loaded)
    xy = np.stack(np.meshgrid(_edges(x, dx), _edges(y, dy)), axis=-1)[numbers > 0]
    forces = np.zeros((len(xy), 3))
    for component, plane in enumerate((qx, qy, p)):
        np.add.at(forces[:, component], corners.ravel() - 1, np.repeat(0.25 * dx * dy * plane[loaded], 4))
    thickness = min(dx, dy)
    about = [
        f"contact stresses on the road, written by treadload; {length}, N, {stress}",
        "x along travel, y to the right, z down into the road; forces that the tire exerts on the road",
        f"sum of the forces, N: x {forces[:, 0].sum():.9g}, y {forces[:, 1].sum():.9g}, z {forces[:, 2].sum():.9g}",
    ]
    mesh = _mesh(about, per_m * xy, per_m * thickness, corners, first)
    loads = _loads(about, forces, per_pa * p[loaded], first, faces=pressure == "faces")
    beside = path.with_name(f"{path.stem}_loads{path.suffix}")
    write_all([(path, mesh), (beside, loads)])
    return path, beside


def _numbered(loaded: BoolArray) -> tuple[IntArray, IntArray]:
    """Numbers of nodes (ny + 1, nx + 1) from 1, 0 where no loaded cell is, and corners (n, 4) of the loaded cells."""
    rows, columns = np.nonzero(loaded)
    used = np.zeros(np.add(loaded.shape, 1), dtype=bool)
    ring = ((0, 0), (0, 1), (1, 1), (1, 0))
    for down, right in ring:
        used[rows + down, columns + right] = True
    numbers = np.where(used, np.cumsum(used).reshape(used.shape), 0)
    return numbers, np.stack([numbers[rows + down, columns + right] for down, right in ring], axis=-1)


def _mesh(about: list[str], xy: Array, thickness: float, corners: IntArray, first: int) -> str:
    """Nodes on the surface and below, elements between them, and their sets."""
    count, stream = len(xy), _begun(about)
    for name, z, shift in ((SURFACE, 0.0, 0), (BOTTOM, thickness, count)):
        stream.write(f"*NODE, NSET={name}\n")
        nodes = np.column_stack([np.arange(count) + first + shift, xy, np.full(count, z)])
        np.savetxt(stream, nodes, fmt=["%d", _DIGITS, _DIGITS, _DIGITS], delimiter=", ")
    stream.write(f"*ELEMENT, TYPE=C3D8, ELSET={PATCH}\n")
    upper = corners + first - 1
    elements = np.column_stack([np.arange(len(corners)) + first, upper, upper + count])
    np.savetxt(stream, elements, fmt="%d", delimiter=", ")
    return stream.getvalue()


def _loads(about: list[str], forces: Array, pressure: Array, first: int, *, faces: bool) -> str:
    """Loads of nodes (n, 3), N, and, on faces, the pressure of elements (m,)."""
    stream = _begun(about)
    if faces:
        stream.write("** pressure on face 1 of each element, the road's surface\n*DLOAD\n")
        for number, value in enumerate(pressure, start=first):
            if value:
                stream.write(f"{number}, P1, {value:.9e}\n")
    stream.write(f"** {'shear' if faces else 'pressure and shear'} as forces on nodes\n*CLOAD\n")
    for number, node in enumerate(forces, start=first):
        for component, value in enumerate(node[: 2 if faces else 3], start=1):
            if value:
                stream.write(f"{number}, {component}, {value:.9e}\n")
    return stream.getvalue()


def _begun(about: list[str]) -> io.StringIO:
    stream = io.StringIO()
    stream.writelines(f"** {line}\n" for line in about)
    return stream


def _edges(centres: Array, step: float) -> Array:
    """Edges (n + 1,) of even cells."""
    edges: Array = centres[0] + step * (np.arange(len(centres) + 1) - 0.5)
    return edges
