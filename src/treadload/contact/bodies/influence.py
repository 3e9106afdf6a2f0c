"""Two bodies on a grid: the influence operators of their surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.gridding.convolution import Convolution, Padding
from treadload.kernels.half_space import rectangle
from treadload.kernels.half_space.rectangle import CombinedElasticity


@dataclass(frozen=True)
class Influence:
    """Influence operators of two half-spaces on a piece of (ny, nx) cells of dx by dy, m.

    Operators are built when first asked for and kept. Signs as in `kernels.half_space.rectangle`: q acts on body 1.
    """

    shape: tuple[int, int]
    dx: float
    dy: float
    bodies: CombinedElasticity

    @cached_property
    def padding(self) -> Padding:
        """Padded space in which the field has the cells of the load."""
        return Padding.of(self.shape)

    @cached_property
    def rolling_padding(self) -> Padding:
        """Padded space in which the field has one column more, ahead of the leading edge."""
        return Padding.of(self.shape, (self.shape[0], self.shape[1] + 1))

    @property
    def symmetric(self) -> bool:
        """True if loads work on each other's displacements alike, as in elastic bodies."""
        return True

    @property
    def dundurs(self) -> float:
        """Dundurs' β: how strongly pressure and shear are coupled."""
        return self.bodies.dundurs

    @cached_property
    def normal(self) -> Convolution:
        """Gap opening by pressure, m/Pa."""
        quadrant = self._by_pressure(*self.padding.quadrant)
        return Convolution.of_kernel(self.padding, self.padding.wrap(quadrant), even=True)

    def tangential(self, padding: Padding) -> Array | ComplexArray:
        """Symbols (3, my, mx // 2 + 1) of the displacement difference by shear, m/Pa: xx, yy, xy.

        Real for symmetric operators.
        """
        xx, yy, xy = self._by_shear(*padding.quadrant)
        wrapped = padding.wrap(xx), padding.wrap(yy), padding.wrap(xy, -1, -1)
        return np.array([padding.spectrum(kernel).real for kernel in wrapped])

    def self_influence(self, *, rolls: bool) -> float:
        """Displacement difference u_x of a cell by a unit shear on itself, m/Pa; u_x(x) - u_x(x + dx) if it rolls."""
        xx = self._by_shear(1, 2)[0]
        return float(xx[0, 0] - xx[0, 1]) if rolls else float(xx[0, 0])

    @cached_property
    def normal_stiffness(self) -> Array | ComplexArray:
        """About the inverse of `normal`: its symbol (ny, nx // 2 + 1) on the unpadded, periodic grid, Pa/m."""
        return stiffness_symbol(self.shape, self.dx, self.dy, self.bodies.contact_modulus)

    @cached_property
    def tangential_stiffness(self) -> Array | ComplexArray:
        """About the inverse of `tangential`: symbols (3, ny, nx // 2 + 1) as above, Pa/m: xx, yy, xy."""
        return tangential_stiffness_symbols(self.shape, self.dx, self.dy, self.bodies)

    def gap_by_shear(self, shear: Array) -> Array:
        """Gap opening (ny, nx), m, by shear (2, ny, nx) on body 1, Pa: zero for like bodies."""
        spectra = self.padding.forward(shear)
        return self.padding.inverse((self._coupling(self.padding) * spectra).sum(0))

    def slip_by_pressure(self, pressure: Array) -> Array:
        """u(x) - u(x + dx) (2, ny, nx), m, by pressure (ny, nx), Pa: zero for like bodies."""
        padding = self.rolling_padding
        u = padding.inverse(-self._coupling(padding) * padding.forward(pressure))
        return u[..., :-1] - u[..., 1:]

    def displacement(self, pressure: Array, shear: Array) -> Array:
        """(u_x, u_y, u_n) (3, ny, nx), m, by pressure (ny, nx) and shear on body 1 (2, ny, nx), Pa."""
        p, (x, y) = self.padding.forward(pressure), self.padding.forward(shear)
        xx, yy, xy = self.tangential(self.padding)
        k_x, k_y = self._coupling(self.padding)
        spectra = [xx * x + xy * y - k_x * p, xy * x + yy * y - k_y * p, self.normal.spectrum * p + k_x * x + k_y * y]
        return self.padding.inverse(np.array(spectra))

    def _coupling(self, padding: Padding) -> ComplexArray:
        k_x, k_y = self._crosswise(*padding.quadrant)
        return np.array([padding.spectrum(padding.wrap(k_x, -1, 1)), padding.spectrum(padding.wrap(k_y, 1, -1))])

    def _by_pressure(self, ny: int, nx: int) -> Array:
        """u_n by p (ny, nx) at offsets 0, 1, 2, … of whole cells both ways, m/Pa; so the others below."""
        return rectangle.normal_by_pressure(ny, nx, self.dx, self.dy, self.bodies)

    def _by_shear(self, ny: int, nx: int) -> Array:
        """u_x by q_x, u_y by q_y, u_x by q_y = u_y by q_x: (3, ny, nx)."""
        return np.array(rectangle.tangential_by_shear(ny, nx, self.dx, self.dy, self.bodies))

    def _crosswise(self, ny: int, nx: int) -> Array:
        """k_x, k_y: (2, ny, nx), the coupling of pressure and shear."""
        return np.array(rectangle.coupling(ny, nx, self.dx, self.dy, self.bodies))


def stiffness_symbol(shape: tuple[int, int], dx: float, dy: float, contact_modulus: float) -> Array:
    """|k| E*/2 (ny, nx // 2 + 1) on the unpadded, periodic grid: the inverse of the normal compliance, Pa/m.

    Source: Johnson (1985), Contact Mechanics, section 13.2 (sinusoidal pressure on a half-space).
    """
    symbol: Array = 0.5 * contact_modulus * wavenumbers(shape, dx, dy)[0]
    return symbol


def tangential_stiffness_symbols(shape: tuple[int, int], dx: float, dy: float, bodies: CombinedElasticity) -> Array:
    """G|k|/2 (1 + ν/(1-ν) k kᵀ/k²) (3, ny, nx // 2 + 1), xx, yy, xy: the inverse tangential compliance, Pa/m.

    On the unpadded, periodic grid. Source: Johnson (1985), Contact Mechanics, section 3 (Cerruti).
    """
    k, cosine, sine = wavenumbers(shape, dx, dy)
    stiffness = 0.5 * bodies.shear_modulus * k
    ratio = bodies.poisson / (1 - bodies.poisson)
    return np.array(
        [stiffness * (1 + ratio * cosine**2), stiffness * (1 + ratio * sine**2), stiffness * ratio * cosine * sine]
    )


def wavenumbers(shape: tuple[int, int], dx: float, dy: float) -> tuple[Array, Array, Array]:
    """|k|, k_x/|k|, k_y/|k|; at k = 0 that of the finite patch: a uniform load on it is no rigid motion."""
    ny, nx = shape
    kx = 2 * np.pi * fft.rfftfreq(nx, dx)[None, :]
    ky = 2 * np.pi * fft.fftfreq(ny, dy)[:, None]
    k = np.hypot(kx, ky)
    short, long = sorted((nx * dx, ny * dy))
    # A uniform load sinks a long strip by the logarithm of its slenderness.
    k[0, 0] = np.pi / (short * (1 + np.log(long / short)))
    return k, kx / k, ky / k
