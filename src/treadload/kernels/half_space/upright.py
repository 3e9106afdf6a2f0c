"""Half-spaces that are the same in all horizontal directions and another along z: fields of loaded cells and discs.

In wavenumbers a field is Σ h(s) e^{-s k z} over the decays s1 and s2 of the plane waves and s3 of the transverse one,
see `kernels.layers.upright`, each times a polynomial of the direction of the wave alone. So in space it is a sum of
the functions of `kernels.half_space.corners` at the depths s z, with their limits at the surface and their integrals
for bilinear loads. With f[s1, s2] = (f(s1) - f(s2)) / (s1 - s2) plane waves are, under i f_k = 1 and under f_z = 1,

    [h(s) e^{-s k z}][s1, s2],   -s1 s2 [h(s)/s e^{-s k z}][s1, s2]

with h = 1/A44 - κ/D(s) for k i u_k, κ s/D for k u_z, s for i f_k and 1 for f_z, D = A13 + A33 s², κ = 1 + A13/A44.
A complex pair takes twice the real part of one. Where s1 and s2 are near each other, as in isotropy, the quotient is
that of a polynomial through points around both: nothing is lost, and isotropy is no exception.

Source: Lekhnitskii (1963), Theory of Elasticity of an Anisotropic Elastic Body, for the waves; the sums were derived.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter

import numpy as np

from treadload.kernels.arrays import Numbers, Reals
from treadload.kernels.gridding.lattice import Corner
from treadload.kernels.half_space.corners import Functions, fields
from treadload.kernels.layers.upright import Upright

_XX, _YY, _ZZ, _XY, _XZ, _YZ, _UX, _UY, _UZ = range(9)
_P, _QX, _QY = range(3)

# Half of s1 - s2 over their mean below which the quotient is that of a polynomial, through points of this reach
# around the mean: (reach / 2)^points is 6e-16, and what is lost else is the inverse of twice that part.
_NEAR, _REACH, _POINTS = 0.05, 0.06, 10


@dataclass(frozen=True)
class UprightMedium:
    """The elasticity of such a half-space over its shear modulus in the horizontal plane.

    poisson: ν in the horizontal plane. upright: what it has of its own along z, over that modulus.
    """

    poisson: float
    upright: Upright

    @classmethod
    def of(cls, shear: float, poisson: float, upright: Upright) -> UprightMedium:
        """From moduli in Pa; shear: in the horizontal plane."""
        return cls(poisson, Upright(upright.along / shear, upright.across / shear, upright.shear / shear))

    def fields(
        self, functions: Callable[[complex], Functions], deep: bool, *, moves: bool = True
    ) -> Iterator[Corner]:
        """As `kernels.half_space.corners.fields`, the displacement times the shear modulus in the plane.

        functions: those of corners or of nodes at a stretch of the depth. deep: whether below the surface, where the
        stretch matters. Stress at the surface is without the part of a uniform load itself, see `own`.
        """
        modes = self.modes
        alone = functions(1.0)
        at = [functions(s) if deep else alone for s in modes.decay]
        swayed = functions(modes.transverse) if deep else alone
        unit = 1 / (2 * np.pi)

        def pressed(part: Numbers, of: Callable[[Functions], Reals]) -> Reals:
            return _real(unit * modes.pressed * part, [of(f) for f in at])

        def sheared(part: Numbers, of: Callable[[Functions], Reals]) -> Reals:
            return _real(unit * modes.sheared * part, [of(f) for f in at])

        along, across, ones, s = modes.along, modes.across, np.ones_like(modes.decay), modes.decay
        s3, sway = unit * modes.transverse, unit * modes.sway
        yield pressed(along - across, _turn_x) + pressed(across, _turn), ((_P, _XX),)
        yield pressed(along - across, _turn_y) + pressed(across, _turn), ((_P, _YY),)
        yield -pressed(ones, _turn), ((_P, _ZZ),)
        yield pressed(along - across, _log_r), ((_P, _XY),)
        yield pressed(s, _log_y), ((_P, _XZ),)
        yield pressed(s, _log_x), ((_P, _YZ),)
        yield sheared(s, _turn_y) - sheared(s, _turn) - unit * _turn_y(swayed), ((_QX, _XZ),)
        yield sheared(s, _turn_x) - sheared(s, _turn) - unit * _turn_x(swayed), ((_QY, _YZ),)
        yield unit * _log_r(swayed) - sheared(s, _log_r), ((_QX, _YZ), (_QY, _XZ))
        yield -sheared(ones, _log_y), ((_QX, _ZZ),)
        yield -sheared(ones, _log_x), ((_QY, _ZZ),)
        cross_x, cross_y = sheared(along - across, _slope_x), sheared(along - across, _slope_y)
        twist_x, twist_y = 2 * s3 * _slope_x(swayed), 2 * s3 * _slope_y(swayed)
        yield sheared(along, _log_y) - cross_y + twist_y, ((_QX, _XX),)
        yield sheared(along, _log_x) - cross_x + twist_x, ((_QY, _YY),)
        yield sheared(across, _log_y) + cross_y - twist_y, ((_QX, _YY),)
        yield sheared(across, _log_x) + cross_x - twist_x, ((_QY, _XX),)
        yield cross_x + s3 * _log_x(swayed) - twist_x, ((_QX, _XY),)
        yield cross_y + s3 * _log_y(swayed) - twist_y, ((_QY, _XY),)
        if not moves:
            return

        out, down = modes.out, modes.down
        yield pressed(down, _flat_x) + pressed(down, _flat_y), ((_P, _UZ),)
        yield pressed(out, _tilt_x), ((_P, _UX),)
        yield pressed(out, _tilt_y), ((_P, _UY),)
        yield -sheared(down, _tilt_x), ((_QX, _UZ),)
        yield -sheared(down, _tilt_y), ((_QY, _UZ),)
        yield sheared(out, _flat_x) + sway * _flat_y(swayed), ((_QX, _UX),)
        yield sheared(out, _flat_y) + sway * _flat_x(swayed), ((_QY, _UY),)
        yield sheared(out, _cross) - sway * _cross(swayed), ((_QX, _UY), (_QY, _UX))

    @property
    def beneath(self) -> float:
        """σ_xx and σ_yy of a uniform pressure where it stands itself, over it."""
        return float((self.modes.pressed * self.modes.across).sum().real)

    @cached_property
    def modes(self) -> Modes:
        """The waves that its fields are made of."""
        return Modes.of(self)


@dataclass(frozen=True, eq=False)
class Modes:
    """Points s (n,) whose functions at s z make the plane waves, and what they carry, over the shear modulus.

    sheared, pressed: weights of the points under i f_k = 1 and under f_z = 1. along, across: σ_kk and σ_tt; out,
    down: k i u_k and k u_z. transverse: s3; sway: k u_t by f_t. Of a complex pair one point stands for both.
    """

    decay: Numbers
    sheared: Numbers
    pressed: Numbers
    along: Numbers
    across: Numbers
    out: Numbers
    down: Numbers
    transverse: float
    sway: float

    @classmethod
    def of(cls, medium: UprightMedium) -> Modes:
        """Of a medium."""
        nu, upright = medium.poisson, medium.upright
        total, product, transverse = upright.roots(1.0, nu)
        middle, apart = 0.5 * total, 0.25 * total * total - product
        decay, sheared = _quotient(middle, apart)
        pressed = -product * sheared / decay
        kappa, below = 1 + upright.across / upright.shear, upright.across + upright.along * decay**2
        out, down = 1 / upright.shear - kappa / below, kappa * decay / below
        plate = 2 / (1 - nu)
        along, across = plate * out - upright.lift, plate * nu * out - upright.lift
        return cls(decay, sheared, pressed, along, across, out, down, transverse, upright.half_space(1.0, nu)[3])


def _quotient(middle: float, apart: float) -> tuple[Numbers, Numbers]:
    """Points and weights of f[s1, s2], s = middle ± √apart; of a complex pair one point, whose real part counts."""
    if abs(apart) > (_NEAR * middle) ** 2:
        half = np.sqrt(complex(apart))
        if apart < 0:
            return np.array([middle + half]), np.array([1 / half])
        return np.array([middle + half.real, middle - half.real]), np.array([0.5, -0.5]) / half.real
    reach = _REACH * middle
    points = np.cos(np.pi * (np.arange(_POINTS) + 0.5) / _POINTS)
    # Of (s - middle)ⁿ: (√apart)ⁿ⁻¹ where n is odd, none where it is even.
    moments = np.zeros(_POINTS)
    moments[1::2] = (apart / reach**2) ** np.arange(_POINTS // 2) / reach
    return middle + reach * points, np.linalg.solve(np.vander(points, increasing=True).T, moments)


Medium = float | UprightMedium
"""What a half-space is made of: Poisson's ratio of an isotropic one, or what stands in its place."""


