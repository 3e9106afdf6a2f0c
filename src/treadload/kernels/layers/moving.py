"""Layers under a load that moves steadily along x: moduli that depend on kx.

Fields g(x - V t, y) vary in time as exp(-i kx V t): at kx > 0 a viscoelastic layer has the modulus conj E*(kx V),
everything else is as at rest. Kernels depend on kx and |k|, still even in ky, and fields are real. E* has a cusp
at kx = 0, which the panels that shrink towards it resolve.

Source: theory as in Chabot, Chupin, Deloffre and Duhamel (2010), Road Mater. Pavement Des. 11, 227-250, ViscoRoute;
reflection from the bottom up as in `kernels.layers.layered`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import cast

import numpy as np
import scipy

from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.gridding.points import Points
from treadload.kernels.layers.layered import Scalars, Stack, transfer
from treadload.kernels.layers.wavenumbers import Spectrum, across_lines, gauss, interleaved, panels, plane_fields

# Wavenumbers of a block: keeps what the layers and depths hold for each near the cache.
_BLOCK = 6_000

# Points of a panel of a path: polynomials through them hold a transform that turns 3.5 radians in half a panel.
_POINTS = 16
# Panels are no wider than what turns this often up to the limit: waves that have fallen to e^-33 there fall by less
# than e^-7 over a panel.
_FALLS = 66.0

Modulus = Callable[[Array], ComplexArray]
"""kx (nkx,) > 0 → Young's modulus, Pa, complex."""


@dataclass(frozen=True)
class Body:
    """Layers from the surface down, some of which have a modulus for each kx.

    moduli: Young's modulus of each layer, Pa, or a function of kx. poisson, thickness, spring, rigid: as in
    `kernels.layers.layered.Stack`.
    """

    moduli: Sequence[float | Modulus]
    poisson: Sequence[float]
    thickness: Sequence[float]
    spring: Sequence[float]
    rigid: bool = False

    def modulus(self, layer: int, kx: Array) -> Array | ComplexArray:
        """Young's modulus of a layer, (nkx,), Pa."""
        modulus = self.moduli[layer]
        return modulus(kx) if callable(modulus) else np.full(len(kx), float(modulus))

    def shear(self, layer: int, kx: Array) -> Array | ComplexArray:
        """Shear modulus of a layer, (nkx,), Pa."""
        return self.modulus(layer, kx) / (2 * (1 + self.poisson[layer]))

    def stack(self, kx: Array, rows: int, layers: int | None = None) -> Stack:
        """The layers for wavenumbers (rows, nkx) in one line; only the first ones, as a half-space, if given."""
        # Complex where a layer has a memory, see `layered.Scalars`.
        shear = cast(
            "list[Scalars]", [np.tile(self.shear(layer, kx), rows) for layer in range(len(self.moduli))[:layers]]
        )
        if layers is not None:
            return Stack(shear, self.poisson[:layers], [], [])
        return Stack(shear, self.poisson, self.thickness, self.spring, self.rigid)


@dataclass(frozen=True)
class Path:
    """Panels of kx for fields however far along x from the loads.

    At points far away exp(i kx x) turns often within a panel, but the fields' transforms do not: on each panel
    they are polynomials, and these times exp(i kx x) are integrated exactly.

    nodes, weights: of Gauss on each panel, (n,). centre, half: of each node's panel, 1/m. origin: the middle of the
    loads, m.
    Source: Bakhvalov and Vasil'eva (1968), USSR Comput. Math. Math. Phys. 8, 241-249.
    """

    nodes: Array
    weights: Array
    centre: Array
    half: Array
    origin: float

    @classmethod
    def of(cls, limit: float, extent: tuple[float, float], length: float) -> Path:
        """limit, length: as in `wavenumbers.quadrature`. extent: first and last loaded point, m."""
        low, high = panels(limit, max(extent[1] - extent[0], _FALLS / limit), length)
        points, shares = gauss(_POINTS)
        centre, half = np.repeat(0.5 * (high + low), _POINTS), np.repeat(0.5 * (high - low), _POINTS)
        origin = 0.5 * (extent[0] + extent[1])
        return cls(centre + half * np.tile(points, len(low)), half * np.tile(shares, len(low)), centre, half, origin)

    def lines(self, x: Array, block: slice) -> ComplexArray:
        """Matrix (nodes of the block, mx) that takes values at the nodes to ∫ f exp(i kx x) dkx."""
        nodes, centre, half = self.nodes[block], self.centre[block], self.half[block]
        at = x - self.origin
        legendre = np.polynomial.legendre.legvander((nodes - centre) / half, _POINTS - 1)
        lines = np.zeros((len(nodes), len(x)), complex)
        for half_length in np.unique(half):
            # ∫ Pₙ(u) exp(i w u) du = 2 iⁿ jₙ(w).
            order = np.arange(_POINTS)[:, None]
            bessel = (
                scipy.special.spherical_jn(order, np.abs(half_length * at)) * np.where(at < 0, -1.0, 1.0) ** order
            )
            rows = half == half_length
            lines[rows] = (legendre[rows] * (2 * order.T + 1)) @ (1j**order * bessel)
        # Spectra count phases from x = 0.
        lines *= self.weights[block, None] * np.exp(1j * (np.outer(centre, at) + (nodes * self.origin)[:, None]))
        return lines


@dataclass(frozen=True)
class Level:
    """One depth.

    depth: m. layer: that holds it. below: whether a value on an interface is that of the layer below it.
    split: True for the field less that of a half-space of the top layer.
    """

    depth: float
    layer: int
    below: bool
    split: bool = False


