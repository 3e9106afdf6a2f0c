"""Layered roads: time and error of a footprint and of discs, how the cost grows, and PyMastic beside it.

On one core, after import. The error is against the same computed with waves followed further down, on panels
with half as many points again, by the largest value of each field. PyMastic is no package: clone
github.com/Mostafa-Nakhaei/PyMastic and put its folder on PYTHONPATH; the table says so where it is absent.
"""

from functools import partial

import numpy as np
from timing import best_of, print_table

import treadload as tl
from treadload.grid import Grid
from treadload.kernels.half_space.interior import fields_on_grid
from treadload.kernels.layers import synthesis, wavenumbers
from treadload.response import GridLoad, layered

ROAD = tl.Pavement(
    [
        tl.Layer(tl.Elastic(7e9, 0.35), 0.06),
        tl.Layer(tl.Elastic(9e9, 0.35), 0.15),
        tl.Layer(tl.Elastic(2e8, 0.35), 0.3),
        tl.Layer(tl.Elastic(5e7, 0.35)),
    ]
)
GRID = Grid.centred(0.3, 0.24, 3e-3)
SQUARE = np.linspace(-0.3, 0.3, 61)


THIN = tl.Pavement([tl.Layer(tl.Elastic(3e9, 0.35), 0.01), *ROAD.layers])


def footprint(grid=GRID):
    x, y = (grid.x - grid.x.mean()) / 0.14, (grid.y[:, None] - grid.y.mean()) / 0.11
    pressure = 8e5 * np.maximum(0, 1 - x**4 - y**4)
    return GridLoad(grid, pressure, 0.3 * pressure * x, 0.2 * pressure * np.ones_like(x))


def solved(loads, depths, x, y, road=ROAD, accuracy=synthesis.FULL):
    """Stress, strain and displacement (15, nz, my, mx)."""
    loads = loads if isinstance(loads, list) else [loads]
    site, view = layered.Site(road, np.array(depths)), layered.View(x, y, accuracy=accuracy)
    stress, strain, displacement, _ = next(layered.layered_responses([loads], [site], [(0, 0)], view, below=False))
    return np.concatenate([stress, strain, displacement])


FINER = synthesis.Accuracy(40.0, 1e-7, 12, 15)
FINE = {
    (wavenumbers, "_POINTS"): 21,
    (wavenumbers, "_LEAST_POINTS"): 12,
    (wavenumbers, "_STEP"): 0.1,
    (synthesis, "_MORE"): 0.9,
}


def error(run):
    """Largest difference from a finer computation, by the largest value of each field."""
    kept = {place: getattr(*place) for place in FINE}
    coarse = run()
    try:
        for place, value in FINE.items():
            setattr(*place, value)
        fine = run(accuracy=FINER)
    finally:
        for place, value in kept.items():
            setattr(*place, value)
    largest = np.maximum(np.abs(fine).max(axis=(1, 2, 3), keepdims=True), 1e-300)
    # Fields that vanish by symmetry hold nothing but round-off.
    kinds = np.repeat([largest[:6].max(), largest[6:12].max(), largest[12:].max()], [6, 6, 3])
    there = largest.ravel() > 1e-9 * kinds
    return float((np.abs(coarse - fine) / largest)[there].max())


FAR = np.linspace(0, 2, 20)
TEN = [0.0, 0.02, 0.06, 0.1, 0.15, 0.21, 0.3, 0.4, 0.51, 0.8]
DISC = tl.UniformDisc(0.12, 7.2e5)


def accuracy():
    load = footprint()
    four = [tl.UniformDisc(0.12, 7.2e5, x=x, y=y) for x in (0.0, 1.3) for y in (0.0, 0.375)]
    runs = [
        ("footprint of 8000 cells, surface of all cells", 0.3, partial(solved, load, [0.0], GRID.x, GRID.y)),
        ("footprint, 61 x 61 points, 6 depths", 1.5, partial(solved, load, TEN[:6], SQUARE, SQUARE)),
        ("one disc, 20 offsets x 10 depths", 0.3, partial(solved, DISC, TEN, FAR, np.zeros(1))),
        ("four discs, the same points", 0.3, partial(solved, four, TEN, FAR, np.zeros(1))),
        ("four discs, 61 x 61 points, 6 depths", 0.3, partial(solved, four, TEN[:6], SQUARE, SQUARE)),
        (
            "footprint on 10 mm of surfacing, 61 x 61, 0 5 10 20 mm",
            10.0,
            partial(solved, load, [0.0, 0.005, 0.01, 0.02], SQUARE, SQUARE, THIN),
        ),
    ]
    rows = []
    for name, goal, run in runs:
        seconds, _ = best_of(run)
        rows.append((name, seconds, goal, "kept" if seconds <= goal else "MISSED", error(run)))
    print_table("Four layers, 15 fields", ("run", "seconds", "goal", "", "error"), rows)