def fields_of(
    functions: Callable[[complex], Functions], medium: Medium, deep: bool, *, moves: bool = True
) -> Iterator[Corner]:
    """`kernels.half_space.corners.fields` of any medium, see `UprightMedium.fields`."""
    if isinstance(medium, UprightMedium):
        return medium.fields(functions, deep, moves=moves)
    return fields(functions(1.0), medium, moves=moves)


def horizontal_stress_ratio(medium: Medium) -> float:
    """σ_xx and σ_yy over the pressure, on the surface below a uniform pressure."""
    return medium.beneath if isinstance(medium, UprightMedium) else -2 * medium


def _real(weights: Numbers, values: list[Reals]) -> Reals:
    """The real part of a sum."""
    real: Reals = sum(weight * value for weight, value in zip(weights, values, strict=True)).real
    return real


# What waves e^{-kz} of a direction (c, s) become over a rectangle, times 2π: those of c² and s², 1, c s, i s and i c,
# i c² s and i c s², then of -i c/k and -i s/k, c²/k and s²/k, and c s/k.
_turn_x = attrgetter("turn_x")
_turn_y = attrgetter("turn_y")
_turn = attrgetter("turn")
_log_r = attrgetter("log_r")
_log_x = attrgetter("log_x")
_log_y = attrgetter("log_y")
_slope_x = attrgetter("slope_x")
_slope_y = attrgetter("slope_y")
_tilt_x = attrgetter("tilt_x")
_tilt_y = attrgetter("tilt_y")


def _flat_x(f: Functions) -> Reals:
    return f.x_log_y - f.z * f.turn_x


def _flat_y(f: Functions) -> Reals:
    return f.y_log_x - f.z * f.turn_y


def _cross(f: Functions) -> Reals:
    return f.r - f.z * f.log_r
