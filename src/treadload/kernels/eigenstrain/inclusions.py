"""Cells of other elasticity in a matrix: the eigenstrain that stands in for them, by conjugate gradients.

With the operator K of `kernels.eigenstrain.operator` and the stress σ₀ of the matrix alone, σ = σ₀ + K e. A cell of
compliance S = C⁻¹ in a matrix of S₀ has S σ = S₀ σ + e: (K + M) e = -σ₀, M = (S₀ - S)⁻¹, in the cells of inclusions.
-K lies between 0 and C₀ in the product weighted by volumes, K taken as means over cells, so K + M is positive for
what is stiffer than the matrix and negative for what is softer; where both are present, or one is stiffer in volume
and softer in shear, it is indefinite, and MINRES takes the place of conjugate gradients. With e = T y, T² M or, where
M may vanish, T² (|M| + C₀) the identity, the spectrum lies between 1 and the contrast, and cells may be empty.

Source: Eshelby (1957), Proc. R. Soc. A 241, 376, for the equivalence; Moschovidis and Mura (1975), J. Appl. Mech. 42,
847, and Zhou, Keer and Wang (2011), Int. J. Solids Struct. 48, 2930, for many inclusions; the preconditioner is ours.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import LinearOperator, cg, minres

from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.eigenstrain.operator import Operator

# Of MINRES: no estimate is finer than round-off.
_FINEST = 1e-15
_WEIGHTS = np.array([1.0, 1, 1, 2, 2, 2])


@dataclass(frozen=True, eq=False)
class Equivalent:
    """What stands in for inclusions.

    eigenstrain, stress: (6, nz, ny, nx), stress in Pa, that of the matrix alone included. iterations: products of K.
    residual: of the equations, relative to that of no eigenstrain. method: "conjugate gradients", "MINRES".
    """

    eigenstrain: Array
    stress: Array
    iterations: int
    residual: float
    method: str


def equivalent(
    operator: Operator,
    stress: Array,
    inclusions: BoolArray,
    stiffness: tuple[Array, Array],
    matrix: tuple[float, float],
    thickness: Array,
    *,
    tolerance: float = 1e-6,
    most: int = 500,
) -> Equivalent:
    """Solve for the eigenstrain of inclusions.

    operator: averaged, of the matrix. stress: σ₀ (6, nz, ny, nx), Pa. inclusions: cells (nz, ny, nx). stiffness: of
    those cells in the order of the mask, 3 k and 2 G, (n,), Pa, 0 of empty ones. matrix: 3 k and 2 G, Pa. thickness:
    (nz,), m. tolerance: of the residual. most: iterations; who asks sees by `residual` whether they were enough.
    """
    count = int(inclusions.sum())
    layer = np.nonzero(inclusions)[0]
    # In these coordinates the product of tensors weighted by volumes is the plain one.
    root = np.sqrt(_WEIGHTS[:, None] * (thickness / thickness.mean())[layer])
    scales, shifts, signs = zip(
        *(_scaled(inclusion, host) for inclusion, host in zip(stiffness, matrix, strict=True)), strict=True
    )
    used = 0

    def isotropic(parts: tuple[Array, Array], tensor: Array) -> Array:
        """A factor of the mean and one of the deviator, applied to (6, n)."""
        mean = tensor[:3].sum(axis=0) / 3
        result: Array = parts[1] * tensor
        result[:3] += (parts[0] - parts[1]) * mean
        return result

    field = np.zeros((6, *inclusions.shape))

    def applied(y: Array) -> Array:
        nonlocal used
        used += 1
        field[:, inclusions] = isotropic(scales, y.reshape(6, count) / root)
        inner = isotropic(scales, np.asarray(operator(field), float)[:, inclusions])
        result: Array = root * (inner + isotropic(shifts, y.reshape(6, count) / root))
        return result.ravel()

    right = -(root * isotropic(scales, stress[:, inclusions])).ravel()
    positive, definite = bool(np.all(signs[0] > 0)), len({*signs[0].tolist(), *signs[1].tolist()}) < 2
    sign = 1.0 if positive or not definite else -1.0
    system = LinearOperator((6 * count, 6 * count), matvec=lambda y: sign * applied(y), dtype=float)
    size = float(np.linalg.norm(right))
    if size == 0 or count == 0:
        return Equivalent(np.zeros_like(stress), stress.copy(), 0, 0.0, "none")
    if definite:
        y, _ = cg(system, sign * right, rtol=tolerance, maxiter=most)
    else:
        # MINRES ends by an estimate that counts the operator's norm; the residual is what is asked for.
        y, inner = np.zeros_like(right), tolerance
        while used < most and np.linalg.norm(applied(y) - right) > tolerance * size and inner > _FINEST:
            y, _ = minres(system, right, x0=y, rtol=inner, maxiter=max(most - used, 1))
            inner *= 0.1
    residual = float(np.linalg.norm(applied(y) - right)) / size
    strain = np.zeros_like(stress)
    strain[:, inclusions] = isotropic(scales, y.reshape(6, count) / root)
    total = stress + np.asarray(operator(strain), float)
    return Equivalent(strain, total, used - 1, residual, "conjugate gradients" if definite else "MINRES")


def _scaled(inclusion: Array, matrix: float) -> tuple[Array, Array, Array]:
    """T, T M T and their sign for one of the two moduli, (n,)."""
    stiff = inclusion >= matrix
    # T² of what is stiffer: S₀ - S. Of what is softer (|M| + C₀)⁻¹, and |M| over that.
    square = np.where(stiff, 1 - matrix / np.where(stiff, inclusion, matrix), 1 - inclusion / matrix) / matrix
    shift = np.where(stiff, 1.0, -inclusion / matrix)
    return np.sqrt(square), shift, np.where(stiff, 1, -1)
