"""Elasticity with a direction: what such materials share, and the one whose axis stands upright.

Matrices are in Voigt's order xx, yy, zz, yz, xz, xy (11 22 33 23 13 12) of engineering shears, z down.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace

import numpy as np

from treadload.describing import as_call
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.kernels.tensors import strain_by_compliance
from treadload.registry import MATERIALS
from treadload.units import Modulus, Number

# A compliance whose eigenvalues lie this far apart is that of a material that keeps its volume, or of none.
_LEAST = 1e-12
# Kelvin's notation, whose shears are √2 times the tensor's, over Voigt's.
_KELVIN = np.array([1.0, 1.0, 1.0, *[np.sqrt(2.0)] * 3])


class Anisotropic(ABC):
    """A linear elastic material whose stiffness depends on direction.

    >>> base = tl.materials.TransverselyIsotropic(100e6, 300e6, 90e6, poisson_horizontal=0.15, poisson_vertical=0.35)
    >>> round(float(1 / base.compliance[2, 2]) / 1e6)  # MPa, vertical Young's modulus
    300
    """

    @property
    @abstractmethod
    def stiffness(self) -> Array:
        """(6, 6), Pa, symmetric and positive definite: stress of engineering strain, in the order of the module."""

    @property
    def compliance(self) -> Array:
        """Its inverse, 1/Pa: engineering strain of stress."""
        return np.linalg.inv(self.stiffness)

    @abstractmethod
    def stiffer(self, factor: float) -> Anisotropic:
        """The material with all its moduli multiplied by a factor, and the same ratios."""

    @property
    def upright(self) -> tuple[float, float]:
        """What vertical stress meets: Young's modulus along z, Pa, and Poisson's ratio, the mean of x and y."""
        along = self.compliance[:3, 2]
        return float(1 / along[2]), float(-0.5 * (along[0] + along[1]) / along[2])

    def strain(self, stress: Array) -> Array:
        """Strain (6, ...) of a stress (6, ...), Pa: xx, yy, zz, xy, xz, yz, extension positive, tensor shear."""
        return strain_by_compliance(stress, self.compliance)


def eigenvalues(compliance: Array) -> Array:
    """Of a compliance (6, 6) in Voigt's order, 1/Pa, as a tensor, smallest first: the same in every frame."""
    values: Array = np.linalg.eigvalsh(compliance / np.outer(_KELVIN, _KELVIN))
    return values


def inverted(compliance: Array, remedy: str) -> Array:
    """The stiffness (6, 6), Pa, of a compliance, 1/Pa, in Voigt's order.

    remedy: what to do about it, for the end of the sentence. Raises InputError, with the smallest eigenvalue, for a
    compliance that is not positive definite: the material would give energy when it is deformed.
    """
    values = eigenvalues(compliance)
    if not values[0] > _LEAST * values[-1]:
        raise InputError(
            f"this elasticity is not positive definite: the smallest eigenvalue of its compliance is {values[0]:.3g} "
            f"1/Pa and must be above 0, or deforming it would give energy; {remedy}"
        )
    stiffness = np.linalg.inv(compliance)
    return 0.5 * (stiffness + stiffness.T)


@MATERIALS.register("transversely-isotropic")
@dataclass(frozen=True)
class TransverselyIsotropic(Anisotropic):
    """Linear elastic material that is the same in all horizontal directions and another along the vertical.

    horizontal: Young's modulus in every horizontal direction, E_h, Pa, > 0. vertical: along the vertical, E_v, Pa,
    > 0. shear: shear modulus in vertical planes, G_hv, Pa, > 0; not bound to the others. poisson_horizontal: ν_hh,
    contraction along one horizontal direction over extension along the other, under stress along that other.
    poisson_vertical: ν_vh, horizontal contraction over vertical extension under vertical stress; the other one, of
    vertical contraction under horizontal stress, is ν_hv = ν_vh E_h / E_v.

    An isotropic material has horizontal = vertical = E, both ratios ν, and shear = E / 2(1 + ν). Raises InputError
    with the smallest eigenvalue for numbers that no material has: it takes |ν_hh| < 1 and
    1 - ν_hh > 2 ν_vh² E_h / E_v.

    >>> base = tl.materials.TransverselyIsotropic(100e6, 300e6, 90e6, poisson_horizontal=0.15, poisson_vertical=0.35)
    >>> round(base.shear_horizontal / 1e6, 1)  # MPa, shear modulus in the horizontal plane
    43.5
    """

    horizontal: Modulus
    vertical: Modulus
    shear: Modulus
    poisson_horizontal: Number
    poisson_vertical: Number

    def __post_init__(self) -> None:
        positive("horizontal", self.horizontal, "Pa", "compacted asphalt is near 5.4e9")
        positive("vertical", self.vertical, "Pa", "compacted asphalt is near 3.8e9")
        positive("shear", self.shear, "Pa", "a fair guess is vertical / 2(1 + poisson_vertical)")
        for name in ("poisson_horizontal", "poisson_vertical"):
            value = getattr(self, name)
            if isinstance(value, bool | str) or not np.isfinite(value):
                raise InputError(f"{name} must be a number, got {value!r}; asphalt is near 0.35")
        if not -1 < self.poisson_horizontal < 1:
            raise InputError(
                f"this elasticity is not positive definite: poisson_horizontal must lie in (-1, 1), got "
                f"{self.poisson_horizontal:g}, and the smallest eigenvalue of its compliance is "
                f"{eigenvalues(self._compliance())[0]:.3g} 1/Pa; asphalt is near 0.35"
            )
        most = np.sqrt((1 - self.poisson_horizontal) * self.vertical / (2 * self.horizontal))
        inverted(
            self._compliance(),
            f"take poisson_vertical between -{most:.3g} and {most:.3g}, or poisson_horizontal nearer to 0",
        )

    @property
    def stiffness(self) -> Array:
        """(6, 6), Pa, in the order xx, yy, zz, yz, xz, xy of engineering shears."""
        return inverted(self._compliance(), "")

    def stiffer(self, factor: float) -> TransverselyIsotropic:
        """As in `Anisotropic`."""
        return replace(
            self, horizontal=factor * self.horizontal, vertical=factor * self.vertical, shear=factor * self.shear
        )

    @property
    def shear_horizontal(self) -> float:
        """G_hh = E_h / 2(1 + ν_hh), the shear modulus in the horizontal plane, Pa."""
        return self.horizontal / (2 * (1 + self.poisson_horizontal))

    @property
    def compliance(self) -> Array:
        """The inverse of the stiffness, 1/Pa."""
        return self._compliance()

    def _compliance(self) -> Array:
        across, down = -self.poisson_horizontal / self.horizontal, -self.poisson_vertical / self.vertical
        result = np.diag(
            [
                *(1 / self.horizontal, 1 / self.horizontal, 1 / self.vertical),
                *(1 / self.shear, 1 / self.shear, 1 / self.shear_horizontal),
            ]
        )
        result[0, 1] = result[1, 0] = across
        result[:2, 2] = result[2, :2] = down
        return result

    def __str__(self) -> str:
        return (
            f"transversely isotropic, E_h = {self.horizontal / 1e6:g} MPa, E_v = {self.vertical / 1e6:g} MPa, "
            f"G_hv = {self.shear / 1e6:g} MPa, ν_hh = {self.poisson_horizontal:g}, ν_vh = {self.poisson_vertical:g}"
        )

    __repr__ = as_call
