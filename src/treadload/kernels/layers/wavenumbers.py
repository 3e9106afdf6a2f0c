"""Loads into wavenumbers and fields out of them, without a lattice: no periodic images, any output grid.

f(x, y) = (2π)⁻² ∬ F exp(i(kx x + ky y)) dkx dky by Gauss panels that shrink towards kx = 0 and ky = 0, where
the fields of a layered body are not smooth: 1/k, kx ky/k² and the like. Both transforms are products with
dense one-dimensional exponentials. Fields are real, so kx >= 0 serves; kernels depend on |k|, so each value
serves ky and -ky, distinguished as even and odd parts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
import scipy

from treadload.kernels.arrays import Array, ComplexArray, Values

# Panels start at this over the length of the problem; what lies below is 1e-9 of a field that falls as 1/k.
_SMALLEST = 1e-7
# Each panel is this many times as far from zero as the one before: Gauss converges like 3.7^(-2n) there.
_RATIO = 3.0
# Most radians that half a panel turns, and the points that resolve them with the layers' own features: 1e-10.
_PHASE, _POINTS = 7.0, 14
# Where every feature of the field is far larger than the panel, fewer points give the same.
_CALM, _LEAST_POINTS = 0.02, 8
# Interpolation in ln k: steps of this size with polynomials of this degree leave 1e-11, in single precision 1e-8.
_STEP, _DEGREE, _SINGLE_DEGREE = 0.15, 7, 5

Spectrum = Callable[[Array, Array], ComplexArray]
"""(kx, ky) → pressure, shear x, shear y (2, 3, nky, nkx): their parts even and odd in ky."""


def quadrature(limit: float, reach: float, length: float) -> tuple[Array, Array]:
    """Nodes and weights on (0, limit) for a transform.

    limit: largest wavenumber, 1/m. reach: largest distance between a loaded and an output point along this
    axis, m. length: the largest length in the field, m: the reach or the characteristic length of the layers.
    Returns nodes (n,), rising, and weights (n,), 1/m.
    """
    low, high = panels(limit, reach, length)
    nodes, weights = [], []
    for start, end in zip(low, high, strict=True):
        points, share = gauss(_LEAST_POINTS if end * length < _CALM else _POINTS)
        nodes.append(0.5 * (end - start) * points + 0.5 * (end + start))
        weights.append(0.5 * (end - start) * share)
    return np.concatenate(nodes), np.concatenate(weights)


def panels(limit: float, reach: float, length: float) -> tuple[Array, Array]:
    """First and last wavenumber of each panel, from 0 to the limit. Arguments as in `quadrature`."""
    widest = 2 * _PHASE / max(reach, 1e-12)
    edges = [0.0, min(_SMALLEST / length, limit)]
    while edges[-1] < limit:
        edges.append(min(limit, _RATIO * edges[-1], edges[-1] + widest))
    return np.array(edges[:-1]), np.array(edges[1:])


@cache
def gauss(count: int) -> tuple[Array, Array]:
    """Gauss-Legendre points and weights on (-1, 1)."""
    points, share = np.polynomial.legendre.leggauss(count)
    # Shared by all callers.
    points.setflags(write=False)
    share.setflags(write=False)
    return points, share


def cells_spectrum(load: Array, dx: float, dy: float, x0: float, y0: float) -> Spectrum:
    """Spectrum of loads uniform on the cells of a grid, by their exact transforms.

    load: (3, ny, nx), Pa. dx, dy: cell, m. x0, y0: centre of the first cell, m.
    """
    _, ny, nx = load.shape
    x, y = x0 + dx * np.arange(nx), y0 + dy * np.arange(ny)

    def spectrum(kx: Array, ky: Array) -> ComplexArray:
        # numpy's sinc takes half turns.
        along = np.exp(-1j * np.outer(x, kx)) * (dx * np.sinc(kx * dx / (2 * math.pi)))
        rows = load @ along.real + 1j * (load @ along.imag)
        narrow = (dy * np.sinc(ky * dy / (2 * math.pi)))[:, None]
        return np.stack(
            [_times(narrow * np.cos(np.outer(ky, y)), rows), -1j * _times(narrow * np.sin(np.outer(ky, y)), rows)]
        )

    return spectrum


def disc_spectrum(radius: float, pressure: float, x: float, y: float) -> Spectrum:
    """Spectrum of a uniform pressure, Pa, on a disc of a radius, m, centred at x, y, m."""

    def spectrum(kx: Array, ky: Array) -> ComplexArray:
        k = np.hypot(kx[None, :], ky[:, None])
        size = (2 * math.pi * radius * pressure) * scipy.special.j1(k * radius) / k
        both = np.zeros((2, 3, len(ky), len(kx)), complex)
        both[0, 0] = size * np.outer(np.cos(ky * y), np.exp(-1j * kx * x))
        both[1, 0] = size * np.outer(-1j * np.sin(ky * y), np.exp(-1j * kx * x))
        return both

    return spectrum


Table = Callable[[Array, Sequence[int]], Array]
"""(ln k (...), numbers of functions (m,)) → (..., m)."""


def tabulated(
    values: Callable[[Array], Array], smallest: float, largest: float, precision: type[np.floating] = np.float64
) -> Table:
    """Functions of k that are smooth in ln k, as piecewise polynomials.

    values: wavenumbers (n,) → (all functions, n). smallest, largest: range, 1/m. precision: in which what is
    interpolated is used.
    """
    start, stop = math.log(smallest) - 1e-6, math.log(largest) + 1e-6
    panels = max(1, math.ceil((stop - start) / _STEP))
    edges = np.linspace(start, stop, panels + 1)
    width = edges[1] - edges[0]
    count = 1 + (_SINGLE_DEGREE if precision is np.float32 else _DEGREE)
    chebyshev = 0.5 - 0.5 * np.cos(math.pi * (np.arange(count) + 0.5) / count)
    samples = values(np.exp(edges[:-1, None] + width * chebyshev).ravel())
    samples = samples.reshape(len(samples), panels, count).transpose(2, 1, 0)
    powers = np.linalg.inv(np.vander(chebyshev, count))
    coefficients = np.tensordot(powers, samples, axes=1) / (width ** np.arange(count)[::-1])[:, None, None]

    @cache
    def polynomials(functions: tuple[int, ...]) -> scipy.interpolate.PPoly:
        return scipy.interpolate.PPoly(coefficients[..., functions], edges)

    def at(log_k: Array, functions: Sequence[int]) -> Array:
        result: Array = polynomials(tuple(functions))(log_k)
        return result

    return at


def plane_fields(
    load: ComplexArray, kernel: Array, shear: Values, poisson: float, kx: Array, ky: Array
) -> ComplexArray:
    """Stress and displacement at one depth in wavenumbers: xx, yy, zz, xy, xz, yz, tension positive, and x, y, z.

    load: (2, 3, nky, nkx), see `Spectrum`. kernel: (10, nky, nkx): k·i u_k, k·u_z, i f_k, f_z, each under i f_k = 1
    and f_z = 1, then k·u_t and f_t under f_t = 1, as in `kernels.layers.layered.Transfer`. shear: shear modulus
    there, Pa, one or (nkx,), real or complex. poisson: ν there. Returns parts even and odd in ky, (2, nky, 9, nkx).
    """
    k = np.hypot(kx[None, :], ky[:, None])
    c, s = kx[None, :] / k, ky[:, None] / k
    pressure, shear_x, shear_y = load[:, 0], load[:, 1], load[:, 2]
    # s is odd in ky: what it multiplies changes parity, [::-1].
    push = 1j * (c * shear_x + s * shear_y[::-1])
    twist = c * shear_y - s * shear_x[::-1]
    u_k, u_z = push * kernel[0] + pressure * kernel[1], push * kernel[2] + pressure * kernel[3]
    f_k, f_z = push * kernel[4] + pressure * kernel[5], push * kernel[6] + pressure * kernel[7]
    u_t, f_t = twist * kernel[8], twist * kernel[9]
    nu, double = poisson, 2 * shear
    kk = (double * u_k - nu * f_z) / (1 - nu)
    tt = nu * (double * u_k - f_z) / (1 - nu)
    kt = (0.5j * double) * u_t
    across = (2 * c * s) * kt[::-1]
    f_k, u_k = 1j * f_k, u_k * (-1j / k)
    u_t = u_t / k
    fields = np.empty((2, len(ky), 9, len(kx)), complex)
    fields[:, :, 0] = c * c * kk + s * s * tt - across
    fields[:, :, 1] = s * s * kk + c * c * tt + across
    fields[:, :, 2] = -f_z
    fields[:, :, 3] = (c * s) * (kk - tt)[::-1] + (c * c - s * s) * kt
    fields[:, :, 4] = c * f_k + s * f_t[::-1]
    fields[:, :, 5] = s * f_k[::-1] - c * f_t
    fields[:, :, 6] = c * u_k - s * u_t[::-1]
    fields[:, :, 7] = s * u_k[::-1] + c * u_t
    fields[:, :, 8] = u_z / k
    return fields


def across_lines(even: Array, odd: Array, fields: ComplexArray) -> ComplexArray:
    """Fields (2, nky, m, nkx) on lines of y, (my, m, nkx). even, odd: cosines and sines times weights, (my, nky)."""
    flat = fields.reshape(2, fields.shape[1], -1)
    return (_times(even, flat[0]) + 1j * _times(odd, flat[1])).reshape(len(even), *fields.shape[2:])


def interleaved(lines: ComplexArray) -> Array:
    """Complex matrix (n, m) as a real one (2n, m): Re(a b) is one real product with a as numpy stores it."""
    real = np.empty((2 * len(lines), lines.shape[1]))
    real[::2], real[1::2] = lines.real, -lines.imag
    return real


def _times(a: Array, b: ComplexArray) -> ComplexArray:
    """Real matrix times complex ones, without making the real one complex."""
    product: ComplexArray = (a @ np.ascontiguousarray(b).view(float)).view(complex)
    return product
