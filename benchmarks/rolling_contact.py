"""Steady rolling, in units of one padded convolution of two components on the same grid.

A disc with half of Kalker's unit creepage and with the force that belongs to it, and the grooved truck tire that
drives with 10 kN; to a residual of 1e-6, from a cold start, the pressure given.
"""

import numpy as np
from floors import rolling_product
from timing import best_of, print_table

from treadload.contact.influence import Influence
from treadload.contact.normal import solve_normal
from treadload.contact.rolling import solve_rolling
from treadload.contact.solve import combine
from treadload.grid import Grid
from treadload.kernels.rectangle import CombinedElasticity
from treadload.tire import Tire
from treadload.validation.closed_forms import hertz
from treadload.validation.patches import paraboloid
from treadload.validation.pressing import ASPHALT, RUBBER

HEADER = ("problem", "cells", "floor, ms", "solve, s", "solve/floor", "Newton", "Krylov", "splitting")


def timed(name, influence, bound, rigid, forces):
    # The solver works on the box around the contact, and so must the floor.
    rows, columns = np.flatnonzero(bound.any(1)), np.flatnonzero(bound.any(0))
    box = rows[-1] - rows[0] + 1, columns[-1] - columns[0] + 1
    shape = (int(box[0]), int(box[1]))
    floor = rolling_product(Influence(shape, influence.dx, influence.dy, influence.bodies))
    seconds, found = best_of(
        lambda: solve_rolling(
            Influence(influence.shape, influence.dx, influence.dy, influence.bodies), bound, rigid, forces
        ),
        repeats=3 if bound.size < 100_000 else 1,
    )
    cells = f"{shape[1]} x {shape[0]}"
    return name, cells, floor * 1e3, seconds, seconds / floor, found.newton, found.krylov, found.splitting


def discs(sizes):
    bodies = CombinedElasticity(1.0, 0.25, 0.0)
    exact = hertz(100.0, 100.0, 4 * bodies.contact_modulus / 300, bodies.contact_modulus)
    for cells in sizes:
        patch = paraboloid(bodies, (100.0, 100.0), exact.load, (cells + 4,) * 2, (2 / cells,) * 2, tolerance=1e-6)
        bound = 0.3 * patch.normal.pressure
        rigid = np.zeros((2, *bound.shape))
        yield timed("disc, force", patch.influence, bound, rigid, (0.43 * 0.3 * patch.load, 0.0))
        rigid[0] = -0.5 * 0.3 * exact.load / 4.12
        yield timed("disc, creepage", patch.influence, bound, rigid, (None, None))


def tires(sizes):
    tire, bodies = Tire.from_profile("315/80R22.5"), combine(RUBBER, ASPHALT)
    for cells in sizes:
        spacing = 0.34 / cells
        grid = Grid.centred(0.34, 0.34, spacing)
        influence = Influence(grid.shape, spacing, spacing, bodies)
        pressure = solve_normal(influence, tire.height_map(grid), load=32.5e3).pressure
        yield timed("tire, 10 kN", influence, 0.7 * pressure, np.zeros((2, *grid.shape)), (10e3, 0.0))


def main(sizes=(64, 128, 256)):
    rows = [*discs(sizes), *tires(sizes)]
    print_table("Steady rolling, floor = one padded convolution of two components", HEADER, rows)


if __name__ == "__main__":
    main()
