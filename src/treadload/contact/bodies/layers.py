"""Layers of a road: what they add to the half-space of their top layer, by images of the load.

See `kernels.layers.images`. Under a soft tire that is next to nothing: see `road_share`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.contact.bodies.body import Body, Offsets, Sum, Waves
from treadload.contact.bodies.half_space import RIGID, HalfSpaces
from treadload.contact.bodies.upright import UprightHalfSpace
from treadload.errors import ConvergenceError, InputError
from treadload.kernels.arrays import Array
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.kernels.layers import images as imaging
from treadload.kernels.layers.images import Images, surface_compliance
from treadload.kernels.layers.layered import Stack

# Of the images' fit, which is below 1e-6 for roads.
_WORST_FIT = 1e-4
# Wavenumbers times radius at which the mean sinking under a disc is summed up; beyond lie 1e-5 of it.
_LONGEST_WAVE, _SHORTEST_WAVE = 1e-6, 200.0


@dataclass(frozen=True)
class Layering(Body):
    """What layers change of the half-space of their top one.

    images: see `images_of`. is_tire: True of body 1, False of the road, body 2.
    """

    images: Images
    is_tire: bool = False

    def normal(self, at: Offsets) -> Array:
        """As in `Body`."""
        return np.asarray(self._images(at)[0])

    def tangential(self, at: Offsets) -> Array:
        """As in `Body`."""
        self.check_shear()
        return self._images(at)[1:4]

    def coupling(self, at: Offsets) -> Array:
        """As in `Body`: u = u1 - u2, so that the road's own displacement by pressure counts against the tire's."""
        return np.asarray(self._side * self._images(at)[4:])

    def compliance(self, waves: Waves) -> Array:
        """As in `Body`."""
        normal, _, transverse, difference = self.images.at(waves.k)
        c, s = waves.cosine, waves.sine
        return np.array([normal, transverse + difference * c**2, transverse + difference * s**2, difference * c * s])

    def across(self, k: Array) -> Array:
        """As in `Body`."""
        normal, coupling = self.images.at(k)[:2]
        return np.array([normal, self._side * coupling])

    def check_shear(self) -> None:
        """Refuse shear above a frictionless interface. Raises InputError."""
        if not self.images.bonded:
            raise InputError(
                "a frictionless interface lets the layers above it drift under shear without limit: their compliance "
                "has no bound; give the bond a stiffness, such as Bond(stiffness=1e8), or the contact friction = 0"
            )

    @property
    def stats(self) -> Mapping[str, object]:
        """Residual of the images' fit, relative."""
        return {"images_residual": self.images.residual}

    @property
    def _side(self) -> int:
        return -1 if self.is_tire else 1

    def _images(self, at: Offsets) -> Array:
        return imaging.coefficients(self.images, at.ny, at.nx, at.dx, at.dy, at.first)


def layered_road(stack: Stack) -> Body:
    """A road of layers, body 2. Raises ConvergenceError as `images_of`."""
    top: Body
    if stack.upright_of(0) is None:
        top = HalfSpaces(CombinedElasticity.of(*RIGID, float(stack.shear[0]), stack.poisson[0]))
    else:
        top = UprightHalfSpace.of(stack)
    return Sum.of(top, Layering(images_of(stack)))


def images_of(stack: Stack) -> Images:
    """Images of a stack's layers. Raises ConvergenceError with the residual if none fit it."""
    images = imaging.fit_images(stack)
    if not images.residual <= _WORST_FIT:
        raise ConvergenceError(
            f"the surface compliance of the layers was fitted with an error of {images.residual:.1e} of the whole, "
            f"above {_WORST_FIT:g}: moduli or thicknesses lie too far apart; leave out the thinnest layer or take "
            "the road as a half-space",
            images.residual,
        )
    return images


@dataclass(frozen=True)
class RoadShare:
    """How much each body yields under a disc as large as the contact: mean sinking, m per Pa of uniform pressure.

    tire, road: of the tire and of the road with its layers. top: of the road as a half-space of its top layer's
    material.
    """

    tire: float
    road: float
    top: float

    @property
    def share(self) -> float:
        """Part of the road in the compliance of both."""
        return self.road / (self.tire + self.road)

    @property
    def layering(self) -> float:
        """Relative change of the compliance of both by the layers, against the half-space of the top layer."""
        return (self.road - self.top) / (self.tire + self.top)


def road_share(tire: Body, stack: Stack, area: float) -> RoadShare:
    """Compliance of tire and layers under a uniform pressure on a disc of an area, m².

    By Parseval's theorem the mean sinking is 2 ∫ k·u_z(k) (J1(k a)/k)² dk.
    """
    at, weight, radius = _disc_waves(area)
    road = float(weight @ surface_compliance(at / radius, stack)[0])
    top = float(weight.sum()) * imaging.half_space_compliance(stack, 0)[0]
    return RoadShare(float(weight @ tire.at_rest.across(at / radius)[0]), road, top)


def half_space_share(tire: Body, road: Body, area: float) -> RoadShare:
    """Compliance of a tire and of a road without layers, as in `road_share`; the mean over directions."""
    at, weight, radius = _disc_waves(area)
    mean = float(weight @ road.at_rest.across(at / radius)[0])
    return RoadShare(float(weight @ tire.at_rest.across(at / radius)[0]), mean, mean)


def _disc_waves(area: float) -> tuple[Array, Array, float]:
    """Wavenumbers times the radius of a disc of an area, m², their weights in its mean sinking, and the radius, m."""
    radius = float(np.sqrt(area / np.pi))
    nodes, weights = np.polynomial.legendre.leggauss(8)
    edges = np.concatenate([np.geomspace(_LONGEST_WAVE, 1.0, 25), np.arange(2.0, _SHORTEST_WAVE + 1, 2.0)])
    half = np.diff(edges) / 2
    at = (edges[:-1, None] + half[:, None] * (1 + nodes)).ravel()
    weight = (half[:, None] * weights).ravel() * 2 * radius * (scipy.special.j1(at) / at) ** 2
    return at, weight, radius
