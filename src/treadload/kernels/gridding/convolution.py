"""Linear convolution of gridded loads with influence coefficients by zero-padded FFT (DC-FFT).

The rows that the padding adds are zero on the way in and unwanted on the way out; both are pruned.

Source: Liu, Wang & Liu (2000), Wear 243, 101-111 (discrete convolution and FFT).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray

Mix = Callable[[list[ComplexArray], slice], list[ComplexArray]]
Along = Callable[[list[ComplexArray]], list[ComplexArray]]


@dataclass(frozen=True)
class Padding:
    """Zero-padded Fourier space in which a product of spectra is a linear convolution.

    load_shape: (ny, nx) of the load. field_shape: (ny, nx) of the result.
    Where the field lies relative to the load is set by the kernel. Along each axis it is sampled at the offsets
    0 … n_field - 1 of a field cell from a load cell, then at whatever no pair has, then at -(n_load - 1) … -1.
    """

    load_shape: tuple[int, int]
    field_shape: tuple[int, int]

    @classmethod
    def of(cls, load_shape: tuple[int, int], field_shape: tuple[int, int] | None = None) -> Padding:
        """Padding for a load and a field of these shapes (ny, nx)."""
        return cls(load_shape, load_shape if field_shape is None else field_shape)

    @property
    def shape(self) -> tuple[int, int]:
        """Padded shape: load + field each way, rounded up to a fast FFT length that is even."""
        (ny, nx), (my, mx) = self.load_shape, self.field_shape
        half_y, half_x = -(-(ny + my) // 2), -(-(nx + mx) // 2)
        return 2 * int(fft.next_fast_len(half_y)), 2 * int(fft.next_fast_len(half_x, real=True))

    @property
    def quadrant(self) -> tuple[int, int]:
        """Offsets 0, 1, 2, … both ways (ky, kx) of which `wrap` wants the kernel: as far as they differ."""
        my, mx = self.shape
        return my // 2 + 1, mx // 2 + 1

    def wrap(self, quadrant: Array, parity_x: int = 1, parity_y: int = 1) -> Array:
        """Kernel (my, mx) on the wrapped offsets from its values (ky, kx) on `quadrant`.

        parity_x, parity_y: +1 for a kernel even in that direction, -1 for odd. The wrapped kernel keeps its
        parity, so that its spectrum is real when it is even in both directions or odd in both, and it has no
        jump half way round, so that a positive kernel nearly keeps a positive spectrum.
        """
        (my, mx) = self.shape
        jy, sign_y = _mirrored(my, parity_y)
        jx, sign_x = _mirrored(mx, parity_x)
        kernel: Array = quadrant[np.ix_(jy, jx)] * sign_y[:, None] * sign_x[None, :]
        return kernel

    def spectrum(self, kernel: Array) -> ComplexArray:
        """Spectrum (my, mx // 2 + 1) of a kernel (my, mx)."""
        spectrum: ComplexArray = fft.rfft2(kernel)
        return spectrum

    def even_spectrum(self, quadrant: Array) -> Array:
        """Spectrum (my, mx // 2 + 1), real, of a kernel even both ways, from its values (ky, kx) on `quadrant`."""
        half = fft.cosine2(np.ascontiguousarray(quadrant.T))
        # Columns lie side by side, as `Convolution` walks through them.
        return np.concatenate([half, half[:, -2:0:-1]], axis=1).T

    def odd_spectrum(self, quadrant: Array) -> Array:
        """`even_spectrum` of a kernel odd both ways; at offsets of none and of half way round it is taken as zero."""
        half = fft.sine2(np.ascontiguousarray(quadrant.T))
        return np.concatenate([half, -half[:, -2:0:-1]], axis=1).T

    def forward(self, load: Array) -> ComplexArray:
        """Spectrum (my, mx // 2 + 1) of a load (ny, nx) padded with zeros."""
        rows = fft.rfft(load, n=self.shape[1], axis=-1)
        spectrum: ComplexArray = fft.fft(rows, n=self.shape[0], axis=-2, overwrite_x=True)
        return spectrum

    def inverse(self, spectrum: ComplexArray) -> Array:
        """Field (ny, nx) of a spectrum: the inverse transform without its padding."""
        (ny, nx), (_, mx) = self.field_shape, self.shape
        rows = fft.ifft(spectrum, axis=-2)[..., :ny, :]
        field: Array = fft.irfft(rows, n=mx, axis=-1)[..., :nx]
        return field

    def through(self, loads: Sequence[Array], mix: Mix, along: Along | None = None) -> list[Array]:
        """Fields (ny, nx) under loads (ny, nx), as many, in nothing but the array API standard.

        mix: spectra of the fields from those of the loads, both turned round: (waves along x, my), of some of the
        waves along x. along: what the fields have besides, from the loads, both transformed along x alone: (waves
        along x, rows). The padded space is walked through a few lines at a time: it is never there as a whole.
        """
        xp, load = fft.namespace(loads[0]), loads[0]
        (loaded, _), (ny, nx), (my, mx) = load.shape, self.field_shape, self.shape
        kind = xp.complex64 if load.dtype == xp.float32 else xp.complex128
        # Waves along x are kept as rows, so that the lines across lie side by side.
        waves = [xp.empty((mx // 2 + 1, max(loaded, ny)), dtype=kind) for _ in loads]
        for into, load in zip(waves, loads, strict=True):
            for portion in fft.portions(load, loaded, mx):
                into[:, portion] = fft.rfft(load[portion, :], n=mx).T
        besides = along([wave[:, :loaded] for wave in waves]) if along else []
        for portion in fft.portions(load, mx // 2 + 1, my):
            mixed = mix([fft.fft(wave[portion, :loaded], n=my) for wave in waves], portion)
            for into, padded in zip(waves, mixed, strict=True):
                into[portion, :ny] = fft.ifft(padded, overwrite_x=True)[:, :ny]
        for into, more in zip(waves, besides, strict=bool(along)):
            into[:, :ny] += more
        fields = []
        for wave in waves:
            field: Array = xp.empty((ny, nx), dtype=load.dtype)
            for portion in fft.portions(load, ny, mx):
                field[portion, :] = fft.irfft(wave[:, portion].T, n=mx)[:, :nx]
            fields.append(field)
        return fields


@dataclass(frozen=True)
class Convolution:
    """A scalar influence operator: field = Σ kernel(cell - load cell) · load.

    padding: the padded space. spectrum: the kernel in it; real when the kernel is even. Of any array library, and
    in the precision that loads come in.
    """

    padding: Padding
    spectrum: ComplexArray | Array

    def __call__(self, load: Array, along: Along | None = None) -> Array:
        """Field (ny, nx) under a load (ny, nx), in nothing but the array API standard. along: as in `through`."""
        spectrum = self.spectrum.T

        def mix(waves: list[ComplexArray], part: slice) -> list[ComplexArray]:
            waves[0] *= spectrum[part, :]
            return waves

        return self.padding.through([load], mix, along)[0]


def _mirrored(n_padded: int, parity: int) -> tuple[Array, Array]:
    """Index into the quadrant and sign, for every wrapped offset."""
    offset = np.arange(n_padded)
    offset = np.where(2 * offset > n_padded, offset - n_padded, offset)
    # Half way round, plus and minus meet: an odd kernel has no value there.
    sign = np.where(offset < 0, parity, 1) * np.where((2 * offset == n_padded) & (parity < 0), 0, 1)
    return np.abs(offset), sign
