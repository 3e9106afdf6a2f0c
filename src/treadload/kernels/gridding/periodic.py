"""Convolution on cells that continue at their borders, repeated or mirrored: a factor for every wave.

Source: Stanley & Kato (1997), J. Tribol. 119, 481-485, for contact on waves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from treadload.kernels import fft
from treadload.kernels.arrays import Array


@dataclass(frozen=True)
class Endless:
    """Cells (ny, nx) of dx by dy, m, that continue for ever. mirrored: in their borders; else they repeat."""

    shape: tuple[int, int]
    dx: float
    dy: float
    mirrored: bool = False

    @property
    def waves(self) -> Array:
        """|k|, 1/m, as the transform orders them; zero for the mean."""
        ny, nx = self.shape
        if self.mirrored:
            along, across = np.pi * np.arange(nx) / (nx * self.dx), np.pi * np.arange(ny) / (ny * self.dy)
        else:
            along, across = 2 * np.pi * fft.rfftfreq(nx, self.dx), 2 * np.pi * fft.fftfreq(ny, self.dy)
        return np.asarray(np.hypot(along[None, :], across[:, None]))

    def operator(self, symbol: Array) -> Callable[[Array], Array]:
        """The product with a field (ny, nx) that has this factor for every wave."""

        def apply(field: Array) -> Array:
            if self.mirrored:
                through: Array = fft.mirrored_waves(fft.mirrored_waves(field) * symbol, back=True)
                return through
            whole: Array = fft.irfft2(fft.rfft2(field) * symbol, s=self.shape)
            return whole

        return apply
