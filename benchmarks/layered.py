"""Layered roads: time and error of surface strain and of depths under a footprint, and of one disc.

On one core, after import. The error is against the same computed with waves followed further down, on panels
twice as fine, by the largest value of each field.
"""

import numpy as np
from timing import best_of, print_table

import treadload as tl
from treadload.grid import Grid
from treadload.kernels import wavenumbers
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


def footprint():
    x, y = GRID.x / 0.14, GRID.y[:, None] / 0.11
    pressure = 8e5 * np.maximum(0, 1 - x**4 - y**4)
    return GridLoad(GRID, pressure, 0.3 * pressure * x, 0.2 * pressure * np.ones_like(x))


def solved(loads, depths, x, y):
    loads = loads if isinstance(loads, list) else [loads]
    stress, strain, displacement, _ = layered.layered_response(loads, ROAD, np.array(depths), x, y, below=False)
    return np.concatenate([stress, strain, displacement])


def error(run):
    """Largest difference from a finer computation, by the largest value of each field."""
    kept = layered._FALL, wavenumbers._RATIO, wavenumbers._PHASE, wavenumbers._STEP
    coarse = run()
    try:
        layered._FALL, wavenumbers._RATIO, wavenumbers._PHASE, wavenumbers._STEP = 40.0, 2.0, 3.5, 0.1
        fine = run()
    finally:
        layered._FALL, wavenumbers._RATIO, wavenumbers._PHASE, wavenumbers._STEP = kept
    largest = np.maximum(np.abs(fine).max(axis=(1, 2, 3), keepdims=True), 1e-300)
    # Fields that vanish by symmetry hold nothing but round-off.
    kinds = np.repeat([largest[:6].max(), largest[6:12].max(), largest[12:].max()], [6, 6, 3])
    there = largest.ravel() > 1e-9 * kinds
    return float((np.abs(coarse - fine) / largest)[there].max())


def main():
    load = footprint()
    disc = tl.UniformDisc(0.12, 7.2e5)
    four = [tl.UniformDisc(0.12, 7.2e5, x=x, y=y) for x in (0.0, 1.3) for y in (0.0, 0.375)]
    far = np.linspace(0, 2, 20)
    ten = [0.0, 0.02, 0.06, 0.1, 0.15, 0.21, 0.3, 0.4, 0.51, 0.8]
    runs = [
        ("footprint of 8000 cells, surface of all cells", 0.3, lambda: solved(load, [0.0], GRID.x, GRID.y)),
        ("footprint, 61 x 61 points, 6 depths", 1.5, lambda: solved(load, ten[:6], SQUARE, SQUARE)),
        ("one disc, 20 offsets x 10 depths", 0.3, lambda: solved(disc, ten, far, np.zeros(1))),
        ("four discs, the same points", 0.3, lambda: solved(four, ten, far, np.zeros(1))),
    ]
    rows = []
    for name, goal, run in runs:
        seconds, _ = best_of(run)
        rows.append((name, seconds, goal, "kept" if seconds <= goal else "MISSED", error(run)))
    print_table("Four layers, 15 fields", ("run", "seconds", "goal", "", "error"), rows)


if __name__ == "__main__":
    main()
