"""Stiffness of an anisotropic solid: matrix, tensor, and what a rotation makes of it.

Matrices (6, 6) are Voigt's, 11 22 33 23 13 12, with engineering shear strain; tensors (3, 3, 3, 3) are C_ijkl.
"""

from __future__ import annotations

import numpy as np

from treadload.kernels.arrays import Array

_ROW = np.array([0, 1, 2, 1, 0, 0])
_COLUMN = np.array([0, 1, 2, 2, 2, 1])
_PLACE = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])


def as_tensor(matrix: Array) -> Array:
    """C_ijkl (3, 3, 3, 3) of a stiffness matrix (6, 6), Pa."""
    return np.asarray(matrix[_PLACE[:, :, None, None], _PLACE[None, None, :, :]])


def as_matrix(tensor: Array) -> Array:
    """Stiffness matrix (6, 6) of C_ijkl (3, 3, 3, 3), Pa."""
    return np.asarray(tensor[_ROW[:, None], _COLUMN[:, None], _ROW[None, :], _COLUMN[None, :]])


def rotated(matrix: Array, rotation: Array) -> Array:
    """Stiffness matrix (6, 6), Pa, of a solid turned by a rotation (3, 3), whose columns are its turned axes."""
    r = rotation
    turned = np.einsum("ia,jb,kc,ld,abcd->ijkl", r, r, r, r, as_tensor(matrix), optimize=True)
    # Rounding must not cost the symmetry.
    full = as_matrix(turned)
    return 0.5 * (full + full.T)
