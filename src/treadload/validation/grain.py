"""Checks of material with a grain: Hertz's pressure on tilted axes by one integral, and the stress below."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import root

from treadload.contact.bodies.choose import surface_of
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.normal import NormalSolution, solve_normal
from treadload.grid import Grid
from treadload.kernels.anisotropy.stiffness import rotated
from treadload.kernels.anisotropy.symbol import surface_symbol, symbol_at
from treadload.kernels.arrays import Array
from treadload.materials import Anisotropic, Orthotropic, TransverselyIsotropic
from treadload.materials.orthotropic import rotation
from treadload.pavement import Pavement
from treadload.response import GridLoad, solve_response
from treadload.validation.check import Check, absolute, relative

_DIRECTIONS = 512
_SOURCE = "Willis (1966), J. Mech. Phys. Solids 14, 163-176, in one integral"
# One stiff axis, of contrast 4, that leans by 34° and is turned by 40°.
LEANING = Orthotropic((1e9, 1e9, 4e9), (0.4e9, 0.45e9, 0.45e9), (0.25, 0.0625, 0.0625)).rotated(
    yaw=math.radians(40), pitch=math.radians(34)
)


@dataclass(frozen=True)
class TurnedEllipse:
    """Hertz contact on an anisotropic half-space: x·A x < 1 with A (2, 2), 1/m²; peak, Pa; approach, m."""

    shape: Array
    peak: float
    approach: float

    @property
    def axes(self) -> tuple[float, float]:
        """Long and short semi-axis, m."""
        short, long = np.linalg.eigvalsh(self.shape)[::-1] ** -0.5
        return float(long), float(short)

    @property
    def angle(self) -> float:
        """Of the long axis from x towards y, rad, in [0, π)."""
        _, vectors = np.linalg.eigh(self.shape)
        return float(math.atan2(vectors[1, 0], vectors[0, 0]) % math.pi)


def hertz_on_grain(material: Anisotropic, curvature: Array, load: float) -> TurnedEllipse:
    """Contact of a rigid paraboloid with a half-space of a material under a load, N.

    curvature: M (2, 2) of the gap x·M x, 1/m: a sphere of radius R has 1/2R twice. With p0 √(1 - x·A x) the surface
    sinks by (π/2) p0 ∫_0^π g(φ) [(1 - x·A x) α^(-1/2) + (n·A x)² α^(-3/2)] dφ, n = (cos φ, sin φ), α = n·A n and g/r
    the sinking under a point load: a paraboloid, so that A and p0 follow from its three coefficients.
    Source: Willis (1966).
    """
    angle = math.pi / _DIRECTIONS * np.arange(_DIRECTIONS)
    stiffness = material.stiffness
    # Each direction by itself, with as many turns as the symbol takes: no harmonics, no table.
    g = symbol_at(stiffness, angle + 0.5 * math.pi, surface_symbol(stiffness).means)[:, 2, 2].real / (2 * math.pi)
    along = np.stack([np.cos(angle), np.sin(angle)])
    across = np.stack([-along[1], along[0]])

    def of(unknown: Array) -> tuple[Array, Array]:
        """A of determinant 1, and ∫ g α^(-3/2) t t dφ, t across n: the curvature that it makes."""
        c, d = unknown
        size = math.hypot(c, d)
        ratio = math.sinh(size) / size if size > 0 else 1.0
        shape = math.cosh(size) * np.eye(2) + ratio * np.array([[c, d], [d, -c]])
        alpha = np.einsum("in,ij,jn->n", along, shape, along)
        return shape, np.einsum("n,in,jn->ij", g * alpha**-1.5, across, across) * math.pi / _DIRECTIONS

    def wrong(unknown: Array) -> list[float]:
        ellipse = of(unknown)[1]
        ellipse, shape_wanted = ellipse / np.trace(ellipse), curvature / np.trace(curvature)
        return [ellipse[0, 0] - shape_wanted[0, 0], ellipse[0, 1] - shape_wanted[0, 1]]

    shape, ellipse = of(root(wrong, np.zeros(2), tol=1e-14).x)
    scale = (4 * np.trace(curvature) / (3 * load * np.trace(ellipse))) ** (1 / 3)
    peak = 3 * load * scale**2 / (2 * math.pi)
    alpha = np.einsum("in,ij,jn->n", along, shape, along)
    sinking = float((g * alpha**-0.5).sum()) * math.pi / _DIRECTIONS
    return TurnedEllipse(scale**2 * shape, peak, math.pi / 2 * peak / scale * sinking)


def pressed(material: Anisotropic, curvature: Array, load: float, cells: int, width: float) -> NormalSolution:
    """A rigid paraboloid on a half-space, on cells x cells over a width, m."""
    spacing = width / cells
    x = spacing * (np.arange(cells) - 0.5 * (cells - 1))
    gap = curvature[0, 0] * x[None] ** 2 + curvature[1, 1] * x[:, None] ** 2
    gap = gap + 2 * curvature[0, 1] * x[None] * x[:, None]
    influence = Influence((cells, cells), spacing, spacing, surface_of(material, is_tire=False))
    return solve_normal(influence, gap, load=load, tolerance=1e-9)


def axes_of(pressure: Array) -> tuple[float, float]:
    """Long over short axis of a contact, and the angle of the long one, rad, by moments of the pressure."""
    ny, nx = pressure.shape
    y, x = np.arange(ny) - 0.5 * (ny - 1), np.arange(nx) - 0.5 * (nx - 1)
    xx, yy = (pressure * x**2).sum(), (pressure * y[:, None] ** 2).sum()
    xy = (pressure * x * y[:, None]).sum()
    values, vectors = np.linalg.eigh(np.array([[xx, xy], [xy, yy]]))
    return float(np.sqrt(values[1] / values[0])), float(math.atan2(vectors[1, 1], vectors[0, 1]) % math.pi)


def _zirconia() -> Check:
    """Contact modulus of monoclinic zirconia, which has 13 constants, for one direction of the normal."""
    constants = {(0, 0): 361, (1, 1): 408, (2, 2): 258, (3, 3): 99.9, (4, 4): 81.2, (5, 5): 126, (0, 1): 142,
                 (0, 2): 55, (1, 2): 196, (0, 4): -21.3, (1, 4): 31.2, (2, 4): -18.2, (3, 5): -22.7}  # fmt: skip
    stiffness = np.zeros((6, 6))
    for (i, j), value in constants.items():
        stiffness[i, j] = stiffness[j, i] = value
    polar, azimuth = math.pi * 12 / 29, 2 * math.pi * 33 / 59
    turn = rotation(azimuth, polar, 0.0).T
    symbol = surface_symbol(rotated(stiffness, turn))
    modulus = 2 / symbol.harmonics[2, 2, symbol.order].real
    source = "Mowlavi & Kamrin (2021), Granular Matter 23, table of their code"
    return relative("contact modulus", "monoclinic zirconia, GPa", modulus, 310.12638401904815, 1e-12, source)


def _below() -> Iterator[Check]:
    """Stress by the integral over directions beside the closed form of an upright axis, cell by cell."""
    upright = TransverselyIsotropic(5.4e9, 3.8e9, 1.6e9, 0.35, 0.25)
    ratio = 0.25 * 5.4 / 3.8
    same = Orthotropic((5.4e9, 5.4e9, 3.8e9), (2e9, 1.6e9, 1.6e9), (0.35, ratio, ratio))
    uniform = np.ones((1, 1))
    cell = GridLoad(Grid(1, 1, 0.02, 0.02, 0.0, 0.0), 8e5 * uniform, 1e5 * uniform, -2e5 * uniform)
    x = 0.003 + 0.01 * np.arange(-3, 4)
    for depth in (0.0, 0.001, 0.02):
        response, reference = (
            solve_response(cell, Pavement.half_space(material), depths=[depth], x=x, y=x).dataset
            for material in (same, upright)
        )
        names = [f"stress_{name}" for name in ("xx", "yy", "zz", "xy", "xz", "yz")]
        apart = max(float(np.abs(response[name] - reference[name]).max()) for name in names) / 8e5
        what = f"largest stress apart at {depth * 1e3:g} mm, over p"
        yield absolute("stress, any anisotropy", what, apart, 0.0, 1e-9, "closed form of an upright axis")


def grain_checks() -> Iterator[Check]:
    """A rigid sphere on a solid whose stiff axis leans, 64 cells over 2.6 radii of the contact, and stress below."""
    curvature, load = np.eye(2) / 2, 1e6
    exact = hertz_on_grain(LEANING, curvature, load)
    contact = pressed(LEANING, curvature, load, 64, 2.6 * exact.axes[0])
    group = "Hertz, axis leaning 34°"
    yield relative(group, "approach, mm", contact.approach * 1e3, exact.approach * 1e3, 5e-4, _SOURCE)
    yield relative(group, "peak pressure, MPa", contact.pressure.max() / 1e6, exact.peak / 1e6, 2e-3, _SOURCE)
    ratio, angle = axes_of(contact.pressure)
    long, short = exact.axes
    yield relative(group, "long over short axis", ratio, long / short, 5e-4, _SOURCE)
    yield absolute(group, "angle of the long axis, °", math.degrees(angle), math.degrees(exact.angle), 0.5, _SOURCE)
    yield _zirconia()
    yield from _below()
