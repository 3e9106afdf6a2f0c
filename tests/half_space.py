"""Stress of a half-space on the load's own cells, at scattered points and under one rectangle, for several tests."""

import numpy as np

from treadload.kernels.half_space.interior import fields_on_grid


def stress_on_grid(load, dx, dy, depths, poisson, x, y, method="auto"):
    """(nz, 6, my, mx), and the methods."""
    stress, _, used = fields_on_grid(load, dx, dy, depths, 1.0, poisson, x, y, method)
    return stress, used


def stress_on_cells(load, dx, dy, depths, poisson):
    """(nz, 6, ny, nx) at the centres of the cells, by FFT."""
    _, ny, nx = load.shape
    return stress_on_grid(load, dx, dy, depths, poisson, dx * np.arange(nx), dy * np.arange(ny), method="fft")[0]


def stress_at_points(load, dx, dy, depths, poisson, x, y):
    """(nz, 6, n) at points x, y (n,), by summing over the cells."""
    one = [
        stress_on_grid(load, dx, dy, depths, poisson, x[k : k + 1], y[k : k + 1], method="direct")[0][..., 0]
        for k in range(len(x))
    ]
    return np.concatenate(one, axis=2)


def stress_by_unit_loads(x, y, z, dx, dy, poisson):
    """(3, 6, n) at points x, y (n,) from the centre of one rectangle, under unit pressure, shear along x, along y."""
    return np.stack(
        [stress_at_points(unit.reshape(3, 1, 1), dx, dy, np.array([z]), poisson, x, y)[0] for unit in np.eye(3)]
    )
