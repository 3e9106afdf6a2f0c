"""Heat conduction in layers below a surface, one-dimensional: finite volumes over depth, implicit in time."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array

# Both stages of the singly diagonal method of order 2 that is L-stable (Alexander, 1977, SIAM J. Numer. Anal. 14).
_GAMMA = 1 - math.sqrt(0.5)
# Newton's steps on one surface temperature, and its accuracy, K.
_STEPS, _CLOSE = 50, 1e-7

Flux = Callable[[float], Callable[[float], tuple[float, float]]]
"""Of a time, s: a function of the surface temperature, °C, that gives the heat flux into the surface, W/m², and its
slope over that temperature."""


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells over depth, from the surface down.

    thickness: (n,), m. conductivity: (n,), W/(m K). capacity: (n,), J/(m³ K).
    """

    thickness: Array
    conductivity: Array
    capacity: Array

    @property
    def centres(self) -> Array:
        """Depths of the middles, m."""
        return np.cumsum(self.thickness) - 0.5 * self.thickness

    @property
    def skin(self) -> float:
        """Resistance between the surface and the first middle, m² K/W."""
        return float(0.5 * self.thickness[0] / self.conductivity[0])


def graded(
    bottoms: Array, conductivity: Array, capacity: Array, *, first: float, growth: float, depth: float
) -> Cells:
    """Cells that grow downwards and end at every interface.

    bottoms: (m - 1,) of the layers but the last, m, which reaches to `depth` at least. conductivity, capacity: (m,).
    first: thickness of the cells at the surface, m. growth: from one cell to the next, >= 1.
    """
    ends = np.append(bottoms, max(depth, 1.5 * bottoms[-1] if len(bottoms) else depth))
    parts: list[Array] = []
    numbers: list[int] = []
    at, size = 0.0, first
    for number, end in enumerate(ends):
        sizes: list[float] = []
        room, next_size = end - at, size
        while sum(sizes) < room:
            sizes.append(next_size)
            next_size *= growth
        # One less where that fits better: the last cell of a layer is not stretched more than half.
        if len(sizes) > 1 and sum(sizes) - room > 0.5 * sizes[-1]:
            sizes.pop()
        scaled = np.array(sizes) * room / sum(sizes)
        parts.append(scaled)
        numbers += [number] * len(scaled)
        at, size = end, float(scaled[-1]) * growth
    return Cells(np.concatenate(parts), conductivity[numbers], capacity[numbers])


def conducted(
    cells: Cells,
    start: Array,
    step: float,
    count: int,
    *,
    flux: Flux | None = None,
    surface: Callable[[float], float] | None = None,
) -> Array:
    """Temperatures (count + 1, n + 1) of the surface and of the cells at times 0, step, 2 step, ...

    start: (n,), of the cells at the time 0. flux: into the surface; or surface: the temperature that it is held at,
    of time, s. No heat passes the bottom. Of second order in both.
    NaN from where the flux has no temperature that balances it.
    """
    n = len(cells.thickness)
    between = 1 / (
        0.5 * cells.thickness[1:] / cells.conductivity[1:] + 0.5 * cells.thickness[:-1] / cells.conductivity[:-1]
    )
    stiffness = np.zeros((n, n))
    rows = np.arange(n - 1)
    stiffness[rows, rows] += between
    stiffness[rows + 1, rows + 1] += between
    stiffness[rows, rows + 1] = stiffness[rows + 1, rows] = -between
    store = cells.capacity * cells.thickness
    part = _GAMMA * step
    solution = np.linalg.inv(np.diag(store) + part * stiffness)
    carried = solution * store
    # Temperatures that a flux of 1 W/m² over a stage adds.
    pushed = part * solution[:, 0]
    skin = cells.skin
    warmth = float(pushed[0]) + skin
    result = np.empty((count + 1, n + 1))
    now = np.array(start, dtype=float)

    def balanced(at: float, below: float, resistance: float, guess: float) -> tuple[float, float]:
        """Temperature of the surface and the flux into it, `resistance` above what is `below` warm."""
        if surface is not None:
            top = surface(at)
            return top, (top - below) / resistance
        assert flux is not None
        balance, top = flux(at), guess
        for _ in range(_STEPS):
            into, slope = balance(top)
            change = (below + resistance * into - top) / (1 - resistance * slope)
            top += change
            if abs(change) < _CLOSE:
                return top, (top - below) / resistance
        return math.nan, math.nan

    def stage(before: Array, at: float, guess: float) -> tuple[Array, float]:
        still = carried @ before
        top, into = balanced(at, float(still[0]), warmth, guess)
        return still + pushed * into, top

    on_top, _ = balanced(0.0, float(now[0]), skin, float(now[0]))
    result[0, 0], result[0, 1:] = on_top, now
    ratio = (1 - _GAMMA) / _GAMMA
    for number in range(count):
        at = number * step
        first, on_top = stage(now, at + part, on_top)
        now, on_top = stage(now + ratio * (first - now), at + step, on_top)
        result[number + 1, 0], result[number + 1, 1:] = on_top, now
    return result


def read_at(cells: Cells, temperatures: Array, depths: Array) -> Array:
    """Temperatures (nt, k) at depths (k,), m, linear between the surface and the middles of the cells.

    temperatures: (nt, n + 1), of `conducted`.
    """
    places = np.concatenate([[0.0], cells.centres])
    above = np.clip(np.searchsorted(places, depths, side="right") - 1, 0, len(places) - 2)
    part = np.minimum((depths - places[above]) / (places[above + 1] - places[above]), 1.0)
    values: Array = temperatures[:, above] * (1 - part) + temperatures[:, above + 1] * part
    return values
