"""Whether a tread is its own mirror image in the plane of the wheel."""

from __future__ import annotations

import numpy as np

from treadload.grid import Grid
from treadload.tire.surface import Surface

# Cells, m, on which a tread is compared with its mirror image; round-off of their places and of its gap, m.
_LOOK, _SAME, _SAME_GAP = 2e-3, 1e-6, 1e-9


def is_mirrored(surface: Surface) -> bool:
    """Whether a tread that is not a scan is its own mirror image."""
    if surface.quality is not None:
        return False
    length, width = surface.extent
    grid = surface.fixed_grid or Grid.on_lattice(0.8 * length, 0.9 * width, _LOOK)
    if abs(grid.y[0] + grid.y[-1]) > _SAME * grid.dy:
        return False
    gap = surface.height_map(grid)
    return bool(np.allclose(gap, gap[::-1], rtol=0, atol=_SAME_GAP, equal_nan=True))
