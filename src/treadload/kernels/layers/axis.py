"""Stress on the axis of a uniformly loaded disc, for many layered columns at once.

σ = p ∫ s(k) a J1(k a) dk over the transforms s of the layers, which fall like exp(-k z) and are smooth over panels
that double: they are known at a few points of each panel, and the integral is a sum with weights that all columns
share.

Source: as `kernels.layers.hankel` and `kernels.layers.settlement`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.kernels.arrays import Array
from treadload.kernels.layers.doubling import panels_up_to
from treadload.kernels.layers.layered import Body, Compliance
from treadload.kernels.layers.settlement import Columns, scaled

# Points of a panel, which spans a factor of two.
_POINTS = 6
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
        nodes, weights = [], []
        for panel in panels_up_to(_BEGIN / depth, _END / shallowest, _POINTS, radius):
            nodes.append(panel.nodes)
            weights.append((panel.w * radius * scipy.special.j1(panel.k * radius)) @ panel.shares)
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
