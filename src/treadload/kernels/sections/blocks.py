"""A tread block condensed in three dimensions: displacement of the cells of its face by loads on them.

x along travel, y to the right, z from the base, where the rubber is bonded, to the face that meets the road. The mesh
is a row of slabs of quadratic hexahedra across travel. Their planes are eliminated from the rear to the front: with
S = L Lᵀ of two planes, the loads become Z = L⁻¹ F, and the compliance of the cells is the sum of Zᵀ Z over the slabs,
symmetric and positive by construction.

scikit-fem is not used: pressure is eliminated inside every element and planes are swept one after the other as dense
blocks, so that of its elements and assembly only the shape functions would serve.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.kernels.sections.block_mesh import Block, BlockMesh
from treadload.kernels.sections.hexahedra import line_shapes, stiffness

# Parts of both sides of an element of the face by whose points of Gauss it is shared out among the cells: loads on
# whole elements are exact.
_PARTS = 6


@dataclass(frozen=True, eq=False)
class FaceCells:
    """Cells of a grid that belong to the face of a block.

    centres: (n, 2) x, y of their middles in the frame of the block, m. dx, dy: m. Points of the face that lie in none
    of them, next to a wall, belong to the nearest one.
    """

    centres: Array
    dx: float
    dy: float


def block_compliance(block: Block, poisson: float, cells: FaceCells) -> Array:
    """Mean displacement of cells of the face of a block of E = 1 Pa by uniform loads on others.

    poisson: ν, below ½. A load is one per area of a cell whatever part of the face belongs to it: a cell at a wall
    may be larger or smaller than its place on the grid and carries the cell's force.
    Returns (3 n, 3 n), m/Pa: u_x of all cells, then u_y, u_z, by loads alike, z out of the face: symmetric, positive.
    Raises ValueError for ν that is not below ½, and a cell that has no part of the face.
    """
    if not -1 < poisson < 0.5:
        raise ValueError(f"Poisson's ratio must lie between -1 and below 0.5, got {poisson:g}")
    mesh = block.mesh
    means, first = _means(mesh, cells)
    order = np.argsort(first, kind="stable")
    shear_modulus = 0.5 / (1 + poisson)
    lame = poisson / ((1 + poisson) * (1 - 2 * poisson))
    swept = _swept(mesh, means[:, :, order], first[order], shear_modulus, lame)
    count = order.size
    place = np.empty(3 * count, int)
    # From cell by cell in the order of the sweep to component by component in that of the cells.
    place[(np.arange(3)[:, None] * count + order).ravel()] = (3 * np.arange(count) + np.arange(3)[:, None]).ravel()
    return np.asarray(cells.dx * cells.dy * swept[np.ix_(place, place)])


def _swept(mesh: BlockMesh, means: Array, first: IntArray, shear_modulus: float, lame: float) -> Array:
    """Compliance (3 n, 3 n), cell by cell, of unit forces spread over the cells; means, first: as of `_means`."""
    count = means.shape[2]
    compliance = np.zeros((3 * count, 3 * count))
    free = mesh.free
    top = means.shape[1]

    def loads(plane: int, columns: int) -> Array:
        """Loads (unknowns of a plane, columns) of the first so many cells."""
        spread = np.zeros((*free[plane].shape, 3, columns, 3))
        for component in range(3):
            spread[:, -1, component, :, component] = means[plane, :top, :columns]
        return np.asarray(spread[free[plane]].reshape(3 * int(free[plane].sum()), 3 * columns))

    size = 3 * int(free[0].sum())
    left, brought = np.zeros((size, size)), np.zeros((size, 0))
    for slab in range(mesh.slabs):
        columns = int(np.searchsorted(first, slab, side="right"))
        near, middle, far = (3 * int(free[2 * slab + k].sum()) for k in range(3))
        kept = near + middle
        stiff = _slab(mesh, slab, shear_modulus, lame)
        stiff[:near, :near] += left
        behind = loads(2 * slab, columns)
        behind[:, : brought.shape[1]] += brought
        forces = np.concatenate([behind, loads(2 * slab + 1, columns)])
        # Loads of the plane between two slabs are those of the first of them.
        lower = scipy.linalg.cholesky(stiff[:kept, :kept], lower=True, overwrite_a=True, check_finite=False)
        both = np.concatenate([forces, stiff[:kept, kept:]], axis=1)
        both = scipy.linalg.solve_triangular(lower, both, lower=True, overwrite_b=True, check_finite=False)
        forces, ahead = both[:, : 3 * columns], both[:, 3 * columns :]
        compliance[: 3 * columns, : 3 * columns] += forces.T @ forces
        left = stiff[kept:, kept:] - ahead.T @ ahead
        brought = -ahead.T @ forces
        assert left.shape[0] == far
    last = loads(2 * mesh.slabs, count)
    last[:, : brought.shape[1]] += brought
    lower = scipy.linalg.cholesky(left, lower=True, check_finite=False)
    forces = scipy.linalg.solve_triangular(lower, last, lower=True, check_finite=False)
    compliance += forces.T @ forces
    return compliance


def _slab(mesh: BlockMesh, slab: int, shear_modulus: float, lame: float) -> Array:
    """Stiffness of a slab on the free unknowns of its three planes, near, middle, far."""
    planes = [2 * slab, 2 * slab + 1, 2 * slab + 2]
    nodes, places = mesh.elements_of(slab)
    parts = stiffness(nodes, shear_modulus, lame)
    size = sum(int(mesh.free[plane].sum()) for plane in planes)
    # One row more takes what belongs to the base.
    whole = np.zeros((3 * size + 3, 3 * size + 3))
    unknowns = (3 * np.where(places < 0, size, places)[:, :, None] + np.arange(3)).reshape(len(parts), 81)
    for part, unknown in zip(parts, unknowns, strict=True):
        whole[np.ix_(unknown, unknown)] += part
    return whole[: 3 * size, : 3 * size]


def _means(mesh: BlockMesh, cells: FaceCells) -> tuple[Array, IntArray]:
    """Weights (planes, nodes across, cells) of the nodes of the face in the mean over a cell, and its first slab.

    The first slab is that after which no load of a later cell has come: cells are sorted by it.
    """
    at = ((2 * np.arange(_PARTS)[:, None] + 1 + np.array([-1, 1]) / np.sqrt(3)) / _PARTS).ravel() - 1
    values, slopes = line_shapes(at)
    planes, across = mesh.face.shape[:2]
    shares = np.zeros((planes, across, len(cells.centres)))
    first = np.full(len(cells.centres), mesh.slabs)
    for slab, row in np.argwhere(mesh.reaches_face):
        block = slice(2 * slab, 2 * slab + 3), slice(2 * row, 2 * row + 3)
        corners = mesh.face[block]
        point = np.einsum("ai,bj,ijk->abk", values, values, corners)
        along = np.einsum("ai,bj,ijk->abk", slopes, values, corners)
        aside = np.einsum("ai,bj,ijk->abk", values, slopes, corners)
        weight = np.abs(along[..., 0] * aside[..., 1] - along[..., 1] * aside[..., 0]) / _PARTS**2
        cell = _nearest(point.reshape(-1, 2), cells)
        weights = np.einsum("ab,ai,bj->abij", weight, values, values).reshape(-1, 3, 3)
        for number in np.unique(cell):
            shares[(*block, number)] += weights[cell == number].sum(0)
            first[number] = min(first[number], slab)
    areas = shares.sum((0, 1))
    if not (areas > 0).all():
        number = int(np.argmin(areas))
        x, y = cells.centres[number]
        raise ValueError(f"the cell at ({x:g}, {y:g}) m has no part of the face of the block")
    return shares / areas, first


def _nearest(points: Array, cells: FaceCells) -> IntArray:
    """Number of the cell of every point (n, 2): the nearest one, distances in cells."""
    apart = (points[:, None, :] - cells.centres) / np.array([cells.dx, cells.dy])
    return np.asarray(np.square(apart).sum(-1).argmin(1))


def is_inside(block: Block, points: Array, margin: float = 1e-9) -> BoolArray:
    """(n,) True for points (n, 2) x, y, m, on the face of a block or within a margin, m, of it."""
    inside = np.ones(len(points), bool)
    corners = np.array(block.corners)
    for start, stop in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        side = (stop - start) / np.linalg.norm(stop - start)
        # Corners go round clockwise as seen with x up and y to the right: outside lies to the left of a side.
        inside &= side[1] * (points[:, 0] - start[0]) - side[0] * (points[:, 1] - start[1]) <= margin
    return inside
