"""A tread layer on an inflated belt: the surface of a tire that is more than a half-space.

The layer gives way as on a rigid base; the belt under it deflects and, turning with its slope, carries the surface of
the tread along. Formulas in `kernels.belt`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from treadload.contact.bodies.body import Body, Offsets, Sum, Waves
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.layers import Layering, images_of
from treadload.contact.bodies.ribs import Ribs
from treadload.contact.bodies.viscoelastic import of_material
from treadload.kernels import belt as belting
from treadload.kernels.arrays import Array
from treadload.kernels.belt import Sheet
from treadload.kernels.layers.layered import Stack
from treadload.materials import Elastic
from treadload.tire.belt import InflatedBelt, LateralBelt

# Directions over which a coupling that differs along and across is averaged.
_DIRECTIONS = 16
# Treads whose fitted images are kept: only with the same images are bodies of equal tires equal and share operators.
_KEPT = 8


@dataclass(frozen=True)
class BeltSheet(Body):
    """The belt of a tire, body 1, with the surface of its tread at an arm. sheet: as in `kernels.belt`."""

    sheet: Sheet

    def normal(self, at: Offsets) -> Array:
        """As in `Body`."""
        return np.asarray(self._kernels(at)[0])

    def tangential(self, at: Offsets) -> Array:
        """As in `Body`."""
        return np.asarray(self._kernels(at)[1:4])

    def coupling(self, at: Offsets) -> Array:
        """As in `Body`."""
        return np.asarray(self._kernels(at)[4:])

    def compliance(self, waves: Waves) -> Array:
        """As in `Body`."""
        kx, ky = waves.k * waves.cosine, waves.k * waves.sine
        per_wave = waves.k / self.sheet.stiffness(kx, ky)
        arm = self.sheet.arm
        return np.asarray(per_wave * np.array([np.ones_like(kx), *(arm**2 * np.array([kx * kx, ky * ky, kx * ky]))]))

    def across(self, k: Array) -> Array:
        """As in `Body`, averaged over directions."""
        angle = np.pi / (2 * _DIRECTIONS) * (np.arange(_DIRECTIONS) + 0.5)
        stiffness = self.sheet.stiffness(np.multiply.outer(np.cos(angle), k), np.multiply.outer(np.sin(angle), k))
        normal = k * (1 / stiffness).mean(0)
        return np.array([normal, self.sheet.arm * k * normal])

    def _kernels(self, at: Offsets) -> Array:
        return belting.coefficients(self.sheet, at.ny, at.nx, at.dx, at.dy, at.first)


@dataclass(frozen=True)
class BeltString(Body):
    """The belt's motion sideways as a whole. lateral: its foundation and length."""

    lateral: LateralBelt

    def normal(self, at: Offsets) -> Array:
        """As in `Body`: none."""
        return np.zeros((at.ny, at.nx))

    def tangential(self, at: Offsets) -> Array:
        """As in `Body`."""
        moved = np.zeros((3, at.ny, at.nx))
        moved[1] = belting.string(self.lateral.stiffness, self.lateral.length, at.x, at.dx, at.dy)
        return moved

    def coupling(self, at: Offsets) -> Array:
        """As in `Body`: none."""
        return np.zeros((2, at.ny, at.nx))

    def compliance(self, waves: Waves) -> Array:
        """As in `Body`: it answers to the waves along x alone."""
        moved = np.zeros((4, *waves.k.shape))
        kx, width = (waves.k * waves.cosine)[0], waves.shape[0] * waves.dy
        moved[2, 0] = waves.k[0] * width / (self.lateral.stiffness * (1 + np.square(kx * self.lateral.length)))
        return moved

    def across(self, k: Array) -> Array:
        """As in `Body`: none."""
        return np.zeros((2, *k.shape))


def belt_surface(inflated: InflatedBelt, speed: float | None = None) -> Body:
    """The surface of a tire on a belt, body 1, rolling at a speed, m/s.

    Raises InputError for a viscoelastic tread without a speed, ConvergenceError as `images_of`.
    """
    belt = inflated.belt

    def tread(material: Elastic) -> Body:
        return _on_rigid_base(material, belt.tread_thickness)

    def surface(material: Elastic) -> Body:
        layer = tread(material)
        return Ribs(inflated.ribs, material, layer) if inflated.ribs else layer

    rubber = of_material(belt.tread, surface, is_tire=True, speed=speed)
    parts = [rubber, BeltSheet(inflated.sheet)]
    if belt.lateral is not None:
        parts.append(BeltString(belt.lateral))
    return Sum.of(*parts)


@lru_cache(maxsize=_KEPT)
def _on_rigid_base(material: Elastic, thickness: float) -> Body:
    """A layer of a tread, thickness in m, on a rigid base: body 1."""
    stack = Stack([material.shear_modulus], [material.poisson], [thickness], [], rigid=True)
    return Sum.of(HalfSpaces.of(material, None), Layering(images_of(stack), is_tire=True))
