"""Points of a scan that stick out of the tire: found, named, and put back on to the surface beside them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import scipy
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.quality import Outlier
from treadload.tire.scan.mesh_file import Mesh
from treadload.tire.unrolled import row_quantile

Indices = NDArray[np.int64]

FAR = 4.0  # over the distance from the middle within which nine tenths of the points lie
NEEDLE = 1.5  # a point this many times further off than the ring of its neighbours is wide
LOWEST = 0.5e-3  # height over the tread that counts, m
DEVIATIONS = 6.0  # of the noise: one point in 500 million of a normal distribution
LARGEST = 0.04  # what is longer belongs to the tire, m
STEEPEST = 1.5  # of the envelope where heights over it can be measured
BESIDE = 0.002  # walls of grooves may lie this far from where they are drawn, m
MOST = 30


@dataclass(frozen=True, eq=False)
class Moved:
    """Points of a mesh that were brought back: their indices (k,), and where they had been, (k, 3)."""

    points: Indices
    where: Array

    def undone(self, vertices: Array) -> Array:
        """The vertices with these points where they had been."""
        vertices = vertices.copy()
        vertices[self.points] = self.where
        return vertices


def without_needles(mesh: Mesh) -> tuple[Mesh, Moved]:
    """The mesh with points far off all others brought back to their neighbours, and which they are.

    For what would spoil the search for the axle. At most a thousandth of the points; else the mesh as it is.
    Points without neighbours to go back to end in the middle, without triangles.
    """
    points = mesh.vertices
    away = np.linalg.norm(points - np.median(points, axis=0), axis=1)
    wild = away > FAR * np.quantile(away, 0.9)
    wild |= _needles(mesh, wild)
    if not wild.any() or wild.sum() > max(MOST, len(points) // 1000):
        return mesh, Moved(np.zeros(0, dtype=np.int64), np.zeros((0, 3)))
    moved, settled = put_back(points, _links(mesh), wild)
    moved[~settled] = np.median(points, axis=0)
    keep = settled[mesh.faces].all(axis=1)
    chosen = np.flatnonzero(wild)
    return replace(mesh, vertices=moved, faces=mesh.faces[keep]), Moved(chosen, points[chosen])


def _links(mesh: Mesh) -> scipy.sparse.csr_array:
    """Matrix (n, n) with a 1 where two vertices share an edge."""
    edge = mesh.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    both = np.concatenate([edge, edge[:, ::-1]])
    n = len(mesh.vertices)
    links = scipy.sparse.csr_array((np.ones(len(both)), (both[:, 0], both[:, 1])), shape=(n, n))
    links.data[:] = 1.0
    return links


def _needles(mesh: Mesh, ignore: BoolArray) -> BoolArray:
    """(n,) True for tips of needles: far from the closed ring of their neighbours, as measured by its width."""
    n = len(mesh.vertices)
    fan = np.bincount(mesh.faces.ravel(), minlength=n)
    corner = mesh.vertices[mesh.faces]
    sides = [np.linalg.norm(corner[:, (k + 1) % 3] - corner[:, k], axis=1) for k in range(3)]
    maybe = (fan >= 3) & ~ignore
    legs = [np.minimum(sides[k], sides[k - 1]) for k in range(3)]
    for k in range(3):
        # One triangle whose far side is long enough clears its tip: few are left to be summed over.
        maybe[mesh.faces[legs[k] <= 0.5 * NEEDLE * sides[(k + 1) % 3], k]] = False
    if not maybe.any():
        return maybe
    near, wide = np.full(n, np.inf), np.zeros(n)
    for k in range(3):
        rows = maybe[mesh.faces[:, k]]
        tip = mesh.faces[rows, k]
        np.minimum.at(near, tip, legs[k][rows])
        # A ring is at most half as wide as it is long; one that holds its point is no nearer to it than that.
        np.add.at(wide, tip, 0.5 * sides[(k + 1) % 3][rows])
    maybe &= near > NEEDLE * wide
    if not maybe.any():
        return np.asarray(maybe, dtype=bool)
    closed = np.diff(_links(mesh).indptr) == fan
    return np.asarray(maybe & closed, dtype=bool)


def put_back(points: Array, links: scipy.sparse.csr_array, wild: BoolArray) -> tuple[Array, BoolArray]:
    """Points (n, k) with the wild ones at the median of their neighbours, from outside in; and which are known."""
    points, settled = points.copy(), ~wild
    left = list(np.flatnonzero(wild))
    while left:
        beside = {k: links.indices[links.indptr[k] : links.indptr[k + 1]] for k in left}
        now = [k for k in left if settled[beside[k]].any()]
        if not now:
            break
        medians = [np.median(points[beside[k][settled[beside[k]]]], axis=0) for k in now]
        points[now] = medians
        settled[now] = True
        left = [k for k in left if k not in set(now)]
    return points, settled


def find_outliers(mesh: Mesh, reference: Array, high: float) -> list[Indices]:
    """Groups of neighbouring points that stick out of the tread, and over the points beside them, by a height.

    mesh: in the frame of the wheel, m. reference: (n,) outer radius of the tread beside each vertex, m; NaN where
    there is no tread. high: m. Groups longer than 40 mm belong to the tire.
    """
    r = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 2])
    with np.errstate(invalid="ignore"):
        where = np.flatnonzero(r > reference + high)
    if len(where) == 0:
        return []
    links = _links(mesh)
    count, group = connected_components(links[where][:, where], directed=False)
    groups = []
    # A cloud of them is beyond this rule: the first hundreds are enough to refuse it.
    for k in range(min(count, 10 * MOST)):
        members = where[group == k]
        if np.linalg.norm(np.ptp(_footprint(mesh.vertices[members]), axis=0)) > LARGEST:
            continue
        beside = np.setdiff1d(links[members].indices, members)
        if len(beside) == 0 or r[members].max() > r[beside].max() + high:
            groups.append(members)
    return groups


def _footprint(points: Array) -> Array:
    """(n, 2) of place across and length along the turn, m, at the smallest radius among the points."""
    turn = np.arctan2(points[:, 0], points[:, 2])
    turn = np.angle(np.exp(1j * (turn - turn[0])))
    return np.stack([points[:, 1], turn * np.hypot(points[:, 0], points[:, 2]).min()], axis=1)


def without_outliers(mesh: Mesh, groups: list[Indices]) -> Mesh:
    """The mesh in the frame of the wheel with groups of points brought back to the radius beside them.

    Groups without points beside them float: they are dropped.
    """
    wild = np.zeros(len(mesh.vertices), dtype=bool)
    wild[np.concatenate(groups)] = True
    r = np.maximum(np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 2]), 1e-9)
    polar = np.stack([mesh.vertices[:, 0] / r, mesh.vertices[:, 1], mesh.vertices[:, 2] / r, r], axis=1)
    moved, settled = put_back(polar, _links(mesh), wild)
    x, z = moved[wild, 0], moved[wild, 2]
    at = moved[wild, 3] / np.maximum(np.hypot(x, z), 1e-12)
    vertices = mesh.vertices.copy()
    vertices[wild] = np.stack([x * at, moved[wild, 1], z * at], axis=1)
    vertices[~settled] = np.median(vertices, axis=0)
    return replace(mesh, vertices=vertices, faces=mesh.faces[settled[mesh.faces].all(axis=1)])


def named(mesh: Mesh, reference: Array, groups: list[Indices], far: Moved, middle: float) -> list[Outlier]:
    """Height and place of groups of points and of points that were brought back before, the highest first.

    mesh, reference: as in find_outliers. middle: place of the middle of the tread along the axle, m.
    """
    r = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 2])
    outliers = []
    for members in groups:
        tip = members[np.argmax(r[members] - reference[members])]
        x, y, z = mesh.vertices[tip]
        outliers.append(Outlier(len(members), float((r - reference)[tip]), math.atan2(x, z), float(y) - middle))
    for index, where in zip(far.points, far.where, strict=True):
        # Named by where it went back to: far off, the smallest tilt of the axle moves it sideways.
        x, y, z = mesh.vertices[index]
        height = float(np.linalg.norm(where - mesh.vertices[index]))
        outliers.append(Outlier(1, height, math.atan2(x, z), float(y) - middle))
    return sorted(outliers, key=lambda outlier: -outlier.height)


def in_words(outliers: list[Outlier], kept: bool, are_lugs: bool = False) -> str:
    """One sentence on what sticks out and was put back, or left. are_lugs: it was taken for the tread's own."""
    points = sum(outlier.points for outlier in outliers)
    places = "one place" if len(outliers) == 1 else f"{len(outliers)} places"
    which = f"({outliers[0]})" if len(outliers) == 1 else f"(the highest {outliers[0]})"
    if are_lugs:
        return (
            f"the mesh sticks out of the envelope of its tread in {places} {which}; it has no noise, so that these "
            'are taken for corners of lugs and kept: outliers="refuse" stops at them, and a finer mesh has fewer'
        )
    if kept:
        return f"the scan sticks out of the tire in {places} {which}, left in it as asked: its tip will carry load"
    return (
        f"the scan stuck out of the tire in {places} {which}: {points} point{'s were' if points > 1 else ' was'} put "
        'back to the surface beside; outliers="keep" leaves such points, "refuse" stops at them'
    )


