"""Elasticity with three axes of its own, which may be turned and tilted: laid, reinforced or wound material."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.anisotropy import stiffness as turning
from treadload.kernels.arrays import Array
from treadload.materials.anisotropic import Anisotropic, eigenvalues
from treadload.registry import MATERIALS
from treadload.units import Angle, Modulus, Number

_MODULI = ("E_1", "E_2", "E_3")
_SHEARS = ("G_12", "G_13", "G_23")
_RATIOS = ("ν_12", "ν_13", "ν_23")
# As far as the ratios bring the smallest eigenvalue to zero, where a material keeps its volume.
_LEAST = 1e-12


@MATERIALS.register("orthotropic")
@dataclass(frozen=True)
class Orthotropic(Anisotropic):
    """Linear elastic material with three perpendicular axes 1, 2 and 3 of its own, which may be turned.

    moduli: Young's moduli E_1, E_2, E_3 along the axes, Pa, > 0. shear_moduli: G_12, G_13, G_23 in the planes of two
    axes each, Pa, > 0. poisson: ν_12, ν_13, ν_23: ν_ij is the contraction along j over the extension along i under
    stress along i; the other ones are ν_ji = ν_ij E_j/E_i. yaw, pitch, roll: how its axes are turned out of x
    (travel), y (right) and z (down), see `rotated`; all zero: axis 1 along travel, 2 to the right, 3 down.

    Raises InputError with the smallest eigenvalue for numbers that no material has.

    >>> mix = tl.materials.Orthotropic((5e9, 4e9, 3e9), (1.8e9, 1.6e9, 1.4e9), (0.3, 0.3, 0.3), pitch=0.5)
    >>> round(mix.upright[0] / 1e9, 2)  # GPa, vertical, of axes leaning forwards
    3.36
    """

    moduli: tuple[Modulus, Modulus, Modulus]
    shear_moduli: tuple[Modulus, Modulus, Modulus]
    poisson: tuple[Number, Number, Number]
    yaw: Angle = 0.0
    pitch: Angle = 0.0
    roll: Angle = 0.0

    def __post_init__(self) -> None:
        for name, words in (("moduli", _MODULI), ("shear_moduli", _SHEARS), ("poisson", _RATIOS)):
            object.__setattr__(self, name, _three(name, getattr(self, name), words))
        for word, value in zip(_MODULI + _SHEARS, self.moduli + self.shear_moduli, strict=True):
            positive(f"the modulus {word}", value, "Pa", "asphalt is near 5.4e9, its shear modulus near 2e9")
        for name in ("yaw", "pitch", "roll"):
            value = getattr(self, name)
            if isinstance(value, bool | str) or not math.isfinite(value):
                raise InputError(f"{name} must be an angle in rad, got {value!r}; 30° is 0.5236")
            object.__setattr__(self, name, float(value))
        values = eigenvalues(self._compliance_along_axes())
        if not values[0] > _LEAST * values[-1]:
            raise InputError(
                f"this elasticity is not positive definite: the smallest eigenvalue of its compliance is "
                f"{values[0]:.3g} 1/Pa and must be above 0, or deforming it would give energy; bring the ratios "
                f"{_listed(_RATIOS, self.poisson)} nearer to 0: |ν_ij| must stay below the root of E_i/E_j, "
                f"{_listed(_RATIOS, self._most)}, and lower where several act together"
            )

    def rotated(self, yaw: Angle = 0.0, pitch: Angle = 0.0, roll: Angle = 0.0) -> Orthotropic:
        """The material turned as a whole from where it is: by roll about x, by pitch about y, then by yaw about z.

        roll: rad, an axis to the right turns downwards. pitch: rad, an axis along travel turns upwards. yaw: rad, an
        axis along travel turns to the right. All are right-handed, z being down.
        """
        if (self.yaw, self.pitch, self.roll) == (0.0, 0.0, 0.0):
            return replace(self, yaw=yaw, pitch=pitch, roll=roll)
        both = rotation(yaw, pitch, roll) @ self.rotation
        return replace(
            self,
            yaw=math.atan2(both[1, 0], both[0, 0]),
            pitch=math.asin(max(-1.0, min(1.0, -both[2, 0]))),
            roll=math.atan2(both[2, 1], both[2, 2]),
        )

    def stiffer(self, factor: float) -> Orthotropic:
        """As in `Anisotropic`."""
        first, two, three = (factor * value for value in self.moduli)
        g_12, g_13, g_23 = (factor * value for value in self.shear_moduli)
        return replace(self, moduli=(first, two, three), shear_moduli=(g_12, g_13, g_23))

    @property
    def rotation(self) -> Array:
        """(3, 3): its columns are the axes 1, 2 and 3 in x, y and z."""
        return rotation(self.yaw, self.pitch, self.roll)

    @property
    def stiffness(self) -> Array:
        """(6, 6), Pa, in x, y, z: up to 21 constants, in the order xx, yy, zz, yz, xz, xy of engineering shears."""
        inverse = np.linalg.inv(self._compliance_along_axes())
        inverse = 0.5 * (inverse + inverse.T)
        if (self.yaw, self.pitch, self.roll) == (0.0, 0.0, 0.0):
            return np.asarray(inverse)
        return turning.rotated(inverse, self.rotation)

    @property
    def _most(self) -> tuple[float, ...]:
        first, two, three = self.moduli
        return math.sqrt(first / two), math.sqrt(first / three), math.sqrt(two / three)

    def _compliance_along_axes(self) -> Array:
        """(6, 6), 1/Pa, along the axes of the material."""
        (first, two, three), (g_12, g_13, g_23) = self.moduli, self.shear_moduli
        result = np.diag([1 / first, 1 / two, 1 / three, 1 / g_23, 1 / g_13, 1 / g_12])
        for (i, j), ratio, modulus in zip(((0, 1), (0, 2), (1, 2)), self.poisson, (first, first, two), strict=True):
            result[i, j] = result[j, i] = -ratio / modulus
        return result

    def __str__(self) -> str:
        moduli = ", ".join(f"{name} = {value / 1e6:g} MPa" for name, value in
                         zip(_MODULI + _SHEARS, self.moduli + self.shear_moduli, strict=True))  # fmt: skip
        turned = ", ".join(
            f"{name} {math.degrees(value):.4g}°"
            for name, value in (("yaw", self.yaw), ("pitch", self.pitch), ("roll", self.roll))
            if value
        )
        return f"orthotropic, {moduli}, {_listed(_RATIOS, self.poisson)}" + (
            f", turned by {turned}" if turned else ""
        )

    __repr__ = as_call


def rotation(yaw: float, pitch: float, roll: float) -> Array:
    """(3, 3): what turns by roll about x, then by pitch about y, then by yaw about z, rad; right-handed, z down."""
    c, s = np.cos([yaw, pitch, roll]), np.sin([yaw, pitch, roll])
    about_z = np.array([[c[0], -s[0], 0], [s[0], c[0], 0], [0, 0, 1]])
    about_y = np.array([[c[1], 0, s[1]], [0, 1, 0], [-s[1], 0, c[1]]])
    about_x = np.array([[1, 0, 0], [0, c[2], -s[2]], [0, s[2], c[2]]])
    return np.asarray(about_z @ about_y @ about_x)


def _listed(names: tuple[str, ...], values: tuple[float, ...]) -> str:
    return ", ".join(f"{name} = {value:.4g}" for name, value in zip(names, values, strict=True))


def _three(name: str, values: object, words: tuple[str, ...]) -> tuple[float, ...]:
    """Three numbers. Raises InputError."""
    entries = () if isinstance(values, str) else tuple(np.atleast_1d(np.asarray(values, object)))
    if len(entries) != 3 or any(isinstance(entry, bool | str) or not np.isscalar(entry) for entry in entries):
        raise InputError(f"{name} must be three numbers, {', '.join(words)}, got {values!r}")
    numbers = tuple(float(entry) for entry in entries)
    if not all(math.isfinite(number) for number in numbers):
        raise InputError(f"{name} must be three finite numbers, {', '.join(words)}, got {values!r}")
    return numbers
