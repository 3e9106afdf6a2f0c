"""Two bodies on a grid: the influence operators of their surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft

from treadload.kernels import rectangle
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.convolution import Convolution, Padding
from treadload.kernels.rectangle import CombinedElasticity


@dataclass(frozen=True)
class Influence:
    """Influence operators of two half-spaces on a piece of (ny, nx) cells of dx by dy, m.

    Operators are built when first asked for and kept. Signs as in `kernels.rectangle`: q acts on body 1.
    """

    shape: tuple[int, int]
    dx: float
    dy: float
    bodies: CombinedElasticity

    @cached_property
    def padding(self) -> Padding:
        """The padded space shared by all operators."""
        return Padding.of(self.shape)

    @cached_property
    def normal(self) -> Convolution:
        """Gap opening by pressure, m/Pa."""
        quadrant = rectangle.normal_by_pressure(*self.shape, self.dx, self.dy, self.bodies)
        return Convolution.of_kernel(self.padding, self.padding.wrap(quadrant), even=True)

    @property
    def self_influence(self) -> float:
        """Gap opening of a cell by a unit pressure on itself, m/Pa."""
        return float(rectangle.normal_by_pressure(1, 1, self.dx, self.dy, self.bodies)[0, 0])

    @cached_property
    def tangential(self) -> ComplexArray:
        """Spectrum (2, 2, my, mx // 2 + 1) of the displacement difference by shear, m/Pa."""
        return self._tangential_spectrum(shift=0)

    @cached_property
    def rolling(self) -> ComplexArray:
        """Spectrum (2, 2, my, mx // 2 + 1) of u(x) - u(x + dx) by shear, m/Pa."""
        return self.tangential - self._tangential_spectrum(shift=1)

    @property
    def rolling_self_influence(self) -> float:
        """u_x(x) - u_x(x + dx) of a cell by a unit shear on itself, m/Pa."""
        xx = rectangle.tangential_by_shear(1, 2, self.dx, self.dy, self.bodies)[0]
        return float(xx[0, 0] - xx[0, 1])

    def gap_by_shear(self, shear: Array) -> Array:
        """Gap opening (ny, nx), m, by shear (2, ny, nx) on body 1, Pa: zero for like bodies."""
        spectra = self.padding.forward(shear)
        return self.padding.inverse(self._coupling[0] * spectra[0] + self._coupling[1] * spectra[1])

    def slip_by_pressure(self, pressure: Array) -> Array:
        """u(x) - u(x + dx) (2, ny, nx), m, by pressure (ny, nx), Pa: zero for like bodies."""
        spectrum = self.padding.forward(pressure)
        shifted = -(self._coupling - self._coupling_spectrum(shift=1))
        return self.padding.inverse(shifted * spectrum)

    def displacement(self, pressure: Array, shear: Array) -> Array:
        """(u_x, u_y, u_n) (3, ny, nx), m, by pressure (ny, nx) and shear on body 1 (2, ny, nx), Pa."""
        p, q = self.padding.forward(pressure), self.padding.forward(shear)
        tangential = np.einsum("ij...,j...->i...", self.tangential, q) - self._coupling * p
        normal = self.normal.spectrum * p + np.einsum("j...,j...->...", self._coupling, q)
        return self.padding.inverse(np.concatenate([tangential, normal[None]]))

    def _tangential_spectrum(self, shift: int) -> ComplexArray:
        ny, nx = self.shape
        xx, yy, xy = rectangle.tangential_by_shear(ny, nx + 1, self.dx, self.dy, self.bodies)
        wrap = self.padding.wrap
        s_xx = self.padding.spectrum(wrap(xx, shift=shift))
        s_yy = self.padding.spectrum(wrap(yy, shift=shift))
        s_xy = self.padding.spectrum(wrap(xy, -1, -1, shift=shift))
        return np.array([[s_xx, s_xy], [s_xy, s_yy]])

    @cached_property
    def _coupling(self) -> ComplexArray:
        return self._coupling_spectrum(shift=0)

    def _coupling_spectrum(self, shift: int) -> ComplexArray:
        ny, nx = self.shape
        k_x, k_y = rectangle.coupling(ny, nx + 1, self.dx, self.dy, self.bodies)
        wrap = self.padding.wrap
        return np.array(
            [
                self.padding.spectrum(wrap(k_x, -1, 1, shift=shift)),
                self.padding.spectrum(wrap(k_y, 1, -1, shift=shift)),
            ]
        )


def stiffness_symbol(shape: tuple[int, int], dx: float, dy: float, contact_modulus: float) -> Array:
    """|k| E*/2 (ny, nx // 2 + 1) on the unpadded, periodic grid: the inverse of the normal compliance, Pa/m.

    The k = 0 mode takes half the stiffness of the longest wave: the patch is finite.
    Source: Johnson (1985), Contact Mechanics, section 13.2 (sinusoidal pressure on a half-space).
    """
    ny, nx = shape
    kx = 2 * np.pi * fft.rfftfreq(nx, dx)[None, :]
    ky = 2 * np.pi * fft.fftfreq(ny, dy)[:, None]
    k = np.hypot(kx, ky)
    k[0, 0] = np.pi / max(nx * dx, ny * dy)
    symbol: Array = 0.5 * contact_modulus * k
    return symbol
