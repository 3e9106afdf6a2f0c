"""Anderson's mixing of fixed-point iterations: strong coupling settles where plain iteration circles.

Sources: Anderson (1965), J. ACM 12, 547-560; Walker & Ni (2011), SIAM J. Numer. Anal. 49, 1715-1735.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from treadload.kernels.arrays import Array


@dataclass
class Anderson:
    """Mixing of x ← g(x) over its last rounds. memory: how many of them."""

    memory: int
    points: list[Array] = field(default_factory=list)
    residuals: list[Array] = field(default_factory=list)

    def next(self, x: Array, g: Array) -> Array:
        """The next point, from a point and what the iteration makes of it."""
        self.points = [*self.points[-self.memory :], x]
        self.residuals = [*self.residuals[-self.memory :], g - x]
        if len(self.points) == 1:
            return g
        steps = np.array([b - a for a, b in zip(self.points, self.points[1:], strict=False)])
        changes = np.array([b - a for a, b in zip(self.residuals, self.residuals[1:], strict=False)])
        basis = changes.reshape(len(changes), -1).T
        weights = np.linalg.lstsq(basis, self.residuals[-1].ravel(), rcond=1e-10)[0]
        mixed: Array = g - np.tensordot(weights, steps + changes, 1)
        return mixed
