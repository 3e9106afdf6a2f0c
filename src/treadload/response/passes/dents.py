"""How plastic strain along a track moves the surface that a wheel rolls on, also while it is being made.

On a half-space bars of strain, with an end or without, are closed forms. What layers change of it follows by Betti's
theorem from the stress of the layered road under one cell, see `kernels.eigenstrain.surface`: cells behind each other
add up to a bar, and twice a bar with its end below the point is one without ends, so that no sum runs far.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from treadload.grid import Grid
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.eigenstrain.operator import Operator, moved_by_track
from treadload.kernels.fft import irfft2, next_fast_len, rfft2
from treadload.pavement import Pavement
from treadload.pavement.stack import stack_of
from treadload.response.layered import View
from treadload.response.loads import GridLoad
from treadload.response.passes.box import Box
from treadload.response.passes.surface import layers_change, surface_profile
from treadload.response.several import Question, answers

_WEIGHTS = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])
# Components that are odd along x: their bars are summed, over so many lengths of the box.
_ODD, _FAR = [3, 4], 3
# Gauss points over a row: what layers change is smooth.
_NODES, _SHARES = np.polynomial.legendre.leggauss(3)


@dataclass(frozen=True, eq=False)
class Dents:
    """Displacement of the surface, m, down positive, by plastic strain in the rows of a box.

    bars: on a half-space of the top layer. change: spectra (6, nz, my, mx // 2 + 1) of what layers change of it, None
    where there are none. waves: cells of their period along y and x.
    """

    box: Box
    road: Pavement
    bars: Operator
    change: ComplexArray | None
    waves: tuple[int, int]

    @classmethod
    def of(cls, box: Box, road: Pavement) -> Dents:
        """In a road that is elastic but for what yields."""
        bars = moved_by_track(box.cells, stack_of(road.bond_limits[0]).poisson[0])
        waves = int(next_fast_len(2 * box.ny - 1)), int(next_fast_len(2 * box.nx - 1, real=True))
        change = None if road.is_homogeneous else rfft2(_bars(box, road), s=waves)
        return cls(box, road, bars, change, waves)

    def endless(self, strain: Array) -> Array:
        """(ny,), of a strain (6, nz, ny) that is the same all along travel."""
        return surface_profile(strain, self.box, self.road, self.box.y)

    def track(self, taken: Array) -> Array:
        """(ny, nx), of the strain (6, nz, ny, nx) that each cell takes and keeps behind it, without end."""
        moved: Array = self.bars(taken)[2, 0]
        if self.change is None:
            return moved
        ny, nx = self.box.ny, self.box.nx
        spectrum = (self.change * rfft2(taken, s=self.waves)).sum(axis=(0, 1))
        more: Array = irfft2(spectrum, s=self.waves)[ny - 1 : 2 * ny - 1, nx - 1 : 2 * nx - 1]
        return moved + more


def _bars(box: Box, road: Pavement) -> Array:
    """What layers change of the surface at offsets of a point from a bar's front, (6, nz, 2 ny - 1, 2 nx - 1)."""
    wide = _FAR * box.nx
    single = _cells(box, road, wide)
    front = single[..., : box.nx]
    # K of a cell at offset m, bars B(m) = Σ K(m + j), j >= 0. K is even: 2 B(0) = K(0) + all of it; or odd.
    begin = 0.5 * (_lines(box, road) + front[..., 0])
    begin[_ODD] = single[_ODD].sum(axis=-1)
    taken_off = np.cumsum(front[..., :-1], axis=-1)
    ahead = begin[..., None] - np.concatenate([np.zeros_like(front[..., :1]), taken_off], axis=-1)
    even = np.where(np.isin(np.arange(6), _ODD), -1.0, 1.0)[:, None, None, None]
    behind = begin[..., None] + even * np.cumsum(front[..., 1:], axis=-1)
    return np.concatenate([behind[..., ::-1], ahead], axis=-1)


def _cells(box: Box, road: Pavement, wide: int) -> Array:
    """Likewise of a cell, at offsets 0 … wide - 1 along x, (6, nz, 2 ny - 1, wide)."""
    half, middle = 0.5 * np.diff(box.edges), box.depths
    depths = (middle[:, None] + half[:, None] * _NODES).ravel()
    x, y = box.dx * np.arange(wide), box.dy * np.arange(1 - box.ny, box.ny)
    unit_cell = (GridLoad(Grid(1, 1, box.dx, box.dy, 0.0, 0.0), np.ones((1, 1))),)
    top = Pavement.half_space(road.layers[0].resolved)
    solved = answers(
        [Question(unit_cell, place, depths) for place in (road, top)], View(x, y, components=range(6)),
        side="below", speed=None, mean_over=None,
    )  # fmt: skip
    stress = solved[0].fields.stress - solved[1].fields.stress
    rows = (half[:, None] * _SHARES).reshape(1, -1, 1, 1) * stress * _WEIGHTS[:, None, None, None]
    summed: Array = rows.reshape(6, len(half), len(_NODES), *stress.shape[2:]).sum(axis=2)
    # From the cell to the point: the load is at the point.
    summed[_ODD] *= -1
    return summed[:, :, ::-1]


def _lines(box: Box, road: Pavement) -> Array:
    """Likewise of a bar without ends, (6, nz, 2 ny - 1)."""
    narrow, rows = replace(box, ny=1), len(box.depths)
    unit = np.eye(6 * rows).reshape(6, rows, 6, rows, 1)
    return layers_change(unit, narrow, road, np.arange(1 - box.ny, box.ny))
