"""Rays on a tire in the frame of its wheel: from below on to the road grid, and from around on to the axle.

Frame of the wheel, m: origin on the axle amid the tread, x along travel, y along the axle to the right, z down.
"""

from __future__ import annotations

from collections.abc import Callable
from copy import copy
from typing import Any

import numpy as np
from numpy.typing import NDArray

from treadload.errors import InputError, how_to_install
from treadload.kernels.arrays import Array, IntArray
from treadload.tire.scan.mesh_file import import_trimesh


class Caster:
    """First hits of rays on a mesh, by Embree when it is installed, else by trimesh itself."""

    def __init__(self, vertices: Array, faces: NDArray[np.int64]) -> None:
        corner = vertices[faces]
        self._anchor = corner[:, 0]
        self._normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        self._shift = np.zeros(3)
        self._first: Callable[[Array, Array], NDArray[np.integer[Any]]] = _no_hits
        if len(faces):
            self._first = _first_of_embree(vertices, faces) or _first_of_trimesh(vertices, faces)

    def moved(self, shift: Array) -> Caster:
        """The same mesh moved by a shift (3,), m; nothing is built again."""
        caster = copy(self)
        caster._shift = self._shift + shift
        return caster

    def distances(self, origins: Array, directions: Array) -> Array:
        """(n,) distance in m along unit directions (n, 3) from origins (n, 3) to the first hit; NaN for none."""
        origins = origins - self._shift
        if len(self._anchor) == 0:
            return np.full(len(origins), np.nan)
        face = np.asarray(self._first(origins, directions), dtype=np.int64)
        hit = face >= 0
        normal, anchor = self._normal[face], self._anchor[face]
        # Embree works in single precision: it only chooses the face, the distance is worked out again.
        along = np.einsum("ij,ij->i", normal, directions)
        across = np.einsum("ij,ij->i", normal, anchor - origins)
        hit &= np.abs(along) > 1e-9 * np.linalg.norm(normal, axis=1)
        out = np.full(len(origins), np.nan)
        out[hit] = across[hit] / along[hit]
        return out


def _first_of_embree(vertices: Array, faces: NDArray[np.int64]) -> Callable[[Array, Array], IntArray] | None:
    """First faces that rays meet, by Embree itself: trimesh would copy and digest the mesh first. None without it."""
    try:
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene
    except ImportError:
        return None
    middle = vertices.min(axis=0)
    # In single precision: a mesh of a hundred units from its corner.
    unit = 100.0 / max(float(np.linalg.norm(np.ptp(vertices, axis=0))), 1e-300)
    scene = EmbreeScene()
    TriangleMesh(scene, ((vertices - middle) * unit).astype(np.float32), faces.astype(np.int32))

    def first(origins: Array, directions: Array) -> IntArray:
        hits: IntArray = scene.run(((origins - middle) * unit).astype(np.float32), directions.astype(np.float32))
        return hits

    return first


def _first_of_trimesh(vertices: Array, faces: NDArray[np.int64]) -> Callable[[Array, Array], IntArray]:
    ray: Any = import_trimesh().Trimesh(vertices, faces, process=False, validate=False).ray

    def first(origins: Array, directions: Array) -> IntArray:
        try:
            hits: IntArray = ray.intersects_first(origins, directions)
        except ModuleNotFoundError as error:  # trimesh's own caster needs rtree
            raise InputError(
                f"casting rays needs embreex (or, slower, rtree), but {error.name} is not installed; "
                f"{how_to_install('scan')}"
            ) from error
        return hits

    return first


def _no_hits(origins: Array, directions: Array) -> IntArray:
    return np.full(len(origins), -1)


def vertical(caster: Caster, x: Array, y: Array, radius: float, camber: float, floor: float) -> Array:
    """Lowest point of the tread above each point of a grid, cast from below.

    x: (nx,), y: (ny,), m, from below the crown. radius: of the crown, m. camber: rad, positive when the top leans
    to the right. floor: hits nearer to the axle than this are dropped, m. Returns (ny, nx) of z in m, positive
    down from the axle's height; NaN without a hit.
    """
    cos, sin = np.cos(camber), np.sin(camber)
    grid_x, grid_y = np.meshgrid(x, y)
    # The crown's middle stays over y = 0 when the wheel leans.
    road_y = grid_y.ravel() - radius * sin
    start = 1.5 * radius
    origins = np.stack([grid_x.ravel(), road_y * cos + start * sin, start * cos - road_y * sin], axis=1)
    direction = np.array([0.0, -sin, -cos])
    distance = caster.distances(origins, np.broadcast_to(direction, origins.shape))
    hit = origins + distance[:, None] * direction
    # Through a hole a ray meets the inside, or the far side above the axle.
    with np.errstate(invalid="ignore"):
        distance[~(np.hypot(hit[:, 0], hit[:, 2]) >= floor) | (hit[:, 2] < 0)] = np.nan
    return np.asarray((start - distance).reshape(grid_x.shape), dtype=np.float64)


def radial(caster: Caster, theta: Array, y: Array, outer: float, floor: float) -> Array:
    """Unrolled tread: distance of its outermost point from the axle, cast from around.

    theta: (nt,) rad from straight down towards travel. y: (ny,) m. outer: m, beyond every point of the tread.
    floor: hits nearer to the axle are dropped, m. Returns (ny, nt) in m; NaN without a hit.
    """
    angle, place = np.meshgrid(theta, y)
    outward = np.stack([np.sin(angle.ravel()), np.zeros(angle.size), np.cos(angle.ravel())], axis=1)
    origins = outer * outward
    origins[:, 1] = place.ravel()
    radius = outer - caster.distances(origins, -outward)
    with np.errstate(invalid="ignore"):
        radius[~(radius >= floor)] = np.nan
    return np.asarray(radius.reshape(angle.shape), dtype=np.float64)


def revolved(y: Array, radius: Array, reach: float, step: float = np.pi / 360) -> Caster:
    """Caster on a meridian turned about the axle.

    y: (ny,), m. radius: (ny,), m, NaN where unknown. reach: half the angle of the sector about straight down, rad.
    step: angle of a facet, rad; half a degree cuts 5 µm under a wheel of 0.5 m.
    """
    theta = np.linspace(-reach, reach, max(2, int(np.ceil(2 * reach / step)) + 1))
    nt, finite = len(theta), np.isfinite(radius)
    safe = np.where(finite, radius, 0.0)
    vertices = np.stack(
        [
            np.outer(safe, np.sin(theta)).ravel(),
            np.repeat(y, nt),
            np.outer(safe, np.cos(theta)).ravel(),
        ],
        axis=1,
    )
    rows = np.flatnonzero(finite[:-1] & finite[1:])
    first = (rows[:, None] * nt + np.arange(nt - 1)[None, :]).ravel()
    faces = np.concatenate(
        [np.stack([first, first + 1, first + nt], axis=1), np.stack([first + 1, first + nt + 1, first + nt], axis=1)]
    )
    return Caster(vertices, faces)
