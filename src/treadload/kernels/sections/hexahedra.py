"""Stiffness of quadratic hexahedra for rubber that hardly changes its volume.

27 nodes and a linear discontinuous pressure, which is eliminated in the element, so that ν may come near ½: the
three-dimensional counterpart of `elements`.

Sources: Sussman & Bathe (1987), Comput. Struct. 26, 357-409 (27 nodes, 4 pressures); Hughes (1987), The Finite
Element Method, chapter 4 (elimination of the pressure).
"""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array

_POINTS = np.sqrt(0.6) * np.array([-1.0, 0.0, 1.0])
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 9


def stiffness(nodes: Array, shear_modulus: float, lame: float) -> Array:
    """Stiffness of elements (elements, 81, 81), N/m.

    nodes: (elements, 27, 3) x, y, z, m: three along the first side of the element, three along the second, three up,
    the last index fastest. Unknowns: node by node, U, V, W of each. shear_modulus: G, Pa. lame: λ, Pa, finite.
    """
    elements = nodes.shape[0]
    shape, slopes = _shapes()
    # (elements, points, local direction, place), and what turns local slopes into those along x, y, z.
    jacobian = np.einsum("dpn,enk->epdk", slopes, nodes)
    inverse = np.linalg.inv(jacobian)
    weight = np.linalg.det(jacobian) * np.einsum("i,j,k->ijk", _WEIGHTS, _WEIGHTS, _WEIGHTS).ravel()
    by_x, by_y, by_z = np.einsum("epkd,dpn->kepn", inverse, slopes, optimize=True)
    strain = np.zeros((elements, 27, 6, 27, 3))
    strain[..., 0, :, 0], strain[..., 1, :, 1], strain[..., 2, :, 2] = by_x, by_y, by_z
    strain[..., 3, :, 1], strain[..., 3, :, 2] = by_z, by_y
    strain[..., 4, :, 0], strain[..., 4, :, 2] = by_z, by_x
    strain[..., 5, :, 0], strain[..., 5, :, 1] = by_y, by_x
    flat = strain.reshape(elements, 27, 6, 81)
    elastic = shear_modulus * np.array([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    scaled = (flat * (weight[..., None] * elastic)[..., None]).reshape(elements, 162, 81)
    total = scaled.swapaxes(1, 2) @ flat.reshape(elements, 162, 81)
    # Change of volume against the pressures 1, x, y, z of the element.
    at = np.einsum("pn,enk->epk", shape, nodes)
    middle = (weight[..., None] * at).sum(1, keepdims=True) / weight.sum(1)[:, None, None]
    modes = np.concatenate([np.ones((elements, 27, 1)), at - middle], axis=2)
    weighted = (modes * weight[..., None]).swapaxes(1, 2)
    change = weighted @ flat[..., :3, :].sum(2)
    mass = np.linalg.inv(weighted @ modes)
    total += change.swapaxes(1, 2) @ (lame * mass) @ change
    return np.asarray(0.5 * (total + total.swapaxes(1, 2)))


def _shapes() -> tuple[Array, Array]:
    """27 shape functions (points, nodes), and their slopes along the sides (3, points, nodes), at 27 points."""
    values, slopes = line_shapes(_POINTS)

    def product(*parts: Array) -> Array:
        return np.asarray(np.kron(np.kron(parts[0], parts[1]), parts[2]))

    return product(values, values, values), np.array(
        [product(slopes, values, values), product(values, slopes, values), product(values, values, slopes)]
    )


def line_shapes(at: Array) -> tuple[Array, Array]:
    """Three quadratic shape functions of a line from -1 to 1 and their slopes at places (n,): (n, 3) each."""
    values = np.stack([0.5 * at * (at - 1), 1 - at**2, 0.5 * at * (at + 1)], axis=1)
    slopes = np.stack([at - 0.5, -2 * at, at + 0.5], axis=1)
    return values, slopes
