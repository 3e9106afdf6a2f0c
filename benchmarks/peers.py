"""Normal contact of the grooved truck tire beside tamaas, a compiled peer: the same cells, a like accuracy.

Both solve the half-space by zero-padded FFT with Love's coefficients; tamaas by Polonsky and Keer's method. How far
the pressures lie from a much tighter solution stands beside the times. Needs `pip install tamaas`; says so without.
"""

import numpy as np
from timing import best_of, print_table

from treadload.contact.bodies.half_space import HalfSpaces, combined
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import solve_normal
from treadload.grid import Grid
from treadload.tire import Tire
from treadload.validation.pressing import ASPHALT, RUBBER

SIZE, LOAD = 0.34, 35e3
HEADER = ("cells", "treadload, s", "error", "tamaas, s", "error", "ratio")


def ours(influence, gap, tolerance=1e-6):
    return solve_normal(influence, gap, load=LOAD, tolerance=tolerance).pressure


def peer(tamaas, gap, contact_modulus, tolerance):
    """Pressure by tamaas: non-periodic, a wall of 1 m where there is no material."""
    n = gap.shape[0]
    model = tamaas.ModelFactory.createModel(tamaas.model_type.basic_2d, [SIZE, SIZE], [n, n])
    model.E, model.nu = contact_modulus, 0.0
    tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    solver = tamaas.PolonskyKeerRey(model, -np.where(np.isnan(gap), 1.0, gap), tolerance)
    solver.setIntegralOperator("dcfft")
    solver.solve(LOAD / SIZE**2)
    return np.array(model.traction)


def main(sizes=(64, 128, 256), peer_tolerance=1e-7):
    try:
        import tamaas
    except ImportError:
        print("tamaas is not installed; `pip install tamaas` sets it beside treadload here\n")
        return
    tamaas.set_log_level(tamaas.LogLevel.error)
    bodies = combined(RUBBER, ASPHALT)
    rows = []
    for cells in sizes:
        grid = Grid.centred(SIZE, SIZE, SIZE / cells)
        gap = Tire.from_profile("315/80R22.5").height_map(grid)
        exact = ours(Influence(grid.shape, grid.dx, grid.dy, HalfSpaces(bodies)), gap, 1e-10)
        scale = np.linalg.norm(exact)
        seconds, pressure = best_of(lambda g=grid, h=gap: ours(Influence(g.shape, g.dx, g.dy, HalfSpaces(bodies)), h))
        theirs, other = best_of(lambda h=gap: peer(tamaas, h, bodies.contact_modulus, peer_tolerance), repeats=1)
        error, their_error = (float(np.linalg.norm(p - exact) / scale) for p in (pressure, other))
        rows.append((f"{cells} x {cells}", seconds, error, theirs, their_error, theirs / seconds))
    print_table(f"Normal contact beside tamaas {tamaas.__version__}", HEADER, rows)


if __name__ == "__main__":
    main()
