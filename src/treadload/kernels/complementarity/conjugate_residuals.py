"""Linear systems by generalised conjugate residuals, in single precision.

The steps are those of GMRES, preconditioned from the right. Directions and their images are kept in place of a basis:
the residual is that of the system itself, and whatever else is linear in a direction and comes with its product, is
known of the solution without another one.

Sources: Eisenstat, Elman & Schultz (1983), SIAM J. Numer. Anal. 20, 345-357; Jiránek, Rozložník & Gutknecht (2008),
SIAM J. Matrix Anal. Appl. 30, 1483-1499 (what leads on where the residual stays).
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from scipy.linalg.blas import saxpy

from treadload.kernels.arrays import Array

# Where this part of the residual is left or more, the last image leads on in its place.
_STAYS = 0.9
# Of an image, what those before leave of it: less is round-off of single precision.
_LOST = 1e-4


def solve(
    rhs: Array,
    product: Callable[[Array], tuple[Array, Array]],
    precondition: Callable[[Array], Array],
    *,
    size: int,
    rtol: float,
    most: int,
) -> tuple[Array, Array]:
    """Solution x (n,) of A x = rhs, and L x (others,), both as far as the most directions lead.

    rhs: (n,). product: A z (n,), which is overwritten, and L z (others,) of a direction z (n,). precondition: an
    approximate inverse of A. rtol: of the residual, as a part of the right side. most: products.
    """
    images: list[Array] = []
    directions: list[tuple[Array, Array]] = []
    upper, shares = np.zeros((most, most)), np.zeros(most)
    seed = residual = rhs.copy()
    left = _size(rhs)
    goal = rtol * left
    while len(images) < most and left > goal:
        k = len(images)
        direction = precondition(seed)
        image, mapped = product(direction)
        whole = _size(image)
        for j, earlier in enumerate(images):
            upper[j, k] = earlier @ image
            image = saxpy(earlier, image, a=-upper[j, k])
        upper[k, k] = _size(image)
        if not upper[k, k] > _LOST * whole:
            # Nothing new in this direction; or none at all, where it is not finite.
            break
        image *= 1 / upper[k, k]
        shares[k] = image @ residual
        residual = saxpy(image, residual, a=-shares[k])
        images.append(image)
        directions.append((direction, mapped))
        before, left = left, _size(residual)
        # A residual that stays would lead the same way again.
        seed = residual if left < _STAYS * before else image
    count = len(images)
    weights = np.linalg.solve(upper[:count, :count], shares[:count])
    solution, result = np.zeros_like(rhs), np.zeros(size, rhs.dtype)
    for weight, (direction, mapped) in zip(weights, directions, strict=True):
        solution, result = saxpy(direction, solution, a=weight), saxpy(mapped, result, a=weight)
    return solution, result


def _size(v: Array) -> float:
    return math.sqrt(v @ v)
