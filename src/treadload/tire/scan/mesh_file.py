"""Triangles of a mesh file, checked and cleaned."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from treadload.errors import GeometryError, InputError, TreadloadError, error_line, how_to_install, reading
from treadload.kernels.arrays import Array
from treadload.registry import OURS, READERS, Entry
from treadload.tire.scan.cloud import mesh_of_points

Triangles = tuple[Array, NDArray[np.int64]]
FEWEST_FACES = 100
SMALLEST, LARGEST = 1e-9, 1e12  # size of a scan in its own unit
HORIZON = 1e4  # over the size of the scan: no point is taken to lie further off


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles in the unit of their file.

    vertices: (n, 3). faces: (m, 3) indices. watertight: every edge has two faces. dropped: degenerate faces left out.
    """

    vertices: Array
    faces: NDArray[np.int64]
    watertight: bool
    dropped: int


def import_trimesh() -> ModuleType:
    """The trimesh package, or InputError that states how to install it."""
    try:
        import trimesh
    except ImportError as error:
        raise InputError(f"reading a scan needs trimesh, which is not installed; {how_to_install('scan')}") from error
    module: ModuleType = trimesh
    return module


def read_mesh(path: str | Path) -> Mesh:
    """Mesh of a file, vertices merged and degenerate faces dropped; through points without triangles one is laid.

    path: OBJ, PLY, STL, GLB or OFF, a cloud as PLY, text, LAS, LAZ or E57, or a format that
    another package reads, see `treadload.registry.READERS`.
    Raises InputError for a missing, unknown or unreadable file, GeometryError for one without usable triangles.
    """
    path = Path(path)
    if not os.path.isfile(path):
        raise InputError(f"no scan file {str(path)!r}; give the path of an OBJ, PLY, STL, GLB or OFF mesh")
    suffix = path.suffix.lower()
    if suffix[1:] not in READERS.names():
        raise InputError(
            f"scan file {path.name!r} has the unknown ending {suffix!r}; "
            f"export the mesh as one of {', '.join(f'.{name}' for name in READERS.names())}"
        )
    if path.stat().st_size == 0:
        raise InputError(f"scan file {path.name!r} is empty (0 bytes); export or copy it again")
    vertices, faces = _read(READERS.find(suffix[1:]), path)
    if vertices.ndim == 2 and len(vertices) and not faces.size:
        faces = faces.reshape(0, 3)
    if not len(vertices):
        raise GeometryError(f"scan file {path.name!r} has no points and no triangles; export it again")
    if vertices.shape[1:] != (3,) or faces.shape[1:] != (3,):
        raise InputError(
            f"scan file {path.name!r} has {vertices.shape[-1]} numbers per vertex and {faces.shape[-1]} vertices "
            "per triangle where 3 and 3 are needed; it may be truncated, export or copy it again"
        )
    bad = int((~np.isfinite(vertices)).any(axis=1).sum())
    if bad:
        raise GeometryError(
            f"scan file {path.name!r} has {bad} of {len(vertices)} vertices that are NaN or infinite; "
            "remove them in the scanning software"
        )
    if len(faces) == 0:
        vertices, faces = mesh_of_points(_of_possible_size(vertices, path), path.name)
        if len(faces) == 0:
            raise GeometryError(f"the points of {path.name!r} lie too far apart to make a surface; scan it denser")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise InputError(
            f"scan file {path.name!r} has faces that name vertex {int(faces.max()) + 1} of {len(vertices)}; "
            "it may be truncated, export or copy it again"
        )
    return _clean(import_trimesh(), path, vertices, faces)


def _read(reader: Entry, path: Path) -> Triangles:
    """Vertices (n, 3) and faces (m, 3) as a reader gives them; what another package does wrong is reported."""
    if reader.package == OURS:
        triangles: Triangles = reader.target(path)
        return triangles
    failure = f"scan file {path.name!r} could not be read by the reader {reader.name!r} of {reader.package}"
    try:
        points, corners = reader.target(path)
        vertices, faces = np.array(points, dtype=np.float64), np.array(corners)
    except TreadloadError:
        raise
    except Exception as error:
        raise InputError(f"{failure}: {error_line(error)}; the file or that package is broken") from error
    whole = faces.dtype.kind in "iu" or not faces.size
    if vertices.ndim != 2 or vertices.shape[1] != 3 or (faces.size and faces.shape[1:] != (3,)) or not whole:
        raise InputError(
            f"{failure}: it must return vertices (n, 3) and faces (m, 3) of whole numbers, got {vertices.shape} and "
            f"{faces.shape} of {faces.dtype}; repair that package"
        )
    return vertices, faces.astype(np.int64)


