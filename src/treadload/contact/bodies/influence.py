"""Two bodies on a grid: the influence operators of their surfaces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import DTypeLike

from treadload.contact.bodies.body import Body, Offsets, Waves
from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.gridding.convolution import Convolution, Padding

# Waves that a patch holds, at which the coupling of pressure and shear is looked at.
_WAVES = 64


@dataclass(frozen=True)
class Influence:
    """Influence operators of two bodies on a piece of (ny, nx) cells of dx by dy, m.

    pair: both bodies, a `contact.bodies.body.Sum` or half-spaces seen as one. Operators are built when first asked
    for and kept. Signs as in `contact.bodies.body`: q acts on body 1.
    """

    shape: tuple[int, int]
    dx: float
    dy: float
    pair: Body

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
        return self.pair.symmetric

    @cached_property
    def dundurs(self) -> float:
        """Dundurs' β: coupling over normal compliance, the largest of the waves that the patch holds."""
        longest = np.pi / np.hypot(self.shape[0] * self.dy, self.shape[1] * self.dx)
        normal, coupling = self.pair.across(np.geomspace(longest, np.pi / min(self.dx, self.dy), _WAVES))
        ratio = coupling / normal
        return float(ratio[np.argmax(np.abs(ratio))])

    @property
    def coupled(self) -> bool:
        """True if pressure makes the bodies slip and shear opens the gap."""
        return self.dundurs != 0

    @cached_property
    def normal(self) -> Convolution:
        """Gap opening by pressure, m/Pa."""
        if self.symmetric:
            return Convolution(self.padding, self.padding.even_spectrum(self._normal_quadrant))
        return Convolution(
            self.padding, self._spectra_of(self.padding, lambda at: self.pair.normal(at)[None], (1,))[0]
        )

    def normal_on(self, shape: tuple[int, int], real: DTypeLike) -> Convolution:
        """`normal` of a symmetric pair on a part of (ny, nx) cells, in a precision."""
        padding = Padding.of(shape)
        rows, columns = padding.quadrant
        spectrum = padding.even_spectrum(self._normal_quadrant[:rows, :columns].astype(real))
        return Convolution(padding, spectrum)

    def normal_stiffness_on(self, shape: tuple[int, int], real: DTypeLike) -> Array:
        """`normal_stiffness` of a symmetric pair on periodic (ny, nx) cells, in a precision."""
        waves = Waves(shape, self.dx, self.dy)
        return np.asarray(waves.k / self.pair.normal_compliance(waves), real)

    @property
    def normal_self_influence(self) -> float:
        """Gap opening of a cell by a unit pressure on itself, m/Pa."""
        return float(self.pair.normal(Offsets(1, 1, self.dx, self.dy))[0, 0])

    def tangential(self, padding: Padding) -> Array | ComplexArray:
        """Symbols (3, my, mx // 2 + 1) of the displacement difference by shear, m/Pa: xx, yy, xy.

        Real for symmetric operators. Raises InputError where a body drifts under shear.
        """
        return self._spectra(padding, self.pair.tangential, ((1, 1), (1, 1), (-1, -1)))

    def self_influence(self, *, rolls: bool) -> float:
        """Displacement difference u_x of a cell by a unit shear on itself, m/Pa; u_x(x) - u_x(x + dx) if it rolls."""
        xx = self.pair.tangential(Offsets(1, 2, self.dx, self.dy))[0, 0]
        return float(xx[0] - xx[1]) if rolls else float(xx[0])

    @cached_property
    def normal_stiffness(self) -> Array | ComplexArray:
        """About the inverse of `normal`: its symbol (ny, nx // 2 + 1) on the unpadded, periodic grid, Pa/m."""
        return np.asarray(self._waves.k / self.pair.normal_compliance(self._waves))

    @cached_property
    def tangential_stiffness(self) -> Array | ComplexArray:
        """About the inverse of `tangential`: symbols (3, ny, nx // 2 + 1) as above, Pa/m: xx, yy, xy."""
        _, xx, yy, xy = self._compliance
        return np.asarray(self._waves.k * np.array([yy, xx, -xy]) / (xx * yy - xy * xy))

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
        """(u_x, u_y, u_n) (3, ny, nx), m, by pressure (ny, nx) and shear on body 1 (2, ny, nx), Pa.

        Raises InputError for shear where a body drifts under it.
        """
        p = self.padding.forward(pressure)
        k_x, k_y = self._coupling(self.padding)
        spectra = np.array([-k_x * p, -k_y * p, self.normal.spectrum * p])
        if shear.any():
            x, y = self.padding.forward(shear)
            xx, yy, xy = self.tangential(self.padding)
            spectra += np.array([xx * x + xy * y, xy * x + yy * y, k_x * x + k_y * y])
        return self.padding.inverse(spectra)

    def tangential_ahead(self, distance: float) -> ComplexArray:
        """`tangential` at a distance ahead of the cells along x, m, in `padding`."""
        return self._spectra_of(self.padding, self.pair.tangential, (1, 1, -1), distance)

    def coupling_ahead(self, distance: float) -> ComplexArray:
        """Symbols k_x, k_y at a distance ahead of the cells along x, m, in `padding`."""
        return self._spectra_of(self.padding, self.pair.coupling, (1, -1), distance)

    @cached_property
    def _normal_quadrant(self) -> Array:
        """The kernel of `normal` at the offsets of `Padding.quadrant`."""
        return self.pair.normal(Offsets(*self.padding.quadrant, self.dx, self.dy))

    @cached_property
    def _waves(self) -> Waves:
        return Waves(self.shape, self.dx, self.dy)

    @cached_property
    def _compliance(self) -> Array | ComplexArray:
        return self.pair.compliance(self._waves)

    def _coupling(self, padding: Padding) -> Array | ComplexArray:
        return self._spectra(padding, self.pair.coupling, ((-1, 1), (1, -1)))

    def _spectra(
        self, padding: Padding, kernels: Callable[[Offsets], Array], parities: tuple[tuple[int, int], ...]
    ) -> Array | ComplexArray:
        """Spectra of kernels with these parities along x and y, +1 even, -1 odd; along y only if not symmetric."""
        if not self.symmetric:
            return self._spectra_of(padding, kernels, tuple(along_y for _, along_y in parities))
        quadrants = kernels(Offsets(*padding.quadrant, self.dx, self.dy))
        spectra = [
            padding.spectrum(padding.wrap(quadrant, *parity))
            for quadrant, parity in zip(quadrants, parities, strict=True)
        ]
        # Even in both directions, or odd in both.
        real = all(along_x == along_y for along_x, along_y in parities)
        return np.array([spectrum.real for spectrum in spectra] if real else spectra)

    def _spectra_of(
        self, padding: Padding, kernels: Callable[[Offsets], Array], parities: tuple[int, ...], distance: float = 0.0
    ) -> ComplexArray:
        """Spectra of kernels that have a parity along y only, at a distance ahead of the cells' centres, m."""
        my, mx = padding.shape
        behind = mx - 1 - mx // 2
        at = Offsets(my // 2 + 1, mx, self.dx, self.dy, distance - behind * self.dx)
        offset = fft.fftfreq(my, 1 / my).round().astype(int)
        spectra = []
        for half, parity in zip(kernels(at), parities, strict=True):
            # Half way round, plus and minus meet: an odd kernel has no value there.
            sign = np.where(offset < 0, parity, 1) * np.where((2 * np.abs(offset) == my) & (parity < 0), 0, 1)
            spectra.append(padding.spectrum(np.roll(half, -behind, axis=-1)[np.abs(offset)] * sign[:, None]))
        return np.array(spectra)
