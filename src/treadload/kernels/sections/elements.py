"""Stiffness of quadratic quadrilaterals under waves along travel, for rubber that hardly changes its volume.

Displacement u = (i U, V, W)(y, z) e^{ikx}. The strains

    ε = (-k U, V_y, W_z, V_z + W_y, U_z + k W, U_y + k V)

are linear in k, the energy is real, and the stiffness K₀ + k K₁ + k² K₂ is symmetric. Pressure is linear in y and z
and of every element alone; it is eliminated there, so that ν may come near ½.

Sources: Sussman & Bathe (1987), Comput. Struct. 26, 357-409 (9 nodes, 3 pressures); Hughes (1987), The Finite
Element Method, chapter 4 (elimination of the pressure); Yang & Hung (2001), Int. J. Numer. Methods Eng. 51, 1283-1304
(waves along the third axis).
"""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array

_POINTS = np.sqrt(0.6) * np.array([-1.0, 0.0, 1.0])
_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 9


def stiffness(y: Array, z: Array, shear_modulus: float, lame: float) -> Array:
    """K₀, K₁, K₂ of elements: (3, elements, 27, 27), N/m² times powers of m.

    y, z: (elements, 3, 3) of the nodes, m: across, then up. Unknowns: node by node, the last index of the nodes
    fastest, U, V, W of each. lame: λ, finite.
    """
    elements = y.shape[0]
    shape, by_xi, by_eta = _shapes()
    nodes_y, nodes_z = y.reshape(elements, 9), z.reshape(elements, 9)
    y_xi, y_eta, z_xi, z_eta = (nodes @ part.T for nodes in (nodes_y, nodes_z) for part in (by_xi, by_eta))
    jacobian = y_xi * z_eta - y_eta * z_xi
    weight = jacobian * np.outer(_WEIGHTS, _WEIGHTS).ravel()
    # Slopes of the shape functions (elements, points, nodes).
    by_y = (z_eta[..., None] * by_xi - z_xi[..., None] * by_eta) / jacobian[..., None]
    by_z = (y_xi[..., None] * by_eta - y_eta[..., None] * by_xi) / jacobian[..., None]
    strain = np.zeros((2, elements, 9, 6, 9, 3))
    plain, waved = strain
    plain[..., 1, :, 1], plain[..., 2, :, 2] = by_y, by_z
    plain[..., 3, :, 1], plain[..., 3, :, 2] = by_z, by_y
    plain[..., 4, :, 0], plain[..., 5, :, 0] = by_z, by_y
    waved[..., 0, :, 0], waved[..., 4, :, 2], waved[..., 5, :, 1] = -shape, shape, shape
    strain = strain.reshape(2, elements, 9, 6, 27)
    elastic = shear_modulus * np.array([2.0, 2.0, 2.0, 1.0, 1.0, 1.0])
    scaled = strain * (weight[..., None] * elastic)[..., None]
    flat = strain.reshape(2, elements, 54, 27)
    scaled = scaled.reshape(2, elements, 54, 27).swapaxes(-1, -2)
    parts = [scaled[0] @ flat[0], scaled[0] @ flat[1] + scaled[1] @ flat[0], scaled[1] @ flat[1]]
    # Change of volume against the pressures 1, y, z of the element.
    at_y, at_z = nodes_y @ shape.T, nodes_z @ shape.T
    area = weight.sum(-1, keepdims=True)
    modes = np.stack(
        [
            np.ones_like(at_y),
            at_y - (weight * at_y).sum(-1, keepdims=True) / area,
            at_z - (weight * at_z).sum(-1, keepdims=True) / area,
        ],
        axis=1,
    )
    weighted = modes * weight[:, None]
    volume = strain[..., :3, :].sum(-2)
    change = weighted[None] @ volume
    mass = np.linalg.inv(weighted @ modes.swapaxes(-1, -2))
    kept = change.swapaxes(-1, -2) @ (lame * mass)
    pressed = [kept[0] @ change[0], kept[0] @ change[1] + kept[1] @ change[0], kept[1] @ change[1]]
    total = np.array(parts) + np.array(pressed)
    return np.asarray(0.5 * (total + total.swapaxes(-1, -2)))


def _shapes() -> tuple[Array, Array, Array]:
    """Nine shape functions and their slopes along both sides, at nine points: (points, nodes) each."""
    values = np.array([0.5 * _POINTS * (_POINTS - 1), 1 - _POINTS**2, 0.5 * _POINTS * (_POINTS + 1)]).T
    slopes = np.array([_POINTS - 0.5, -2 * _POINTS, _POINTS + 0.5]).T
    return np.kron(values, values), np.kron(slopes, values), np.kron(values, slopes)
