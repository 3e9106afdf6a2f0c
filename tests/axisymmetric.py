"""Axisymmetric finite elements of a half-space, a witness that shares nothing with the package.

Quadrilaterals of four nodes whose change of volume is the mean over the element (B-bar, Hughes 1980, Int. J. Numer.
Methods Eng. 15, 1413-1418), so that plastic flow does not lock. Von Mises' law by radial return with its consistent
tangent (Simo & Taylor 1985, Comput. Methods Appl. Mech. Eng. 48, 101-118). A rigid paraboloid without friction: nodes
in contact hang on one unknown, its depth; they leave where they would pull and join where they would overlap.

Coordinates r and z, z down. Components: rr, zz, tt, and the shear angle rz.
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

_GAUSS = np.array([-1.0, 1.0]) / np.sqrt(3)
_ONE = np.array([1.0, 1.0, 1.0, 0.0])
# Products of tensors count the shear twice.
_TWICE = np.array([1.0, 1.0, 1.0, 2.0])


def graded(fine, cells, far, growth=1.15):
    """Coordinates from 0: so many equal cells up to `fine`, then growing ones up to `far`."""
    size, at = fine / cells, list(np.linspace(0, fine, cells + 1))
    while at[-1] < far:
        size *= growth
        at.append(at[-1] + size)
    return np.array(at)


@dataclass
class Elements:
    """Quadrilaterals. places: (nodes, 2). corners: (elements, 4), in turn around each."""

    places: np.ndarray
    corners: np.ndarray
    strains: np.ndarray = field(init=False)
    volumes: np.ndarray = field(init=False)

    @classmethod
    def rows(cls, r, z):
        """Of nodes in rows and columns, r and z (m, n)."""
        number = np.arange(r.size).reshape(r.shape)
        corners = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1)
        return cls(np.stack([r.ravel(), z.ravel()], axis=-1), corners.reshape(-1, 4))

    def __post_init__(self):
        shape, local, radius, area = at_gauss_points(self.places[self.corners])
        self.volumes = 2 * np.pi * radius * area
        b = np.zeros((*radius.shape, 4, 8))
        b[..., 0, ::2], b[..., 1, 1::2] = local[..., 0, :], local[..., 1, :]
        b[..., 2, ::2] = shape / radius[..., None]
        b[..., 3, ::2], b[..., 3, 1::2] = local[..., 1, :], local[..., 0, :]
        change = b[..., :3, :].sum(axis=-2)
        mean = np.einsum("eg,egn->en", self.volumes, change) / self.volumes.sum(axis=1)[:, None]
        b[..., :3, :] += (mean[:, None] - change)[..., None, :] / 3
        self.strains = b
        unknowns = np.stack([2 * self.corners, 2 * self.corners + 1], axis=-1).reshape(-1, 8)
        self.unknowns = unknowns
        self.at_rows = np.repeat(unknowns, 8, axis=1).ravel()
        self.at_columns = np.tile(unknowns, (1, 8)).ravel()

    def strain(self, moved):
        """Of nodes moved by (2 nodes,): (elements, 4, 4) by Gauss point and component."""
        return np.einsum("egcn,en->egc", self.strains, moved[self.unknowns])

    def forces(self, stress):
        """On the nodes, (2 nodes,)."""
        inner = np.einsum("eg,egcn,egc->en", self.volumes, self.strains, stress)
        return np.bincount(self.unknowns.ravel(), inner.ravel(), self.places.size)

    def stiffness(self, tangent):
        """Matrix of tangents (elements, 4, 4, 4)."""
        both = np.einsum("eg,egcn,egcd->egnd", self.volumes, self.strains, tangent)
        blocks = np.einsum("egnd,egdm->enm", both, self.strains)
        size = self.places.size
        return coo_matrix((blocks.ravel(), (self.at_rows, self.at_columns)), shape=(size, size)).tocsc()


def at_gauss_points(corners):
    """Quadrilaterals of four nodes at their Gauss points. corners: (elements, 4, 2), r and z.

    Returns the shape functions (4, nodes), their slopes (elements, 4, 2, nodes), radii and areas (elements, 4).
    """
    s, t = (grid.ravel() for grid in np.meshgrid(_GAUSS, _GAUSS))
    sign_s, sign_t = np.array([-1, 1, 1, -1]), np.array([-1, -1, 1, 1])
    shape = 0.25 * (1 + s[:, None] * sign_s) * (1 + t[:, None] * sign_t)
    slope = 0.25 * np.stack([sign_s * (1 + t[:, None] * sign_t), sign_t * (1 + s[:, None] * sign_s)])
    jacobian = np.einsum("kgn,end->egkd", slope, corners)
    local = np.linalg.solve(jacobian, np.broadcast_to(np.moveaxis(slope, 1, 0), (*jacobian.shape[:2], 2, 4)))
    radius = np.einsum("gn,en->eg", shape, corners[..., 0])
    return shape, local, radius, np.abs(np.linalg.det(jacobian))


def elastic(modulus, poisson):
    """Stress over strain, (4, 4)."""
    shear, bulk = modulus / (2 * (1 + poisson)), modulus / (3 * (1 - 2 * poisson))
    return shear * np.diag([2.0, 2, 2, 1]) + (bulk - 2 * shear / 3) * np.outer(_ONE, _ONE)


@dataclass
class Plastic:
    """Von Mises' law with linear hardening at points: plastic strain (..., 4), tensor shear, and equivalent (...)."""

    modulus: float
    poisson: float
    strength: float
    hardening: float

    def __call__(self, strain, before, hard):
        """Stress, tangent, plastic strain and equivalent plastic strain at a strain."""
        shear = self.modulus / (2 * (1 + self.poisson))
        bulk = self.modulus / (3 * (1 - 2 * self.poisson))
        tensor = strain.copy()
        tensor[..., 3] *= 0.5
        part = tensor - before
        volume = part[..., :3].sum(axis=-1)
        s = 2 * shear * (part - volume[..., None] / 3 * _ONE)
        size = np.sqrt(np.einsum("c,...c,...c->...", _TWICE, s, s))
        q = np.sqrt(1.5) * size
        over = q - self.strength - self.hardening * hard
        dp = np.maximum(over, 0) / (3 * shear + self.hardening)
        n = s / np.where(size > 0, size, 1)[..., None]
        left = 1 - 3 * shear * dp / np.where(q > 0, q, 1)
        stress = left[..., None] * s + (bulk * volume)[..., None] * _ONE
        plain = np.diag([1.0, 1, 1, 0.5]) - np.outer(_ONE, _ONE) / 3
        turn = np.where(over > 0, 3 * shear / (3 * shear + self.hardening) - (1 - left), 0.0)
        tangent = bulk * np.outer(_ONE, _ONE) + 2 * shear * left[..., None, None] * plain
        tangent = tangent - 2 * shear * turn[..., None, None] * n[..., :, None] * n[..., None, :]
        return stress, tangent, before + np.sqrt(1.5) * dp[..., None] * n, hard + dp