@READERS.register("obj", "ply", "stl", "glb", "off")
def _of_trimesh(path: Path) -> Triangles:
    """Vertices (n, 3) and faces (m, 3) of a mesh file, in its own unit."""
    trimesh = import_trimesh()
    with reading(f"scan file {path.name!r}", path.suffix[1:].upper()):
        loaded = trimesh.load_scene(path, process=False, skip_materials=True).to_mesh()
        if len(loaded.faces):
            return np.array(loaded.vertices, dtype=np.float64), np.array(loaded.faces, dtype=np.int64)
    points = _points_of(trimesh, path)
    return (np.zeros((0, 3)) if points is None else points), np.zeros((0, 3), dtype=np.int64)


def _clean(trimesh: ModuleType, path: Path, vertices: Array, faces: NDArray[np.int64]) -> Mesh:
    # A few points may lie absurdly far away: the size is that of nine tenths, and they end on its horizon.
    used = vertices[_named(faces, len(vertices))]
    middle = np.median(used, axis=0)
    with np.errstate(over="ignore", invalid="ignore"):
        away = np.abs(used - middle).max(axis=1)
        size = 2 * float(np.quantile(away, 0.9)) or float(away.max())
        if not SMALLEST < size < LARGEST:
            raise GeometryError(
                f"all {len(vertices)} vertices of {path.name!r} are one point; it holds no surface"
                if size == 0
                else f"{path.name!r} is {size:.3g} wide, which is no tire in any unit; export it again"
            )
        scaled = np.clip(
            np.nan_to_num((vertices - middle) / size, posinf=HORIZON, neginf=-HORIZON), -HORIZON, HORIZON
        )
    # The merge tolerance of trimesh is absolute, so it gets a mesh of size 1.
    unit = trimesh.Trimesh(scaled, faces, process=False)
    unit.merge_vertices(merge_tex=True, merge_norm=True)
    merged, faces = np.array(unit.vertices, dtype=np.float64), np.array(unit.faces, dtype=np.int64)
    corner = merged[faces]
    area = 0.5 * np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    good = area > 1e-14
    dropped = int((~good).sum())
    faces = faces[good]
    if len(faces) < FEWEST_FACES:
        raise GeometryError(
            f"scan file {path.name!r} has {len(faces)} usable triangles, fewer than the {FEWEST_FACES} that a tire "
            "needs; is it the right file?"
        )
    whole, faces = renumbered(faces, len(merged))
    merged = merged[whole]
    near = merged[np.abs(merged).max(axis=1) <= 2]
    if len(near) < 4 or np.linalg.svd(near - near.mean(axis=0), compute_uv=False)[2] < 0.5e-3 * np.sqrt(len(near)):
        raise GeometryError(
            f"the {len(merged)} points of {path.name!r} lie on a plane; a tire needs three dimensions"
        )
    a, b = faces.ravel(), faces[:, [1, 2, 0]].ravel()
    first, last = np.minimum(a, b), np.maximum(a, b)
    # Closed: every edge twice and none a third time.
    key = np.sort(first * len(merged) + last)
    closed = len(key) % 2 == 0 and bool((key[::2] == key[1::2]).all() and (key[1:-1:2] != key[2::2]).all())
    return Mesh(merged * size + middle, faces, closed, dropped)


def _named(faces: NDArray[np.int64], count: int) -> NDArray[np.int64]:
    """Indices of the vertices that faces name, each once."""
    seen = np.zeros(count, dtype=bool)
    seen[faces.ravel()] = True
    return np.flatnonzero(seen)


def renumbered(faces: NDArray[np.int64], count: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Indices of the vertices that faces (m, 3) name, of `count`, and the faces over these alone."""
    used = _named(faces, count)
    place = np.zeros(count, dtype=np.int64)
    place[used] = np.arange(len(used))
    return used, place[faces]


def _points_of(trimesh: ModuleType, path: Path) -> Array | None:
    """(n, 3) points of a file that holds no faces; None where it holds any, or cannot be read."""
    try:
        parts = list(trimesh.load_scene(path, process=False, skip_materials=True).geometry.values())
        if not parts or any(hasattr(part, "faces") for part in parts):
            return None
        return np.concatenate([np.array(part.vertices, dtype=np.float64).reshape(-1, 3) for part in parts])
    except Exception:
        return None


def _of_possible_size(points: Array, path: Path) -> Array:
    """Points without those absurdly far off; raises GeometryError for one place only, or no place a tire can be."""
    middle = np.median(points, axis=0)
    with np.errstate(over="ignore", invalid="ignore"):
        away = np.abs(points - middle).max(axis=1)
        size = 2 * float(np.quantile(away, 0.9))
    if not SMALLEST < size < LARGEST:
        raise GeometryError(
            f"the {len(points)} points of {path.name!r} are {size:.3g} wide, no tire in any unit; export it again"
        )
    kept: Array = points[away < 4 * size]
    return kept
