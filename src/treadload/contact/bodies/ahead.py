"""Displacement where particles were a step ago: the fields of the old tractions, ahead of the cells' centres.

Nothing is interpolated: the influence coefficients are taken at the travelled distance, a fraction of a cell
or several cells, so that particles ahead of the leading edge bring along their displacement there.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.contact.bodies.influence import Influence
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.complementarity.coulomb import four
from treadload.kernels.gridding.strips import Strips


@dataclass(frozen=True)
class Ahead:
    """Tangential displacement difference u (2, ny, nx), m, at a distance ahead of the cells of a patch.

    influence: the two bodies and the cells. distance: along x, m, ≥ 0; zero is the centre of each cell.
    Kernels are built when first asked for and kept.
    """

    influence: Influence
    distance: float

    def __call__(self, shear: Array, pressure: Array | None = None) -> Array:
        """Displacement by shear on body 1 (2, ny, nx), Pa, and by pressure (ny, nx), Pa, of dissimilar bodies."""
        if not shear.any():
            # Layers that drift under shear have no such kernels, and need none here.
            return np.zeros(shear.shape) if pressure is None else self.by_pressure(pressure)
        padding = self.influence.padding
        xx, yy, xy, yx = four(self._tangential)
        x, y = padding.forward(shear)
        spectra = np.stack([xx * x + xy * y, yx * x + yy * y])
        if pressure is not None and self.influence.coupled:
            spectra += self._coupling[1] * padding.forward(pressure)
        moved = padding.inverse(spectra)
        if self._strips is not None:
            moved += self._strips.displacement(shear, (0, 1), (0, 1), shear.shape[2])
            if pressure is not None:
                moved += self._strips.displacement(pressure[None], (2,), (0, 1), shear.shape[2])
        return moved

    def by_pressure(self, pressure: Array) -> Array:
        """Displacement (2, ny, nx), m, by pressure (ny, nx), Pa, alone: zero for like bodies."""
        if not self.influence.coupled:
            return np.zeros((2, *pressure.shape))
        padding = self.influence.padding
        moved = padding.inverse(self._coupling[1] * padding.forward(pressure))
        if self._strips is not None:
            moved += self._strips.displacement(pressure[None], (2,), (0, 1), pressure.shape[1])
        return moved

    def gap(self, shear: Array) -> Array:
        """Gap opening (ny, nx), m, by shear on body 1 (2, ny, nx), Pa: zero for like bodies."""
        if not self.influence.coupled:
            return np.zeros(shear.shape[1:])
        padding = self.influence.padding
        opening = padding.inverse((self._coupling[0] * padding.forward(shear)).sum(0))
        if self._strips is not None:
            opening += self._strips.displacement(shear, (0, 1), (2,), shear.shape[2])[0]
        return opening

    @cached_property
    def _strips(self) -> Strips | None:
        return self.influence.strips_ahead(self.distance)

    @cached_property
    def _tangential(self) -> ComplexArray:
        return self.influence.tangential_ahead(self.distance)

    @cached_property
    def _coupling(self) -> tuple[ComplexArray, ComplexArray]:
        return self.influence.coupling_ahead(self.distance)
