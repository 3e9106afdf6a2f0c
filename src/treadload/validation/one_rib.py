"""One rib pressed in plane strain with friction: pressure and shear by quadratic programs in turn."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.optimize import lsq_linear, nnls

from treadload.errors import ConvergenceError
from treadload.kernels.arrays import Array
from treadload.kernels.sections import FaceTable, Section, face_compliance

# Of the rubber, and the mean pressure on the rib, Pa.
_MODULUS, _MEAN = 5.5e6, 0.8e6
# Width of the tread beyond the walls, m, rounds of pressure and shear, the change that ends them, over the mean, and
# the smallest bound of a shear.
_BESIDE, _ROUNDS, _CHANGE, _LEAST = 6e-3, 60, 1e-4, 1e-6


@dataclass(frozen=True)
class PressedRib:
    """A rib under a mean pressure of 0.8 MPa, E = 5.5 MPa.

    width, depth, undertread: m. edge: radius of its edges, m. cells: across.
    """

    width: float = 0.04856
    depth: float = 0.015
    undertread: float = 0.005
    edge: float = 0.0029
    poisson: float = 0.495
    friction: float = 0.7
    cells: int = 24

    @property
    def places(self) -> Array:
        """(cells, 2) edges of the strips, m."""
        return strips(self.width, self.cells)


def strips(width: float, number: int) -> Array:
    """(number, 2) edges of equal strips, m."""
    edges = np.linspace(0, width, number + 1)
    return np.stack([edges[:-1], edges[1:]], axis=1)


@lru_cache(maxsize=4)
def pressed(rib: PressedRib) -> tuple[Array, Array]:
    """Pressure of the strips and their shear q_y on the rib, Pa (cells,), not to be written to.

    Raises ConvergenceError where pressure and shear do not come to rest.
    """
    cells, places = rib.cells, rib.places
    section = Section(
        ((0.0, rib.width),), rib.depth + rib.undertread, (rib.undertread, rib.undertread), (_BESIDE, _BESIDE)
    )
    table = _plane_table(section.for_cells(rib.width / cells), rib.poisson).on_cells(places)
    plane = table.compliance[0][cells:, cells:] / _MODULUS
    sign = np.repeat([1.0, -1.0], cells)
    plane = plane * sign * sign[:, None]
    by_shear, by_pressure = plane[:cells, :cells], plane[:cells, cells:]
    opening, normal = plane[cells:, :cells], plane[cells:, cells:]
    y = places.mean(1)
    into = np.clip(rib.edge - np.minimum(y, rib.width - y), 0, rib.edge)
    gap = rib.edge - np.sqrt(rib.edge**2 - into**2)
    root_of_shear, root = cholesky(by_shear, lower=True), cholesky(normal, lower=True)
    shear, approach, change = np.zeros(cells), _MEAN * normal.sum(1).mean(), np.inf
    for _ in range(_ROUNDS):
        rest = approach - gap - opening @ shear
        pressure = nnls(root.T, solve_triangular(root, rest, lower=True))[0]
        approach *= (_MEAN / pressure.mean()) ** 0.7
        bound = rib.friction * pressure + _LEAST * _MEAN
        aim = solve_triangular(root_of_shear, -by_pressure @ pressure, lower=True)
        after = lsq_linear(root_of_shear.T, aim, (-bound, bound), method="bvls").x
        change = float(np.abs(after - shear).max())
        shear = 0.3 * shear + 0.7 * after
        if change < _CHANGE * _MEAN:
            return pressure, shear
    raise ConvergenceError(f"pressure and shear of a rib still change by {change:g} Pa after {_ROUNDS} rounds")


@lru_cache(maxsize=4)
def _plane_table(section: Section, poisson: float) -> FaceTable:
    return face_compliance(section, poisson, waves=np.zeros(1))


def mean_over(places: Array, field: Array, low: float, high: float) -> float:
    """Mean of a field of strips from y = low to high, m."""
    covered = np.clip(np.minimum(places[:, 1], high) - np.maximum(places[:, 0], low), 0, None)
    return float((covered * field).sum() / (high - low))


def outer_third(rib: PressedRib) -> float:
    """Shear of the outer thirds over the mean pressure."""
    pressure, shear = pressed(rib)
    third = rib.width / 3
    left, right = (mean_over(rib.places, shear, *part) for part in ((0, third), (2 * third, rib.width)))
    return abs(right - left) / (2 * float(pressure.mean()))


def outer_pin(rib: PressedRib, pin: float = 9.7e-3) -> float:
    """Shear of a pin at the edge over the mean pressure. pin: its width, m."""
    pressure, shear = pressed(rib)
    return abs(mean_over(rib.places, shear, rib.width - pin, rib.width)) / float(pressure.mean())


def half_rib(rib: PressedRib) -> float:
    """Lateral force of half of the rib over the load of the rib."""
    pressure, shear = pressed(rib)
    return abs(mean_over(rib.places, shear, rib.width / 2, rib.width)) / (2 * float(pressure.mean()))
