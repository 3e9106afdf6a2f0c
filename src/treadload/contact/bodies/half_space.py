"""Elastic half-spaces, one or the two of a pair."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from treadload.contact.bodies.body import Body, Offsets, Waves
from treadload.kernels.arrays import Array
from treadload.kernels.half_space import rectangle
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.materials import Elastic

RIGID = (math.inf, 0.0)


@dataclass(frozen=True)
class HalfSpaces(Body):
    """Elastic half-spaces seen as one. elasticity: of both, or of one against a rigid body.

    Sources: those of `kernels.half_space.rectangle`; Johnson (1985), Contact Mechanics, sections 3 and 13.2 (waves).
    """

    elasticity: CombinedElasticity

    @classmethod
    def of(cls, tire: Elastic | None, road: Elastic | None) -> HalfSpaces:
        """Of a material on each side, body 1 and body 2; None is rigid."""
        return cls(combined(tire, road))

    def normal(self, at: Offsets) -> Array:
        """As in `Body`."""
        return rectangle.normal_by_pressure(at.ny, at.nx, at.dx, at.dy, self.elasticity, at.first)

    def tangential(self, at: Offsets) -> Array:
        """As in `Body`."""
        return rectangle.tangential_by_shear(at.ny, at.nx, at.dx, at.dy, self.elasticity, at.first)

    def coupling(self, at: Offsets) -> Array:
        """As in `Body`."""
        if self.elasticity.difference == 0:
            return np.zeros((2, at.ny, at.nx))
        return rectangle.coupling(at.ny, at.nx, at.dx, at.dy, self.elasticity, at.first)

    def compliance(self, waves: Waves) -> Array:
        """As in `Body`."""
        scale, poisson = 2 / self.elasticity.shear_modulus, self.elasticity.poisson
        c, s = waves.cosine, waves.sine
        parts = [np.full_like(c, 1 - poisson), 1 - poisson * c**2, 1 - poisson * s**2, -poisson * c * s]
        return np.asarray(scale * np.array(parts))

    def normal_compliance(self, waves: Waves) -> Array:
        """As in `Body`: the same for every wave."""
        return np.asarray(2 / self.elasticity.contact_modulus)

    def across(self, k: Array) -> Array:
        """As in `Body`."""
        parts = np.array([1 - self.elasticity.poisson, self.elasticity.difference])
        return np.multiply.outer(2 / self.elasticity.shear_modulus * parts, np.ones_like(k))

    def joined(self, body: Body) -> HalfSpaces | None:
        """With other half-spaces: their compliances add up."""
        if not isinstance(body, HalfSpaces):
            return None
        first, two = self.elasticity, body.elasticity
        # 2/G, 2ν/G and 4K/G are sums over the bodies, see `CombinedElasticity`.
        shear = 1 / (1 / first.shear_modulus + 1 / two.shear_modulus)
        poisson = shear * (first.poisson / first.shear_modulus + two.poisson / two.shear_modulus)
        difference = shear * (first.difference / first.shear_modulus + two.difference / two.shear_modulus)
        return HalfSpaces(CombinedElasticity(shear, poisson, difference))


def combined(tire: Elastic | None, road: Elastic | None) -> CombinedElasticity:
    """The elasticity of two half-spaces seen as one; None is rigid."""
    tire_side, road_side = (RIGID if side is None else (side.shear_modulus, side.poisson) for side in (tire, road))
    return CombinedElasticity.of(*tire_side, *road_side)
