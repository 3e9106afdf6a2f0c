"""Viscoelastic bodies in steady rolling: the influence operators of surfaces that remember.

Everything is as in `contact.bodies.influence`, but the operators are not symmetric: what enters the patch at its
leading edge is undeformed, and what leaves it still recovers. Contact moves ahead of the axle, and rolling costs
work.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from treadload.contact.bodies.influence import Influence, stiffness_symbol, tangential_stiffness_symbols
from treadload.errors import InputError
from treadload.kernels import fft
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.gridding.convolution import Convolution, Padding
from treadload.kernels.half_space import memory, rectangle_ahead
from treadload.kernels.half_space.rectangle import CombinedElasticity
from treadload.materials import Elastic, Prony

Material = Elastic | Prony

# (x, y, dx, dy, bodies) → kernels (components, ny, nx).
_Kernel = Callable[[Array, Array, float, float, CombinedElasticity], Array]


@dataclass(frozen=True)
class ViscoelasticInfluence(Influence):
    """Influence operators of two half-spaces, at least one of them viscoelastic, that roll steadily along +x.

    bodies: their elasticity at once (glassy). tire, road: materials of body 1 and body 2. speed: m/s.
    Build it with `of`. The kernels of the bodies add up; each is its glassy one and what fades of it.
    """

    tire: Material
    road: Material
    speed: float

    @classmethod
    def of(
        cls, shape: tuple[int, int], dx: float, dy: float, tire: Material, road: Material, speed: float | None
    ) -> ViscoelasticInfluence:
        """Operators on (ny, nx) cells of dx by dy, m, for two materials rolling at a speed, m/s.

        Raises InputError for a speed that is missing or not positive, and for a fluid.
        """
        check_rolling(tire, road, speed)
        assert speed is not None
        glassy, rubbery = combined(tire, road, "glassy"), combined(tire, road, "rubbery")
        # Bodies that are alike at once, but not for long, are coupled.
        alike = glassy.difference == 0 and rubbery.difference != 0
        return cls(shape, dx, dy, rubbery if alike else glassy, tire, road, float(speed))

    @property
    def symmetric(self) -> bool:
        """False: the work of two loads on each other's displacements differs."""
        return False

    @cached_property
    def normal(self) -> Convolution:
        """Gap opening by pressure, m/Pa."""
        return Convolution(self.padding, self._spectra(self.padding, _normal, (1,))[0])

    def tangential(self, padding: Padding) -> ComplexArray:
        """Symbols (3, my, mx // 2 + 1) of the displacement difference by shear, m/Pa: xx, yy, xy."""
        return self._spectra(padding, rectangle_ahead.tangential_by_shear, (1, 1, -1))

    def self_influence(self, *, rolls: bool) -> float:
        """Displacement difference u_x of a cell by a unit shear on itself, m/Pa; u_x(x) - u_x(x + dx) if it rolls."""
        xx = self._kernels(rectangle_ahead.tangential_by_shear, 1, 0, 1)[0, 0]
        return float(xx[0] - xx[1]) if rolls else float(xx[0])

    @cached_property
    def normal_stiffness(self) -> ComplexArray:
        """Symbol (ny, nx // 2 + 1) on the unpadded, periodic grid of the inverse normal compliance, Pa/m."""
        compliance = sum(self._fading_symbol(material) / alone.contact_modulus for material, alone in self._alone)
        return np.asarray(stiffness_symbol(self.shape, self.dx, self.dy, 1.0) / compliance)

    @cached_property
    def tangential_stiffness(self) -> ComplexArray:
        """Symbols (3, ny, nx // 2 + 1), xx, yy, xy, of the inverse tangential compliance, Pa/m, as above."""
        glassy = [(m, tangential_stiffness_symbols(self.shape, self.dx, self.dy, alone)) for m, alone in self._alone]
        compliance = sum(self._fading_symbol(m) * _inverse(symbols) for m, symbols in glassy)
        return _inverse(np.asarray(compliance))

    def _coupling(self, padding: Padding) -> ComplexArray:
        return self._spectra(padding, rectangle_ahead.coupling, (1, -1))

    @cached_property
    def _alone(self) -> list[tuple[Material, CombinedElasticity]]:
        """The materials that deform, each with its glassy elasticity against a rigid body."""
        tire, road = (elastic(material, "glassy") for material in (self.tire, self.road))
        pairs = (
            (self.tire, CombinedElasticity.of(tire.shear_modulus, tire.poisson, math.inf, 0.0)),
            (self.road, CombinedElasticity.of(math.inf, 0.0, road.shear_modulus, road.poisson)),
        )
        return [(material, alone) for material, alone in pairs if math.isfinite(alone.shear_modulus)]

    def _spectra(self, padding: Padding, kernel: _Kernel, parities: tuple[int, ...]) -> ComplexArray:
        """Spectra of kernels that have a parity along y only: +1 even, -1 odd."""
        my, mx = padding.shape
        ahead = mx // 2
        behind = mx - 1 - ahead
        half = np.roll(self._kernels(kernel, my // 2 + 1, behind, ahead), -behind, axis=-1)
        offset = fft.fftfreq(my, 1 / my).round().astype(int)
        spectra = []
        for part, parity in zip(half, parities, strict=True):
            # Half way round, plus and minus meet: an odd kernel has no value there.
            sign = np.where(offset < 0, parity, 1) * np.where((2 * np.abs(offset) == my) & (parity < 0), 0, 1)
            spectra.append(padding.spectrum(part[np.abs(offset)] * sign[:, None]))
        return np.array(spectra)

    def _kernels(self, kernel: _Kernel, ny: int, behind: int, ahead: int) -> Array:
        """Coefficients (components, ny, behind + 1 + ahead) at Y = 0 … and X = -behind · dx … ahead · dx."""
        y = self.dy * np.arange(ny)
        total: Array | float = 0.0
        for material, alone in self._alone:

            def sample(first: float, count: int, alone: CombinedElasticity = alone) -> Array:
                return kernel(first + self.dx * np.arange(count), y, self.dx, self.dy, alone)

            total = total + sample(-behind * self.dx, behind + 1 + ahead)
            if isinstance(material, Prony):
                strengths, times = np.array(material.creep_terms).T
                faded = memory.fading(sample, behind, ahead, self.dx, self.speed * times)
                total = total + np.tensordot(strengths, faded, 1)
        return np.asarray(total)

    def _fading_symbol(self, material: Material) -> ComplexArray:
        """1 + Σ fⱼ/(1 - i k_x V Tⱼ) (1, nx // 2 + 1): compliance over the glassy one."""
        nx = self.shape[1]
        kx = 2 * np.pi * fft.rfftfreq(nx, self.dx)[None, :]
        # Not at rest, even at k_x = 0: nothing stays under the wheel for longer than it takes to cross the patch.
        kx[0, 0] = np.pi / (nx * self.dx)
        terms = material.creep_terms if isinstance(material, Prony) else ()
        symbol = 1 + sum((f / (1 - 1j * kx * self.speed * t) for f, t in terms), np.zeros(kx.shape, complex))
        symbol[0, 0] = abs(symbol[0, 0])
        return np.asarray(symbol)


def combined(tire: Material, road: Material, limit: str) -> CombinedElasticity:
    """The elasticity of tire (body 1) and road (body 2) seen as one, in the "glassy" or the "rubbery" limit."""
    one, other = elastic(tire, limit), elastic(road, limit)
    return CombinedElasticity.of(one.shear_modulus, one.poisson, other.shear_modulus, other.poisson)


def elastic(material: Material, limit: str) -> Elastic:
    """An elastic material, or the "glassy" or the "rubbery" limit of a viscoelastic one."""
    if isinstance(material, Elastic):
        return material
    return material.glassy if limit == "glassy" else material.rubbery


def check_rolling(tire: Material, road: Material, speed: float | None) -> None:
    """Refuse viscoelastic materials without a speed, m/s, > 0, and fluids. Raises InputError."""
    for name, material in (("tire", tire), ("road", road)):
        if isinstance(material, Prony):
            _check_rolls(name, material, speed)


def _check_rolls(name: str, material: Prony, speed: float | None) -> None:
    if speed is None:
        raise InputError(
            f"the {name} is viscoelastic ({material}): give the rolling speed (m/s), on which its stiffness depends"
        )
    if not (math.isfinite(speed) and speed > 0):
        raise InputError(
            f"speed must be a positive number of m/s, got {speed}; for a viscoelastic {name} at rest use the "
            "elastic limit material.rubbery"
        )
    if material.is_fluid:
        raise InputError(
            f"the {name} is a fluid ({material}): its shares add up to 1, as in a Maxwell element. Rolling steadily, "
            "it sinks without end and leaves a rut. Keep a long-term modulus: a standard linear solid, "
            "or shares that add up to 0.99 at most"
        )


def _normal(x: Array, y: Array, dx: float, dy: float, bodies: CombinedElasticity) -> Array:
    """u_n by p (1, ny, nx), m/Pa: Boussinesq's 1/r is a share of the sum of Cerruti's two."""
    xx, yy, _ = rectangle_ahead.tangential_by_shear(x, y, dx, dy, bodies)
    share = (1 - bodies.poisson) / (2 - bodies.poisson)
    return np.asarray(share * (xx + yy))[None]


def _inverse(symbols: Array | ComplexArray) -> ComplexArray:
    """Inverse, mode by mode, of the symmetric 2 x 2 matrices xx, yy, xy (3, …)."""
    xx, yy, xy = symbols
    return np.asarray(np.array([yy, xx, -xy]) / (xx * yy - xy * xy))
