"""Normal contact of a grooved truck tire, in units of one padded convolution of the same grid.

Tread 315/80R22.5 under 35 kN on a fixed piece of road of 0.34 x 0.34 m, to a residual of 1e-6 of the approach,
from a cold start: operators and the coarser grids that start the solve are included.
"""

from floors import normal_product
from timing import best_of, print_table

from treadload.contact.bodies.half_space import HalfSpaces, combined
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import solve_normal
from treadload.grid import Grid
from treadload.tire import Tire
from treadload.validation.pressing import ASPHALT, RUBBER

SIDE, LOAD = 0.34, 35e3


def main(sizes=(64, 128, 256, 512, 1024)):
    tire, bodies = Tire.from_profile("315/80R22.5"), combined(RUBBER, ASPHALT)
    rows = []
    for cells in sizes:
        spacing = SIDE / cells
        grid = Grid.centred(SIDE, SIDE, spacing)
        gap = tire.height_map(grid)
        floor = normal_product(Influence(grid.shape, spacing, spacing, HalfSpaces(bodies)))
        # A new Influence each time: nothing is kept from the run before.
        seconds, found = best_of(
            lambda shape=grid.shape, h=spacing, gap=gap: solve_normal(
                Influence(shape, h, h, HalfSpaces(bodies)), gap, load=LOAD
            ),
            repeats=3 if cells <= 512 else 1,
        )
        rows.append(
            (
                f"{cells} x {cells}",
                floor * 1e3,
                seconds,
                seconds / floor,
                found.iterations,
                found.products,
                found.residual,
            )
        )
    header = ("cells", "floor, ms", "solve, s", "solve/floor", "iterations", "products", "residual")
    print_table("Normal contact, floor = one padded convolution", header, rows)


if __name__ == "__main__":
    main()
