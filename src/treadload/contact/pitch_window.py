"""Blocks that roll through the contact: a window on the tread that moves on by a pitch at a time.

In the frame of the tread the blocks stand still and stick to the road where they stick, while the wheel moves on: a
step has no shift of the fields, only another gap. After a pitch the same blocks lie under the wheel again, so that
the window moves by as many cells, what leaves it at the rear is forgotten and what enters at the front is free.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from treadload.contact.bodies.blocks import BlockInfluence, block_influence, on_blocks
from treadload.contact.bodies.body import Body
from treadload.contact.rolling_state import Rolling, bound_on
from treadload.contact.solvers.marching import Stage, State, march
from treadload.contact.solvers.rolling import rigid_slip
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.tire import Tire
from treadload.tire.blocks import BlockPattern
from treadload.tire.lugs import LuggedTread


@dataclass(frozen=True, eq=False)
class Window:
    """Cells of a tread on which its blocks roll through the contact.

    tread: its blocks and their gap. pair: belt and road. grid: cells, the axle at x = 0 where a pitch begins.
    cells: of a pitch along travel. positions: of the axle in a pitch.
    """

    tire: Tire
    tread: LuggedTread
    pair: Body
    grid: Grid
    cells: int
    positions: int

    @property
    def step(self) -> float:
        """Distance from one position to the next, m."""
        return self.pattern.period / self.positions

    @property
    def pattern(self) -> BlockPattern:
        """The blocks."""
        return self.tread.pattern

    @cached_property
    def influence(self) -> BlockInfluence:
        """Operators of the blocks that lie whole in the window, of belt and road."""
        grid, inflated = self.grid, self.tire.carcass
        start = grid.x0 - 0.5 * grid.dx
        blocks = self.pattern.between(start, start + grid.nx * grid.dx)
        return block_influence(grid, self.pair, blocks, inflated.belt.tread)  # type: ignore[union-attr, arg-type]

    def seen_from(self, axle: float) -> Grid:
        """The cells in the frame of the wheel. axle: place, m."""
        return replace(self.grid, x0=self.grid.x0 - axle)

    def gap(self, axle: float) -> Array:
        """Gap (ny, nx) before loading, m, with the axle at a place, m; NaN between blocks."""
        seen = self.seen_from(axle)
        return np.where(on_blocks(self.grid, self.influence), self.tread.gap(seen.x, seen.y, axle), np.nan)

    def stage(self, rolling: Rolling, axle: float, travel: float) -> Stage:
        """The step that ends with the axle at a place, m, after a travel, m; of none, the wheel stands."""
        grid = self.seen_from(axle)
        rigid: Array = np.zeros((2, 1, 1))
        forces: tuple[float | None, float | None] = (0.0, 0.0)
        if travel:
            # Spin in the middle of the step.
            slip = rigid_slip(grid.x + 0.5 * travel, grid.y, 0.0, rolling.creepages, rolling.spin)
            slip[0] += self.tire.row_slip(grid)
            rigid, forces = slip * travel, rolling.forces

        return Stage(
            rigid, forces, bound_on(grid, rolling), axes=rolling.law.axes, load=rolling.normal_load,
            approach=rolling.approach, gap=self.gap(axle),
        )  # fmt: skip

    def stand(self, rolling: Rolling, tolerance: float) -> State:
        """The wheel put down without a force along the road, the axle at 0."""
        return next(march(self.influence, [self.stage(rolling, 0.0, 0.0)], tolerance=tolerance))

    def roll(self, rolling: Rolling, before: State, tolerance: float) -> Iterator[State]:
        """The states at all positions of a pitch, after a state with the axle at 0."""
        stages = [self.stage(rolling, number * self.step, self.step) for number in range(1, self.positions + 1)]
        yield from march(self.influence, stages, before=before, tolerance=tolerance)

    def moved_on(self, state: State) -> State:
        """The state of the end of a pitch as that of the beginning of the next."""

        def moved(fields: Array) -> Array:
            shifted = np.zeros_like(fields)
            shifted[..., : -self.cells] = fields[..., self.cells :]
            return shifted

        tangential = state.tangential
        # Which cells stuck is found again in every step.
        moved_shear = replace(
            tangential,
            shear=moved(tangential.shear),
            slip=moved(tangential.slip),
            stick=np.zeros_like(tangential.stick),
        )
        return replace(state, pressure=moved(state.pressure), tangential=moved_shear)
