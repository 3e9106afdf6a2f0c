"""Meshes of tires for tests, made by rule: ribs, lugs, noise, points that stick out."""

import math

import numpy as np
import trimesh
from scipy.spatial.transform import Rotation

from treadload.tire import TreadProfile, equal_ribs

RIB_TREAD = TreadProfile(0.538, 2.0, 0.282, 0.010, equal_ribs(0.282, 4, 0.012, 0.015, math.radians(8)))


def tire_mesh(profile=RIB_TREAD, *, around=360, across=90, arc=2 * math.pi, noise=0.0, flipped=0.0, seed=1):
    """Revolved tread with short sidewalls, in the frame of the wheel: vertices (n, 3) in m, faces (m, 3)."""
    random = np.random.default_rng(seed)
    half = 0.5 * profile.width
    # Walls of grooves need a pair of points each, or they lean over the distance between two.
    edges = [
        g.centre + side * (0.5 * g.width - inward) + nudge
        for g in profile.grooves
        for side in (-1, 1)
        for inward in (0.0, g.depth * math.tan(g.wall_angle))
        for nudge in (-1e-4, 1e-4)
    ]
    y = np.union1d(np.linspace(-half + 1e-4, half - 1e-4, across), edges)
    r = profile.rolling_radius - profile.drop(y)
    down = np.linspace(0.05, 1, 20)
    y = np.concatenate([y[0] - 0.02 * np.sin(np.pi * down[::-1]), y, y[-1] + 0.02 * np.sin(np.pi * down)])
    r = np.concatenate([r[0] - 0.2 * down[::-1], r, r[-1] - 0.2 * down])
    closed = arc > 2 * math.pi - 1e-6
    n = round(around * arc / (2 * math.pi))
    theta = np.linspace(-0.5 * arc, 0.5 * arc, n, endpoint=not closed)
    vertices = np.stack([np.outer(r, np.sin(theta)), np.tile(y[:, None], n), np.outer(r, np.cos(theta))], axis=-1)
    vertices = vertices.reshape(-1, 3) + random.normal(scale=noise, size=(len(y) * n, 3))
    faces = lattice_faces(len(y), n, closed)
    turned = random.random(len(faces)) < flipped
    faces[turned] = faces[turned][:, ::-1]
    return vertices, faces


def lugged_mesh(
    *, radius=0.35, width=0.24, lugs=20, depth=0.025, angle=45.0, share=0.3, overlap=0.03, wall=2e-3, around=1200,
    across=121, noise=0.0, seed=1,
):  # fmt: skip
    """Wheel with lugs in two staggered rows (a tractor's or a robot's), in the frame of the wheel, m.

    radius: over the lugs. width: of the tread. lugs: in each row. depth: of the voids. angle: of the lugs from
    the axle, degrees (0: bars straight across). share: of the turn that lugs cover at a place across.
    overlap: how far the rows reach over the middle. wall: run of the side walls along the turn, m.
    Returns vertices (n, 3), faces (m, 3) and the radius (across, around) over the tread.
    """
    half = 0.5 * width
    y = np.linspace(-half, half, across)
    theta = (np.arange(around) + 0.5) * 2 * np.pi / around
    pitch = 2 * np.pi / lugs
    lug = np.zeros((across, around))
    for side, start in ((1.0, 0.0), (-1.0, 0.5 * pitch)):
        away = np.abs(theta[None, :] - start - side * y[:, None] * math.tan(math.radians(angle)) / radius)
        away = np.abs((away + 0.5 * pitch) % pitch - 0.5 * pitch) * radius
        run = np.clip((0.5 * share * pitch * radius - away) / wall + 0.5, 0, 1)
        run *= np.clip((side * y[:, None] + overlap) / wall, 0, 1)
        lug = np.maximum(lug, run)
    # A crown of radius 1 m, as of a soft wheel; the carcass runs level beneath it.
    top = radius - y**2 / 2
    r = top[:, None] - depth * (1 - lug)
    down = np.linspace(0.1, 1, 12)
    low = top[0] - depth
    sides = low - 0.4 * low * down
    bulge = 0.03 * np.sin(np.pi * down)
    y_all = np.concatenate([-half - bulge[::-1] - 1e-3, y, half + bulge + 1e-3])
    r_all = np.concatenate([np.repeat(sides[::-1, None], around, 1), r, np.repeat(sides[:, None], around, 1)])
    vertices = np.stack(
        [r_all * np.sin(theta), np.repeat(y_all[:, None], around, 1), r_all * np.cos(theta)], axis=-1
    ).reshape(-1, 3)
    vertices = vertices + np.random.default_rng(seed).normal(scale=noise, size=vertices.shape)
    return vertices, lattice_faces(len(y_all), around, True), r


def lattice_faces(rows, columns, closed):
    """Triangles of a lattice of points (rows, columns), its columns joined round the turn when closed."""
    row, column = (a.ravel() for a in np.meshgrid(np.arange(rows - 1), np.arange(columns if closed else columns - 1)))
    a, b = row * columns + column, row * columns + (column + 1) % columns
    return np.concatenate([np.stack([a, b, a + columns], axis=1), np.stack([b, b + columns, a + columns], axis=1)])


def stick_out(vertices, height, *, near=(0.0, 0.02, 0.538), count=1):
    """The mesh with its points nearest to a place pushed away from the axle (y) by a height, m."""
    vertices = vertices.copy()
    chosen = np.argsort(np.linalg.norm(vertices - np.asarray(near), axis=1))[:count]
    r = np.hypot(vertices[chosen, 0], vertices[chosen, 2])
    vertices[chosen] *= np.stack([1 + height / r, np.ones(count), 1 + height / r], axis=1)
    return vertices


def write(path, vertices, faces):
    trimesh.Trimesh(vertices, faces, process=False).export(path)
    return path


def pose(seed):
    return Rotation.random(random_state=seed).as_matrix(), np.random.default_rng(seed).normal(size=3)
