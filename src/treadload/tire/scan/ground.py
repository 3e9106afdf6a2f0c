"""The floor that a tire stood on when it was scanned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from treadload.tire.scan.axis import sample_surface
from treadload.tire.scan.mesh_file import FEWEST_FACES, Mesh

TRIALS = 400
THICKNESS = 0.004  # of the floor over the size of the scan
SMALLEST_SHARE = 0.1


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
    used, faces = np.unique(mesh.faces[keep], return_inverse=True)
    return replace(mesh, vertices=mesh.vertices[used], faces=faces.reshape(-1, 3), watertight=False)
