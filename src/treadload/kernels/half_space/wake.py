"""Strain and displacement of a viscoelastic half-space under a load that moves: the load of the past, in closed form.

With one creep compliance J(t) = (1 + Σ fⱼ (1 - exp(-t/Tⱼ))) / E₀ for all components, the body under p(x - V t) moves
like an elastic one of modulus E₀ under p + q, q(x) = Σ fⱼ/Lⱼ ∫ₓ^∞ exp(-(s - x)/Lⱼ) p(s) ds, Lⱼ = V Tⱼ: what it
carried earlier lies ahead. q trails behind the load as its wake. Its mean over each cell is exact; the field of
these means differs from that of q at second order in the cell's length, and only near the load.

Near the points the wake lies on the load's own cells. Farther behind, panels of doubling length hold few cells
with the same moments, up to where nothing remains; their field is smooth, so few points carry it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.gridding.points import Points
from treadload.kernels.half_space.interior import fields_on_grid

# Cells along and across a panel of the far wake, no closer than it is long: 5.8^-8 of its field is left.
_CELLS = 8
# Points along x and along y that carry the field of the far wake: 2.4^-20 of it is left.
_CARRIERS = 20
# The wake ends where it has fallen to e^-22 of itself.
_END = 22.0

Term = tuple[float, float]
"""f and L: compliance relative to the instantaneous one, and the length V T over which it comes, m."""


@dataclass(frozen=True)
class Cells:
    """A load uniform on cells. load: (3, ny, nx), Pa. dx, dy: cell, m. x0, y0: centre of the first cell, m."""

    load: Array
    dx: float
    dy: float
    x0: float
    y0: float

    def refined(self, times: int) -> Cells:
        """The same load on cells that are shorter along x."""
        fine = self.dx / times
        return Cells(np.repeat(self.load, times, axis=2), fine, self.dy, self.x0 - 0.5 * (self.dx - fine), self.y0)


def delayed_fields(
    cells: Cells,
    terms: Sequence[Term],
    depths: Array,
    shear: float,
    poisson: float,
    x: Array,
    y: Array,
    at: Points | None = None,
) -> tuple[Array, Array]:
    """Stress and displacement that q gives an elastic half-space.

    cells: the load p. terms: of the creep compliance. depths: (nz,), m. shear: G of E₀, Pa. poisson: ν.
    x: (mx,), y: (my,), m. at: of the grid of x and y only these points. Returns (nz, 6, my, mx), Pa, and
    (nz, 3, my, mx), m. Along x the field is taken between the cells, where steps of shear leave no error O(dx), and
    interpolated with cubics.
    """
    clear = max(float(np.ptp(x)) / 2, float(np.ptp(y)) / 2, cells.load.shape[1] * cells.dy, 2 * cells.dx)
    rear = cells.x0 - 0.5 * cells.dx
    behind = math.ceil((rear - min(rear, float(x.min())) + clear) / cells.dx)
    wake, remains = _near(cells, terms, behind)
    start = cells.x0 - behind * cells.dx
    trail = Cells(wake, cells.dx, cells.dy, start, cells.y0)

    def near(x: Array, y: Array) -> Array:
        edges, weights = _cubics((x - start) / cells.dx + 0.5)
        between = start + cells.dx * (edges - 0.5)
        result: Array = _fields(trail, depths, shear, poisson, between, y) @ weights.T
        return result

    panels = _far(cells, remains, [length for _, length in terms], start - 0.5 * cells.dx, clear)

    def carried(x: Array, y: Array) -> tuple[Array, Array, Array]:
        (few_x, from_x), (few_y, from_y) = _carriers(x), _carriers(y)
        far = np.zeros((len(depths), 9, len(few_y), len(few_x)))
        for panel in panels:
            far += _fields(panel, depths, shear, poisson, few_x, few_y)
        return from_y, far, from_x

    def both(x: Array, y: Array) -> Array:
        from_y, far, from_x = carried(x, y)
        result: Array = near(x, y) + from_y @ far @ from_x.T
        return result

    def alone(x: Array, y: Array) -> Array:
        from_y, far, from_x = carried(x, y)
        pairs = [near(x[k : k + 1], y[k : k + 1])[..., 0, 0] for k in range(len(x))]
        result: Array = np.stack(pairs, axis=-1) + np.einsum("pj,zcji,pi->zcp", from_y, far, from_x)
        return result

    fields = both(x, y) if at is None else at.gathered(both, x, y, alone)
    return fields[:, :6], fields[:, 6:]


def _fields(cells: Cells, depths: Array, shear: float, poisson: float, x: Array, y: Array) -> Array:
    """Stress and displacement (nz, 9, my, mx)."""
    stress, displacement, _ = fields_on_grid(
        cells.load, cells.dx, cells.dy, depths, shear, poisson, x - cells.x0, y - cells.y0
    )
    return np.concatenate([stress, displacement], axis=1)


def _near(cells: Cells, terms: Sequence[Term], behind: int) -> tuple[Array, Array]:
    """Means of q on the load's cells and some behind it; fⱼ times what each term carries there, (3, ny, terms)."""
    # scipy.signal brings scipy.stats along, which takes as long to import as all of this package.
    from scipy.signal import lfilter

    load = np.pad(cells.load, ((0, 0), (0, 0), (behind, 0)))
    wake = np.zeros_like(load)
    remains = np.empty((*load.shape[:2], len(terms)))
    for number, (strength, length) in enumerate(terms):
        fade = math.exp(-cells.dx / length)
        grow = -math.expm1(-cells.dx / length)
        # From the front backwards: what each cell hands on, and what came to it.
        handed = lfilter([grow], [1.0, -fade], load[..., ::-1], axis=-1)[..., ::-1]
        came = np.concatenate([handed[..., 1:], np.zeros_like(handed[..., :1])], axis=-1)
        mean = grow * length / cells.dx
        wake += strength * (load * (1 - mean) + came * mean)
        remains[..., number] = strength * handed[..., 0]
    return wake, remains


