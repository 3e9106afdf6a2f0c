"""A tire on layers: the influence operators of a half-space against a layered road.

Everything is as in `contact.bodies.influence`, where the road is a half-space of its top layer; here images of the
load add what its layers change, see `kernels.layers.images`. For a soft tire that is next to nothing: `road_share`
tells.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import special

from treadload.contact.bodies.influence import Influence, wavenumbers
from treadload.errors import ConvergenceError, InputError
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.gridding.convolution import Padding
from treadload.kernels.layers import images as imaging
from treadload.kernels.layers.images import Images, surface_compliance
from treadload.kernels.layers.layered import Stack
from treadload.materials import Elastic

# Of the images' fit, which is below 1e-6 for roads.
_WORST_FIT = 1e-4
# Wavenumbers times radius at which the mean sinking under a disc is summed up; beyond lie 1e-5 of it.
_LONGEST_WAVE, _SHORTEST_WAVE = 1e-6, 200.0


@dataclass(frozen=True)
class LayeredInfluence(Influence):
    """Influence operators of a half-space, body 1, on layers, body 2, on a piece of (ny, nx) cells of dx by dy, m.

    bodies: body 1 and the top layer as half-spaces. images: what the layers change, see `images_of`.
    """

    images: Images

    @property
    def dundurs(self) -> float:
        """The largest Dundurs' β of the waves that the patch holds: coupling over normal compliance."""
        longest = np.pi / np.hypot(self.shape[0] * self.dy, self.shape[1] * self.dx)
        normal, coupling, *_ = self._compliance(np.geomspace(longest, np.pi / min(self.dx, self.dy), 64))
        ratio = coupling / normal
        return float(ratio[np.argmax(np.abs(ratio))])

    def tangential(self, padding: Padding) -> Array | ComplexArray:
        """Symbols (3, my, mx // 2 + 1) of the displacement difference by shear, m/Pa: xx, yy, xy.

        Raises InputError as `check_held`.
        """
        self.check_held()
        return super().tangential(padding)

    def check_held(self) -> None:
        """Refuse shear above a frictionless interface. Raises InputError."""
        if not self.images.held:
            raise InputError(
                "a frictionless interface lets the layers above it drift under shear without end: their compliance "
                "has no bound; give the bond a stiffness, such as Bond(stiffness=1e8), or the contact friction = 0"
            )

    @cached_property
    def normal_stiffness(self) -> Array:
        """About the inverse of `normal`: its symbol (ny, nx // 2 + 1) on the unpadded, periodic grid, Pa/m."""
        k = wavenumbers(self.shape, self.dx, self.dy)[0]
        return np.asarray(k / self._compliance(k)[0])

    @cached_property
    def tangential_stiffness(self) -> Array:
        """About the inverse of `tangential`: symbols (3, ny, nx // 2 + 1) as above, Pa/m: xx, yy, xy."""
        k, cosine, sine = wavenumbers(self.shape, self.dx, self.dy)
        _, _, transverse, difference = self._compliance(k)
        across, along = k / transverse, k / (transverse + difference)
        return np.array(
            [
                along * cosine**2 + across * sine**2,
                along * sine**2 + across * cosine**2,
                (along - across) * cosine * sine,
            ]
        )

    def displacement(self, pressure: Array, shear: Array) -> Array:
        """(u_x, u_y, u_n) (3, ny, nx), m, by pressure (ny, nx) and shear on body 1 (2, ny, nx), Pa."""
        if self.images.held or shear.any():
            return super().displacement(pressure, shear)
        # Nothing holds the top against shear, and there is none.
        p = self.padding.forward(pressure)
        k_x, k_y = self._coupling(self.padding)
        return self.padding.inverse(np.array([-k_x * p, -k_y * p, self.normal.spectrum * p]))

    def _by_pressure(self, ny: int, nx: int) -> Array:
        added = self._images(ny, nx)[0]
        return np.asarray(super()._by_pressure(ny, nx) + added)

    def _by_shear(self, ny: int, nx: int) -> Array:
        return np.asarray(super()._by_shear(ny, nx) + self._images(ny, nx)[1:4])

    def _crosswise(self, ny: int, nx: int) -> Array:
        # u = u1 - u2, so that the road's own displacement by pressure counts against that of the tire.
        return np.asarray(super()._crosswise(ny, nx) + self._images(ny, nx)[4:])

    def _images(self, ny: int, nx: int) -> Array:
        return imaging.coefficients(self.images, ny, nx, self.dx, self.dy)

    def _compliance(self, k: Array) -> Array:
        """Times k (…): of u_n by p, of k_x, of u_t by q_t, and of u_k by q_k less that: (4, …), 1/Pa."""
        bodies = self.bodies
        parts = np.array([1 - bodies.poisson, bodies.difference, 1.0, -bodies.poisson]) * (2 / bodies.shear_modulus)
        compliance: Array = self.images.at(k) + parts.reshape(4, *(1,) * np.ndim(k))
        return compliance


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
    """Who gives way under a disc as large as the contact: mean sinking, m per Pa of uniform pressure.

    tire, road: of the tire as a half-space and of the road with its layers. top: of the road as a half-space of
    its top layer's material.
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


def road_share(tire: Elastic, stack: Stack, area: float) -> RoadShare:
    """Compliance of tire and layers under a uniform pressure on a disc of an area, m².

    By Parseval's theorem the mean sinking is 2 ∫ k·u_z(k) (J1(k a)/k)² dk.
    """
    radius = float(np.sqrt(area / np.pi))
    nodes, weights = np.polynomial.legendre.leggauss(8)
    edges = np.concatenate([np.geomspace(_LONGEST_WAVE, 1.0, 25), np.arange(2.0, _SHORTEST_WAVE + 1, 2.0)])
    half = np.diff(edges) / 2
    at = (edges[:-1, None] + half[:, None] * (1 + nodes)).ravel()
    weight = (half[:, None] * weights).ravel() * 2 * radius * (special.j1(at) / at) ** 2
    road = float(weight @ surface_compliance(at / radius, stack)[0])
    mean = float(weight.sum())
    tire_alone = mean * (1 - tire.poisson) / tire.shear_modulus
    return RoadShare(tire_alone, road, mean * (1 - stack.poisson[0]) / stack.shear[0])
