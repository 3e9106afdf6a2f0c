"""Kernels of a pair of bodies in the Fourier space of padded cells, by the parities that they have."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from treadload.contact.bodies.body import Body, Offsets
from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.gridding.convolution import Padding


@dataclass(frozen=True, eq=False)
class KernelSpectra:
    """Spectra of the kernels of a pair of bodies on cells of dx by dy, m. Signs as in `contact.bodies.body`."""

    pair: Body
    dx: float
    dy: float

    def tangential(self, padding: Padding) -> Array | ComplexArray:
        """Displacement difference by shear, m/Pa: xx, yy, xy (3, my, mx // 2 + 1); yx as well of a tilted grain."""
        symbols = self.on(padding, self.pair.tangential, ((1, 1), (1, 1), (-1, -1)))
        return symbols if self.pair.mirrored else _leaning(symbols, self._tilted(padding)[0])

    def coupling(self, padding: Padding) -> tuple[Array | ComplexArray, ...]:
        """(2, my, mx // 2 + 1) of u_n by q and of u by p, m/Pa."""
        k = self.on(padding, self.pair.coupling, ((-1, 1), (1, -1)))
        if self.pair.mirrored:
            return k, -k
        e = self._tilted(padding)[1:]
        return k + e, e - k

    def tangential_ahead(self, padding: Padding, distance: float) -> ComplexArray:
        """`tangential` at a distance ahead of the cells along x, m."""
        symbols = self.ahead(padding, self.pair.tangential, (1, 1, -1), distance)
        if self.pair.mirrored:
            return symbols
        return _leaning(symbols, self.ahead(padding, self.pair.tilted, (1, 1, 1), distance)[0])

    def coupling_ahead(self, padding: Padding, distance: float) -> tuple[ComplexArray, ComplexArray]:
        """`coupling` at a distance ahead of the cells along x, m."""
        k = self.ahead(padding, self.pair.coupling, (1, -1), distance)
        if self.pair.mirrored:
            return k, -k
        e = self.ahead(padding, self.pair.tilted, (1, 1, 1), distance)[1:]
        return k + e, e - k

    def _tilted(self, padding: Padding) -> Array | ComplexArray:
        """(3, my, mx // 2 + 1) of a, e_x, e_y, m/Pa."""
        return self.on(padding, self.pair.tilted, ((-1, 1), (1, 1), (1, 1)))

    def on(
        self, padding: Padding, kernels: Callable[[Offsets], Array], parities: tuple[tuple[int, int], ...]
    ) -> Array | ComplexArray:
        """Spectra of kernels with these parities along x and y, +1 even, -1 odd; along y only if not symmetric.

        Of pairs that are not mirrored only the product of both parities is what the kernels have.
        """
        if not self.pair.symmetric:
            return self.ahead(padding, kernels, tuple(along_y for _, along_y in parities))
        if not self.pair.mirrored:
            whole = padding.spectrum(self.wrapped(padding, kernels, 0.0))
            # Half way round, where plus and minus meet, no pair of cells is: the parity holds there, too.
            return np.array(
                [term.real if x == y else 1j * term.imag for term, (x, y) in zip(whole, parities, strict=True)]
            )
        quadrants = kernels(Offsets(*padding.quadrant, self.dx, self.dy))
        if all(along_x == along_y for along_x, along_y in parities):
            # Even in both directions, or odd in both: real. Columns lie side by side.
            spectra = [
                (padding.even_spectrum if along > 0 else padding.odd_spectrum)(quadrant).T
                for quadrant, (along, _) in zip(quadrants, parities, strict=True)
            ]
            return np.array(spectra).transpose(0, 2, 1)
        wrapped = zip(quadrants, parities, strict=True)
        return np.array([padding.spectrum(padding.wrap(quadrant, *parity)) for quadrant, parity in wrapped])

    def ahead(
        self, padding: Padding, kernels: Callable[[Offsets], Array], parities: tuple[int, ...], distance: float = 0.0
    ) -> ComplexArray:
        """Spectra of kernels that have a parity along y only, at a distance ahead of the cells' centres, m."""
        if not self.pair.mirrored:
            return padding.spectrum(self.wrapped(padding, kernels, distance))
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

    def wrapped(self, padding: Padding, kernels: Callable[[Offsets], Array], distance: float) -> Array:
        """Kernels (…, my, mx) without parities on the wrapped offsets, at a distance ahead of the cells, m."""
        behind_y, behind_x = (m - 1 - m // 2 for m in padding.shape)
        at = Offsets(*padding.shape, self.dx, self.dy, distance - behind_x * self.dx, -behind_y * self.dy)
        return np.roll(kernels(at), (-behind_y, -behind_x), axis=(-2, -1))


def _leaning(symbols: Array | ComplexArray, a: Array | ComplexArray) -> ComplexArray:
    """xx, yy, xy, yx of the displacement by shear with what a tilted grain adds."""
    xx, yy, xy = symbols
    return np.array([xx, yy, xy + a, xy - a])
