"""Anisotropic solids for tests, and their surface by Stroh's eigenvectors."""

import numpy as np

import treadload as tl

# Contrast 3 with no plane of symmetry left in the axes of the road.
STRAIGHT = tl.materials.Orthotropic((3e9, 1.5e9, 1e9), (0.6e9, 0.5e9, 0.4e9), (0.3, 0.3, 0.3))
TILTED = STRAIGHT.rotated(*np.radians([40, 34, 20]))
# One stiff axis, leaning by 34° and turned by 40°: contrast 4.
LEANING = tl.materials.Orthotropic((1e9, 1e9, 4e9), (0.4e9, 0.45e9, 0.45e9), (0.25, 0.0625, 0.0625)).rotated(
    yaw=np.radians(40), pitch=np.radians(34)
)


def isotropic(modulus, poisson):
    """Stiffness (6, 6), Pa, of an isotropic solid."""
    shear = modulus / (2 * (1 + poisson))
    stiffness = np.diag([2 * shear] * 3 + [shear] * 3)
    stiffness[:3, :3] += 2 * shear * poisson / (1 - 2 * poisson)
    return stiffness


def stroh(stiffness, angle):
    """p (3,) with Im p > 0, A and B (3, 3) by columns, for waves along an angle. Source: Ting (1996), chapter 5."""
    at = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])
    c = stiffness[at[:, :, None, None], at[None, None]]
    m, n = np.array([np.cos(angle), np.sin(angle), 0]), np.array([0, 0, 1.0])
    q, r, t = (np.einsum("j,ijkl,l->ik", one, c, other) for one, other in ((m, m), (m, n), (n, n)))
    inverse = np.linalg.inv(t)
    whole = np.block([[-inverse @ r.T, inverse], [r @ inverse @ r.T - q, -r @ inverse]])
    p, vectors = np.linalg.eig(whole)
    up = p.imag > 0
    return p[up], vectors[:3, up], vectors[3:, up]


def stroh_symbol(stiffness, angle):
    """L (3, 3), 1/Pa: u = L t / k with t = -ik B f on the surface z = 0."""
    scale = stiffness.max()
    _, a, b = stroh(stiffness / scale, angle)
    return 1j * a @ np.linalg.inv(b) / scale
