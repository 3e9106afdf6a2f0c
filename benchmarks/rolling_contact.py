"""The whole of rolling, normal contact, kernels and all levels, in units of one convolution of the same grid.

The floor is one padded convolution of two components; seconds are the processor's, on one thread (OMP_NUM_THREADS=1),
the fewest of some runs. A disc at half of its friction, by creepage and by force, on CONTACT's numbers of cells, and
treads of a truck tire: ribs that drive, lugs that drive through a turn. To a residual of 1e-6, from a cold start. The
bounds are the house's.
"""

from dataclasses import replace
from time import process_time

import numpy as np
from floors import rolling_product
from timing import best_of, print_table

from treadload.catalogue import tires
from treadload.contact.bodies.half_space import HalfSpaces, combined
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import solve_normal
from treadload.contact.solvers.rolling import rigid_slip, solve_rolling
from treadload.contact.solvers.shift import solve_shift
from treadload.grid import Grid
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.tire import LateralGrooves, Tire
from treadload.validation.pressing import ASPHALT, RUBBER

HEADER = ("problem", "cells", "floor, ms", "whole, s", "whole/floor", "bound", "Newton", "Krylov", "products")
# Of whole over floor, by the cells of a disc.
GOALS = {200: 45, 400: 60}
DISC = CombinedElasticity(1.0, 0.25, 0.0)
RIBS = tires["315/80R22.5"]
LUGS = replace(
    RIBS, lateral=(LateralGrooves(pitch=0.06, width=0.012, depth=0.012, wall_angle=0.1, edge_radius=0.002),)
)


def timed(name, bound, influence, solve):
    before = rolling_product(influence, process_time)
    repeats = 7 if influence.shape[0] < 300 else 3
    fresh = [replace(influence) for _ in range(repeats)]
    seconds, found = best_of(lambda: solve(fresh.pop()), repeats, process_time)
    # Memory that the process gives back and fetches anew doubles the time of a product, and comes and goes.
    floor = min(before, rolling_product(influence, process_time))
    cells = f"{influence.shape[1]} x {influence.shape[0]}"
    return name, cells, floor * 1e3, seconds, seconds / floor, bound, found.newton, found.krylov, found.products


def disc(cells):
    """A disc of radius 1 under a load of 1: gap (ny, nx), influence and load."""
    dx = 2.2 / cells
    x = dx * (np.arange(cells) - (cells - 1) / 2)
    gap = (x[None, :] ** 2 + x[:, None] ** 2) * 3 / (8 * DISC.contact_modulus)
    return gap, Influence(gap.shape, dx, dx, HalfSpaces(DISC))


def discs(sizes):
    for cells in sizes:
        gap, influence = disc(cells)

        def whole(fresh, rigid=0.0, forces=(None, None), gap=gap):
            pressure = solve_normal(fresh, gap, load=1.0).pressure
            w = np.zeros((2, *gap.shape))
            w[0] = rigid
            return solve_rolling(fresh, 0.3 * pressure, w, forces)

        bound = GOALS.get(cells, 150)
        yield timed("disc, creepage", bound, influence, lambda f, run=whole: run(f, rigid=0.5 * 0.3 / 4.12))
        yield timed("disc, force", bound, influence, lambda f, run=whole: run(f, forces=(0.43 * 0.3, 0.0)))


def treads(sizes):
    bodies = combined(RUBBER, ASPHALT)
    for cells in sizes:
        grid = Grid.centred(0.34, 0.34, 0.34 / cells)
        influence = Influence(grid.shape, grid.dx, grid.dy, HalfSpaces(bodies))
        for name, bound, profile, forces, spin in (
            ("ribs, 10 kN", 250, RIBS, (10e3, 0.0), 0.0),
            ("lugs, 10 and 6 kN, 20 m", 400, LUGS, (10e3, 6e3), 0.05),
        ):
            gap = Tire.from_profile(profile).height_map(grid)
            rigid = rigid_slip(grid.x, grid.y, grid.dx, (0.0, 0.0), spin)

            def whole(fresh, gap=gap, rigid=rigid, forces=forces):
                pressure = solve_normal(fresh, gap, load=32.5e3).pressure
                return solve_rolling(fresh, 0.7 * pressure, rigid, forces)

            yield timed(name, bound, influence, whole)


def shifts(sizes):
    for cells, bound in sizes:
        gap, influence = disc(cells)
        pressure = solve_normal(influence, gap, load=1.0).pressure

        def shift(influence=influence, pressure=pressure):
            return solve_shift(replace(influence), 0.3 * pressure, np.zeros((2, *pressure.shape)), (0.15, 0.0))

        seconds, found = best_of(shift, clock=process_time)
        yield f"{cells} x {cells}", seconds, bound, found.newton, found.krylov


def main(disc_sizes=(100, 200, 400), tread_sizes=(64, 128, 256), shift_sizes=((128, 0.15), (256, 1.5))):
    rows = [*discs(disc_sizes), *treads(tread_sizes)]
    print_table(
        "Steady rolling with its normal contact, floor = one padded convolution of two components", HEADER, rows
    )
    header = ("cells", "shift, s", "bound, s", "Newton", "Krylov")
    print_table("Shift of a disc at half of its friction, cold", header, [*shifts(shift_sizes)])


if __name__ == "__main__":
    main()
