"""Waves that fade with depth, summed over a rectangle: the nine functions that fields below a surface are made of.

A field below a loaded surface, or that of a source's image, is a sum of exp(-k Z) cosᵃθ sinᵇθ over the wave vectors
k (cos θ, sin θ), k² times it, and so on. Its integral over a rectangle is an alternating sum over four corners of

    A_ab(X, Y, Z) = F⁻¹[cosᵃ sinᵇ exp(-k Z) / (kx ky)],  a + b = 4,   i A_ab likewise for a + b = 3,

F⁻¹[f] = (2π)⁻² ∬ f exp(i (kx X + ky Y)) dkx dky. Hence F⁻¹[cosᵃ sinᵇ exp(-k Z) / ((i kx)(i ky))] = -A_ab of the even
ones, F⁻¹[i cosᵃ sinᵇ …] = A_ab of the odd ones; each factor k is -d/dZ. Lower powers of the same parity follow by
cos² + sin² = 1. Functions of X and Z, or of Y and Z, alone are left out: no alternating sum has them.

Z may be complex with Re Z > 0, as the complex decay of a body with a grain has it: all functions are analytic there.
Real Z = 0 is the limit Z → 0+.

Source: derived from ∫ exp(-k Z) Jₙ(k r) kᵐ dk (Gradshteyn and Ryzhik, 6.621); held by tests against quadrature.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array, Values

POWERS = ((4, 0), (3, 1), (2, 2), (1, 3), (0, 4), (3, 0), (2, 1), (1, 2), (0, 3))
"""Powers of cosine and sine, in the order of all results here: five even functions, four odd ones."""

_TURN = 1 / (2 * np.pi)


@dataclass(frozen=True)
class Waves:
    """The nine functions, each result (9, ...), at X, Y, Z from a corner, m, arrays or numbers that broadcast.

    X = Z = 0, Y = Z = 0 (edges seen from the surface) and X = Y = 0 above Z = 0 are singular.
    """

    x: Values
    y: Values
    z: Values

    @cached_property
    def distance(self) -> Values:
        """R = √(X² + Y² + Z²), of positive real part."""
        return np.sqrt(self.x * self.x + self.y * self.y + self.z * self.z)

    @cached_property
    def values(self) -> Array:
        """A, without unit."""
        x, y, t, turn_x, turn_y, log_x, log_y = self.x, self.y, self._t, *self._turns, *self._logs
        squares = 0.5 / (t * t)
        cross, level = x * y * squares, -0.5 * (np.log(t) + self.z / t)
        return _stacked(
            cross - turn_x, level - x * x * squares, -cross, level - y * y * squares, cross - turn_y,
            log_y - y / t, x / t, y / t, log_x - x / t,
        )  # fmt: skip

    @cached_property
    def slopes(self) -> Array:
        """dA/dZ, 1/m."""
        x, y, z, r, t = self.x, self.y, self.z, self.distance, self._t
        xz, yz = x * x + z * z, y * y + z * z
        squares, single = 1 / (t * t * r), 1 / (t * r)
        return _stacked(
            x * y * (1 / (r * xz) - squares), x * x * squares - 1 / t, x * y * squares, y * y * squares - 1 / t,
            x * y * (1 / (r * yz) - squares),
            y * (single - z / (xz * r)), -x * single, -y * single, x * (single - z / (yz * r)),
        )  # fmt: skip

    @cached_property
    def curvatures(self) -> Array:
        """d²A/dZ², 1/m²."""
        x, y, z, r, t = self.x, self.y, self.z, self.distance, self._t
        xz, yz = x * x + z * z, y * y + z * z
        cube = 1 / (r * r * r)
        falls, single = (2 * r + z) / (t * t) * cube, 1 / (t * r)

        def even(across: Values) -> Values:
            return x * y * (falls - z / across * (cube + 2 / (r * across)))

        def odd(along: Values, across: Values) -> Values:
            return along * ((z * z * (cube + 2 / (r * across)) - 1 / r) / across - cube)

        return _stacked(
            even(xz), single - x * x * falls, -x * y * falls, single - y * y * falls, even(yz),
            odd(y, xz), x * cube, y * cube, odd(x, yz),
        )  # fmt: skip

    @cached_property
    def integrals(self) -> Array:
        """∫ A dZ that vanishes with all alternating sums at Z → ∞, m."""
        x, y, z, r, t = self.x, self.y, self.z, self.distance, self._t
        (turn_x, turn_y), (log_x, log_y), log = self._turns, self._logs, np.log(t)
        squares = 0.25 / t * (1 + (x * x + y * y) / (3 * t * t))
        level, slow = r / 3 - z * z / (6 * t) - 0.5 * z * log, 0.5 * (log + z / t)
        cross, rises = x * y * squares, 0.5 * (log - z / t)
        return _stacked(
            x * log_y - z * turn_x - cross, level + x * x * squares, cross, level + y * y * squares,
            y * log_x - z * turn_y - cross,
            z * log_y + x * turn_x + y * rises, x * slow, y * slow, z * log_x + y * turn_y + x * rises,
        )  # fmt: skip

    @cached_property
    def _t(self) -> Values:
        return self.distance + self.z

    @cached_property
    def _turns(self) -> tuple[Values, Values]:
        """atan(Y/X) - atan(Y Z / X R), and with X and Y exchanged; as one angle, which has no quotient of zeros."""
        x, y, z, r = self.x, self.y, self.z, self.distance
        rise = x * y * ((x * x + y * y) / self._t)
        return _angle(rise, x * x * r + y * y * z), _angle(rise, y * y * r + x * x * z)

    @cached_property
    def _logs(self) -> tuple[Values, Values]:
        """asinh(X / √(Y² + Z²)), asinh(Y / √(X² + Z²))."""
        x, y, z = self.x, self.y, self.z
        return np.arcsinh(x / np.sqrt(y * y + z * z)), np.arcsinh(y / np.sqrt(x * x + z * z))


def _angle(rise: Values, run: Values) -> Values:
    """atan(rise / run) where the run has a positive real part or both vanish."""
    if np.isrealobj(rise):
        return np.arctan2(rise, run)
    return np.arctan(rise / run)


def _stacked(*functions: Values) -> Array:
    stacked: Array = _TURN * np.stack(np.broadcast_arrays(*functions))
    return stacked
