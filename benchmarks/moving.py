"""Loads that move over viscoelastic layers: time and error of a footprint's fields and of the ELLVA case.

On one core, after import. The error is against the same computed with finer cells of the wake, waves followed
further down and panels half as wide, by the largest value of each field at each depth.
"""

import numpy as np
from timing import best_of, print_table

import treadload as tl
from treadload.grid import Grid
from treadload.kernels.layers import wavenumbers
from treadload.response import GridLoad, moving

BINDER = tl.materials.Prony(12e9, ((0.3, 0.002), (0.3, 0.02), (0.2, 0.2), (0.1, 2.0)), 0.35)
ROAD = tl.Pavement(
    [
        tl.Layer(BINDER, 0.06),
        tl.Layer(tl.materials.Prony(14e9, ((0.3, 0.003), (0.3, 0.03)), 0.35), 0.15),
        tl.Layer(tl.Elastic(2e8, 0.35), 0.3),
        tl.Layer(tl.Elastic(5e7, 0.35)),
    ]
)
ELLVA = tl.Pavement(
    [
        tl.Layer(tl.materials.PowerLawCreep(2.5e-11, 1e-8, 1000.0, 0.35, 0.3), 0.15),
        tl.Layer(tl.Elastic(2e8, 0.35), 0.6),
        tl.Layer(tl.Elastic(4e7, 0.4)),
    ]
)
GRID = Grid.centred(0.3, 0.24, 3e-3)
NAMES = [f"{kind}_{c}" for kind in ("stress", "strain") for c in ("xx", "yy", "zz", "xy", "xz", "yz")]
NAMES += [f"displacement_{c}" for c in "xyz"]


def footprint():
    x, y = GRID.x / 0.14, GRID.y[:, None] / 0.11
    pressure = 8e5 * np.maximum(0, 1 - x**4 - y**4)
    return GridLoad(GRID, pressure, 0.3 * pressure * x, 0.2 * pressure * np.ones_like(x))


def solved(loads, road, **where):
    data = tl.solve_response(loads, road, **where).dataset
    return np.stack([data[name].to_numpy() for name in NAMES])


def error(run):
    """Largest difference from a finer computation, by the largest value of each field at each depth."""
    kept = moving._FALL, moving._PIECES, moving._FINER, wavenumbers._RATIO, wavenumbers._PHASE
    coarse = run()
    try:
        moving._FALL, moving._PIECES, moving._FINER = 40.0, 360, 6
        wavenumbers._RATIO, wavenumbers._PHASE = 2.0, 3.5
        fine = run()
    finally:
        moving._FALL, moving._PIECES, moving._FINER, wavenumbers._RATIO, wavenumbers._PHASE = kept
    largest = np.abs(fine).max(axis=(2, 3))
    # Fields that vanish by symmetry hold nothing but round-off.
    kinds = np.repeat([largest[:6].max(), largest[6:12].max(), largest[12:].max()], [6, 6, 3])
    there = largest > 1e-9 * kinds[:, None]
    return float((np.abs(coarse - fine).max(axis=(2, 3)) / np.where(there, largest, 1))[there].max())


def main():
    load, disc = footprint(), tl.UniformDisc(0.15, 1.1e6)
    path = np.linspace(-5, 5, 201)
    runs = [
        (
            "footprint of 8000 cells, surface and 3 depths of all cells, 4 layers",
            lambda: solved(load, ROAD, depths=[0.0, 0.02, 0.04, 0.06], speed=20.0),
        ),
        (
            "the same, surface alone",
            lambda: solved(load, ROAD, depths=[0.0], speed=20.0),
        ),
        (
            "ELLVA: disc on 3 layers, 201 points of a path of 10 m, surface",
            lambda: solved(disc, ELLVA, depths=[0.0], x=path, y=[0.3], speed=60 / 3.6),
        ),
    ]
    rows = []
    for name, run in runs:
        seconds, _ = best_of(run)
        rows.append((name, seconds, error(run)))
    print_table("Moving viscoelastic layers, 15 fields and the energy", ("run", "seconds", "error"), rows)


if __name__ == "__main__":
    main()
