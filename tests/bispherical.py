"""Finite elements of a sphere below a free surface, a witness that shares nothing with the package.

Quadrilaterals in bispherical coordinates, which fit plane and sphere, of the section r and z, z down. Fields go round
the axis as cos(m a) and sin(m a): m = 0 for equal tensions in x and y and for one down, m = 2 for a tension in x
and as much pressure in y. What the sphere changes of the uniform stress is solved for.
Components: rr, zz, tt, and the shear angles rz, rt, zt; unknowns of a node: along r, z and round.
"""

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import splu

from axisymmetric import at_gauss_points

LOADS = ("equal", "down", "opposite")


def mean_strain_of_a_sphere(depth, poisson, contrast, load, rows):
    """Mean strain along x and z of a sphere of radius 1 in a half-space of modulus 1, under tensions of 1.

    depth: of its centre. contrast: of its modulus, 0 of a void. load: "equal" in x and y, "down", or "opposite", of
    x and less y, whose strain down is 0. rows: of elements between surface and sphere; three times as many go round
    it, half as many to its centre. The body is held 100 radii away.
    """
    wave = 2 if load == "opposite" else 0
    r, z, outer = _places(depth, rows, 3 * rows, rows // 2)
    number = np.arange(r.size).reshape(r.shape)
    corners = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1).reshape(-1, 4)
    strains, volumes = _strains(np.stack([r.ravel(), z.ravel()], axis=-1)[corners], wave)
    alone = {
        "equal": np.array([1 - poisson, -2 * poisson, 1 - poisson, 0, 0, 0]),
        "down": np.array([-poisson, 1, -poisson, 0, 0, 0]),
        "opposite": (1 + poisson) * np.array([1.0, 0, -1, 0, -2, 0]),
    }[load]
    inside = np.repeat(np.arange(len(r) - 1) >= outer, r.shape[1] - 1)
    matrix, sphere = _elastic(1.0, poisson), _elastic(max(contrast, 1e-9), poisson)
    laws = np.where(inside[:, None, None], sphere, matrix)
    stress = np.where(inside[:, None], (matrix - sphere) @ alone, 0.0)
    blocks = np.einsum("eg,egcn,ecd,egdm->enm", volumes, strains, laws, strains, optimize=True)
    forces = np.einsum("eg,egcn,ec->en", volumes, strains, stress)
    unknowns = (3 * corners[..., None] + np.arange(3)).reshape(-1, 12)
    size = 3 * r.size
    at = np.repeat(unknowns, 12, axis=1).ravel(), np.tile(unknowns, (1, 12)).ravel()
    stiff = coo_matrix((blocks.ravel(), at), shape=(size, size)).tocsc()
    held = np.zeros(size, bool)
    axis, corner = 3 * number[:, [0, -1]], 3 * number[:2, :2]
    for unknown in range(3):
        held[corner + unknown] = True
        # On the axis nothing moves in a wave of two; else it moves down. Without a wave nothing goes round.
        held[axis + unknown] |= bool(wave) or unknown != 1
    held[2::3] |= not wave
    moved = np.zeros(size)
    force = np.bincount(unknowns.ravel(), forces.ravel(), size)
    moved[~held] = splu(stiff[~held][:, ~held].tocsc()).solve(force[~held])
    # Of the sphere's face, as a void has no strain of its own: the mean of sym(u n) over it.
    face, mean = 3 * number[outer], np.zeros(2)
    angle = np.arctan2(r[outer], z[outer] - depth)
    for point, weight in zip(*np.polynomial.legendre.leggauss(3), strict=True):
        part = 0.5 * (1 + point)
        to = angle[:-1] + part * np.diff(angle)
        out, down, round_ = ((1 - part) * moved[face + k][:-1] + part * moved[face + k][1:] for k in range(3))
        area = np.pi * weight * np.sin(to) * np.abs(np.diff(angle))
        if wave:
            mean[0] += (0.25 * (out - round_) * np.sin(to) * area).sum()
        else:
            mean += [(0.5 * out * np.sin(to) * area).sum(), (down * np.cos(to) * area).sum()]
    return mean / (4 / 3 * np.pi) + alone[:2]


def extrapolated(depth, poisson, contrast, load, rows):
    """The same, of elements and of twice as many rows of them, whose error is of second order."""
    coarse, fine = (mean_strain_of_a_sphere(depth, poisson, contrast, load, n * rows) for n in (1, 2))
    return (4 * fine - coarse) / 3


def _places(depth, rows, columns, inner):
    """Places r and z of nodes, the sphere's face in row `outer`, and that."""
    end = np.arccosh(depth)
    size, far = np.sinh(end), 0.02

    def towards_infinity(last, count):
        at = last * np.sinh(5.0 * np.linspace(0, 1, count + 1)) / np.sinh(5.0)
        return np.concatenate([[0.0, far], at[at > 1.1 * far]])

    eta, xi = np.meshgrid(towards_infinity(end, rows), towards_infinity(np.pi, columns), indexing="ij")
    below = np.cosh(eta) - np.cos(xi)
    below[0, 0] = 1.0
    r, z = size * np.sin(xi) / below, size * np.sinh(eta) / below
    r[:, [0, -1]] = 0.0
    # The node at infinity makes one square element of its three neighbours, which are held.
    r[0, 0], z[0, 0] = r[0, 1], z[1, 0]
    shrinks = np.append(np.linspace(1, 0, inner + 1)[1:-1], 1e-3)[:, None]
    outer = len(r) - 1
    return np.vstack([r, shrinks * r[-1]]), np.vstack([z, depth + shrinks * (z[-1] - depth)]), outer


def _strains(at, wave):
    """Strains (elements, 4, 6, 12) of unknowns at the Gauss points, and their volumes (elements, 4)."""
    shape, local, radius, area = at_gauss_points(at)
    along_r, along_z, turned = local[..., 0, :], local[..., 1, :], shape / radius[..., None]
    b = np.zeros((*radius.shape, 6, 12))
    b[..., 0, ::3], b[..., 1, 1::3] = along_r, along_z
    b[..., 2, ::3], b[..., 2, 2::3] = turned, wave * turned
    b[..., 3, ::3], b[..., 3, 1::3] = along_z, along_r
    b[..., 4, ::3], b[..., 4, 2::3] = -wave * turned, along_r - turned
    b[..., 5, 1::3], b[..., 5, 2::3] = -wave * turned, along_z
    return b, radius * area


def _elastic(modulus, poisson):
    shear = modulus / (2 * (1 + poisson))
    law = np.diag(shear * np.array([2.0, 2, 2, 1, 1, 1]))
    law[:3, :3] += modulus * poisson / ((1 + poisson) * (1 - 2 * poisson))
    return law
