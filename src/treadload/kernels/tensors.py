"""Symmetric second-order tensors: strain from stress, principal values and directions, invariants.

A tensor field is an array (6, ...) of the components xx, yy, zz, xy, xz, yz; shear is the tensor's, not 2ε.
"""

from __future__ import annotations

import math

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.largest import ALIKE

# Where each entry of the 3 x 3 matrix stands in (xx, yy, zz, xy, xz, yz).
_FULL = np.array([[0, 3, 4], [3, 1, 5], [4, 5, 2]])
# Where each component stands in Voigt's order.
_VOIGT = np.array([0, 1, 2, 5, 4, 3])
# Components of a unit vector below this are zero when its sign is chosen: round-off of a unit vector.
_ZERO = 1e-12
# cos 3φ beyond which two principal values count as close: φ keeps 1e-14 up to there.
_APART = 1 - 1e-4
# A deviator below this part of the largest component has no direction that its cube could tell.
_LEAST = 1e-100


def strain_from_stress(stress: Array, modulus: float, poisson: float) -> Array:
    """Strain of an isotropic elastic body, ε = ((1 + ν) σ - ν tr σ 1) / E.

    stress: (6, ...), Pa. modulus: E, Pa. poisson: ν. Returns (6, ...), extension positive, tensor shear.
    """
    strain: Array = stress * ((1 + poisson) / modulus)
    strain[:3] -= poisson / modulus * stress[:3].sum(axis=0)
    return strain


def strain_by_compliance(stress: Array, compliance: Array) -> Array:
    """Strain of an anisotropic elastic body.

    stress: (6, ...), Pa. compliance: (6, 6), 1/Pa, engineering strain in Voigt's order xx, yy, zz, yz, xz, xy.
    Returns (6, ...), extension positive, tensor shear.
    """
    voigt = compliance[np.ix_(_VOIGT, _VOIGT)]
    voigt[3:] *= 0.5
    strain = np.zeros_like(stress)
    for row, column in zip(*np.nonzero(voigt), strict=True):
        # What a component does not take may be unknown.
        strain[row] += voigt[row, column] * stress[column]
    return strain


def matrices(tensor: Array) -> Array:
    """3 x 3 matrices (..., 3, 3) of a tensor field (6, ...)."""
    full: Array = np.moveaxis(tensor, 0, -1)[..., _FULL]
    return full


def principal_values(tensor: Array) -> Array:
    """Principal values (3, ...), largest first, of a tensor field (6, ...), in its unit.

    The trigonometric form of the cubic's roots, some 0.1 µs a point: λ = m + 2 p cos(φ + 2πj/3), cos 3φ = det of the
    deviator over p, half of it. Where two values come near each other φ loses digits, as the square root of what is
    left: those points go to LAPACK's symmetric solver. Errors are round-off of the largest value either way.
    Source: Smith (1961), Commun. ACM 4, 168.
    """
    tensor, unit = _scaled(tensor)
    middle, size, half, angle = _cubic(tensor)
    first, last = 2 * size * np.cos(angle), 2 * size * np.cos(angle + 2 * np.pi / 3)
    values = np.stack([middle + first, middle - first - last, middle + last])
    # Also what is no number, which compares as false.
    close = ~(np.abs(half) < _APART)
    if close.any():
        values[:, close] = np.linalg.eigvalsh(matrices(tensor[:, close])).T[::-1]
    return values * unit


def largest_principal(tensor: Array) -> Array:
    """The largest principal value (...) of a tensor field (6, ...), in its unit; as `principal_values`.

    It keeps its digits where the other two come near each other.
    """
    tensor, unit = _scaled(tensor)
    middle, size, half, angle = _cubic(tensor)
    values = middle + 2 * size * np.cos(angle)
    close = ~(half > -_APART)
    if close.any():
        values[close] = np.linalg.eigvalsh(matrices(tensor[:, close]))[..., -1]
    return np.asarray(values * unit)


def _scaled(tensor: Array) -> tuple[Array, float]:
    """Components in double precision whose squares neither overflow nor vanish, and the unit that they are in.

    A power of two, so that no digit changes. Single numbers would leave the root of their round-off where two values
    are near each other.
    """
    largest = max(float(tensor.max(initial=0.0)), -float(tensor.min(initial=0.0)))
    unit = math.ldexp(0.5, math.frexp(largest)[1]) if 0 < largest < math.inf else 1.0
    return np.divide(tensor, unit, dtype=float), unit


def _cubic(tensor: Array) -> tuple[Array, Array, Array, Array]:
    """m, p, cos 3φ and φ of `principal_values`, (...) each."""
    middle = mean(tensor)
    xx, yy, zz = tensor[:3] - middle
    xy, xz, yz = tensor[3:]
    size = np.sqrt((xx * xx + yy * yy + zz * zz + 2 * (xy * xy + xz * xz + yz * yz)) / 6)
    scale = np.where(size > _LEAST, size, 1.0)
    determinant = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    half = 0.5 * determinant / (scale * scale * scale)
    return middle, size, half, np.arccos(np.clip(half, -1.0, 1.0)) / 3


