"""Checks of normal contact: Hertz, and how many iterations a grooved tire takes."""

from __future__ import annotations

from collections.abc import Iterator

from treadload.contact.bodies.half_space import HalfSpaces, combined
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.grid import Grid
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.materials import Elastic
from treadload.tire import Tire
from treadload.validation.check import Check, absolute, relative
from treadload.validation.closed_forms import hertz
from treadload.validation.patches import paraboloid

RUBBER, ASPHALT = Elastic(3e6, 0.5), Elastic(5.4e9, 0.35)
_CELLS_ACROSS = 64
_MARGIN = 8
_MOST_ITERATIONS = 30
_PIECE = 0.34  # side of the piece of road under the grooved tire, m


def hertz_checks() -> Iterator[Check]:
    """Sphere and 4:1 paraboloid, 64 cells across the patch each way."""
    bodies = CombinedElasticity.of(1.2e6, 0.45, 1.2e6, 0.45)
    source = "Johnson (1985), Contact Mechanics, section 4.2"
    for name, radii in (("sphere", (0.5, 0.5)), ("ellipse, R_x/R_y = 4", (2.0, 0.5))):
        exact = hertz(*radii, 5e3, bodies.contact_modulus)
        spacing = 2 * exact.a / _CELLS_ACROSS, 2 * exact.b / _CELLS_ACROSS
        shape = (_CELLS_ACROSS + _MARGIN, _CELLS_ACROSS + _MARGIN)
        patch = paraboloid(bodies, radii, exact.load, shape, spacing, tolerance=1e-6)
        group = f"Hertz, {name}"
        yield relative(group, "approach, mm", patch.normal.approach * 1e3, exact.approach * 1e3, 0.001, source)
        peak = float(patch.normal.pressure.max())
        yield relative(group, "peak pressure, kPa", peak / 1e3, exact.peak / 1e3, 0.005, source)


def grooved_tire(cells: int) -> NormalSolution:
    """Normal contact of the profile 315/80R22.5 under 35 kN on cells x cells of a fixed piece of road."""
    spacing = _PIECE / cells
    grid = Grid.centred(_PIECE, _PIECE, spacing)
    gap = Tire.from_profile("315/80R22.5").height_map(grid)
    influence = Influence(grid.shape, spacing, spacing, HalfSpaces(combined(RUBBER, ASPHALT)))
    return solve_normal(influence, gap, load=35e3)


def iteration_checks() -> Iterator[Check]:
    """Iterations on grids from 64² to 512² cells; 1024² is left to the tests, for its time."""
    for cells in (64, 128, 256, 512):
        yield absolute(
            "grooved tire",
            f"iterations on {cells} x {cells} cells to 1e-6",
            grooved_tire(cells).iterations,
            0,
            _MOST_ITERATIONS,
            "house bound: at most 30 on any grid",
        )