def _far(cells: Cells, remains: Array, lengths: Sequence[float], rear: float, clear: float) -> list[Cells]:
    """The wake behind x = rear, in panels as long as they are far from what lies `clear` ahead of it."""
    end = _END * max(lengths)
    edges = [0.0]
    while edges[-1] < end:
        edges.append(2 * edges[-1] + clear)
    ny = cells.load.shape[1]
    rows, dy, y0 = remains, cells.dy, cells.y0
    if ny > _CELLS:
        dy = ny * cells.dy / _CELLS
        y0 = cells.y0 + 0.5 * (dy - cells.dy)
        rows = np.einsum("ij,cjt->cit", _same_moments(np.linspace(-1, 1, ny + 1)), remains)
    points, shares = np.polynomial.legendre.leggauss(3 * _CELLS)
    carry = _inverse_moments() @ (np.polynomial.legendre.legvander(points, _CELLS - 1).T * shares)
    panels = []
    for low, high in itertools.pairwise(edges):
        distance = 0.5 * (high - low) * points + 0.5 * (high + low)
        # Points count backwards, cells forwards.
        fading = (carry @ np.exp(-distance[:, None] / np.asarray(lengths)))[::-1]
        dx = (high - low) / _CELLS
        panels.append(Cells(np.einsum("cjt,it->cji", rows, fading), dx, dy, rear - high + 0.5 * dx, y0))
    return panels


def _inverse_moments() -> Array:
    """From Legendre moments on (-1, 1) to the values on equal cells that have them."""
    return np.asarray(np.linalg.inv(_cell_moments(np.linspace(-1, 1, _CELLS + 1))))


def _cell_moments(edges: Array) -> Array:
    """∫ Pₙ over each cell, (_CELLS, cells)."""
    points, shares = np.polynomial.legendre.leggauss(_CELLS)
    half = 0.5 * np.diff(edges)
    at = 0.5 * (edges[1:] + edges[:-1])[:, None] + half[:, None] * points
    values = np.polynomial.legendre.legvander(at, _CELLS - 1)
    return np.asarray(np.einsum("cpn,p,c->nc", values, shares, half))


def _same_moments(edges: Array) -> Array:
    """From values on cells to those on few equal cells with the same moments."""
    return np.asarray(_inverse_moments() @ _cell_moments(edges))


def _cubics(place: Array) -> tuple[Array, Array]:
    """Whole numbers that surround places, and the matrix (places, numbers) that interpolates between four of them."""
    first = np.floor(place + 1e-6).astype(int) - 1
    wanted = np.unique(first[:, None] + np.arange(4))
    t = (place - first)[:, None]
    nodes = np.arange(4)
    share = np.stack(
        [np.prod([(t[:, 0] - m) / (n - m) for m in nodes if m != n], axis=0) for n in nodes],
        axis=1,
    )
    weights = np.zeros((len(place), len(wanted)))
    weights[np.arange(len(place))[:, None], np.searchsorted(wanted, first[:, None] + nodes)] = share
    return wanted, weights


def _carriers(points: Array) -> tuple[Array, Array]:
    """Few points among which a smooth field is interpolated, and the matrix (points, carriers) that does it."""
    if len(points) <= _CARRIERS:
        return points, np.eye(len(points))
    low, high = float(points.min()), float(points.max())
    turn = math.pi * (np.arange(_CARRIERS) + 0.5) / _CARRIERS
    nodes = np.polynomial.chebyshev.chebvander(np.cos(turn), _CARRIERS - 1)
    scaled = np.clip((2 * points - low - high) / (high - low), -1, 1)
    values = np.polynomial.chebyshev.chebvander(scaled, _CARRIERS - 1)
    return 0.5 * (low + high) + 0.5 * (high - low) * np.cos(turn), values @ np.linalg.inv(nodes)