def principal(tensor: Array) -> tuple[Array, Array]:
    """Principal values, largest first, and the direction of the largest.

    tensor: (6, ...). Returns values (3, ...) in the unit of the tensor and unit vectors (..., 3) in (x, y, z).
    Of the two opposite vectors the one is given whose first non-zero component is positive. Where the two largest
    values are alike, as below the centre of a circular load, round-off would choose among many directions: the one
    nearest to travel is given, whose crack is transverse. LAPACK's symmetric solver: 1.7 µs per point, and
    orthogonal directions however close the values, which the trigonometric form does not give.
    """
    values, vectors = np.linalg.eigh(matrices(tensor))
    directions = vectors[..., :, 2]
    alike = values[..., 2] - values[..., 1] <= ALIKE * np.abs(values).max(axis=-1)
    if alike.any():
        directions[alike] = _nearest_to_travel(values[alike], vectors[alike])
    return np.moveaxis(values[..., ::-1], -1, 0), _oriented(directions)


def _nearest_to_travel(values: Array, vectors: Array) -> Array:
    """Of the directions (n, 3) of a double largest value, the one nearest to x; to y in a plane across x.

    values: (n, 3), smallest first. vectors: (n, 3, 3), in columns.
    """
    least = vectors[..., 0]
    along = np.eye(3)[np.where(1 - least[:, 0] ** 2 > ALIKE, 0, 1)]
    # Three alike: all directions are.
    threefold = values[:, 2] - values[:, 0] <= ALIKE * np.abs(values).max(axis=-1)
    across = along - (along * least).sum(axis=1, keepdims=True) * least
    nearest = np.where(threefold[:, None], np.eye(3)[0], across)
    directions: Array = nearest / np.linalg.norm(nearest, axis=1)[:, None]
    return directions


def in_plane_principal(tensor: Array) -> tuple[Array, Array]:
    """Largest principal value in the plane (x, y) and its angle from x towards y.

    tensor: (6, ...). Returns the value (...) and the angle (...) in rad, in (-π/2, π/2]; 0 where all directions
    are alike: round-off would choose among them.
    """
    middle, difference, shear = 0.5 * (tensor[0] + tensor[1]), 0.5 * (tensor[0] - tensor[1]), tensor[3]
    radius = np.hypot(difference, shear)
    angle = 0.5 * np.arctan2(shear, difference)
    # -0.0 and underflow land on -π/2, the same line as π/2.
    angle = np.where(angle <= -np.pi / 2, np.pi / 2, angle)
    return middle + radius, np.where(radius <= 0.5 * ALIKE * (np.abs(middle) + radius), 0.0, angle)


def mean(tensor: Array) -> Array:
    """Mean of the normal components (...), tension positive."""
    value: Array = (tensor[0] + tensor[1] + tensor[2]) / 3
    return value


def octahedral_shear(stress: Array) -> Array:
    """Octahedral shear stress, √((σ₁-σ₂)² + (σ₂-σ₃)² + (σ₃-σ₁)²) / 3, from (6, ...)."""
    xx, yy, zz, xy, xz, yz = stress
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    value: Array = np.sqrt(normal + 6 * (xy**2 + xz**2 + yz**2)) / 3
    return value


def von_mises(tensor: Array) -> Array:
    """Von Mises equivalent value, √(½ ((t₁-t₂)² + (t₂-t₃)² + (t₃-t₁)²)), of a stress or strain (6, ...)."""
    value: Array = 3 / np.sqrt(2.0) * octahedral_shear(tensor)
    return value


def distortion_energy(stress: Array, strain: Array) -> Array:
    """Energy of distortion per unit volume, ½ s:e of the deviators (...), from stress and strain (6, ...).

    In an elastic body (1 + ν)/(6E) Σ (σᵢ-σⱼ)² = 3 τ_oct² / (4G), whatever its moduli.
    """
    normal = (stress[:3] - mean(stress)) * (strain[:3] - mean(strain))
    value: Array = 0.5 * normal.sum(axis=0) + (stress[3:] * strain[3:]).sum(axis=0)
    return value


def vertical_shear(strain: Array) -> Array:
    """Largest engineering shear strain between the vertical and the horizontal, 2 √(ε_xz² + ε_yz²), of (6, ...)."""
    value: Array = 2 * np.hypot(strain[4], strain[5])
    return value


def mazars(values: Array) -> Array:
    """Equivalent strain √Σ⟨εᵢ⟩₊² of principal strains (3, ...).

    Source: Mazars (1986), Eng. Fract. Mech. 25, 729-737.
    """
    value: Array = np.sqrt((np.maximum(values, 0.0) ** 2).sum(axis=0))
    return value


def _oriented(vectors: Array) -> Array:
    """The same unit vectors (..., 3) with their first non-zero component positive."""
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    leading = np.where(np.abs(x) > _ZERO, x, np.where(np.abs(y) > _ZERO, y, z))
    oriented: Array = np.where(leading[..., None] < 0, -vectors, vectors)
    return oriented