def growth():
    """Seconds as wheels, points and cells are doubled: never cells times points, on the load's lattice or off it."""
    rows = []
    line, depths = 0.012 * np.arange(-10, 10), TEN[:6]
    for count in (1, 2, 4, 8):
        discs = [tl.UniformDisc(0.12, 7.2e5, x=-0.3 + 0.6 * i / count) for i in range(count)]
        rows.append((f"{count} disc(s)", best_of(lambda discs=discs: solved(discs, depths, SQUARE, SQUARE))[0]))
    for count in (1, 2, 4):
        wheels = [footprint(Grid(100, 80, 3e-3, 3e-3, -0.15, -0.4 + 0.24 * i)) for i in range(count)]
        rows.append((f"{count} footprint(s)", best_of(lambda wheels=wheels: solved(wheels, depths, line, line))[0]))
    print_table("Wheels", ("wheels", "seconds"), rows)

    rows = []
    for count in (200, 400, 800, 1600, 3200):
        along, anywhere = 3e-3 * (np.arange(count // 20) - count // 40), np.linspace(-0.24, 0.23, count // 20)
        disc, _ = best_of(lambda x=along: solved(DISC, depths, x, line))
        cells, _ = best_of(lambda x=along: solved(footprint(), depths, x, line))
        off, _ = best_of(lambda x=anywhere: solved(footprint(), depths, x, line), repeats=1)
        rows.append((count, disc, cells, off))
    header = ("points", "disc, seconds", "footprint on its lattice", "footprint, points anywhere")
    print_table("Points of a depth", header, rows)

    rows = []
    for side in (6e-3, 4e-3, 3e-3, 2e-3, 1.5e-3):
        load = footprint(Grid.centred(0.3, 0.24, side))
        rows.append((load.pressure.size, best_of(lambda load=load: solved(load, depths, line, line))[0]))
    print_table("Cells of a footprint", ("cells", "seconds"), rows)
    off_the_lattice()


def off_the_lattice():
    """The surface at points that share no lattice, beside sums over cells, and how far apart the two are."""
    rng, header = np.random.default_rng(0), ("cells", "points", "seconds", "summed", "apart by largest value")
    for title, runs in (
        ("Points off the lattice", ((3e-3, 16), (3e-3, 31), (3e-3, 61), (3e-3, 121))),
        ("Cells off the lattice", ((6e-3, 61), (4e-3, 61), (3e-3, 61), (2e-3, 61))),
    ):
        rows = []
        for side, count in runs:
            grid = Grid.centred(0.3, 0.24, side)
            load = footprint(grid).array
            x, y = np.sort(rng.uniform(-0.3, 0.3, count)) - grid.x0, np.sort(rng.uniform(-0.3, 0.3, count)) - grid.y0

            def surface(method, load=load, side=side, x=x, y=y):
                fields = fields_on_grid(load, side, side, np.zeros(1), 1.0, 0.35, x, y, method)
                return np.concatenate(fields[:2], axis=1)[0]

            quick, found = best_of(lambda: surface("auto"))
            slow, exact = best_of(lambda: surface("direct"), repeats=1)
            # Beside the load the surface carries no traction.
            largest = np.maximum(np.abs(exact).max(axis=(1, 2)), 1e-300)
            rows.append(
                (load[0].size, count**2, quick, slow, float((np.abs(found - exact).max(axis=(1, 2)) / largest).max()))
            )
        print_table(title, header, rows)


def peer():
    """PyMastic, one disc at 20 offsets x 10 depths; its error is that of u_z and of stress_zz below the surface."""
    try:
        from Main.MLE import PyMastic
    except ImportError:
        print("PyMastic is absent: clone github.com/Mostafa-Nakhaei/PyMastic and put its folder on PYTHONPATH\n")
        return
    layers = ROAD.layers
    seconds, exact = best_of(lambda: solved(DISC, TEN, FAR, np.zeros(1)))
    apart = error(lambda: solved(DISC, TEN, FAR, np.zeros(1)))
    rows = [("treadload", seconds, apart, apart)]
    for terms in (25, 100, 200):

        def run(terms=terms):
            # Its moduli are a thousand times the unit of the pressure; compression counts positive.
            return PyMastic(
                DISC.pressure,
                DISC.radius,
                list(FAR),
                list(TEN),
                [layer.thickness for layer in layers[:-1]],
                [layer.material.modulus / 1e3 for layer in layers],
                [layer.material.poisson for layer in layers],
                isBounded=[1] * (len(layers) - 1),
                iteration=terms,
            )

        seconds, theirs = best_of(run, repeats=1)
        pairs = ((theirs["Displacement_Z"], exact[14, :, 0]), (-theirs["Stress_Z"], exact[2, :, 0]))
        errors = [float(np.abs(a - b)[1:].max() / np.abs(b).max()) for a, b in pairs]
        rows.append((f"PyMastic, {terms} terms", seconds, *errors))
    print_table("One disc, 200 points, beside PyMastic", ("program", "seconds", "error u_z", "error stress_zz"), rows)


def main():
    accuracy()
    growth()
    peer()


if __name__ == "__main__":
    main()
