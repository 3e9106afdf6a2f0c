"""Slope of the surface ahead of rolling wheels, for many layered columns at once: what moving basins are fitted with.

Points of a line along travel, which passes beside the loaded areas. In the frame of the wheels
-∂u/∂x = Re ∬ -i kx P(kx, ky) g(k, kx) / k exp(i(kx x + ky y)) dkx dky / π² over kx, ky > 0, with g = k u_z / f_z of
layers whose moduli depend on kx where they have a memory, as in `kernels.layers.moving`. g less that of the top
layer's half-space falls like exp(-2 k h₁) and is smooth over panels that double, in k and in kx apart: it is known at
a few points of each pair of panels, and the integral is a sum with weights that all columns share. Of the half-space
the integral over ky is Bessel's K0 of the distance from the load's lines, so that it is a sum over kx alone. Loads,
lines and sensors enter the weights, layers enter g: a change of moduli costs some forty products for each pair.

Source: as `kernels.layers.moving`; K0 as the transform of 1/k after Watson (1944), A Treatise on the Theory of Bessel
Functions, section 6.16.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.kernels.arrays import Array, ComplexArray, IntArray
from treadload.kernels.layers.doubling import interpolation, nodes_between
from treadload.kernels.layers.moving import Path
from treadload.kernels.layers.wavenumbers import Spectrum, gauss, panels

# Points of a panel, which spans a factor of two, in k and in kx: what g lacks there falls like 6⁻ⁿ.
_POINTS, _ALONG = 7, 5
# Waves end where exp(-2 k h₁) is e^-20, those of the half-space where K0 has fallen as far; panels begin at this,
# 1/m: longer waves turn the slope by less than 1e-6 of it.
_END, _BEGIN = 10.0, 0.01
# Gauss points of a panel across.
_ACROSS = 12


@dataclass(frozen=True, eq=False)
class Lines:
    """Loads of 1 N together as lines along travel: what the half-space needs.

    y: of each line (q,), m. transform: kx (n,) → (q, n), of the pressure along each line times its width, N.
    """

    y: Array
    transform: Sequence[tuple[Array, Array, Array]]

    def at(self, kx: Array) -> ComplexArray:
        """Transform of every line (q, n). Each is rectangles of (middle, half-length, force), m, m, N."""
        out = np.zeros((len(self.y), len(kx)), complex)
        for row, (middle, half, force) in enumerate(self.transform):
            shape = np.sinc(np.outer(half, kx) / math.pi) * np.exp(-1j * np.outer(middle, kx))
            out[row] = force @ shape
        return out


@dataclass(frozen=True, eq=False)
class Track:
    """Sensors on a line beside rolling wheels.

    nodes: wavenumbers k (n,), 1/m. along: kx, 1/m (m,), of the moduli. at: number of the kx of each node (n,).
    weights: (s, n), of g less that of the top half-space. direct: (s, m), of the top half-space alone.
    """

    nodes: Array
    along: Array
    at: IntArray
    weights: ComplexArray
    direct: ComplexArray

    @classmethod
    def of(
        cls,
        spectra: Sequence[Spectrum],
        lines: Lines,
        extent: tuple[float, float],
        x: Array,
        y: float,
        thinnest: float,
    ) -> Track:
        """Sensors at x (s,), y, m, ahead of and beside wheels of 1 N together.

        spectra, lines: of the loads. extent: first and last loaded point along x, m. thinnest: of the top layers, m,
        inf for a half-space. The line must pass beside all loads: y differs from every line of theirs.
        """
        gap = float(np.abs(lines.y - y).min())
        limit = _BEGIN if math.isinf(thinnest) else _END / thinnest
        beside = 2 * _END / gap
        steps = _edges(max(limit, beside))
        knots = np.concatenate([nodes_between(low, high, _ALONG) for low, high in itertools.pairwise(steps)])
        direct = _of_half_space(lines, extent, x, y, beside, steps)
        none = _Part(np.zeros(0), np.zeros(0, int), np.zeros((len(x), 0), complex))
        parts = [none]
        if math.isfinite(thinnest):
            parts += _of_layers(spectra, extent, x, y, limit, steps)
        return cls(
            np.concatenate([part.nodes for part in parts]), knots, np.concatenate([part.at for part in parts]),
            np.concatenate([part.weights for part in parts], axis=1), direct,
        )  # fmt: skip

    @property
    def without_memory(self) -> Track:
        """The same where no modulus depends on kx: a node for each k."""
        nodes, place = np.unique(self.nodes, return_inverse=True)
        weights = np.zeros((len(self.weights), len(nodes)))
        np.add.at(weights.T, place.ravel(), self.weights.real.T)
        direct = self.direct.real.sum(axis=1, keepdims=True)
        return Track(
            nodes, self.along[:1], np.zeros(len(nodes), int), weights.astype(complex), direct.astype(complex)
        )

    def slope(self, kernel: Array | ComplexArray, top: Array | ComplexArray) -> Array:
        """-∂u/∂x (..., s) under 1 N. kernel: g (..., n), 1/Pa. top: its limit (..., m)."""
        apart = kernel - top[..., self.at]
        return _real(apart, self.weights) + _real(top, self.direct)


@dataclass(frozen=True, eq=False)
class _Part:
    """Nodes of a pair of panels (n,), numbers of their kx (n,), weights (s, n)."""

    nodes: Array
    at: IntArray
    weights: ComplexArray


def _real(values: Array | ComplexArray, weights: ComplexArray) -> Array:
    """Real part of values (..., n) times weights (s, n)."""
    if not np.iscomplexobj(values):
        return np.asarray(values @ weights.real.T)
    return np.asarray(values.real @ weights.real.T - values.imag @ weights.imag.T)


def _edges(limit: float) -> Array:
    count = max(1, math.ceil(math.log2(limit / _BEGIN)))
    return np.concatenate([[0.0], _BEGIN * 2.0 ** np.arange(count + 1)])


def _fine(limit: float, extent: tuple[float, float]) -> Path:
    # Panels begin where the fields have nothing of their own below.
    return Path.of(limit, extent, 1e-7 / _BEGIN)


def _of_half_space(
    lines: Lines, extent: tuple[float, float], x: Array, y: float, limit: float, steps: Array
) -> ComplexArray:
    """Weights (s, m) of the half-space's kernel at the knots of the panels."""
    path = _fine(limit, extent)
    kx = path.nodes
    bessel = scipy.special.k0(np.abs(lines.y - y)[:, None] * kx)
    across = (lines.at(kx) * bessel).sum(axis=0) / math.pi**2
    fine = path.lines(x, slice(None)) * (-1j * kx * across)[:, None]
    out = np.zeros((len(x), (len(steps) - 1) * _ALONG), complex)
    for panel, (low, high) in enumerate(itertools.pairwise(steps)):
        there = (kx >= low) & (kx < high)
        columns = slice(panel * _ALONG, (panel + 1) * _ALONG)
        out[:, columns] = fine[there].T @ interpolation(kx[there], low, high, _ALONG)
    return out


