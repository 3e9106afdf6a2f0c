"""A tread of bristles: the brush model as a body."""

from dataclasses import dataclass

import numpy as np

from treadload.contact.bodies import Body, Offsets, Waves
from treadload.units import Stiffness


@dataclass(frozen=True)
class Bristles(Body):
    """Springs side by side, Pa/m: a loaded cell moves itself and no other."""

    normal_stiffness: float
    shear_stiffness: float

    def normal(self, at: Offsets) -> np.ndarray:
        """Opening by unit pressure on the cell at the origin, m/Pa."""
        return self._own_cell(at) / self.normal_stiffness

    def tangential(self, at: Offsets) -> np.ndarray:
        """Displacement by unit shear: x by x, y by y, x by y."""
        own = self._own_cell(at) / self.shear_stiffness
        return np.array([own, own, 0 * own])

    def coupling(self, at: Offsets) -> np.ndarray:
        """Displacement along x and y by unit pressure: none."""
        return np.zeros((2, at.ny, at.nx))

    def compliance(self, waves: Waves) -> np.ndarray:
        """The same of a wave, times its wavenumber; it preconditions."""
        k = waves.k
        return np.array([k / self.normal_stiffness, k / self.shear_stiffness, k / self.shear_stiffness, 0 * k])

    def across(self, k: np.ndarray) -> np.ndarray:
        """Of a wave across, times its wavenumber."""
        return np.array([k / self.normal_stiffness, 0 * k])

    def _own_cell(self, at: Offsets) -> np.ndarray:
        return np.outer(np.abs(at.y) < at.dy / 2, np.abs(at.x) < at.dx / 2).astype(float)


@dataclass(frozen=True)
class Brush:
    """A tread of bristles.

    normal_stiffness, shear_stiffness: pressure per deflection.
    """

    normal_stiffness: Stiffness
    shear_stiffness: Stiffness

    def surface(self, *, is_tire: bool, speed: float | None) -> Body:
        """The body that contact sees."""
        return Bristles(self.normal_stiffness, self.shear_stiffness)
