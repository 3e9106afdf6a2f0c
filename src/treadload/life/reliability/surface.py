"""A quadratic surface through few solves, with its cross terms and its error."""

from __future__ import annotations

import itertools

import numpy as np

from treadload.kernels.arrays import Array

# Where along an axis and in the plane of two inputs is solved, in standard deviations: 95 % lies within.
_AXIAL, _PAIR, _INNER = 2.0, 1.5, 1.0
# Up to so many inputs a second point on each side of an axis costs little, and the error needs it.
_CHEAP = 2


def designed(count: int) -> Array:
    """Points (n, count) in standard deviations: the middle, both sides of each axis, two in the plane of each pair.

    n = count² + count + 1 for more than two inputs: no fewer than a quadratic with cross terms has coefficients.
    """
    points = [np.zeros(count)]
    axes = np.eye(count)
    levels = (_AXIAL, _INNER) if count <= _CHEAP else (_AXIAL,)
    points += [sign * level * axis for axis in axes for level in levels for sign in (-1.0, 1.0)]
    for number, (first, second) in enumerate(itertools.combinations(axes, 2)):
        turned = first + (-1) ** number * second
        points += [_PAIR * turned, -_PAIR * turned]
    return np.array(points)


def fitted(points: Array, values: Array) -> tuple[float, Array, Array, float]:
    """Constant, gradient, curvature and error of the quadratic through values (n,) at points (n, count).

    The error is the root mean square of what each value differs from the surface through all the others.
    """
    count = points.shape[1]
    pairs = list(itertools.combinations_with_replacement(range(count), 2))
    terms = np.column_stack([np.ones(len(points)), points, *(points[:, i] * points[:, j] for i, j in pairs)])
    inverse = np.linalg.pinv(terms)
    coefficients = inverse @ values
    leverage = np.einsum("ij,ji->i", terms, inverse)
    # A point that no other stands for tells nothing of the error.
    sound = leverage < 1 - 1e-9
    left_out = (values - terms @ coefficients)[sound] / (1 - leverage[sound])
    error = float(np.sqrt(np.mean(left_out**2))) if sound.any() else 0.0
    curvature = np.zeros((count, count))
    for (i, j), value in zip(pairs, coefficients[1 + count :], strict=True):
        curvature[i, j] += value
        curvature[j, i] += value
    return float(coefficients[0]), coefficients[1 : 1 + count], curvature, error
