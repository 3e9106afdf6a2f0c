"""Checks of the tangential contact of like bodies: strips and discs with closed forms, Kalker's table, CONTACT."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from treadload.contact.bodies.half_space import HalfSpaces
from treadload.contact.bodies.influence import Influence
from treadload.contact.solvers.rolling import rigid_slip, solve_rolling
from treadload.contact.solvers.shift import solve_shift
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.validation.check import Check, absolute, relative
from treadload.validation.closed_forms import (
    carter_shear,
    carter_stick,
    cattaneo_shear,
    cattaneo_shift,
    hertz,
    hertz_of_axes,
)
from treadload.validation.patches import LONG, centres, cylinder, paraboloid

_CONTACT = "CONTACT (open source), example"

# Longitudinal creepage and -Q_x/μP of CONTACT's example tractcurv, Coulomb friction.
CREEP_CURVE = (
    (1e-5, 0.007015),
    (4e-4, 0.2588),
    (8e-4, 0.4742),
    (1.2e-3, 0.6482),
    (1.6e-3, 0.7831),
    (2e-3, 0.8816),
    (2.4e-3, 0.9467),
    (2.8e-3, 0.9832),
    (3.2e-3, 0.9976),
    (3.6e-3, 0.9991),
)


def carter_checks() -> Iterator[Check]:
    """Rolling strip: closed form with 200 cells across, CONTACT with 50."""
    bodies = CombinedElasticity(1.0, 0.28, 0.0)
    radius, friction, number = 100.0, 0.3, 200
    peak = bodies.contact_modulus / (2 * radius)
    creepage = -0.4 * friction / radius
    spacing = 2 / number
    patch = cylinder(bodies, radius, np.pi * peak / 2, number + 6, spacing, LONG)
    rolled = patch.roll(friction, (creepage, 0.0), tolerance=1e-9)
    stick = carter_stick(creepage, radius, 1.0, friction)
    error = rolled.shear[0, 0] / (friction * peak) - carter_shear(patch.x, stick)
    edge = float(patch.x[rolled.stick[0] & patch.contact[0]].min()) - spacing / 2
    source = "Carter (1926); Johnson (1985), section 8.3"
    group = "Carter strip, 200 cells"
    yield absolute(group, "largest error of shear over μp0", float(np.abs(error).max()), 0, 0.02, source)
    yield absolute(group, "edge of the stick zone, cells", edge / spacing, (1 - 2 * stick) / spacing, 1.0, source)
    force = patch.force(rolled.shear)[0] / (friction * patch.load)
    yield relative(group, "Q_x/μP", force, 1 - stick**2, 0.01, source)

    steel = CombinedElasticity(82e9, 0.28, 0.0)
    patch = cylinder(steel, 0.5, 178.9e3, 55, 4e-5, 0.2, shift=3e-5)
    rolled = patch.roll(0.3, (-2.4e-4, 0.0))
    slipping = int((patch.contact & ~rolled.stick).sum())
    group, source = "Carter strip, CONTACT's grid", f"{_CONTACT} carter2d"
    yield relative(group, "Q_x/μP", patch.force(rolled.shear)[0] / (0.3 * patch.load), 0.6480, 1e-3, source)
    yield absolute(group, "cells in contact", patch.contact.sum(), 50, 0, source)
    yield absolute(group, "cells in slip", slipping, 20, 0, source)
    yield relative(group, "approach, mm", patch.normal.approach * 1e3, 6.492e-3, 1e-3, source)


def cattaneo_checks() -> Iterator[Check]:
    """Shifted disc: closed form for ν = 0 with 128 cells across, CONTACT for ν = 0.42 with 15."""
    bodies = CombinedElasticity(1.0, 0.0, 0.0)
    number, friction, stick = 128, 0.3, 0.5
    exact = hertz(100.0, 100.0, 4 * bodies.contact_modulus / 300, bodies.contact_modulus)
    spacing = 2 / number
    patch = paraboloid(bodies, (100.0, 100.0), exact.load, (number + 4, number + 4), (spacing, spacing))
    force = -friction * patch.load * (1 - stick**3)
    bound = friction * patch.normal.pressure
    shifted = solve_shift(patch.influence, bound, np.zeros((2, *bound.shape)), (force, 0.0))
    r = np.hypot(patch.x[None, :], patch.y[:, None])
    error = shifted.shear[0] / (friction * exact.peak) + cattaneo_shear(r, stick)
    sticking = shifted.stick & patch.contact
    outermost, innermost = r[sticking].max(), r[patch.contact & ~shifted.stick].min()
    off = max(outermost - stick, stick - innermost) / spacing
    group, source = "Cattaneo-Mindlin, 128 cells", "Cattaneo (1938), Mindlin (1949); Johnson (1985), section 7.2"
    yield absolute(group, "largest error of shear over μp0", float(np.abs(error).max()), 0, 0.02, source)
    yield absolute(group, "error of the edge of the stick disc, cells", off, 0, 1.0, source)
    shift = cattaneo_shift(exact.load, friction, exact.a, 1.0, 0.0, stick)
    yield relative(group, "shift, 1e-3 radii", shifted.rigid[0] * 1e3, shift * 1e3, 0.01, source)

    bodies = CombinedElasticity(200e6, 0.42, 0.0)
    load = 4 * bodies.contact_modulus * 1e-9 / (3 * 0.05)
    patch = paraboloid(bodies, (0.05, 0.05), load, (19, 19), (1.3333e-4, 1.3333e-4))
    bound = 0.4 * patch.normal.pressure
    shifted = solve_shift(patch.influence, bound, np.zeros((2, 19, 19)), (-0.875 * 0.4 * load, 0.0))
    group, source = "Cattaneo shift, CONTACT's grid", f"{_CONTACT} cattaneo"
    yield relative(group, "shift, mm", shifted.rigid[0] * 1e3, 8.155e-3, 2e-4, source)
    yield absolute(group, "cells in contact", patch.contact.sum(), 177, 0, source)
    yield absolute(group, "cells in slip", (patch.contact & ~shifted.stick).sum(), 132, 0, source)
    yield relative(group, "peak pressure, MPa", patch.normal.pressure.max() / 1e6, 4.393, 2e-4, source)


def kalker_coefficients(poisson: float, cells: int, ratio: float = 1.0) -> dict[str, float]:
    """C11, C22, C23, C33 of an ellipse a/b = ratio by rolling without slip, cells across each axis.

    Forces are taken per area of the cells inside the ellipse, not of the ellipse: c² = ab = area/π.
    """
    a, b = np.sqrt(ratio), 1 / np.sqrt(ratio)
    bodies = CombinedElasticity(1.0, poisson, 0.0)
    dx, dy = 2 * a / cells, 2 * b / cells
    x, y = centres(cells + 2, dx), centres(cells + 2, dy)
    inside = (x[None, :] / a) ** 2 + (y[:, None] / b) ** 2 < 1
    influence = Influence(inside.shape, dx, dy, HalfSpaces(bodies))
    # A bound far above the shear of a unit creepage: every cell sticks.
    bound = np.where(inside, 1e3, 0.0)
    c = float(np.sqrt(inside.sum() * dx * dy / np.pi))

    def response(creepages: tuple[float, float], spin: float) -> tuple[float, float, float]:
        rigid = rigid_slip(x, y, dx, creepages, spin)
        shear = solve_rolling(influence, bound, rigid, (None, None), tolerance=1e-7).shear
        moment = (x[None, :] * shear[1] - y[:, None] * shear[0]).sum()
        return float(shear[0].sum() * dx * dy), float(shear[1].sum() * dx * dy), float(moment * dx * dy)

    along, across, turning = response((-1.0, 0.0), 0.0), response((0.0, -1.0), 0.0), response((0.0, 0.0), -1.0)
    return {"C11": along[0] / c**2, "C22": across[1] / c**2, "C23": turning[1] / c**3, "C33": turning[2] / c**4}


def kalker_checks() -> Iterator[Check]:
    """Creepage coefficients of a disc, ν = 0.25, 100 cells across."""
    group, coefficients = "Kalker, a/b = 1, ν = 0.25", kalker_coefficients(0.25, 100)
    for name, printed in (("C11", 4.12), ("C22", 3.67), ("C23", 1.47), ("C33", 1.19)):
        yield relative(group, f"{name}, 100 cells", coefficients[name], printed, 0.02, "Kalker (1990), table E.3")


def creep_curve() -> list[tuple[float, float, float]]:
    """(creepage, -Q_x/μP here, in CONTACT) along the example tractcurv: a/b = 0.5 on 48 x 44 cells."""
    bodies = CombinedElasticity(82e9, 0.28, 0.0)
    # The example gives one curvature and a/b; its grid is 1.1 times the ellipse.
    exact = hertz_of_axes(6.304e-3, 12.61e-3, 106.7e3, bodies.contact_modulus)
    radii = exact.radius_x, exact.radius_y
    patch = paraboloid(bodies, radii, 106.7e3, (44, 48), (0.2889e-3, 0.6304e-3))
    curve = []
    for creepage, printed in CREEP_CURVE:
        force = patch.force(patch.roll(0.33, (creepage, 0.0)).shear)[0]
        curve.append((creepage, -float(force) / (0.33 * patch.load), printed))
    return curve


def disc_checks() -> Iterator[Check]:
    """Rolling disc against CONTACT on the same cells, and its creep curve of an ellipse."""
    curve = creep_curve()
    worst = max(curve, key=lambda row: abs(row[1] - row[2]))
    yield absolute(
        "creep curve, a/b = 0.5",
        f"Q_x/μP, worst of {len(curve)} creepages ({worst[0]:g})",
        worst[1],
        worst[2],
        2e-4,
        f"{_CONTACT} tractcurv",
    )
    bodies = CombinedElasticity(80e9, 0.25, 0.0)
    radius = 1 / (2 * 0.785398163397)
    patch = paraboloid(bodies, (radius, radius), 48254.8631591, (31, 31), (0.48e-3, 0.48e-3))
    limit = 0.3 * patch.load
    group, source = "rolling disc, 25 cells", "CONTACT (open source), revision 2707, same cells"
    rolled = patch.roll(0.3, forces=(0.5 * limit, None))
    yield relative(group, "creepage at Q_x = 0.5 μP", rolled.rigid[0], -7.19547044161e-4, 1e-5, source)
    rolled = patch.roll(0.3, forces=(0.4 * limit, 0.4 * limit))
    yield relative(group, "creepage x at Q_x = Q_y = 0.4 μP", rolled.rigid[0], -5.9872499688e-4, 1e-5, source)
    yield relative(group, "creepage y at Q_x = Q_y = 0.4 μP", rolled.rigid[1], -6.67071785776e-4, 1e-5, source)
    slipping = (patch.contact & ~rolled.stick).sum()
    yield absolute(group, "cells in slip at Q_x = Q_y = 0.4 μP", slipping, 175, 0, source)
    peak = np.hypot(*rolled.shear).max() / 1e6
    yield relative(group, "largest shear at Q_x = Q_y = 0.4 μP, MPa", peak, 168.489444568, 1e-5, source)

    bodies = CombinedElasticity(1.0, 0.25, 0.0)
    exact = hertz(10.0, 10.0, 4 * bodies.contact_modulus / 30, bodies.contact_modulus)
    patch = paraboloid(bodies, (10.0, 10.0), exact.load, (64, 64), (0.04, 0.04))
    unit = 0.3 * exact.load / 4.12
    along, across = patch.force(patch.roll(0.3, (0.5 * unit, 0.4 * unit), -unit).shear) / (0.3 * patch.load)
    group = "rolling disc with spin, 50 cells"
    # Its cells are of about, not of exactly, this size: the bounds are those of a staircase rim.
    source = "CONTACT (open source), similar cells; creepages (0.5, 0.4, -1) μP/GC11"
    yield relative(group, "Q_x/μP", along, -0.3501, 0.01, source)
    yield relative(group, "Q_y/μP", across, 0.03928, 0.02, source)
