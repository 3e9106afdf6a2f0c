"""Functions of time and their Carson transforms, s ∫ f(t) exp(-st) dt over t > 0.

The transform of a creep or relaxation function has no singularity off the negative real axis of s, and is what
E* or 1/E* becomes where iω is replaced by s. Both directions converge geometrically in the number of nodes.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from treadload.kernels.arrays import Array, ComplexArray

Transform = Callable[[ComplexArray], ComplexArray]

# 3.89^-24 is 7e-15.
_CONTOUR_NODES = 24
# Step and ends of the double-exponential rule. For creep by powers t^n: 1e-14 for n up to 0.6, 2e-11 at n = 0.99.
_STEP, _FIRST, _LAST = 1 / 16, -4.5, 3.75
_BLOCK = 1024


def inverse_carson(transform: Transform, time: ArrayLike) -> Array:
    """f(t) from its Carson transform.

    transform: of complex s, 1/s; analytic off the negative real axis, with real values on the positive one.
    time: t > 0, s, of any shape. Returns f, the shape of `time`; the error is near 1e-13 of f for functions
    that vary by powers of t.
    Source: Trefethen, Weideman & Schmelzer (2006), BIT 46, 653-670, eq. 3.1: Talbot's contour with the best
    cotangent.
    """
    t = np.asarray(time, dtype=float)
    # The lower half of the contour gives the conjugate.
    angle = (2 * np.arange(_CONTOUR_NODES // 2) + 1) * np.pi / _CONTOUR_NODES
    sine = np.sin(0.6407 * angle)
    z = _CONTOUR_NODES * (0.5017 * angle / np.tan(0.6407 * angle) - 0.6122 + 0.2645j * angle)
    slope = 0.5017 / np.tan(0.6407 * angle) - 0.5017 * 0.6407 * angle / sine**2 + 0.2645j
    weights = 2 * slope * np.exp(z) / (1j * z)
    return np.asarray((weights * transform(z / t[..., None])).real.sum(axis=-1))


def carson(function: Callable[[Array, ComplexArray], ComplexArray], s: ArrayLike) -> ComplexArray:
    """Carson transform of f: ∫ f(u/s) exp(-u) du over u > 0, on the contour along which st is real.

    function: f(u/s) of u > 0 and complex s, arrays to be broadcast; f is analytic where |arg t| <= |arg s| and grows
    no faster than a power of t.
    s: complex, 1/s, off the negative real axis, of any shape. Returns the transform, the shape of `s`.
    Source: Takahasi & Mori (1974), Publ. RIMS Kyoto Univ. 9, 721-741: u = exp(x - exp(-x)), trapezoidal in x.
    """
    s = np.asarray(s, dtype=complex)
    x = np.arange(_FIRST, _LAST + 0.5 * _STEP, _STEP)
    u = np.exp(x - np.exp(-x))
    weights = _STEP * (1 + np.exp(-x)) * u * np.exp(-u)
    flat = s.ravel()
    transform = np.empty_like(flat)
    for start in range(0, flat.size, _BLOCK):
        part = slice(start, start + _BLOCK)
        transform[part] = function(u, flat[part, None]) @ weights
    return transform.reshape(s.shape)
