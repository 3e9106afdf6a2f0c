"""What is in a scan beside the tire: the floor that it stood on, pieces apart from it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import scipy
from scipy.sparse.csgraph import connected_components

from treadload.errors import GeometryError
from treadload.tire.scan.axis import sample_surface
from treadload.tire.scan.mesh_file import FEWEST_FACES, Mesh, renumbered

TRIALS = 400
THICKNESS = 0.004  # of the floor over the size of the scan
SMALLEST_SHARE = 0.1
ANOTHER = 0.4  # of the largest piece's area: a second tire


def without_ground(mesh: Mesh) -> Mesh | None:
    """The mesh without the largest plane in it, when that can be a floor; else None.

    A floor holds at least a tenth of the area and has everything else on one side. Found by random planes through
    three points (RANSAC); the same for the same mesh.
    """
    points, normals = sample_surface(mesh.vertices, mesh.faces, 20_000)
    size = float(np.ptp(points, axis=0).max())
    random = np.random.default_rng(0)
    best, normal, level = 0, np.zeros(3), 0.0
    for three in points[random.integers(len(points), size=(TRIALS, 3))]:
        across = np.cross(three[1] - three[0], three[2] - three[0])
        length = float(np.linalg.norm(across))
        if length < 1e-4 * size**2:
            continue
        across = across / length
        height = float(across @ three[0])
        near = (np.abs(points @ across - height) < THICKNESS * size) & (np.abs(normals @ across) > 0.9)
        if near.sum() > best:
            best, normal, level = int(near.sum()), across, height
    if best < SMALLEST_SHARE * len(points):
        return None
    over = mesh.vertices @ normal - level
    rest = np.abs(over) > 2 * THICKNESS * size
    if not rest.any() or 0.02 < float((over[rest] > 0).mean()) < 0.98:
        return None
    keep = rest[mesh.faces].any(axis=1)
    if keep.sum() < FEWEST_FACES or keep.all():
        return None
    used, faces = renumbered(mesh.faces[keep], len(mesh.vertices))
    return replace(mesh, vertices=mesh.vertices[used], faces=faces, watertight=False)


def largest_piece(mesh: Mesh, name: str) -> tuple[Mesh, int]:
    """The largest connected piece of a mesh, by area, and how many others there were.

    Raises GeometryError when another piece is nearly as large and lies beside it: a second tire.
    """
    faces, count = mesh.faces, len(mesh.vertices)
    links = scipy.sparse.coo_array(
        (np.ones(2 * len(faces)), (faces[:, [0, 1]].ravel(), faces[:, [1, 2]].ravel())), (count, count)
    )
    number, piece = connected_components(links, directed=False)
    if number == 1:
        return mesh, 0
    corner = mesh.vertices[faces]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1)
    of_face = piece[faces[:, 0]]
    sizes = np.bincount(of_face, area, number)
    first, second = np.argsort(sizes)[::-1][:2]
    if sizes[second] > ANOTHER * sizes[first]:
        boxes = [mesh.vertices[piece == number] for number in (first, second)]
        low, high = np.maximum(*(box.min(axis=0) for box in boxes)), np.minimum(*(box.max(axis=0) for box in boxes))
        if (low > high).any():
            raise GeometryError(
                f"{name!r} holds two pieces of like size beside each other, {sizes[second] / sizes[first]:.0%} of "
                "the area of the larger; a scan holds one tire: cut the other out of it"
            )
    used, faces = renumbered(faces[of_face == first], count)
    pieces_left_out = int((sizes > 0).sum()) - 1
    return replace(mesh, vertices=mesh.vertices[used], faces=faces, watertight=False), pieces_left_out