@dataclass
class Pressed:
    """Load, depth, and at the surface's fine nodes pressure and the area that hangs on each; hardening by element."""

    load: float
    depth: float
    pressure: np.ndarray
    areas: np.ndarray
    hardening: np.ndarray


def press(loads, radius, material, fine, cells, deep, far=60.0):
    """A rigid paraboloid pressed into a plastic half-space through loads, N, each held to equilibrium.

    fine: of the equal cells along r, m, so many; deep: of those along z, m. far: size of the body over `fine`; twice
    that moves the peak pressure by less than 0.1 %. The first load should be elastic.
    Returns per load a Pressed; places r; the elements.
    """
    size = fine / cells
    r, z = graded(fine, cells, far * fine), graded(deep, round(deep / size), far * fine)
    body = Elements.rows(*np.meshgrid(r, z))
    nodes, top = len(body.places), np.arange(cells + 1)
    on_axis, below = np.arange(0, nodes, len(r)), np.arange(nodes - len(r), nodes)
    held = np.concatenate([2 * on_axis, 2 * below + 1])
    gap, areas = r[top] ** 2 / (2 * radius), _shares(r[: cells + 2])[: cells + 1]
    moved, depth = np.zeros(2 * nodes), 0.0
    plastic, hard = np.zeros((len(body.corners), 4, 4)), np.zeros((len(body.corners), 4))
    active = r[top] < (0.75 * loads[0] * radius * (1 - material.poisson**2) / material.modulus) ** (1 / 3)
    results = []
    for load in loads:
        for turn in range(60):
            stress, tangent, after, harder = material(body.strain(moved), plastic, hard)
            inner = body.forces(stress)
            force, apart = inner[2 * top + 1], moved[2 * top + 1] - (depth - gap)
            if turn:
                fresh = np.where(active, force > 0, apart < -1e-12 * radius)
                same, active = bool((fresh == active).all()), fresh
            else:
                same, active = False, active | (apart < 0)
            tied = 2 * top[active] + 1
            free = np.ones(2 * nodes, bool)
            free[held], free[tied] = False, False
            off = max(np.abs(inner[free]).max(), abs(force[active].sum() - load)) / max(loads)
            if same and off < 1e-7 and np.abs(apart[active]).max() < 1e-9 * radius:
                break
            step, sinks = _newton(body.stiffness(tangent), inner, load, np.flatnonzero(free), tied, -apart[active])
            moved, depth = moved + step, depth + sinks
        else:
            raise RuntimeError(f"no equilibrium at {load:g}: off by {off:.1e}")
        plastic, hard = after, harder
        results.append(Pressed(load, depth, np.where(active, force, 0.0) / areas, areas, hard.max(axis=1)))
    return results, r[top], body


def _newton(stiff, inner, load, loose, tied, jump):
    """Step of all unknowns and of the depth, which tied ones follow after a jump of their own."""
    count = stiff.shape[0]
    rows = np.concatenate([loose, tied])
    columns = np.concatenate([np.arange(len(loose)), np.full(len(tied), len(loose))])
    follow = coo_matrix((np.ones(len(rows)), (rows, columns)), shape=(count, len(loose) + 1)).tocsc()
    start = np.zeros(count)
    start[tied] = jump
    right = follow.T @ -(inner + stiff @ start)
    right[-1] += load
    matrix = (follow.T @ stiff @ follow).tocsc()
    step = splu(matrix, permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve(right)
    return follow @ step + start, step[-1]


def _shares(edges):
    """Area that hangs on each node of rings between radii."""
    a, b = edges[:-1], edges[1:]
    inner = 2 * np.pi * (b - a) * (2 * a + b) / 6
    outer = 2 * np.pi * (b - a) * (a + 2 * b) / 6
    area = np.zeros(len(edges))
    area[:-1] += inner
    area[1:] += outer
    return area