def moving_fields(
    spectra: Sequence[Spectrum],
    body: Body,
    levels: Sequence[Level],
    limit: float,
    x: Array,
    y: Array,
    path: Path,
    across: tuple[Array, Array],
    at: Points | None = None,
) -> Array:
    """Stress, displacement and strain under loads that move.

    spectra: of loads that add up. levels: (nz) depths whose waves matter up to `limit`, 1/m. x: (mx,), y: (my,), m,
    moving with the loads. path: panels in kx. across: nodes and weights in ky, see `wavenumbers.quadrature`.
    at: of the grid of x and y only these points.
    Returns (nz, 15, my, mx): stress xx, yy, zz, xy, xz, yz in Pa, displacement x, y, z in m, strain as stress.
    Works in blocks of wavenumbers; one pass through the layers serves all levels; far points cost no more.
    """
    result = np.zeros((len(levels), 15, *((len(y), len(x)) if at is None else at.shape)))
    for block, lines in _lines(spectra, body, levels, limit, y, path.nodes, across):
        back = interleaved(path.lines(x, block))
        for field, level, line in zip(result, levels, lines, strict=True):
            nu, compliance = body.poisson[level.layer], 1 / body.modulus(level.layer, path.nodes[block])
            everything = np.concatenate([line, _unit_strain(line[:, :6], nu) * compliance], axis=1)
            if at is not None:
                field += at.product(everything.view(float).swapaxes(0, 1), back)
                continue
            flat = everything.reshape(len(y) * 15, -1).view(float)
            field += (flat @ back).reshape(len(y), 15, len(x)).transpose(1, 0, 2)
    return result


def dissipated_energy(
    spectra: Sequence[Spectrum],
    body: Body,
    levels: Sequence[Level],
    limit: float,
    y: Array,
    along: tuple[Array, Array],
    across: tuple[Array, Array],
) -> Array:
    """Energy that a passage dissipates per unit volume, (nz, my), J/m³: W = -∫ σ_ij ∂ε_ij/∂x dx.

    Arguments as in `moving_fields`, none of the levels split; along, across: nodes and weights in kx and in ky.
    By Parseval one sum over kx of kx Im(1/E) ((1 + ν) |σ|² - ν |tr σ|²).
    """
    energy = np.zeros((len(levels), len(y)))
    for block, lines in _lines(spectra, body, levels, limit, y, along[0], across):
        kx, weights = along[0][block], along[1][block]
        for row, level, line in zip(energy, levels, lines, strict=True):
            nu, loss = body.poisson[level.layer], (1 / body.modulus(level.layer, kx)).imag
            stress = line[:, :6]
            product = stress.conj() * _unit_strain(stress, nu)
            # Shear stands twice in the tensor. Lines hold 1/π of the transform over x.
            work = (product[:, :3] + 2 * product[:, 3:]).sum(axis=1).real
            row += math.pi * (work @ (weights * kx * loss))
    return energy


def _unit_strain(stress: ComplexArray, nu: float) -> ComplexArray:
    """Strain (my, 6, nkx) for a modulus of 1 Pa."""
    strain = (1 + nu) * stress
    strain[:, :3] -= nu * stress[:, :3].sum(axis=1, keepdims=True)
    return strain


def _lines(
    spectra: Sequence[Spectrum],
    body: Body,
    levels: Sequence[Level],
    limit: float,
    y: Array,
    kx_all: Array,
    across: tuple[Array, Array],
) -> Iterator[tuple[slice, list[ComplexArray]]]:
    """Blocks of kx, and at each level stress and displacement (my, 9, nkx) on the lines of y."""
    ky_all, wy_all = across
    # Twice for kx < 0 and twice for ky < 0.
    even = np.cos(np.outer(y, ky_all)) * (wy_all / math.pi**2)
    odd = np.sin(np.outer(y, ky_all)) * (wy_all / math.pi**2)
    start = 0
    while start < len(kx_all) and kx_all[start] < limit:
        # Waves count within a circle.
        rows = max(1, int(np.searchsorted(ky_all, math.sqrt(limit**2 - kx_all[start] ** 2))))
        block = slice(start, start + max(1, _BLOCK // rows))
        start = block.stop
        kx, ky = kx_all[block], ky_all[:rows]
        load = np.asarray(sum(spectrum(kx, ky) for spectrum in spectra))
        kernels = _kernels(body, levels, kx, ky)
        lines = [
            across_lines(
                even[:, :rows],
                odd[:, :rows],
                plane_fields(load, kernel, body.shear(level.layer, kx), body.poisson[level.layer], kx, ky),
            )
            for level, kernel in zip(levels, kernels, strict=True)
        ]
        yield block, lines


def _kernels(body: Body, levels: Sequence[Level], kx: Array, ky: Array) -> ComplexArray:
    """(nz, 10, nky, nkx) as `wavenumbers.plane_fields` takes them."""
    shape = len(ky), len(kx)
    k = np.hypot(kx[None, :], ky[:, None]).ravel()

    def rows(stack: Stack, levels: Sequence[Level]) -> ComplexArray:
        solved = transfer(k, stack, [level.depth for level in levels], [level.below for level in levels])
        joined: ComplexArray = np.concatenate([solved.plane.reshape(len(levels), 8, -1), solved.transverse], axis=1)
        return joined.reshape(len(levels), 10, *shape)

    kernels = rows(body.stack(kx, len(ky)), levels)
    split = [number for number, level in enumerate(levels) if level.split]
    if split:
        kernels[split] -= rows(body.stack(kx, len(ky), 1), [levels[number] for number in split])
    return kernels
