"""One rib pressed in plane strain with friction: pressure and shear by quadratic programs in turn."""

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import lsq_linear, nnls

from treadload.kernels.sections import Section, face_compliance

MODULUS, MEAN = 5.5e6, 0.8e6


def strips(width, number):
    """(number, 2) edges of equal strips, m."""
    edges = np.linspace(0, width, number + 1)
    return np.stack([edges[:-1], edges[1:]], axis=1)


def pressed(*, width=0.04856, depth=0.015, undertread=0.005, poisson=0.495, friction=0.7, cells=24, edge=0.0029):
    """Edges of the strips, their pressure and their shear q_y on the rib, Pa, under a mean pressure of 0.8 MPa."""
    section = Section(((0.0, width),), depth + undertread, (undertread, undertread), (0.006, 0.006))
    places = strips(width, cells)
    table = face_compliance(section.for_cells(width / cells), poisson).on_cells(places)
    plane = table.compliance[0][cells:, cells:] / MODULUS
    sign = np.repeat([1.0, -1.0], cells)
    plane = plane * sign * sign[:, None]
    by_shear, by_pressure = plane[:cells, :cells], plane[:cells, cells:]
    opening, normal = plane[cells:, :cells], plane[cells:, cells:]
    y = places.mean(1)
    into = np.clip(edge - np.minimum(y, width - y), 0, edge)
    gap = edge - np.sqrt(edge**2 - into**2)
    root_of_shear, root = cholesky(by_shear, lower=True), cholesky(normal, lower=True)
    shear, approach = np.zeros(cells), MEAN * normal.sum(1).mean()
    for _ in range(60):
        rest = approach - gap - opening @ shear
        pressure = nnls(root.T, solve_triangular(root, rest, lower=True))[0]
        approach *= (MEAN / pressure.mean()) ** 0.7
        bound = friction * pressure + 1e-6 * MEAN
        aim = solve_triangular(root_of_shear, -by_pressure @ pressure, lower=True)
        found = lsq_linear(root_of_shear.T, aim, (-bound, bound), method="bvls").x
        change = np.abs(found - shear).max()
        shear = 0.3 * shear + 0.7 * found
        if change < 1e-4 * MEAN:
            return places, pressure, shear
    raise AssertionError(f"the shear still changes by {change:g} Pa")


def mean_over(places, field, low, high):
    """Mean of a field of strips from y = low to high, m."""
    covered = np.clip(np.minimum(places[:, 1], high) - np.maximum(places[:, 0], low), 0, None)
    return float((covered * field).sum() / (high - low))


def outer_third(**rib):
    """Shear of the outer thirds over the mean pressure."""
    width = rib.get("width", 0.04856)
    places, pressure, shear = pressed(**rib)
    thirds = mean_over(places, shear, 0, width / 3), mean_over(places, shear, 2 * width / 3, width)
    return abs(thirds[1] - thirds[0]) / (2 * pressure.mean())