def tread_reference(vertices: Array, y: Array, top: Array, turn: Array, theta: Array, floor: float) -> Array:
    """(n,) outer radius of the tread beside each vertex, m, out-of-roundness included; NaN off the tread.

    y: (ny,) even steps; top: (ny,) tops of the blocks there, m. turn: (ny, nt) radius, m, at the angles theta,
    even steps round the turn. floor: radius down to which the tread reaches, m.
    """
    step = float(y[1] - y[0])
    cells = 2 * math.ceil(BESIDE / step) + 1
    finite = np.isfinite(top) & (top > floor)
    height = scipy.ndimage.maximum_filter1d(np.where(finite, top, -np.inf), cells)
    slope = np.gradient(np.where(np.isfinite(height), height, 0.0), step)
    usable = np.isfinite(height) & (np.abs(slope) < STEEPEST)
    over = np.where(finite[:, None], turn - top[:, None], np.nan)
    seen = np.isfinite(over).any(axis=0)
    high = np.zeros(len(theta))
    high[seen] = row_quantile(over[:, seen].T, 0.9)
    # Over 45°, the higher part: the turn itself where lugs leave gaps.
    window = max(3, round(len(theta) / 8))
    run = scipy.ndimage.percentile_filter(high, 75, size=window, mode="wrap")
    across = np.interp(vertices[:, 1], y, np.where(usable, height, np.nan), left=np.nan, right=np.nan)
    angle = np.arctan2(vertices[:, 0], vertices[:, 2]) % (2 * np.pi)
    return np.asarray(across + np.interp(angle, theta, run, period=2 * np.pi), dtype=np.float64)
