"""Whether wheels with a side force need contacts on halved cells: by what their damage could move the years."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from treadload.damage.cycles import harm_of
from treadload.damage.life import Life
from treadload.damage.miner import wander_of
from treadload.damage.rib_sides import SHALLOW
from treadload.damage.traffic import Traffic
from treadload.kernels.arrays import Array
from treadload.life.design import Design
from treadload.life.wheels import has_side_force

# Cells that are halved, m. Larger ones were chosen to save time, smaller ones are fine enough.
_HALVED = (2e-3, 4e-3)
CELL_ERRORS = {1.5e-3: 0.03, 2e-3: 0.06, 3e-3: 0.13, 6e-3: 0.51}
"""Largest change of years from cells, m, to those of 0.75 mm, measured under ribs with side forces."""
# Part by which the default cells change the surface damage of wheels with a side force, at most, and the part of the
# years that a life accepts, see `docs/notes/cells_and_means.md`.
_ERROR, _ACCEPTED = CELL_ERRORS[3e-3], 0.025


def can_be_halved(design: Design) -> bool:
    """Whether cells are of a size that is halved where years need it, and no tread has cells of its own."""
    low, high = _HALVED
    treads = [design.traffic.classes[row].tire or design.tire for row in pushed_classes(design.traffic)]
    return 1.01 * low < design.spacing < 1.01 * high and all(tread.fixed_grid is None for tread in treads)


def on_halved_cells(design: Design) -> Design:
    """The design whose wheels with a side force have contacts on halved cells; contacts are shared."""
    return replace(design, contacts=design.contacts.on_halved_cells())


def as_solved(design: Design, life: Life) -> Design:
    """The design on the cells on which its life was solved."""
    return on_halved_cells(design) if life.stats.get("halved_cells") else design


def needs_halved_cells(design: Design, life: Life) -> bool:
    """Whether the cells under side forces could move the years of a surface criterion by more than a life accepts.

    life: of the design, by Miner's sum. The damage of wheels with a side force is taken as too small, then as too
    large, everywhere across travel, and the damage at the place that is then the worst is compared with the life's.
    """
    if design.contacts.halved or not pushed_classes(design.traffic) or not can_be_halved(design):
        return False
    for k in near_surface(design):
        whole = life.dataset["damage_per_year"].to_numpy()[k]
        top = float(whole.max())
        if top > 0:
            part = _of_side_forces(life, k, len(whole))
            if any(abs((whole + sign * _ERROR * part).max() / top - 1) > _ACCEPTED for sign in (-1, 1)):
                return True
    return False


def near_surface(design: Design) -> list[int]:
    """Criteria, by number, that evaluate a mean near the surface, where cells under side forces count."""
    return [
        k
        for k, criterion in enumerate(design.criteria)
        if criterion.mean_over and min(criterion.depths(design.road)) < SHALLOW
    ]


def pushed_classes(traffic: Traffic) -> list[int]:
    """Classes of axles, by number, whose wheels have a side force, see `has_side_force`."""
    return [row for row, axles in enumerate(traffic.classes) if has_side_force(axles.maneuver)]


def _of_side_forces(life: Life, number: int, columns: int) -> Array:
    """Damage of the first year (columns,) by a criterion that wheels with a side force do, after wander."""
    traffic, laws, y = life.traffic, life.class_laws[number], life.readings["y"].to_numpy()
    readings = life.readings.to_numpy()[number]
    still = np.zeros(len(y))
    for row in pushed_classes(traffic):
        for season, law, read in zip(life.climate.seasons, laws[row], readings[row], strict=True):
            still += traffic.passes_per_year * traffic.classes[row].share * season.share * harm_of(law, read)
    spread = wander_of(laws[0][0], traffic).spread(still, float(y[1] - y[0]))
    # A law that includes wander has its damage on the columns of those that do not.
    margin = (columns - len(spread)) // 2
    return np.pad(spread, (margin, columns - len(spread) - margin))
