"""The grid of a contact: where on the tread the contact lies, the cells that hold it, and whether they cut it off."""

from __future__ import annotations

import math
from weakref import WeakKeyDictionary

import numpy as np

from treadload.contact.bodies.body import Body
from treadload.contact.bodies.influence import Influence
from treadload.contact.bounds import check_numbers, check_spacing
from treadload.contact.memory_bound import check_memory
from treadload.contact.rolling_state import Rolling
from treadload.contact.solution import Contact
from treadload.contact.solvers.normal import solve_normal
from treadload.errors import GeometryError, InputError, positive
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.tire import Tire

DEFAULT_SPACING = 3e-3
NO_OFFSET = (0.0, 0.0)
_LOCATING_CELLS = 64
_MARGIN = 0.024
# Of each tire in use the last place that was looked for, see `_reaches`.
_REACHES: WeakKeyDictionary[Tire, tuple[tuple[object, ...], tuple[float, float]]] = WeakKeyDictionary()


class BorderError(GeometryError):
    """The contact reaches the border of its grid: along x, across it, or both."""

    def __init__(self, message: str, *, along: bool, across: bool) -> None:
        super().__init__(message)
        self.along, self.across = along, across


def place(
    tire: Tire,
    rolling: Rolling,
    bodies: Body,
    spacing: float | None,
    offset: tuple[float, float] = NO_OFFSET,
) -> tuple[Grid, Array]:
    """Grid that holds the contact of two bodies with a margin, and the initial gap on it."""
    if len(offset) != 2 or not all(abs(part) <= 0.5 for part in offset):
        raise InputError(f"offset must be two parts of a cell from -0.5 to 0.5, along x and y, got {offset}")
    if tire.fixed_grid is not None:
        if tuple(offset) != NO_OFFSET:
            raise InputError(f"a height map keeps its own cells, got offset = {offset}; leave it out")
        grid = tire.fixed_grid
        check_memory(tire, rolling, bodies, grid)
        if spacing is not None and not math.isclose(spacing, grid.dx, rel_tol=1e-9):
            raise InputError(
                f"the height map has cells of {grid.dx * 1e3:g} mm and keeps them, got spacing = "
                f"{spacing * 1e3:g} mm; leave spacing out, or resample the map"
            )
        gap = tire.height_map(grid)
        check_numbers(rolling, bodies, grid, gap)
        return grid, gap
    step = _cell(spacing)
    length, width = tire.extent
    if step > min(length, width) / 8:
        raise InputError(
            f"a spacing of {step * 1e3:g} mm leaves fewer than 8 cells across the tread of "
            f"{min(length, width) * 1e3:.0f} mm; use {min(length, width) / 64 * 1e3:.2g} mm or less"
        )
    reach_x, reach_y = _reaches(tire, rolling, bodies, step)
    grid = Grid.on_lattice(
        min(length, 2 * (reach_x + _MARGIN)),
        min(width + 2 * _MARGIN, 2 * (reach_y + _MARGIN)),
        step,
        offset=offset,
    )
    check_memory(tire, rolling, bodies, grid)
    return grid, tire.height_map(grid)


def cell_across(tire: Tire, spacing: float | None) -> float:
    """Size across of the cells that a contact has, m. Raises InputError for one that no contact has."""
    return _cell(spacing) if tire.fixed_grid is None else tire.fixed_grid.dy


def _cell(spacing: float | None) -> float:
    """Size of the cells, m: the default where none is given."""
    size = DEFAULT_SPACING if spacing is None else spacing
    positive("spacing", size, "metres", "3 mm is 0.003")
    check_spacing(size, size)
    return size


