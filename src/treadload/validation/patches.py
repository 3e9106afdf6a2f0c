"""Standard problems on a grid: a paraboloid on a half-space, a cylinder on a strip."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.contact.solvers.rolling import rigid_slip, solve_rolling
from treadload.contact.solvers.tangential import TangentialSolution
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.half_space.rectangle import CombinedElasticity

# Cells this many half-widths long make a strip: the ends change the field by the square of 1/LONG.
LONG = 1e4


@dataclass(frozen=True)
class Patch:
    """A normal contact solved: cell centres x (nx,), y (ny,), m, the operators and the pressure."""

    x: Array
    y: Array
    influence: Influence
    normal: NormalSolution

    @property
    def cell(self) -> float:
        """Area of a cell, m²."""
        return self.influence.dx * self.influence.dy

    @property
    def contact(self) -> BoolArray:
        """(ny, nx): the cells that touch."""
        return np.asarray(self.normal.pressure > 0)

    @property
    def load(self) -> float:
        """Σ p dA, N."""
        return float(self.normal.pressure.sum()) * self.cell

    def roll(
        self,
        friction: float,
        creepages: tuple[float, float] = (0.0, 0.0),
        spin: float = 0.0,
        forces: tuple[float | None, float | None] = (None, None),
        tolerance: float = 1e-6,
    ) -> TangentialSolution:
        """Steady rolling on this patch; forces in N, None where the creepage counts."""
        rigid = rigid_slip(self.x, self.y, self.influence.dx, creepages, spin)
        return solve_rolling(self.influence, friction * self.normal.pressure, rigid, forces, tolerance=tolerance)

    def force(self, shear: Array) -> Array:
        """(Q_x, Q_y), N, of a shear (2, ny, nx), Pa."""
        return np.asarray(shear.sum((1, 2)) * self.cell)

    def moment(self, shear: Array) -> float:
        """Moment about the origin, N m, of a shear (2, ny, nx), Pa."""
        return float((self.x[None, :] * shear[1] - self.y[:, None] * shear[0]).sum()) * self.cell


def centres(number: int, spacing: float, shift: float = 0.0) -> Array:
    """Cell centres (number,), m, about `shift`."""
    return shift + spacing * (np.arange(number) - (number - 1) / 2)


def paraboloid(
    bodies: CombinedElasticity,
    radii: tuple[float, float],
    load: float,
    shape: tuple[int, int],
    spacing: tuple[float, float],
    *,
    shift: float = 0.0,
    tolerance: float = 1e-8,
) -> Patch:
    """Paraboloid x²/2R_x + y²/2R_y pressed on a half-space.

    radii: (R_x, R_y), m. load: N. shape: (ny, nx). spacing: (dx, dy), m. shift: of the grid along x, m.
    """
    (ny, nx), (dx, dy) = shape, spacing
    x, y = centres(nx, dx, shift), centres(ny, dy)
    influence = Influence(shape, dx, dy, HalfSpaces(bodies))
    gap = x[None, :] ** 2 / (2 * radii[0]) + y[:, None] ** 2 / (2 * radii[1])
    return Patch(x, y, influence, solve_normal(influence, gap, load=load, tolerance=tolerance))


def cylinder(
    bodies: CombinedElasticity,
    radius: float,
    load: float,
    number: int,
    spacing: float,
    length: float,
    *,
    shift: float = 0.0,
    tolerance: float = 1e-10,
) -> Patch:
    """Cylinder across the travel, of radius R, m, on a row of cells so long that its middle is in plane strain.

    load: N per m of length. number, spacing, m: of the cells along x. length: of the row along y, m.
    """
    influence = Influence((1, number), spacing, length, HalfSpaces(bodies))
    x = centres(number, spacing, shift)
    normal = solve_normal(influence, x[None, :] ** 2 / (2 * radius), load=load * length, tolerance=tolerance)
    return Patch(x, np.zeros(1), influence, normal)
