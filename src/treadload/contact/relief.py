"""A tire above a road that is no plane: the gap less the height of the road."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.pavement.relief import Relief
from treadload.tire import Tire
from treadload.tire.quality import ScanQuality
from treadload.tire.surface import Surface

# Cells that a wave needs for its peaks to be carried by more than points.
_CELLS_PER_WAVE = 4


@dataclass(frozen=True)
class AboveRelief:
    """A tread's surface as it stands above a road that is no plane.

    Its gap is counted from the road's plane, and negative where the road rises into the tread.
    """

    surface: Surface
    relief: Relief

    @property
    def tread_surface(self) -> Surface:
        """The tread itself."""
        return self.surface

    @property
    def extent(self) -> tuple[float, float]:
        """Of the tread."""
        return self.surface.extent

    @property
    def fixed_grid(self) -> Grid | None:
        """Of the tread."""
        return self.surface.fixed_grid

    @property
    def quality(self) -> ScanQuality | None:
        """Of the tread."""
        return self.surface.quality

    @property
    def outer_radius(self) -> float | None:
        """Of the tread."""
        return getattr(self.surface, "outer_radius", None)

    @property
    def crown_arc_radius(self) -> float | None:
        """Of the tread."""
        return getattr(self.surface, "crown_arc_radius", None)

    def height_map(self, grid: Grid) -> Array:
        """(ny, nx) gap, m, from the tread to the road; NaN where there is no material."""
        return self.above_road(self.surface.height_map(grid), grid)

    def above_road(self, gap: Array, grid: Grid) -> Array:
        """(ny, nx) gap to the road, m, of a gap to its plane."""
        return gap - heights_on(self.relief, grid)


def above(tire: Tire, relief: Relief) -> Tire:
    """The tire above a relief. Raises InputError for what is none."""
    if not isinstance(relief, Relief):
        raise InputError(
            f"relief must be a pavement.Texture or have a method height(x, y), got {type(relief).__name__}"
        )
    return replace(tire, surface=AboveRelief(tire.surface, relief))


def heights_on(relief: Relief, grid: Grid) -> Array:
    """(ny, nx), m, at the centres of the cells. Raises InputError for another shape and for no numbers."""
    height = np.asarray(relief.height(grid.x, grid.y), dtype=float)
    if height.shape != grid.shape:
        raise InputError(
            f"the road's relief gave heights of shape {height.shape} for a grid of {grid.shape} (ny, nx)"
        )
    unknown = ~np.isfinite(height)
    if unknown.any():
        raise InputError(
            f"the height of the road is not known at {int(unknown.sum())} of {height.size} places of the contact; "
            "fill the drop-outs of the texture, or give a larger one"
        )
    return height


def check_step(relief: Relief, cell: float) -> None:
    """Refuse a relief whose points lie further apart than the cells, m. Raises InputError."""
    points = getattr(relief, "step", None)
    if points is not None and points > cell * (1 + 1e-9):
        raise InputError(
            f"the road's texture has points every {points * 1e3:.3g} mm, and the cells of the contact are "
            f"{cell * 1e3:.3g} mm: what lies between its points is not known; take cells of {points * 1e3:.3g} mm or "
            "more, or a texture that was measured finer"
        )


def caveats_of(relief: Relief, grid: Grid) -> Sequence[str]:
    """What the cells of a contact cannot resolve of the road's relief."""
    finest = getattr(relief, "finest_wave", None)
    step = max(grid.dx, grid.dy)
    if finest is None or finest >= _CELLS_PER_WAVE * step:
        return ()
    return (
        f"the road's texture has waves down to {finest * 1e3:.3g} mm and the cells are {step * 1e3:.3g} mm: its "
        "peaks are cut off, and pressure and real area are those of what is left; take cells of "
        f"{finest / _CELLS_PER_WAVE * 1e3:.2g} mm, or a representative patch, contact.solve_texture",
    )
