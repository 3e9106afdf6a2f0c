"""Numbers beyond which the arithmetic of a contact ends, far from any tire: refused before a solver divides by them.

Solvers take steps in single precision, which ends at 1e38, and square what they compare.
"""

from __future__ import annotations

import math

import numpy as np

from treadload.contact.bodies.body import Body
from treadload.contact.rolling_state import Rolling
from treadload.errors import InputError, within
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.tire import Tire

# Of a cell, m, and of all heights, m.
_CELLS, _HIGHEST = (1e-9, 1e3), 1e6
# Of the load on one cell and on all cells, Pa; of a body, 1/modulus.
_PRESSURES, _MODULI = (1e-12, 1e17), (1e-9, 1e18)
# Rows of cells that a rib has at least; of their width, after sums.
_CELLS_OF_A_RIB, _ROUND_OFF = 3, 1e-9


def check_spacing(dx: float, dy: float) -> None:
    """Refuse cells of a size, m, that no contact has. Raises InputError."""
    for size in (dx, dy):
        within("the size of the cells", size, *_CELLS, "m", "tires are solved on cells of 3 mm, 0.003")


def check_numbers(rolling: Rolling, bodies: Body, grid: Grid, gap: Array) -> None:
    """Refuse heights, moduli and loads on these cells that leave the range of numbers. Raises InputError.

    gap: (ny, nx), m, NaN where there is no material.
    """
    check_spacing(grid.dx, grid.dy)
    within(
        "the height of the surface", float(np.nanmax(np.abs(gap), initial=0.0)), 0.0, _HIGHEST, "m", "is it in mm?"
    )
    check_modulus("tire and road together", bodies)
    if rolling.normal_load is not None:
        area = grid.cell_area
        low, high = _PRESSURES[0] * area * gap.size, _PRESSURES[1] * area
        cells = f"on cells of {grid.dx * 1e3:g} mm; a truck's wheel carries 20e3 to 60e3"
        within("normal_load", rolling.normal_load, low, high, "N", cells)


def check_modulus(name: str, body: Body) -> None:
    """Refuse a body whose surface is softer or stiffer than numbers reach. name: whose it is. Raises InputError."""
    with np.errstate(all="ignore"):
        compliance = float(np.abs(body.across(np.array([1.0]))[0, 0]))
    low, high = (1 / modulus for modulus in reversed(_MODULI))
    if not low <= compliance <= high:
        side = "softer" if compliance > high else "stiffer"
        bound = _MODULI[0] if compliance > high else _MODULI[1]
        raise InputError(
            f"the modulus of {name} must lie between {_MODULI[0]:g} and {_MODULI[1]:g} Pa, and it is {side} than "
            f"{bound:g} Pa; rubber has 3e6, asphalt 5e9, steel 2.1e11"
        )


def check_ribs(tire: Tire, cell: float) -> None:
    """Refuse cells of a size across, m, too wide for the ribs of a tire. Raises InputError with one that serves."""
    widths = [right - left for group in tire.ribs for left, right in group.faces]
    narrowest = min(widths, default=math.inf)
    if narrowest < _CELLS_OF_A_RIB * cell * (1 - _ROUND_OFF):
        size = math.floor(narrowest / _CELLS_OF_A_RIB * 1e4) / 10
        remedy = f'use spacing = "{size:g} mm" or less'
        if tire.fixed_grid is not None:
            remedy = f"a height map keeps its cells: give one on cells of {size:g} mm or less across"
        raise InputError(
            f"the narrowest rib is {narrowest * 1e3:.3g} mm wide and has fewer than {_CELLS_OF_A_RIB} cells of "
            f"{cell * 1e3:g} mm; {remedy}"
        )
