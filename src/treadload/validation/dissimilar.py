"""Checks of rolling with dissimilar bodies, where pressure and shear act on each other, through solve_contact."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.contact import Contact, Rolling, solve_contact
from treadload.materials import Elastic
from treadload.pavement import Pavement
from treadload.tire import Tire
from treadload.validation.check import Check, absolute, relative
from treadload.validation.patches import centres

_LOAD = 16201.9  # N on a metre of strip, CONTACT's example bentall


def _material(shear_modulus: float, poisson: float) -> Elastic:
    return Elastic(2 * shear_modulus * (1 + poisson), poisson)


def aluminium_on_steel(friction: float, **rolling: float) -> Contact:
    """Aluminium cylinder that rolls on steel: half-width 0.1 mm, R = 25 mm, 200 cells, as in CONTACT's bentall.

    CONTACT rolls towards -x there: forces and creepages change sign.
    """
    # One row of cells 1 m long; rows without material keep the contact off the border.
    x = centres(216, 1e-6)
    gap = np.full((3, x.size), np.nan)
    gap[1] = x**2 / (2 * 0.025)
    tire = Tire.from_height_map(gap, (1e-6, 1.0), material=_material(23e9, 0.31))
    road = Pavement.half_space(_material(82e9, 0.28))
    return solve_contact(tire, road, Rolling(normal_load=_LOAD, friction=friction, **rolling))


def free_creepage_without_friction() -> float:
    """Creepage of the strip at which vanishing friction carries no force, by interpolation between two."""
    low, high = -5.30e-4, -5.22e-4
    f_low, f_high = (float(aluminium_on_steel(1e-4, creepage_x=xi).dataset.tractive_force) for xi in (low, high))
    return low - f_low * (high - low) / (f_high - f_low)


def bentall_checks() -> Iterator[Check]:
    """Free and driven rolling of a strip with Dundurs' β = 0.144."""
    group, source = "Bentall-Johnson strip, β = 0.144", "CONTACT (open source), example bentall"
    for friction, along, creepage, peak in (
        (0.05, 0.0, 4.294e-4, 103.6),
        (0.05, 0.75, 5.392e-4, None),
        (0.05, -0.75, 2.108e-4, None),
        (10.0, 0.0, 3.591e-4, 103.8),
    ):
        fields = aluminium_on_steel(friction, tractive_force=along * friction * _LOAD).dataset
        what = f"μ = {friction:g}, Q_x = {along:g} μP"
        yield relative(group, f"creepage at {what}", fields.creepage_x, -creepage, 3e-4, source)
        if peak is not None:
            yield relative(group, f"peak pressure at {what}, MPa", fields.pressure.max() / 1e6, peak, 1e-3, source)
    # ξ = 0.457 · 2βa/R, β of the same two materials.
    beta = float(aluminium_on_steel(0.05).stats["dundurs"])
    exact = -0.457 * 2 * beta * 1e-4 / 0.025
    source = "Bentall & Johnson (1967), Int. J. Mech. Sci. 9, 389-404"
    yield relative(
        group, "creepage without friction, μ = 1e-4", free_creepage_without_friction(), exact, 2e-3, source
    )


def rubber_on_asphalt(**rolling: float) -> Contact:
    """Smooth tire of ν = 0.45 on asphalt, 35 kN, μ = 0.7, on 28 x 52 cells of 12 mm."""
    x, y = centres(28, 0.012), centres(52, 0.012)
    gap = x[None, :] ** 2 + y[:, None] ** 2 / 3
    tire = Tire.from_height_map(gap, 0.012, material=Elastic(3e6, 0.45))
    road = Pavement.half_space(Elastic(5.4e9, 0.35))
    return solve_contact(tire, road, Rolling(normal_load=35e3, friction=0.7, **rolling))


def rubber_checks() -> Iterator[Check]:
    """A tire of ν = 0.45 that drives and turns, cell by cell as CONTACT has it."""
    fields = rubber_on_asphalt(tractive_force=10e3, lateral_force=5e3).dataset
    group, source = "rubber (ν = 0.45) on asphalt", "CONTACT (open source), revision 2707, same cells"
    yield relative(group, "creepage x at 10 and 5 kN", fields.creepage_x, -0.0453690099645, 1e-5, source)
    yield relative(group, "creepage y at 10 and 5 kN", fields.creepage_y, -0.0272324641267, 1e-5, source)
    yield relative(group, "peak pressure, kPa", fields.pressure.max() / 1e3, 516.700158987, 1e-5, source)
    largest = np.hypot(fields.traction_x, fields.traction_y).max() / 1e3
    yield relative(group, "largest shear, kPa", largest, 280.381964357, 1e-5, source)
    yield relative(group, "aligning moment, N m", fields.aligning_moment, -185.317367499, 1e-5, source)
    yield absolute(group, "cells in contact", (fields.state > 0).sum(), 715, 0, source)
    yield absolute(group, "cells in slip", (fields.state == 2).sum(), 193, 0, source)
    free = rubber_on_asphalt().dataset
    yield relative(group, "creepage in free rolling", free.creepage_x, -0.00798529089052, 1e-5, source)
    shear = math.sqrt(float((free.traction_x**2 + free.traction_y**2).max())) / 1e3
    yield relative(group, "largest shear in free rolling, kPa", shear, 41.0360298961, 1e-4, source)
