"""Closed forms of contact mechanics that the solvers are held against.

E* is the contact modulus, G the combined shear modulus and ν the combined Poisson's ratio of
`kernels.half_space.rectangle.CombinedElasticity`. Gaps are x²/2R_x + y²/2R_y.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from treadload.kernels.arrays import Array


@dataclass(frozen=True)
class Ellipse:
    """Hertz contact: semi-axes a along x and b along y, m; peak pressure, Pa; approach, m; radii R_x, R_y, m."""

    a: float
    b: float
    peak: float
    approach: float
    radius_x: float
    radius_y: float

    @property
    def load(self) -> float:
        """P = 2π a b p0 / 3, N."""
        return 2 * math.pi / 3 * self.a * self.b * self.peak

    def pressure(self, x: Array, y: Array) -> Array:
        """p0 √(1 - x²/a² - y²/b²), Pa, at x, y that broadcast."""
        inside = np.maximum(0.0, 1 - (x / self.a) ** 2 - (y / self.b) ** 2)
        return np.asarray(self.peak * np.sqrt(inside))


def hertz(radius_x: float, radius_y: float, load: float, contact_modulus: float) -> Ellipse:
    """Hertz contact of a paraboloid with radii R_x and R_y, m, under a load, N; contact_modulus: E*, Pa.

    Source: Johnson (1985), Contact Mechanics, section 4.2, with complete elliptic integrals.
    """
    short, long = sorted((radius_x, radius_y))
    if math.isclose(short, long, rel_tol=1e-9):
        a = (3 * load * short / (4 * contact_modulus)) ** (1 / 3)
        return Ellipse(a, a, 3 * load / (2 * math.pi * a * a), a * a / short, radius_x, radius_y)

    def curvature_ratio(k: float) -> float:
        m = 1 - k * k
        return float((ellipe(m) / k**2 - ellipk(m)) / (ellipk(m) - ellipe(m)))

    k = float(brentq(lambda k: curvature_ratio(k) - long / short, 1e-6, 1 - 1e-9, xtol=1e-14))
    m = 1 - k * k
    # The ellipse is long where the body is flat.
    major = (3 * load * long * float(ellipk(m) - ellipe(m)) / (math.pi * contact_modulus * m)) ** (1 / 3)
    minor = k * major
    peak = 3 * load / (2 * math.pi * major * minor)
    approach = peak * minor * float(ellipk(m)) / contact_modulus
    a, b = (minor, major) if radius_x < radius_y else (major, minor)
    return Ellipse(a, b, peak, approach, radius_x, radius_y)


def hertz_of_axes(a: float, b: float, load: float, contact_modulus: float) -> Ellipse:
    """Hertz contact with semi-axes a and b, m: the radii that make it. Source: as `hertz`."""
    peak = 3 * load / (2 * math.pi * a * b)
    minor, major = sorted((a, b))
    if math.isclose(a, b, rel_tol=1e-9):
        radius = 2 * contact_modulus * a / (math.pi * peak)
        return Ellipse(a, b, peak, a * a / radius, radius, radius)
    m = 1 - (minor / major) ** 2
    scale = peak / contact_modulus * minor / (m * major**2)
    flat = 1 / (2 * scale * float(ellipk(m) - ellipe(m)))
    steep = 1 / (2 * scale * float((major / minor) ** 2 * ellipe(m) - ellipk(m)))
    approach = peak * minor * float(ellipk(m)) / contact_modulus
    return Ellipse(a, b, peak, approach, *((steep, flat) if a < b else (flat, steep)))


def carter_stick(creepage: float, radius: float, half_width: float, friction: float) -> float:
    """Half the length of the stick zone over the half-width of the strip. Source: Carter (1926)."""
    return 1 - radius * abs(creepage) / (friction * half_width)


def carter_shear(x: Array, stick: float) -> Array:
    """|q| / μp0 on a strip |x| < 1 that rolls towards +x, with stick next to x = 1. Source: Carter (1926)."""
    inner = (x - 1 + stick) / stick
    whole = np.sqrt(np.maximum(0.0, 1 - x**2))
    return np.asarray(whole - stick * np.sqrt(np.maximum(0.0, 1 - inner**2)))


def cattaneo_shear(r: Array, stick: float) -> Array:
    """|q| / μp0 on a disc r < 1 that sticks where r < stick; exact for ν = 0.

    Source: Cattaneo (1938), Mindlin (1949); Johnson (1985), section 7.2.
    """
    whole = np.sqrt(np.maximum(0.0, 1 - r**2))
    return np.asarray(whole - stick * np.sqrt(np.maximum(0.0, 1 - (r / stick) ** 2)))


def cattaneo_shift(
    load: float, friction: float, half_width: float, shear_modulus: float, poisson: float, stick: float
) -> float:
    """Shift of the bodies, m, when a disc sticks within `stick` of its radius.

    load: N. half_width: a, m. shear_modulus: G, Pa. Source: Johnson (1985), section 7.2.
    """
    scale = 3 * friction * load / (2 * math.pi * half_width * shear_modulus)
    return scale * (1 - stick**2) * (math.pi / 2 - poisson * math.pi / 4)


def hertz_axis_stress(zeta: Array, poisson: float) -> tuple[Array, Array]:
    """(radial, vertical) stress over p0 on the axis of a Hertz disc at depths zeta·a > 0.

    Source: Johnson (1985), eq. 3.45.
    """
    vertical = -1 / (1 + zeta**2)
    radial = -(1 + poisson) * (1 - zeta * np.arctan(1 / zeta)) - vertical / 2
    return np.asarray(radial), np.asarray(vertical)


def disc_axis_stress(zeta: Array, poisson: float) -> tuple[Array, Array]:
    """(radial, vertical) stress over p on the axis of a uniform disc at depths zeta·a.

    Source: Ahlvin & Ulery (1962), Highway Research Board Bulletin 342, 1-13.
    """
    c = zeta / np.hypot(1, zeta)
    radial = -(1 + 2 * poisson - 2 * (1 + poisson) * c + c**3) / 2
    return np.asarray(radial), np.asarray(-(1 - c**3))
