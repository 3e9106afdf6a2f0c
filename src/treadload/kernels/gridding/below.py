"""Stress in rows below the cells of a surface under a pressure on these, by transforms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.fft import irfft2, next_fast_len, rfft2


@dataclass(frozen=True, eq=False)
class Below:
    """Stress of pressure on cells. shape: (ny, nx). waves: cells of a period along y and x.
    spectrum: (6, nz, my, mx // 2 + 1), of the stress under one cell.
    """

    shape: tuple[int, int]
    waves: tuple[int, int]
    spectrum: ComplexArray

    @classmethod
    def of(cls, kernel: Array) -> Below:
        """kernel: stress (6, nz, 2 ny - 1, 2 nx - 1) under a pressure of 1 on the middle one of so many cells."""
        rows, columns = kernel.shape[-2:]
        waves = int(next_fast_len(rows)), int(next_fast_len(columns, real=True))
        spectrum: ComplexArray = rfft2(kernel, s=waves)
        return cls(((rows + 1) // 2, (columns + 1) // 2), waves, spectrum)

    def __call__(self, pressure: Array) -> Array:
        """Stress (6, nz, ny, nx), Pa, of a pressure (ny, nx), Pa."""
        ny, nx = self.shape
        whole = irfft2(self.spectrum * rfft2(pressure, s=self.waves), s=self.waves)
        # Of what comes round nothing falls on the last ny rows and nx columns of the kernel's first 2 n - 1.
        stress: Array = np.ascontiguousarray(whole[..., ny - 1 : 2 * ny - 1, nx - 1 : 2 * nx - 1])
        return stress
