"""Stress on the axis of a uniformly loaded disc, for many layered columns at once.

σ = p ∫ s(k) a J1(k a) dk over the transforms s of the layers, which fall like exp(-k z) and are smooth over panels
that double: they are known at a few points of each panel, and the integral is a sum with weights that all columns
share.

Source: as `kernels.layers.hankel` and `kernels.layers.settlement`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.polynomial.chebyshev import chebpts1, chebvander

from treadload.kernels.arrays import Array
from treadload.kernels.layers.layered import Body, Compliance
from treadload.kernels.layers.settlement import Columns, scaled
from treadload.kernels.layers.wavenumbers import gauss

# Points of a panel, which spans a factor of two, and Gauss points of half a turn of the Bessel function.
_POINTS, _GAUSS = 6, 12
# Wavenumbers end where exp(-k z) is 1e-5; the panel at zero ends at this over the depth of the columns.
_END, _BEGIN = 12.0, 0.25


@dataclass(frozen=True, eq=False)
class AxisIntegral:
    """The integral over wavenumbers on the axis of a disc.

    nodes: wavenumbers (nk,), 1/m. weights: (nk,), 1/m, of transforms under unit pressure.
    """

    nodes: Array
    weights: Array

    @classmethod
    def of(cls, radius: float, shallowest: float, depth: float) -> AxisIntegral:
        """radius: of the disc, m. shallowest: least depth of the stress, m. depth: of the deepest layer, m."""
        edges = [0.0, _BEGIN / depth]
        while edges[-1] < _END / shallowest:
            edges.append(2 * edges[-1])
        unit = chebpts1(_POINTS)
        to_series = np.linalg.inv(chebvander(unit, _POINTS - 1))
        nodes, weights = [], []
        for low, high in itertools.pairwise(edges):
            nodes.append(0.5 * (high - low) * unit + 0.5 * (high + low))
            parts = max(1, math.ceil((high - low) * radius / math.pi))
            at, share = gauss(_GAUSS)
            ends = np.linspace(low, high, parts + 1)
            k = (0.5 * np.diff(ends)[:, None] * at + 0.5 * (ends[1:] + ends[:-1])[:, None]).ravel()
            w = (0.5 * np.diff(ends)[:, None] * share).ravel()
            interpolate = chebvander((2 * k - low - high) / (high - low), _POINTS - 1) @ to_series
            weights.append((w * radius * scipy.special.j1(k * radius)) @ interpolate)
        return cls(np.concatenate(nodes), np.concatenate(weights))

    def stress(self, columns: Columns, shear: Array, bottoms: Sequence[int]) -> tuple[Array, Array]:
        """Vertical and horizontal stress on the axis under unit pressure, (n, v, depths) each, compression positive.

        columns: at the nodes. shear: modulus of their layers (n, v, L), Pa. bottoms: numbers of the layers at whose
        lower ends the stress is taken, rising; the horizontal stress is that of the layer itself.
        """
        ones = np.ones((*shear.shape[:2], len(self.nodes)))
        below = columns.bottom(shear[..., -1:] * ones)
        bodies: list[Compliance] = []
        slabs = []
        for number in reversed(range(len(columns.slabs))):
            modulus = shear[..., number : number + 1]
            slab = scaled(columns.slabs[number], modulus)
            sprung = Body.of(below, 0.0, self.nodes, columns.spring_below(number), modulus).sprung
            slabs.append(slab)
            bodies.append(sprung)
            below = slab.up(sprung)
        force = np.stack([0 * ones, ones])
        vertical, horizontal = [], []
        wanted = set(bottoms)
        for number, (slab, body) in enumerate(zip(reversed(slabs), reversed(bodies), strict=True)):
            moved, force = slab.down(body, force)
            if number in wanted:
                down, stretch = force[1] @ self.weights, moved[0] @ self.weights
                poisson, modulus = columns.poisson[:, number, None], shear[..., number]
                vertical.append(down)
                # As `hankel` has it where r = 0; compression is positive here.
                horizontal.append((poisson * down - 2 * modulus * stretch) / (1 - poisson) + modulus * stretch)
            if number == max(wanted):
                break
        return np.stack(vertical, axis=-1), np.stack(horizontal, axis=-1)
