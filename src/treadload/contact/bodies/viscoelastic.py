"""A body that remembers, in steady rolling: what enters the patch is undeformed, what leaves it still recovers.

Its displacement is not symmetric along x: contact moves ahead of the axle, and rolling costs work.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from treadload.contact.bodies.body import Body, Offsets, Rows, Strip, Sum, Waves
from treadload.contact.bodies.half_space import HalfSpaces
from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array, ComplexArray
from treadload.kernels.half_space import memory
from treadload.materials import Elastic, Prony

Material = Elastic | Prony


@dataclass(frozen=True)
class Fading(Body):
    """A viscoelastic body that rolls steadily along +x: its displacement at once, and what fades of it.

    glassy, rubbery: its surface of the instantaneous and of the long-term modulus, elastic; all of its compliance
    goes with that one modulus, as that of a half-space or of a layer on a rigid base does. material: not a fluid.
    speed: m/s, > 0. Build it with `of_material`, which checks.
    """

    glassy: Body
    rubbery: Body
    material: Prony
    speed: float

    @property
    def symmetric(self) -> bool:
        """False: the work of two loads on each other's displacements differs."""
        return False

    @property
    def at_rest(self) -> Body:
        """That of the long-term modulus."""
        return self.rubbery

    def check_shear(self) -> None:
        """As in `Body`."""
        self.glassy.check_shear()

    @property
    def stats(self) -> Mapping[str, object]:
        """Of the body at once."""
        return self.glassy.stats

    def normal(self, at: Offsets) -> Array:
        """As in `Body`."""
        return self._with_memory(self.glassy.normal, at)

    def tangential(self, at: Offsets) -> Array:
        """As in `Body`."""
        return self._with_memory(self.glassy.tangential, at)

    def coupling(self, at: Offsets) -> Array:
        """As in `Body`."""
        return self._with_memory(self.glassy.coupling, at)

    def compliance(self, waves: Waves) -> ComplexArray:
        """As in `Body`: the glassy one times 1 + Σ fⱼ/(1 - i k_x V Tⱼ)."""
        fading = self._fading(waves.along)
        fading[0, 0] = abs(fading[0, 0])
        return np.asarray(fading * self.glassy.compliance(waves))

    def across(self, k: Array) -> Array:
        """As in `Body`, of waves along x."""
        return np.asarray(np.abs(self._fading(k)) * self.glassy.across(k))

    @property
    def striped(self) -> bool:
        """As the body at once."""
        return self.glassy.striped

    def strips(self, rows: Rows) -> tuple[Strip, ...]:
        """As in `Body`: those of the body at once, and what fades of them."""
        memory = tuple((strength, self.speed * time) for strength, time in self.material.creep_terms)
        return tuple(replace(strip, memory=memory) for strip in self.glassy.strips(rows))

    def _fading(self, kx: Array) -> ComplexArray:
        return np.asarray(
            1 + sum((f / (1 - 1j * kx * self.speed * t) for f, t in self.material.creep_terms), np.zeros(kx.shape))
        )

    def _with_memory(self, glassy: Callable[[Offsets], Array], at: Offsets) -> Array:
        def sample(first: float, count: int) -> Array:
            return glassy(Offsets(at.ny, count, at.dx, at.dy, first))

        behind = round(-at.first / at.dx)
        if behind < 0 or not math.isclose(-at.first, behind * at.dx, abs_tol=1e-9 * at.dx):
            raise InputError(
                f"a viscoelastic body in steady rolling is known at whole cells, asked for {at.first:g} m on "
                f"cells of {at.dx:g} m; a history takes an elastic one, material.glassy or material.rubbery"
            )
        strengths, times = np.array(self.material.creep_terms).T
        faded = memory.fading(sample, behind, at.nx - 1 - behind, at.dx, self.speed * times)
        return np.asarray(sample(at.first, at.nx) + np.tensordot(strengths, faded, 1))


def half_space(material: Material, *, is_tire: bool, speed: float | None = None) -> Body:
    """A half-space of a material on one side of a contact, rolling at a speed, m/s.

    Raises InputError for a viscoelastic one without a positive speed, and for a fluid.
    """
    return of_material(material, lambda elastic: _elastic(elastic, is_tire), is_tire=is_tire, speed=speed)


def of_material(
    material: Material, surface: Callable[[Elastic], Body], *, is_tire: bool, speed: float | None = None
) -> Body:
    """A body of one material, whose compliance goes with its modulus, rolling at a speed, m/s.

    surface: the body of an elastic material. Raises InputError as `half_space`.
    """
    if isinstance(material, Elastic):
        return surface(material)
    name = "tire" if is_tire else "road"
    if speed is None:
        raise InputError(
            f"the {name} is viscoelastic ({material}): give the rolling speed (m/s), on which its stiffness depends"
        )
    at_rest = f"for a viscoelastic {name} at rest use the elastic limit material.rubbery"
    positive("speed", speed, "m/s", at_rest)
    if material.is_fluid:
        raise InputError(
            f"the {name} is a fluid ({material}): its shares add up to 1, as in a Maxwell element. Rolling steadily, "
            "it sinks indefinitely and leaves a rut. Keep a long-term modulus: a standard linear solid, "
            "or shares that add up to 0.99 at most"
        )
    return Fading(surface(material.glassy), surface(material.rubbery), material, float(speed))


def rolling_pair(tire: Material, road: Material, speed: float | None) -> Body:
    """Two half-spaces that roll at a speed, m/s; raises as `half_space`."""
    return Sum.of(half_space(tire, is_tire=True, speed=speed), half_space(road, is_tire=False, speed=speed))


def _elastic(material: Elastic, is_tire: bool) -> HalfSpaces:
    return HalfSpaces.of(material, None) if is_tire else HalfSpaces.of(None, material)
