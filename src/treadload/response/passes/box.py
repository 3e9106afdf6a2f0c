"""The piece of road that yields: rows of cells between depths, and what they are made of."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.eigenstrain.operator import Grid as Cells
from treadload.kernels.eigenstrain.rows import graded_edges, spread_edges
from treadload.kernels.plasticity.state import State
from treadload.materials import ElastoPlastic
from treadload.pavement import Pavement

# Of a pass, bytes, and of what it keeps beside the operator, in bytes for each cell and component: rounds of the
# mixing, with their differences, and transforms.
_MOST, _ROUNDS = 1.5e9, 900
# Of rows of depth.
MOST_ROWS = 64


@dataclass(frozen=True)
class Course:
    """A plastic layer of a road: its material, and its top and bottom, m."""

    material: ElastoPlastic
    top: float
    bottom: float


def courses(road: Pavement) -> tuple[Course, ...]:
    """The layers of a road that can yield, from the surface down."""
    ends = [0.0, *road.interfaces.tolist(), math.inf]
    return tuple(
        Course(layer.material, ends[number], ends[number + 1])
        for number, layer in enumerate(road.layers)
        if isinstance(layer.material, ElastoPlastic)
    )


def over_strength(material: ElastoPlastic, stress: Array) -> Array:
    """Yield function of the virgin material over its strength (...), at a stress (6, ...), Pa."""
    law: Any = material.law
    virgin = State(np.zeros_like(stress), np.zeros(stress.shape[1:]), np.zeros_like(stress))
    excess: Array = material.return_map().excess(stress, virgin) / law.strength
    return excess


@dataclass(frozen=True, eq=False)
class Box:
    """Cells nx by ny of dx by dy, m, the centre of the first at x0, y0, in rows between depths `edges`, m."""

    nx: int
    ny: int
    dx: float
    dy: float
    x0: float
    y0: float
    edges: Array

    @property
    def cells(self) -> Cells:
        """As the operators of eigenstrain take them."""
        return Cells(self.nx, self.ny, self.dx, self.dy, self.edges)

    @cached_property
    def depths(self) -> Array:
        """Centres of the rows, (nz,), m."""
        middle: Array = 0.5 * (self.edges[1:] + self.edges[:-1])
        return middle

    @property
    def x(self) -> Array:
        """Centres along travel, (nx,), m."""
        return self.x0 + self.dx * np.arange(self.nx)

    @property
    def y(self) -> Array:
        """Centres across, (ny,), m."""
        return self.y0 + self.dy * np.arange(self.ny)

    @property
    def shape(self) -> tuple[int, int]:
        """Of a state: rows, and cells across."""
        return len(self.depths), self.ny

    def __str__(self) -> str:
        long, wide, deep = self.nx * self.dx, self.ny * self.dy, self.edges[-1] - self.edges[0]
        return f"{long * 1e3:.0f} x {wide * 1e3:.0f} x {deep * 1e3:.0f} mm"

    def grown(self, behind: float, ahead: float, left: float, right: float) -> Box:
        """Longer and wider by parts of its sides."""
        back, front = math.ceil(behind * self.nx), math.ceil(ahead * self.nx)
        low, high = math.ceil(left * self.ny), math.ceil(right * self.ny)
        return replace(
            self, nx=self.nx + back + front, ny=self.ny + low + high,
            x0=self.x0 - back * self.dx, y0=self.y0 - low * self.dy,
        )  # fmt: skip

    @property
    def bytes(self) -> float:
        """What a pass over these cells needs at most: its operator in single precision, and its rounds."""
        return 0.5 * self.cells.bytes + _ROUNDS * 6.0 * len(self.depths) * self.nx * self.ny

    @property
    def too_large(self) -> bool:
        """Whether a pass over these cells would not fit into memory."""
        return self.bytes > _MOST

    def check_size(self) -> None:
        """Raise InputError where a pass over these cells would not fit into memory."""
        if self.too_large:
            raise InputError(
                f"a box of {self.nx} x {self.ny} cells in {len(self.depths)} rows of depth needs "
                f"{self.bytes / 1e9:.1f} GB, above {_MOST / 1e9:.1f} GB; raise spacing (now {self.dx * 1e3:.3g} mm) "
                "or lower layers"
            )


def row_edges(among: tuple[Course, ...], cell: float, depth: float, count: int | None, ratio: float = 1.0) -> Array:
    """Edges (n + 1,), m, of rows from the top of the plastic courses to a depth, all interfaces between among them.

    cell: thickness of the first row, m. count: of the rows, graded where so many of that thickness do not reach the
    depth; None: as many as it takes where each is thicker than the one above by a ratio > 1.
    """
    top = among[0].top
    bottom = min(max(depth, top + cell), among[-1].bottom)
    if count is None:
        edges = spread_edges(top, bottom, cell, ratio, MOST_ROWS)
    else:
        edges = graded_edges(top, bottom, cell, count)
    for inside in {z for course in among for z in (course.top, course.bottom) if top < z < bottom}:
        nearest = 1 + int(np.abs(edges[1:-1] - inside).argmin())
        if abs(edges[nearest] - inside) > 0.45 * min(np.diff(edges)[nearest - 1 : nearest + 1]):
            edges = np.sort(np.append(edges, inside))
        else:
            edges[nearest] = inside
    rising: Array = edges
    return rising
