"""Interpolation of vectors at scattered points by radial basis functions, and its error at points left out."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array

# Lengths of the inputs that are tried, over the half range of each.
_LENGTHS = (0.5, 0.7, 1.0, 1.4, 2.0)


@dataclass(frozen=True, eq=False)
class RadialBasis:
    """Cubes of distances and a linear polynomial through values at points: s(u) = Σ c |u - u_i|³ + a + b·u.

    points: (n, d), divided by the lengths. lengths: (d,) of the inputs. weights: (n + d + 1, m).
    """

    points: Array
    lengths: Array
    weights: Array

    def __call__(self, at: Array) -> Array:
        """Values (m,) at a point (d,)."""
        place = at / self.lengths
        distances = np.sqrt(np.square(self.points - place).sum(1))
        row = np.concatenate([distances**3, [1.0], place])
        return np.asarray(row @ self.weights)


def fit(points: Array, values: Array) -> tuple[RadialBasis, Array]:
    """The interpolation through values (n, m) at distinct points (n, d), and what it gives without each point (n, m).

    Inputs have lengths: those, of all combinations of a few, with the least sum of squares of the errors at points
    left out, which follow from the inverse of the system without a further fit. points: each input from -1 to 1.
    Raises LinAlgError where two points coincide or all lie in one plane.
    Source: Rippa (1999), Advances in Computational Mathematics 11, 193-210 (errors at points left out).
    """
    choices = [(1.0, *more) for more in itertools.product(_LENGTHS, repeat=points.shape[1] - 1)]
    best: tuple[float, RadialBasis, Array] | None = None
    for choice in choices:
        basis, off = _through(points, values, np.array(choice))
        total = float(np.square(off).sum())
        if best is None or total < best[0]:
            best = total, basis, off
    assert best is not None
    return best[1], values - best[2]


def _through(points: Array, values: Array, lengths: Array) -> tuple[RadialBasis, Array]:
    """The interpolation with these lengths, and value less prediction at each point left out (n, m)."""
    scaled = points / lengths
    count, sides = scaled.shape
    squares = np.square(scaled[:, None] - scaled[None]).sum(2)
    tail = np.column_stack([np.ones(count), scaled])
    system = np.zeros((count + sides + 1,) * 2)
    system[:count, :count] = squares**1.5
    system[:count, count:] = tail
    system[count:, :count] = tail.T
    inverse = np.linalg.inv(system)
    if not np.isfinite(inverse).all() or np.linalg.norm(inverse, 1) * np.linalg.norm(system, 1) > 1e14:
        raise np.linalg.LinAlgError("points coincide")
    weights = inverse[:, :count] @ values
    off = weights[:count] / np.diagonal(inverse)[:count, None]
    return RadialBasis(scaled, lengths, weights), off
