"""Checks of rolling with viscoelastic bodies: CONTACT's cylinders, and Hunter's closed form."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import i0e, i1e, k0e, k1e

from treadload.contact.bodies.influence import Influence
from treadload.contact.bodies.viscoelastic import Material, rolling_pair
from treadload.contact.solvers.normal import solve_normal
from treadload.contact.solvers.rolling import rigid_slip, solve_rolling
from treadload.kernels.arrays import Array
from treadload.materials import Elastic, Prony
from treadload.validation.check import Check, absolute, relative
from treadload.validation.patches import LONG, Patch, centres

# Retardation time, s: peak pressure, MPa, approach, mm, cells in contact and in stick, creepage.
CYLINDERS = {
    0.009: (78.74, 2.36736, 62, 37, 1.365e-2),
    0.045: (84.72, 2.06321, 57, 36, 1.152e-2),
    2.0: (85.31, 1.45462, 56, 35, 9.932e-3),
}
_RIGID = Elastic(1e30, 0.3)


@dataclass(frozen=True)
class HunterCylinder:
    """Rigid cylinder that rolls without friction on a standard linear solid, in plane strain.

    half_width: c, m. centre: of the contact ahead of the axle, m. load: N/m. pressure_centre: ahead of the axle, m.
    scale: E*/2R, Pa/m, glassy. share: f. length: L = V T, m. extra: D, m², of the square-root terms.
    """

    half_width: float
    centre: float
    load: float
    pressure_centre: float
    scale: float
    share: float
    length: float
    extra: float

    def pressure(self, x: Array) -> Array:
        """Pressure, Pa, at positions x (n,), m, from the axle."""
        c, rate = self.half_width, (1 + self.share) / self.length
        nodes, weights = np.polynomial.legendre.leggauss(60)
        inside = np.clip((np.asarray(x, dtype=float) - self.centre) / c, -1.0, 1.0)
        # s = c sin θ takes away the roots at the ends.
        low = np.arcsin(inside)
        theta = 0.5 * (np.pi / 2 + low)[:, None] + 0.5 * (np.pi / 2 - low)[:, None] * nodes
        s = c * np.sin(theta)
        source = c**2 * np.cos(theta) ** 2 - (self.centre - self.length) * s + self.extra
        kept = np.exp(-rate * (s - c * inside[:, None]))
        return self.scale / self.length * 0.5 * (np.pi / 2 - low) * ((kept * source) @ weights)


def hunter(load: float, radius: float, modulus: float, share: float, length: float) -> HunterCylinder:
    """Closed form of rolling contact on a solid of creep compliance (1 + f (1 - exp(-t/T)))/E.

    load: N per m. radius: m. modulus: glassy E* = E/(1 - ν²), Pa. share: f. length: V T, m.
    With p = 0 outside, P = (1 + f) p - L p' solves an elastic problem of slope (L - x)/R; that p ends at both
    edges and that material enters undeformed give centre and half-width.
    Source: Hunter (1961), J. Appl. Mech. 28, 611-617.
    """
    scale = modulus / (2 * radius)

    def shape(c: float) -> tuple[float, float]:
        ahead, behind = k1e(c / length) / k0e(c / length), (1 + share) * c / length
        ratio = i1e(behind) / i0e(behind)
        centre = length * share / (1 + share) * ratio / (ratio + ahead)
        return centre, c * centre * ahead

    def carried(c: float) -> float:
        return scale * math.pi * (c * c / 2 + shape(c)[1]) / (1 + share)

    largest = 2 * math.sqrt((1 + share) * load / (math.pi * scale))
    c = brentq(lambda c: carried(c) - load, 1e-6 * largest, largest, xtol=1e-15, rtol=1e-14)
    centre, extra = shape(c)
    first = -scale * (centre - length) * math.pi * c * c / 2
    pressure_centre = centre + (first / load - length) / (1 + share)
    return HunterCylinder(c, centre, load, pressure_centre, scale, share, length, extra)


def cylinder(
    materials: tuple[Material, Material], speed: float, radius: float, load: float, x: Array, length: float
) -> Patch:
    """Cylinder of radius R, m, across the travel, under a load, N/m, on a row of cells at x, of a length, m."""
    dx = float(x[1] - x[0])
    influence = Influence((1, x.size), dx, length, rolling_pair(*materials, speed))
    normal = solve_normal(influence, x[None, :] ** 2 / (2 * radius), load=load * length, tolerance=1e-9)
    return Patch(x, np.zeros(1), influence, normal)


def polymer_cylinders(retardation: float) -> tuple[Patch, tuple[float, int, int, float]]:
    """CONTACT's example visc_cylindr: two like cylinders at 1 m/s, driven backwards with 0.6 μP.

    retardation: T, s. Returns the patch and (approach in mm, cells in contact, in stick, creepage).
    """
    material = Prony.from_creep(2 * 1143e6 * 1.4, ((1.0, retardation),), 0.4)
    x = 1e-3 * (-7.92 + 0.16 * np.arange(99))
    patch = cylinder((material, material), 1.0, 0.05, 600e3, x, 1.0)
    rigid = rigid_slip(x, np.zeros(1), 0.16e-3, (0.0, 0.0), 0.0)
    forces = (-0.6 * 0.3 * patch.load, 0.0)
    rolled = solve_rolling(patch.influence, 0.3 * patch.normal.pressure, rigid, forces, tolerance=1e-9)
    stuck = int((rolled.stick & patch.contact).sum())
    return patch, (1e3 * patch.normal.approach, int(patch.contact.sum()), stuck, rolled.rigid[0])


def hunter_strip(cells: int, length: float = 2.0, share: float = 1.5) -> tuple[Patch, HunterCylinder]:
    """A strip of about so many cells across the contact, and its closed form; lengths over the half-width near 1."""
    exact = hunter(1.0, 100.0, 2e2, share, length)
    material = Prony.from_creep(2e2, ((share, length),), 0.0)
    spacing = 2 * exact.half_width / cells
    x = centres(cells + 8, spacing, exact.centre)
    return cylinder((material, _RIGID), 1.0, 100.0, 1.0, x, LONG * exact.half_width), exact


def cylinder_checks() -> Iterator[Check]:
    """CONTACT's viscoelastic cylinders, cell by cell, and Hunter's cylinder."""
    source = "CONTACT (open source), example visc_cylindr"
    for time, (peak, approach, contact, stick, creepage) in CYLINDERS.items():
        group = f"viscoelastic cylinders, {time:g} s"
        patch, (sunk, touching, stuck, crept) = polymer_cylinders(time)
        # CONTACT integrates its coefficients to 1e-3.
        yield relative(group, "peak pressure, MPa", patch.normal.pressure.max() / 1e6, peak, 2e-4, source)
        yield relative(group, "approach, mm", sunk, approach, 3e-5, source)
        yield absolute(group, "cells in contact", touching, contact, 0, source)
        yield absolute(group, "cells in stick", stuck, stick, 0, source)
        yield relative(group, "creepage", crept, creepage, 4e-4, source)
    patch, exact = hunter_strip(200)
    group, source = "rigid cylinder on a standard linear solid", "Hunter (1961), J. Appl. Mech. 28, 611-617"
    pressure = patch.normal.pressure[0]
    centre = float((pressure * patch.x).sum() / pressure.sum())
    peak = float(exact.pressure(patch.x).max())
    yield relative(group, "pressure centre ahead of the axle, m", centre, exact.pressure_centre, 1e-3, source)
    yield relative(group, "peak pressure, Pa", pressure.max(), peak, 1e-3, source)
