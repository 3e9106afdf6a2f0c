"""Finite elements in plane strain: a line contact that rolls over an endless elastic-plastic half-space.

Nothing here is of the package. x is the direction of travel, y the endless axis across, z depth; lengths count in
halves a of the contact, tension is positive, tensors are xx, yy, zz, xz with the tensor's shear.

Stress is that of Hertz' pressure on the elastic half-plane, in closed form, and that of the plastic strain,

    σ = σ_Hertz + C : (ε(u) - ε_p),    ∫ ε(v) : C : (ε(u) - ε_p) dA = 0   for all v,    ε_yy(u) = 0,

the latter by elements of eight nodes with 2 x 2 points (no locking), whose stiffness is factorised once. Rows of
points are lines of material. `steady` solves a pass in the frame of the load. Material enters at large x; its law is
followed along every row in short steps of the strain, which is linear between points, and what it takes stays behind
it to the end of the mesh. The plastic strain of the pass is a fixed point. What earlier passes left is the same all
along x, so that its stress needs no elements: ε_xx = ε_yy = 0 and σ_zz = σ_xz = 0.

A mesh must reach far. A track pushes with a force on what lies ahead of it, which gives way by the inverse of the
body's length and depth; where little hardens the plastic strain answers that by many times as much.

Sources: McEwen (1949), Philos. Mag. 40, 454-459, in Johnson (1985), Contact Mechanics, sections 4.2 and 7.1, for
Hertz' line; Merwin & Johnson (1963), Proc. Inst. Mech. Eng. 177, 676-690, for the problem; Dang Van & Maitournam
(1993), J. Mech. Phys. Solids 41, 1691-1710, for steady passes; Simo & Hughes (1998), Computational Inelasticity,
box 3.1, for the return.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from scipy.sparse import coo_matrix, diags
from scipy.sparse.linalg import splu

_TWICE = np.array([1.0, 1.0, 1.0, 2.0])[:, None]
_GAUSS = 1 / np.sqrt(3)
NAMES = (*(f"plastic {pair}" for pair in ("xx", "yy", "zz", "xz")), "equivalent", "residual xx", "residual yy")


def hertz(x, z, peak, friction, poisson):
    """Stress (4, ...) of the pressure peak √(1 - x²) and of friction times it as shear, which pulls towards +x."""
    x, z = np.broadcast_arrays(np.asarray(x, float), np.asarray(z, float))
    plus = 1 - x * x + z * z
    root = np.sqrt(plus**2 + 4 * x * x * z * z)
    m, n = np.sqrt((root + plus) / 2), np.copysign(np.sqrt(np.clip(root - plus, 0, None) / 2), x)
    r = m * m + n * n
    xx, zz, xz = 2 * z - m * (1 + (z * z + n * n) / r), -m * (1 - (z * z + n * n) / r), -n * (m * m - z * z) / r
    pulled = n * (2 - (z * z - m * m) / r) - 2 * x
    xx, zz, xz = xx + friction * pulled, zz + friction * xz, xz + friction * xx
    return peak * np.array([xx, poisson * (xx + zz), zz, xz])


@dataclass(frozen=True)
class Law:
    """Von Mises' law with linear hardening.

    strength: the yield stress. isotropic: its slope over the equivalent plastic strain. prager: c, the back stress is
    2/3 c times the plastic strain. All in the unit of the modulus.
    """

    modulus: float
    poisson: float
    strength: float
    prager: float = 0.0
    isotropic: float = 0.0

    @property
    def shear(self):
        return self.modulus / (2 * (1 + self.poisson))

    def stress(self, strain):
        """C : strain, (4, ...)."""
        stress = 2 * self.shear * strain
        stress[:3] += 2 * self.shear * self.poisson / (1 - 2 * self.poisson) * strain[:3].sum(axis=0)
        return stress

    def endless(self, plastic):
        """Stress (4, ...) of a plastic strain that is the same all along x and y."""
        nu, stress = self.poisson, np.zeros_like(plastic)
        stress[0] = -self.modulus / (1 - nu**2) * (plastic[0] + nu * plastic[1])
        stress[1] = -self.modulus / (1 - nu**2) * (plastic[1] + nu * plastic[0])
        return stress

    def flow(self, trial, plastic, equivalent):
        """Plastic strain (4, n) and its accumulated equivalent (n,) after a step; trial: C : (strain - plastic)."""
        relative = trial.copy()
        relative[:3] -= trial[:3].mean(axis=0)
        relative -= 2 / 3 * self.prager * plastic
        size = np.sqrt(1.5 * (_TWICE * relative * relative).sum(axis=0))
        step = size - self.strength - self.isotropic * equivalent
        step = np.clip(step, 0, None) / (3 * self.shear + self.prager + self.isotropic)
        return plastic + 1.5 * step / np.maximum(size, 1e-300) * relative, equivalent + step


def graded(low, high, cell, far, ratio=1.3):
    """Edges of equal cells between low and high, and beyond these of cells that grow, as far as far."""
    inner = np.linspace(low, high, round((high - low) / cell) + 1)
    wide = np.cumsum(cell * ratio ** np.arange(1, 80))
    wide = wide[: np.searchsorted(wide, far) + 1]
    return inner, wide


@dataclass(frozen=True, eq=False)
class Strip:
    """Elements between edges (n + 1,) along x and z, with points in rows, (nz, nx) of them.

    Both ends are held along x, the bottom along z. x (nx,), z (nz,): of the points; weights (nz · nx,): their areas.
    """

    edges_x: np.ndarray
    edges_z: np.ndarray
    law: Law

    @classmethod
    def of(cls, law, cell, track=(-2.0, 2.0), deep=2.5, far=4000.0):
        """cell: side of the equal elements in a track as deep as that; far: how much farther others reach."""
        x, beyond = graded(*track, cell, far)
        z, below = graded(0.0, deep, cell, far)
        return cls(np.concatenate([x[0] - beyond[::-1], x, x[-1] + beyond]), np.concatenate([z, z[-1] + below]), law)

    @property
    def shape(self):
        return 2 * (len(self.edges_z) - 1), 2 * (len(self.edges_x) - 1)

    @property
    def x(self):
        return _points(self.edges_x)

    @property
    def z(self):
        return _points(self.edges_z)

    @cached_property
    def weights(self):
        return np.outer(np.repeat(np.diff(self.edges_z), 2), np.repeat(np.diff(self.edges_x), 2)).ravel() / 4

    @cached_property
    def strains(self):
        """Sparse (4 n, degrees): displacements → strain xx, yy = 0, zz, xz of all points."""
        mx, mz = len(self.edges_x) - 1, len(self.edges_z) - 1
        # Nodes of a grid twice as fine; the middles of elements are not used.
        node = lambda i, k: k * (2 * mx + 1) + i  # noqa: E731
        i, k = np.meshgrid(np.arange(mx), np.arange(mz))
        half_x, half_z = np.diff(self.edges_x)[i] / 2, np.diff(self.edges_z)[k] / 2
        count = 4 * mx * mz
        rows, columns, values = [], [], []
        for a, c in np.ndindex(2, 2):
            point = ((2 * k + c) * 2 * mx + 2 * i + a).ravel()
            for (p, q), (by_r, by_s) in _slopes(_GAUSS * (2 * a - 1), _GAUSS * (2 * c - 1)).items():
                at = node(2 * i + 1 + p, 2 * k + 1 + q).ravel()
                along, down = (by_r / half_x).ravel(), (by_s / half_z).ravel()
                for component, axis, value in ((0, 0, along), (2, 1, down), (3, 0, down / 2), (3, 1, along / 2)):
                    rows.append(component * count + point)
                    columns.append(2 * at + axis)
                    values.append(value)
        size = 2 * (2 * mx + 1) * (2 * mz + 1)
        full = coo_matrix(
            (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), (4 * count, size)
        )
        return full.tocsc()[:, self._free(full)]

    def _free(self, full):
        width, height = 2 * len(self.edges_x) - 1, 2 * len(self.edges_z) - 1
        free = np.zeros((height, width, 2), bool)
        free.reshape(-1)[np.unique(full.col)] = True
        free[:, [0, -1], 0] = False
        free[-1, :, 1] = False
        return np.flatnonzero(free)

    @cached_property
    def solve(self):
        """Forces → displacements, by factors of the elastic stiffness."""
        law, count = self.law, len(self.weights)
        g, lame = law.shear * self.weights, 2 * law.shear * law.poisson / (1 - 2 * law.poisson) * self.weights
        parts = [self.strains[n * count : (n + 1) * count] for n in (0, 2, 3)]
        volume = parts[0] + parts[1]
        stiffness = volume.T @ diags(lame) @ volume
        for part, factor in zip(parts, (2, 2, 4), strict=True):
            stiffness = stiffness + part.T @ diags(factor * g) @ part
        return splu(stiffness.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve

    def strain(self, plastic):
        """Strain (4, ...) that a plastic strain (4, ...) of all points gives the body."""
        force = _TWICE * self.law.stress(plastic.reshape(4, -1)) * self.weights
        return (self.strains @ self.solve(self.strains.T @ force.ravel())).reshape(plastic.shape)


def _points(edges):
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    return np.stack([middle - _GAUSS * half, middle + _GAUSS * half], axis=-1).ravel()


def _slopes(r, s):
    """Slopes along r and s of the eight functions of an element, by the place of their node in -1, 0, 1."""
    slopes = {}
    for p, q in np.ndindex(3, 3):
        p, q = p - 1, q - 1
        if p and q:
            slopes[p, q] = (
                p * (1 + s * q) * (2 * r * p + s * q) / 4, q * (1 + r * p) * (r * p + 2 * s * q) / 4,
            )  # fmt: skip
        elif q:
            slopes[p, q] = -r * (1 + s * q), q * (1 - r * r) / 2
        elif p:
            slopes[p, q] = p * (1 - s * s) / 2, -s * (1 + r * p)
    return slopes


@dataclass
class Mixing:
    """Anderson's mixing of a fixed point with its last rounds."""

    memory: int = 12
    points: list = field(default_factory=list)
    images: list = field(default_factory=list)

    def __call__(self, point, image):
        self.points, self.images = [*self.points, point][-self.memory :], [*self.images, image][-self.memory :]
        if len(self.points) == 1:
            return image
        gaps = np.array([(b - a).ravel() for a, b in zip(self.points, self.images, strict=True)])
        falls = np.diff(gaps, axis=0)
        shares = np.linalg.lstsq(falls @ falls.T, falls @ gaps[-1], rcond=1e-12)[0]
        return image - np.tensordot(shares, np.diff(np.array(self.images), axis=0), 1)


