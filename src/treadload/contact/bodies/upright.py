"""A half-space that is the same in all horizontal directions and another along z.

Its surface yields to waves by four numbers whatever their direction: to pressure, to shear along and across the wave,
and by what couples them. Point loads then act as on an isotropic half-space, with one pair of constants for pressure
and another for shear: every coefficient is that of `kernels.half_space.rectangle`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.contact.bodies.body import Body, Offsets, Waves
from treadload.kernels.arrays import Array
from treadload.kernels.half_space import rectangle
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.kernels.layers.images import half_space_compliance
from treadload.kernels.layers.layered import Stack


@dataclass(frozen=True)
class UprightHalfSpace(Body):
    """Such a half-space against a rigid body.

    pressed: gives u_n by p, and what couples p and q. sheared: gives u by q.
    Source: Turner (1980), Int. J. Solids Struct. 16, 409-419, for the contact modulus.
    """

    pressed: CombinedElasticity
    sheared: CombinedElasticity

    @classmethod
    def of(cls, stack: Stack, *, is_tire: bool = False) -> UprightHalfSpace:
        """Of the top layer of a stack; is_tire: as body 1."""
        normal, coupling, transverse, difference = half_space_compliance(stack, 0).tolist()
        side = -1 if is_tire else 1
        # In `CombinedElasticity` (1 - ν)/G is normal / 2 and K/G ± coupling / 2; of shear 1/G is transverse / 2, and
        # ν/G what a wave sees less along than across.
        return cls(
            CombinedElasticity(2 / normal, 0.0, side * coupling / normal),
            CombinedElasticity(2 / transverse, -difference / transverse, 0.0),
        )

    @property
    def contact_modulus(self) -> float:
        """E* of the half-space against a rigid body, Pa: 2 over its compliance to waves of pressure, times k."""
        return self.pressed.contact_modulus

    def normal(self, at: Offsets) -> Array:
        """As in `Body`."""
        return rectangle.normal_by_pressure(at.ny, at.nx, at.dx, at.dy, self.pressed, at.first)

    def tangential(self, at: Offsets) -> Array:
        """As in `Body`."""
        return rectangle.tangential_by_shear(at.ny, at.nx, at.dx, at.dy, self.sheared, at.first)

    def coupling(self, at: Offsets) -> Array:
        """As in `Body`."""
        return rectangle.coupling(at.ny, at.nx, at.dx, at.dy, self.pressed, at.first)

    def compliance(self, waves: Waves) -> Array:
        """As in `Body`."""
        scale, poisson = 2 / self.sheared.shear_modulus, self.sheared.poisson
        c, s = waves.cosine, waves.sine
        shear = [scale * (1 - poisson * c**2), scale * (1 - poisson * s**2), -scale * poisson * c * s]
        return np.array([np.full_like(c, 2 / self.contact_modulus), *shear])

    def normal_compliance(self, waves: Waves) -> Array:
        """As in `Body`: the same for every wave."""
        return np.asarray(2 / self.contact_modulus)

    def across(self, k: Array) -> Array:
        """As in `Body`."""
        parts = 2 / self.pressed.shear_modulus * np.array([1.0, self.pressed.difference])
        return np.multiply.outer(parts, np.ones_like(k))
