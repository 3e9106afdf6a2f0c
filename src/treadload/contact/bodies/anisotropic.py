"""Half-spaces whose stiffness depends on direction: of any anisotropic material, turned and tilted as it may be."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from treadload.contact.bodies.body import Body, Offsets, Waves
from treadload.errors import InputError
from treadload.kernels.anisotropy.coefficients import Angular, coefficients
from treadload.kernels.anisotropy.symbol import NotConvergedError, Symbol, surface_symbol
from treadload.kernels.arrays import Array, ComplexArray

# Rows of the kernel's coefficients, see there.
_XX, _YY, _ZZ, _XY, _XZ, _YZ, _ODD_XY, _ODD_XZ, _ODD_YZ = range(9)
# Part of the largest harmonic below which a stiffness is taken for its own image: round-off of a rotation.
_ROUND_OFF = 1e-12
# Directions among which the strongest coupling is looked for.
_DIRECTIONS = 64


@dataclass(frozen=True, eq=False)
class Surface:
    """What the surface of an anisotropic half-space z > 0 does. symbol: to waves. angular: under a loaded cell."""

    symbol: Symbol
    angular: Angular


@dataclass(frozen=True, eq=False)
class AnisotropicHalfSpace(Body):
    """One anisotropic half-space against a rigid body. surface: of its stiffness. is_tire: True of body 1.

    A solid is its own image in a point. So the tire, which lies above z = 0, answers like the same solid below seen
    from behind: with the same even kernels, and odd kernels of the other sign.
    Sources: those of `kernels.anisotropy`.
    """

    surface: Surface
    is_tire: bool = False

    @classmethod
    def of(cls, stiffness: Array, *, is_tire: bool) -> AnisotropicHalfSpace:
        """Of a stiffness (6, 6), Pa, positive definite, in the axes of the contact, x, y and z down.

        Raises InputError for one that differs with direction more than the kernels can follow.
        """
        return cls(_surface(np.ascontiguousarray(stiffness, float).tobytes()), is_tire)

    @cached_property
    def mirrored(self) -> bool:
        """True if no plane of its grain is turned out of x = 0 and y = 0."""
        c = self.surface.symbol.harmonics
        largest = np.abs(c).max()
        # Images in x = 0 and y = 0: cosines alone on the diagonal, a shear couples by real sines, no e and no a.
        crossed = [c[i, i].imag for i in range(3)] + [c[0, 1].real, c[0, 2].real, c[1, 2].imag]
        odd = np.abs(np.arange(c.shape[-1]) - self.surface.symbol.order) % 2 == 1
        leaning = [np.where(odd, c[0, 1], 0), np.where(odd, 0, c[0, 2]), np.where(odd, 0, c[1, 2])]
        return bool(max(np.abs(part).max() for part in crossed + leaning) <= _ROUND_OFF * largest)

    def normal(self, at: Offsets) -> Array:
        """As in `Body`."""
        return np.asarray(self._kernels(at, _ZZ)[0])

    def tangential(self, at: Offsets) -> Array:
        """As in `Body`."""
        return self._kernels(at, _XX, _YY, _XY)

    def coupling(self, at: Offsets) -> Array:
        """As in `Body`."""
        return np.asarray(self._side * self._kernels(at, _ODD_XZ, _ODD_YZ))

    def tilted(self, at: Offsets) -> Array:
        """As in `Body`."""
        a, e_x, e_y = self._kernels(at, _ODD_XY, _XZ, _YZ)
        return np.array([self._side * a, -e_x, -e_y])

    def compliance(self, waves: Waves) -> Array:
        """As in `Body`, without what a tilted grain adds."""
        angle = np.arctan2(waves.sine, waves.cosine)
        symbol = self.surface.symbol(angle).real
        # A uniform load has no direction.
        symbol[0, 0] = self.surface.symbol.harmonics[..., self.surface.symbol.order].real
        return np.array([symbol[..., 2, 2], symbol[..., 0, 0], symbol[..., 1, 1], symbol[..., 0, 1]])

    def across(self, k: Array) -> Array:
        """As in `Body`: the mean over directions, and the coupling where it is strongest."""
        angle = np.pi / _DIRECTIONS * np.arange(_DIRECTIONS)
        values = self.surface.symbol(angle)
        radial = (np.cos(angle) * values[:, 0, 2] + np.sin(angle) * values[:, 1, 2]).imag
        parts = [values[:, 2, 2].real.mean(), -self._side * radial[np.argmax(np.abs(radial))]]
        return np.asarray(np.multiply.outer(np.array(parts), np.ones_like(k)))

    def towards(self, k: Array, angle: float) -> ComplexArray:
        """As in `Body`."""
        value = self.surface.symbol(np.array(angle))
        x, y = (-value[axis, 2].real + 1j * self._side * value[axis, 2].imag for axis in (0, 1))
        return np.asarray(np.multiply.outer(np.array([value[2, 2], x, y]), np.ones_like(k)))

    @property
    def _side(self) -> int:
        return -1 if self.is_tire else 1

    def _kernels(self, at: Offsets, *rows: int) -> Array:
        return coefficients(self.surface.angular, at.ny, at.nx, at.dx, at.dy, at.first, at.first_y, rows)


@lru_cache(maxsize=16)
def _surface(stiffness: bytes) -> Surface:
    """Of the numbers of a stiffness matrix, kept: one road meets many tires."""
    try:
        symbol = surface_symbol(np.frombuffer(stiffness).reshape(6, 6))
    except NotConvergedError as error:
        raise InputError(
            "the stiffness of this material differs with direction more than its surface can be computed for: "
            f"{error}; bring its moduli closer together"
        ) from error
    return Surface(symbol, Angular.of(symbol))