def _fixed_point(step, start, tolerance, most=300):
    """The fixed point of a step, by what the step returns first; all that it returns there."""
    point, mixing = start, Mixing()
    for _ in range(most):
        found = step(point)
        moved, size = np.linalg.norm(found[0] - point), np.linalg.norm(found[0])
        if moved <= tolerance * size:
            return found
        point = mixing(point, found[0])
    raise RuntimeError(f"the plastic strain still changed by {moved / size:.1e} of itself")


@dataclass(frozen=True, eq=False)
class Wake:
    """What a pass leaves by depth: plastic (4, nz), its equivalent (nz,), residual stress (4, nz)."""

    z: np.ndarray
    plastic: np.ndarray
    equivalent: np.ndarray
    residual: np.ndarray

    def rows(self, edges):
        """Means over rows between depths `edges`, by the names of `NAMES`."""
        at = edges[:-1, None] + np.diff(edges)[:, None] * (np.arange(40) + 0.5) / 40
        profiles = [*self.plastic, self.equivalent, *self.residual[:2]]
        return {name: np.interp(at, self.z, part).mean(axis=1) for name, part in zip(NAMES, profiles, strict=True)}


def steady(strip, peak, passes=1, *, friction=0.0, steps=4, tolerance=1e-4):
    """What each of some passes leaves, a list of `Wake`.

    steps: of the law between points that follow each other. tolerance: of the plastic strain of a pass.
    """
    law, (nz, nx), left = strip.law, strip.shape, []
    wheel = hertz(strip.x, strip.z[:, None], peak, friction, law.poisson)
    plastic, equivalent, change = np.zeros((4, nz)), np.zeros(nz), np.zeros((4, nz, nx))

    def along(change):
        driving = wheel + law.stress(strip.strain(change)) + (law.endless(plastic) + law.stress(plastic))[..., None]
        now, sums, found, last = plastic, equivalent, np.zeros_like(change), driving[..., -1]
        for column in range(nx - 1, -1, -1):
            for part in np.arange(1, steps + 1) / steps:
                now, sums = law.flow(last + part * (driving[..., column] - last) - law.stress(now), now, sums)
            found[..., column], last = now - plastic, driving[..., column]
        return found, sums

    for _ in range(passes):
        change, after = _fixed_point(along, change, tolerance)
        plastic, equivalent = plastic + change[..., 0], after
        left.append(Wake(strip.z, plastic, equivalent, law.endless(plastic)))
    return left
