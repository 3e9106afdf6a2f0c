"""Anderson's mixing of fixed-point iterations: strong coupling settles where plain iteration circles.

Sources: Anderson (1965), J. ACM 12, 547-560; Walker & Ni (2011), SIAM J. Numer. Anal. 49, 1715-1735.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from treadload.kernels.arrays import Array, BoolArray


@dataclass
class _Rounds:
    """The last rounds of x ← g(x). memory: how many of them are mixed."""

    memory: int
    points: list[Array] = field(default_factory=list)
    residuals: list[Array] = field(default_factory=list)

    def differences(self, x: Array, g: Array) -> tuple[Array, Array] | None:
        """From round to round those of the points and of the residuals (rounds - 1, ...); None after a first round.

        x, g: a point and what the iteration makes of it, the latest round.
        """
        self.points = [*self.points[-self.memory :], x]
        self.residuals = [*self.residuals[-self.memory :], g - x]
        if len(self.points) == 1:
            return None
        return np.diff(np.stack(self.points), axis=0), np.diff(np.stack(self.residuals), axis=0)


@dataclass
class Anderson(_Rounds):
    """Mixing of x ← g(x) over its last rounds."""

    def next(self, x: Array, g: Array) -> Array:
        """The next point, from a point and what the iteration makes of it."""
        differences = self.differences(x, g)
        if differences is None:
            return g
        steps, changes = differences
        basis = changes.reshape(len(changes), -1).T
        weights = np.linalg.lstsq(basis, self.residuals[-1].ravel(), rcond=1e-10)[0]
        mixed: Array = g - np.tensordot(weights, steps + changes, 1)
        return mixed


@dataclass
class AndersonOfMany(_Rounds):
    """The same for many iterations side by side (..., n), each with weights of its own."""

    def next(self, x: Array, g: Array) -> Array:
        """The next points (..., n), from points and what the iteration makes of them."""
        differences = self.differences(x, g)
        if differences is None:
            return g
        steps, changes = (np.moveaxis(difference, 0, -1) for difference in differences)
        normal = np.einsum("...nr,...ns->...rs", changes, changes)
        trace = np.einsum("...rr->...", normal)[..., None, None]
        normal = normal + (1e-12 * trace + 1e-300) * np.eye(normal.shape[-1])
        wanted = np.einsum("...nr,...n->...r", changes, self.residuals[-1])
        weights = np.linalg.solve(normal, wanted[..., None])
        mixed: Array = g - ((steps + changes) @ weights)[..., 0]
        return mixed

    def keep(self, chosen: BoolArray) -> None:
        """Go on with some of the iterations: of the axis before the last, by mask."""
        self.points = [part[..., chosen, :] for part in self.points]
        self.residuals = [part[..., chosen, :] for part in self.residuals]
