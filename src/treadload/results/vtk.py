"""Contacts and responses as VTK files in XML, which ParaView and other programs draw.

Written in the format that its makers publish ("VTK XML formats", https://docs.vtk.org): numbers packed by zlib, in
base64 within the XML, little-endian, so that nothing else is needed to write or to read them. SI units, tension
positive; x along travel, y to the right, z down, which is right-handed: a viewer that points z up shows the road from
below until its camera is turned.
"""

from __future__ import annotations

import base64
import os
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from treadload.composing import Source, dataset_of
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.files import check_suffix, write_whole
from treadload.kernels.arrays import Array

VTK = {
    ".vts": "VTK, a structured grid: a contact",
    ".vtr": "VTK, a rectilinear grid: a response",
    ".vtu": "VTK, an unstructured grid: either",
}
"""Suffixes of VTK and what they hold."""

# Rows of a 3 x 3 tensor in the order of VTK.
_TENSOR = (("xx", "xy", "xz"), ("xy", "yy", "yz"), ("xz", "yz", "zz"))
_QUAD, _HEXAHEDRON = 9, 12
# Bytes of a block before it is packed.
_BLOCK = 2**20
_VECTORS = ("traction", "slip", "slip_distance", "displacement")


def write_vtk(result: Source, path: str | os.PathLike[str]) -> Path:
    """Write a contact (.vts), a response (.vtr), or either as an unstructured grid (.vtu), for ParaView.

    result: a contact or footprint, whose fields become data of cells, with traction, slip and displacement as
    vectors; or a response on a grid, whose fields become data of points, with stress and strain as tensors of nine
    components in the order XX, XY, XZ, YX, ... that the filter of tensor glyphs takes, directions and displacement as
    vectors.
    Names are those of the datasets, values SI, NaN where nothing is known. Returns the path.
    Raises InputError for a result at a list of points, one without x and y, and a suffix of the other kind.

    >>> road = tl.Pavement.half_space(tl.Elastic(100e6, 0.35))
    >>> plate = tl.UniformDisc(0.15, 700e3)
    >>> response = tl.solve_response(plate, road, depths=[0.1, 0.2], x=[0.0, 0.1], y=[0.0, 0.1])
    >>> tl.results.write_vtk(response, "plate.vtr").name
    'plate.vtr'
    """
    suffix = check_suffix(path, VTK, "VTK")
    data = dataset_of(result)
    if "point" in data.dims or not {"x", "y"} <= set(data.dims):
        raise InputError(f"cannot write {path}: VTK needs a result on a grid of x and y; write .csv for others")
    volume = "depth" in data.dims
    if suffix == {True: ".vts", False: ".vtr"}[volume]:
        what, right = ("a response", ".vtr") if volume else ("a contact", ".vts")
        raise InputError(f"cannot write {path}: {suffix} holds the other kind; write {what} as {right} or .vtu")
    x, y = (data[name].to_numpy().astype(float) for name in ("x", "y"))
    z = data["depth"].to_numpy().astype(float) if volume else np.zeros(1)
    if not volume:
        x, y = _edges(x), _edges(y)
    fields = dict(_fields(data, volume))
    place = "PointData" if volume else "CellData"
    extent = f"0 {len(x) - 1} 0 {len(y) - 1} 0 {len(z) - 1}"
    lines = [f"<{place}{_chosen(fields)}>", *(_array(name, values) for name, values in fields.items()), f"</{place}>"]
    if suffix == ".vtr":
        lines += ["<Coordinates>", *(_array(name, axis) for name, axis in zip("xyz", (x, y, z), strict=True)),
                  "</Coordinates>"]  # fmt: skip
        kind, piece = "RectilinearGrid", f'Extent="{extent}"'
    else:
        points = np.stack([axis.ravel() for axis in np.meshgrid(z, y, x, indexing="ij")[::-1]], axis=-1)
        lines += ["<Points>", _array("points", points), "</Points>"]
        kind, piece = "StructuredGrid", f'Extent="{extent}"'
        if suffix == ".vtu":
            corners, shape = _cells(len(x), len(y), len(z))
            ends = np.arange(1, len(corners) + 1) * corners.shape[1]
            lines += ["<Cells>", _array("connectivity", corners.ravel()), _array("offsets", ends),
                      _array("types", np.full(len(corners), shape, dtype=np.uint8)), "</Cells>"]  # fmt: skip
            kind = "UnstructuredGrid"
            piece = f'NumberOfPoints="{len(points)}" NumberOfCells="{len(corners)}"'
    whole = "" if suffix == ".vtu" else f' WholeExtent="{extent}"'
    head = f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64" '
    head += 'compressor="vtkZLibDataCompressor">'
    text = ['<?xml version="1.0"?>', head, f"<{kind}{whole}>", f"<Piece {piece}>", *lines, "</Piece>", f"</{kind}>"]
    return write_whole(path, "\n".join([*text, "</VTKFile>", ""]))


