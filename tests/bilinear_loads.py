"""Fields below a bilinear load at several depths, one by one."""

import numpy as np

from treadload.kernels.half_space.bilinear import bilinear_sums_on_grid


def bilinear_on_grid(load, dx, dy, depths, shear, poisson, x, y, method="auto"):
    """Stress (nz, 6, my, mx), Pa, displacement (nz, 3, my, mx), m, on a grid, and the methods that made them.

    load: (3, ny, nx), Pa, at the centres of cells. shear: modulus, Pa. x, y: relative to the centre of the first
    cell, m.
    """
    both, used = bilinear_sums_on_grid(load, dx, dy, depths, np.eye(len(depths)), poisson, x, y, method)
    return both[:, :6], both[:, 6:] / shear, used
