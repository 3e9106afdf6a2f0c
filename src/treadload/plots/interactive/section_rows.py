"""Rows of a vertical section between the depths of a response: smooth within layers, cut at their interfaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array, IntArray
from treadload.plots.kit.layers import Layers

# Rows of a whole section, about; and the fewest of a layer.
_ROWS, _FEWEST = 96, 4


@dataclass(frozen=True)
class SectionRows:
    """Rows of a section. edges: (n + 1,), mm. low, high: (n,), numbers of the depths around each row; share: (n,), of
    the way from one to the other.
    """

    edges: Array
    low: IntArray
    high: IntArray
    share: Array

    @classmethod
    def of(cls, depths: Array, layers: Layers) -> SectionRows:
        """Rows between increasing depths, mm, none of which lies between two layers.

        A row holds the value at its middle, linear in depth between the two depths around it that lie in its layer;
        where a layer has no depth at its interface, the nearest of its depths holds up to there.
        """
        sides = (min(0.0, float(depths[0])), *layers.interfaces, np.inf)
        bottom = float(depths[-1])
        step = (bottom - sides[0]) / _ROWS
        edges, low, high, share = [np.array([sides[0]])], [], [], []
        for number, rows in enumerate(layers.pieces(depths)):
            inside = depths[rows]
            if not len(inside):
                continue
            top, end = float(edges[-1][-1]), min(sides[number + 1], bottom)
            if end <= top:
                continue
            count = max(_FEWEST, int(np.ceil((end - top) / step - 1e-9)))
            borders = np.linspace(top, end, count + 1)
            middle = (borders[1:] + borders[:-1]) / 2
            first = np.clip(np.searchsorted(inside, middle, side="right") - 1, 0, max(0, len(inside) - 2))
            second = np.minimum(first + 1, len(inside) - 1)
            apart = np.where(second > first, inside[second] - inside[first], 1.0)
            low.append(first + rows.start)
            high.append(second + rows.start)
            share.append(np.clip((middle - inside[first]) / apart, 0.0, 1.0))
            edges.append(borders[1:])
        return cls(np.concatenate(edges), *(np.concatenate(parts) for parts in (low, high, share)))

    def between(self, values: Array) -> Array:
        """Values (n, ...) of the rows, from those (nz, ...) at the depths."""
        share = self.share.reshape(-1, *(1,) * (values.ndim - 1))
        rows: Array = values[self.low] * (1 - share) + values[self.high] * share
        return rows

    def as_lists(self) -> list[list[float]]:
        """Of each row, the numbers of its depths and the share, for a browser."""
        return [
            [int(low), int(high), round(float(share), 6)]
            for low, high, share in zip(self.low, self.high, self.share, strict=True)
        ]