def _fields(data: xr.Dataset, volume: bool) -> Iterator[tuple[str, Array]]:
    """Name and values (n,) or (n, components), x fastest, of every field on the grid."""
    over = ("depth", "y", "x") if volume else ("y", "x")
    names_of_data = {str(name) for name, variable in data.data_vars.items() if variable.dtype.kind in "fiu"}

    def flat(name: str) -> Array:
        variable = data[name]
        return np.asarray(variable.transpose(*over).to_numpy(), dtype=float).ravel()

    used: set[str] = set()
    for kind in ("stress", "strain"):
        names = {f"{kind}_{part}" for row in _TENSOR for part in row}
        if names <= names_of_data and all(set(data[name].dims) == set(over) for name in names):
            yield kind, np.stack([flat(f"{kind}_{part}") for row in _TENSOR for part in row], axis=-1)
            used |= names
    for vector in _VECTORS:
        parts = [f"{vector}_{axis}" for axis in "xyz"]
        there = [name for name in parts if name in names_of_data and set(data[name].dims) == set(over)]
        if len(there) > 1:
            size = data[there[0]].size
            yield vector, np.stack([flat(name) if name in there else np.zeros(size) for name in parts], axis=-1)
            used |= set(there)
    for name in sorted(names_of_data - used):
        variable = data[name]
        if set(variable.dims) == set(over):
            yield name, flat(name)
        elif set(variable.dims) == {*over, "component"} and variable.sizes["component"] == 3:
            yield name, np.asarray(variable.transpose(*over, "component").to_numpy(), dtype=float).reshape(-1, 3)


def _chosen(fields: dict[str, Array]) -> str:
    """What ParaView shows first: a scalar, a vector and a tensor."""
    complaint = ""
    for word, components in (("Scalars", 1), ("Vectors", 3), ("Tensors", 9)):
        first = [name for name, field in fields.items() if (field.shape[1] if field.ndim > 1 else 1) == components]
        first = sorted(first, key=lambda name: name not in ("pressure", "principal_strain_1", "traction", "stress"))
        complaint += f" {word}={quoteattr(first[0])}" if first else ""
    return complaint


def _cells(nx: int, ny: int, nz: int) -> tuple[Array, int]:
    """Corners (n, 4 or 8) of the cells between points on a grid, x fastest, and their kind."""
    number = np.arange(nx * ny * nz).reshape(nz, ny, nx)
    ring = [(slice(None, -1), slice(None, -1)), (slice(None, -1), slice(1, None)),
            (slice(1, None), slice(1, None)), (slice(1, None), slice(None, -1))]  # fmt: skip
    if nz == 1:
        return np.stack([number[0][corner].ravel() for corner in ring], axis=-1), _QUAD
    upper, lower = number[:-1], number[1:]
    corners = [part[(slice(None), *corner)].ravel() for part in (upper, lower) for corner in ring]
    return np.stack(corners, axis=-1), _HEXAHEDRON


def _array(name: str, values: Any) -> str:
    array = np.asarray(values)
    kind, words = ("<f8", "Float64") if array.dtype.kind == "f" else ("<i8", "Int64")
    if array.dtype == np.uint8:
        kind, words = "u1", "UInt8"
    coded = _packed(np.ascontiguousarray(array, dtype=kind).tobytes())
    components = f' NumberOfComponents="{array.shape[1]}"' if array.ndim > 1 else ""
    return f'<DataArray type="{words}" Name={quoteattr(name)}{components} format="binary">{coded}</DataArray>'


def _packed(raw: bytes) -> str:
    """Bytes in blocks packed by zlib behind 64-bit numbers: blocks, their size, that of the last, packed sizes."""
    blocks = [raw[start : start + _BLOCK] for start in range(0, len(raw), _BLOCK)]
    packed = [zlib.compress(block) for block in blocks]
    # The last block has the size of the others where it is full.
    last = len(raw) % _BLOCK
    head = np.array([len(blocks), _BLOCK, last, *map(len, packed)], dtype="<u8").tobytes()
    return (base64.b64encode(head) + base64.b64encode(b"".join(packed))).decode()


def _edges(centres: Array) -> Array:
    step = float(np.diff(centres).mean()) if len(centres) > 1 else 1e-3
    inner = (centres[1:] + centres[:-1]) / 2
    joined: Array = np.concatenate([[centres[0] - step / 2], inner, [centres[-1] + step / 2]])
    return joined
