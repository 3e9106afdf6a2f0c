"""Theories of rough contact, for comparison: real area against pressure of an elastic body on a rough one.

E* is the plane-strain modulus, E/(1 - ν²) of rubber on a rigid road; slope the root of the mean square gradient.

Sources: Persson (2001), J. Chem. Phys. 115, 3840; Bush, Gibson & Thomas (1975), Wear 35, 87-111; Westergaard (1939),
J. Appl. Mech. 6, 49-53; Johnson, Greenwood & Higginson (1985), Int. J. Mech. Sci. 27, 383-396.
"""

from __future__ import annotations

import math

import numpy as np
import scipy

from treadload.kernels.arrays import Array


def persson_area(pressure: Array, modulus: float, slope: float) -> Array:
    """Share of the area that touches at pressures, Pa: erf(√2 p/(E* slope)); √(8/π) p/(E* slope) at light load."""
    return np.asarray(scipy.special.erf(math.sqrt(2) * np.asarray(pressure) / (modulus * slope)))


def asperity_area(pressure: Array, modulus: float, slope: float) -> Array:
    """The same by independent asperities, at vanishing load: √(2π) p/(E* slope)."""
    return np.asarray(math.sqrt(2 * math.pi) * np.asarray(pressure) / (modulus * slope))


def sine_area(pressure: Array, modulus: float, amplitude: float, wave: float) -> Array:
    """Share of the area that touches on ridges a·cos(2π x/λ): (2/π) asin √(p/p*), p* = π E* a/λ."""
    full = math.pi * modulus * amplitude / wave
    return np.asarray(2 / math.pi * np.arcsin(np.sqrt(np.clip(np.asarray(pressure) / full, 0, 1))))
