"""A half-space below the cells of a contact, and the zone of it that can yield.

What yields below a contact is a small part of the cells below it. Stress of plastic strain is asked for there alone:
its operator takes the square of the zone's rows. The zone is where the elastic contact under the largest load yields,
and a margin; it grows where the plastic strain reaches its border.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.eigenstrain.operator import Grid as Cells
from treadload.kernels.eigenstrain.operator import Operator, cells, moved_by_cells
from treadload.kernels.gridding.below import Below
from treadload.kernels.half_space.interior import fields_on_grid
from treadload.kernels.plasticity.state import State
from treadload.materials import ElastoPlastic

Cut = tuple[slice, slice, slice]

# Cells that a zone has beyond what is known to yield, and that part of its size.
_MARGIN, _PART = 2, 0.125


@dataclass(frozen=True)
class Zone:
    """A block of cells: first and last + 1 of the rows, across and along."""

    first: tuple[int, int, int]
    end: tuple[int, int, int]

    @classmethod
    def around(cls, hardened: BoolArray) -> Zone:
        """Of cells (nz, ny, nx), with a margin; of their middle where there are none."""
        if hardened.any():
            places = np.argwhere(hardened)
            low, high = places.min(axis=0), places.max(axis=0) + 1
        else:
            low = np.array(hardened.shape) // 2
            high = low + 1
        margin = np.maximum(_MARGIN, np.ceil(_PART * (high - low)).astype(int))
        return cls(
            tuple(np.maximum(low - margin, 0).tolist()), tuple(np.minimum(high + margin, hardened.shape).tolist())
        )

    @property
    def cut(self) -> Cut:
        """The cells of it among all."""
        rows, across, along = (slice(*ends) for ends in zip(self.first, self.end, strict=True))
        return rows, across, along

    def ends_in(self, hardened: BoolArray) -> bool:
        """Whether one of some cells (nz, ny, nx) lies on a side of it that is no side of them all."""
        part = hardened[self.cut]
        return any(
            (low > 0 and bool(part.take(0, axis).any())) or (high < whole and bool(part.take(-1, axis).any()))
            for axis, (low, high, whole) in enumerate(zip(self.first, self.end, hardened.shape, strict=True))
        )


@dataclass(frozen=True, eq=False)
class Ground:
    """The half-space below a contact's cells, in rows between depths `edges`, (nz + 1,), m."""

    grid: Grid
    material: ElastoPlastic
    edges: Array

    @property
    def depths(self) -> Array:
        """Centres of the rows, (nz,), m."""
        middle: Array = 0.5 * (self.edges[1:] + self.edges[:-1])
        return middle

    @property
    def shape(self) -> tuple[int, int, int]:
        """Rows, cells across and along."""
        return len(self.edges) - 1, self.grid.ny, self.grid.nx

    @cached_property
    def stress(self) -> Below:
        """Stress (6, nz, ny, nx), Pa, of a pressure."""
        grid, unit_load = self.grid, np.zeros((3, 1, 1))
        unit_load[0] = 1.0
        x, y = grid.dx * np.arange(1 - grid.nx, grid.nx), grid.dy * np.arange(1 - grid.ny, grid.ny)
        poisson = self.material.elastic.poisson
        stress = fields_on_grid(unit_load, grid.dx, grid.dy, self.depths, 1.0, poisson, x, y, moves=False)[0]
        return Below.of(np.moveaxis(stress, 1, 0))

    def zone(self, pressure: Array) -> Zone:
        """Of what would yield first under a pressure (ny, nx), Pa."""
        stress = self.stress(pressure)
        return Zone.around(self.material.return_map().excess(stress, State.virgin(self.shape)) > 0)


@dataclass(frozen=True, eq=False)
class Yielding:
    """A zone of the ground: what plastic strain in it does to it and to the surface."""

    ground: Ground
    zone: Zone

    @cached_property
    def stress_of_strain(self) -> Operator:
        """Stress of plastic strain, both in the zone."""
        (rows, across, along), grid = self.zone.cut, self.ground.grid
        edges = self.ground.edges[rows.start : rows.stop + 1]
        block = Cells(along.stop - along.start, across.stop - across.start, grid.dx, grid.dy, edges)
        elastic = self.ground.material.elastic
        return cells(block, elastic.shear_modulus, elastic.poisson, single=True)

    @cached_property
    def _moved(self) -> Operator:
        rows, grid = self.zone.cut[0], self.ground.grid
        edges = self.ground.edges[rows.start : rows.stop + 1]
        return moved_by_cells(Cells(grid.nx, grid.ny, grid.dx, grid.dy, edges), self.ground.material.elastic.poisson)

    @cached_property
    def stress(self) -> Below:
        """Stress of a pressure in the rows of the zone, everywhere along and across."""
        whole = self.ground.stress
        return Below(whole.shape, whole.waves, whole.spectrum[:, self.zone.cut[0]])

    def pressed(self, pressure: Array) -> Array:
        """Stress in the zone, (6, ...), Pa, of a pressure (ny, nx), Pa."""
        return self.stress(pressure)[:, :, *self.zone.cut[1:]]

    def sunk(self, strain: Array) -> Array:
        """How far the surface sinks, (ny, nx), m, under a plastic strain (6, ...) in the zone."""
        whole = np.zeros((6, strain.shape[1], *self.ground.shape[1:]))
        whole[:, :, *self.zone.cut[1:]] = strain
        moved: Array = self._moved(whole)[2, 0]
        return moved

    def of(self, state: State) -> State:
        """What of a state of the ground is in the zone."""
        return state.at(self.zone.cut)

    def put(self, state: State, inner: State) -> State:
        """The state of the ground with another one in the zone."""
        parts = [getattr(state, name).copy() for name in ("strain", "hardening", "back")]
        for part, new in zip(parts, (inner.strain, inner.hardening, inner.back), strict=True):
            part[..., *self.zone.cut] = new
        return State(*parts)

    def spared_border(self, before: State, after: State) -> bool:
        """Whether no cell at the zone's border yielded between two states of the ground."""
        return not self.zone.ends_in(after.hardening > before.hardening)

    def grown(self, before: State, after: State) -> Yielding:
        """The zone with a margin around what it holds and what yielded."""
        hardened = after.hardening > before.hardening
        hardened[self.zone.cut] = True
        return Yielding(self.ground, Zone.around(hardened))
