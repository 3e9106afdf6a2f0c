"""Contact of ribs on the columns that touch: a window of the grid without the margin around the contact.

Products with dense blocks cost as many waves as there are columns, and a grid has a margin on all sides. The rounds
of pressure and shear run on the window; the whole grid judges what they find.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from treadload.contact.bodies.influence import Influence, operators
from treadload.contact.solvers.normal import NormalSolution
from treadload.contact.solvers.slipping import SlippingSolution
from treadload.contact.solvers.tangential import TangentialSolution
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray

# Columns that the contact may grow by on either side; windows are of whole multiples of so many, for those of like
# contacts to share operators. A window of more than this part of the cells is not worth it.
_MARGIN, _MULTIPLE, _MOST = 3, 4, 0.9


class GrownError(Exception):
    """The contact reaches the first or last column of its window, which is not that of the grid."""


@dataclass(frozen=True, eq=False)
class Window:
    """Some rows and columns of a grid. influence: the operators on them. grid: their cells."""

    rows: slice
    columns: slice
    shape: tuple[int, int]
    influence: Influence
    grid: Grid

    @classmethod
    def of(cls, influence: Influence, grid: Grid, pressure: Array) -> Window | None:
        """The window of a contact whose pressure (ny, nx) is nearly known; None where none is worth it."""
        if not influence.has_strips or influence.first_y is None:
            return None
        touching = np.flatnonzero((pressure > 0).any(0))
        lines = np.flatnonzero(influence.material)
        if touching.size == 0:
            return None
        first, last = int(touching[0]) - _MARGIN, int(touching[-1]) + 1 + _MARGIN
        length = -(-(last - first) // _MULTIPLE) * _MULTIPLE
        first = max(0, min(first, grid.nx - length))
        rows = slice(int(lines[0]), int(lines[-1]) + 1)
        columns = slice(first, min(grid.nx, first + length))
        ny, nx = rows.stop - rows.start, columns.stop - columns.start
        if ny * nx > _MOST * grid.nx * grid.ny:
            return None
        small = replace(grid, nx=nx, ny=ny, x0=grid.x0 + first * grid.dx, y0=influence.first_y + rows.start * grid.dy)
        part = operators((ny, nx), grid.dx, grid.dy, influence.pair, small.y0)
        if not np.array_equal(part.material, influence.material[rows]):
            return None
        return cls(rows, columns, grid.shape, part, small)

    def of_field(self, field: Array) -> Array:
        """The part of a field (…, ny, nx) in the window."""
        return np.asarray(field[..., self.rows, self.columns])

    def check(self, pressure: Array) -> None:
        """Raises GrownError where pressure in the window reaches a column beyond which the grid goes on."""
        if (self.columns.start > 0 and pressure[:, 0].any()) or (
            self.columns.stop < self.shape[1] and pressure[:, -1].any()
        ):
            raise GrownError

    def tangential_of(self, whole: TangentialSolution) -> TangentialSolution:
        """The part of a solution in the window."""
        return replace(
            whole,
            shear=self.of_field(whole.shear),
            slip=self.of_field(whole.slip),
            stick=np.asarray(whole.stick[self.rows, self.columns]),
        )

    def slipping_on_grid(self, slipping: SlippingSolution) -> SlippingSolution:
        """A solution of the window on the whole grid: no shear elsewhere. The temperature stays as it is."""
        part = slipping.tangential
        tangential = replace(
            part,
            shear=self.on_grid(part.shear),
            slip=self.on_grid(part.slip),
            stick=self.on_grid(part.stick.astype(float)) > 0,
        )
        return replace(
            slipping,
            tangential=tangential,
            bound=self.on_grid(slipping.bound),
            coefficient=self.on_grid(slipping.coefficient),
        )

    def on_grid(self, field: Array) -> Array:
        """A field (…, rows, columns) of the window on the grid, zero elsewhere."""
        whole = np.zeros((*field.shape[:-2], *self.shape))
        whole[..., self.rows, self.columns] = field
        return whole

    def normal_on_grid(
        self, influence: Influence, gap: Array, normal: NormalSolution, shear: Array
    ) -> NormalSolution:
        """Pressure of the window on the whole grid, with the residual that it has there.

        influence, gap (ny, nx), m: of the grid. shear: (2, ny, nx) on the grid, Pa.
        """
        pressure = self.on_grid(normal.pressure)
        material: BoolArray = influence.material[:, None] & ~np.isnan(gap)
        after = np.where(material, gap, np.nan) + influence.normal(pressure) + influence.gap_by_shear(shear)
        after -= normal.approach
        scale = max(abs(normal.approach - float(np.nanmin(gap))), np.finfo(float).tiny)
        apart = max(float(np.abs(after[pressure > 0]).max(initial=0.0)), -float(np.nanmin(after)))
        return replace(normal, pressure=pressure, gap=after, residual=max(normal.residual, apart / scale))