def _of_layers(
    spectra: Sequence[Spectrum],
    extent: tuple[float, float],
    x: Array,
    y: float,
    limit: float,
    steps: Array,
) -> list[_Part]:
    """A part for each pair of panels that waves up to the limit fall into."""
    parts = []
    path = _fine(limit, extent)
    ky, wy = _across(limit)
    lines = path.lines(x, slice(None)) * (-1j * path.nodes)[:, None]
    for number, (low, high) in enumerate(itertools.pairwise(steps)):
        rows = np.flatnonzero((path.nodes >= low) & (path.nodes < high) & (path.nodes < limit))
        if not len(rows):
            continue
        kx = path.nodes[rows]
        k = np.hypot(kx[None, :], ky[:, None])
        load = np.asarray(sum(spectrum(kx, ky) for spectrum in spectra))[:, 0]
        turn = ky * y
        wave = ((np.cos(turn) * wy)[:, None] * load[0] + 1j * (np.sin(turn) * wy)[:, None] * load[1]) / k
        along = interpolation(kx, low, high, _ALONG)
        # (s · a, nkx): what a value of g at (ky, kx) does to each sensor through each knot of kx.
        carried = np.asarray(lines[rows].T[:, None, :] * along.T[None], dtype=complex).reshape(-1, len(rows))
        for below, above in itertools.pairwise(steps[number:]):
            inside = (k >= below) & (k < above) & (k < limit)
            if not inside.any():
                continue
            columns = np.nonzero(inside)[1]
            shares = interpolation(k[inside], below, above, _POINTS) * (wave[inside] / math.pi**2)[:, None]
            # Sums over ky first: (nkx, points).
            summed: ComplexArray = np.zeros((len(rows), _POINTS), complex)
            np.add.at(summed, columns, shares)
            block: ComplexArray = np.matmul(carried, summed).reshape(len(x), _ALONG * _POINTS)
            nodes = np.tile(nodes_between(below, above, _POINTS), _ALONG)
            at = np.repeat(number * _ALONG + np.arange(_ALONG), _POINTS)
            parts.append(_Part(nodes, at, block))
    return parts


def _across(limit: float) -> tuple[Array, Array]:
    # Wheels lie within a metre of the line: half a panel turns less than seven radians.
    low, high = panels(limit, 1.0, 1e-7 / _BEGIN)
    points, share = gauss(_ACROSS)
    half, middle = 0.5 * (high - low), 0.5 * (high + low)
    return (middle[:, None] + half[:, None] * points).ravel(), (half[:, None] * share).ravel()