def _reaches(tire: Tire, rolling: Rolling, bodies: Body, step: float) -> tuple[float, float]:
    """How far from the middle the contact reaches along x and y, m, at most, as coarse cells show it.

    step: of the cells that will be solved, m. Contacts of a tire that differ by their grid offset alone share it.
    """
    question = (rolling.normal_load, rolling.approach, bodies, step)
    earlier = _REACHES.get(tire)
    if earlier is not None and earlier[0] == question:
        return earlier[1]
    length, width = tire.extent
    coarse = Grid.centred(length, width, max(step, max(length, width) / _LOCATING_CELLS))
    shape = tire.height_map(coarse)
    check_numbers(rolling, bodies, coarse, shape)
    first = solve_normal(
        Influence(coarse.shape, coarse.dx, coarse.dy, bodies.at_rest, coarse.y0),
        shape,
        load=rolling.normal_load,
        approach=rolling.approach,
        tolerance=1e-2,
    )
    touching: BoolArray = first.pressure > 0
    reaches = (
        _reach(coarse.x, np.any(touching, axis=0)) + coarse.dx,
        _reach(coarse.y, np.any(touching, axis=1)) + coarse.dy,
    )
    _REACHES[tire] = question, reaches
    return reaches


def widened(tire: Tire, grid: Grid, cut: BorderError, offset: tuple[float, float] = NO_OFFSET) -> Grid | None:
    """A grid that holds the whole tread where the border cut; None where the tire is known no further.

    Whole, since a border that comes to lie in a groove would not show what it cuts.
    """
    if tire.fixed_grid is not None:
        return None
    length, width = tire.extent
    wider = Grid.on_lattice(
        length if cut.along else grid.nx * grid.dx,
        width + 2 * _MARGIN if cut.across else grid.ny * grid.dy,
        grid.dx,
        offset=offset,
    )
    grown = (wider.nx > grid.nx or not cut.along) and (wider.ny > grid.ny or not cut.across)
    return wider if grown else None


def same_place(
    tire: Tire, rolling: Rolling, bodies: Body, start: Contact, spacing: float | None
) -> tuple[Grid, Array]:
    """The grid of an earlier contact, or a larger one if this contact needs it, and the initial gap on it."""
    data = start.dataset
    dx, dy = float(data.attrs["dx"]), float(data.attrs["dy"])
    if spacing is not None and not math.isclose(spacing, dx, rel_tol=1e-9):
        raise InputError(
            f"the start has cells of {dx * 1e3:g} mm, got spacing = {spacing * 1e3:g} mm; leave spacing out"
        )
    grid = Grid(data.sizes["x"], data.sizes["y"], dx, dy, float(data.x[0]), float(data.y[0]))
    before = start.rolling
    if (tire, rolling.normal_load, rolling.approach) != (start.tire, before.normal_load, before.approach):
        # Where its border lies in a groove, it would not show what it cuts.
        wanted, gap = place(tire, rolling, bodies, dx if tire.fixed_grid is None else None)
        if wanted.nx > grid.nx or wanted.ny > grid.ny:
            return wanted, gap
    return grid, tire.height_map(grid)


def _reach(positions: Array, touching: BoolArray) -> float:
    return float(np.abs(positions[touching]).max(initial=0.0))


def check_border(pressure: Array, grid: Grid) -> None:
    """Refuse a contact that the grid cuts off."""
    sides = {
        "leading (x max)": pressure[:, -1],
        "trailing (x min)": pressure[:, 0],
        "right (y max)": pressure[-1],
        "left (y min)": pressure[0],
    }
    cut = [f"{name}, {int((p > 0).sum())} cells" for name, p in sides.items() if (p > 0).any()]
    if cut:
        raise BorderError(
            f"the contact reaches the border of the surface ({'; '.join(cut)}): the surface known is only "
            f"{grid.nx * grid.dx * 1e3:.0f} x {grid.ny * grid.dy * 1e3:.0f} mm. Give a larger height map or scan "
            "(NaN where there is no material), lower the load, or raise the tire's modulus",
            along=bool((pressure[:, [0, -1]] > 0).any()),
            across=bool((pressure[[0, -1]] > 0).any()),
        )
