"""Which bodies meet: a tire's and a road's, by what they are made of.

A body of another kind is a subclass of `contact.bodies.body.Body`, and a material whose method `surface` makes it; it
may live in somebody else's package. One that this program brings is registered for the class of its material with
`surface_of.register`.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, singledispatch
from typing import Literal, cast, get_args

from treadload.contact.bodies.anisotropic import AnisotropicHalfSpace
from treadload.contact.bodies.belt import belt_surface
from treadload.contact.bodies.body import Body, Sum
from treadload.contact.bodies.layers import layered_road
from treadload.contact.bodies.upright import UprightHalfSpace
from treadload.contact.bodies.viscoelastic import half_space
from treadload.errors import InputError
from treadload.materials import Anisotropic, Elastic, Prony, TransverselyIsotropic
from treadload.materials.kinds import Surfaced
from treadload.pavement import Pavement
from treadload.pavement.stack import stack_of
from treadload.tire import Tire
from treadload.tire.belt import InflatedBelt

RoadCompliance = Literal["half_space", "layers"]


@singledispatch
def surface_of(material: object, *, is_tire: bool, speed: float | None = None) -> Body:
    """The body whose surface a material makes, on the tire's side or the road's.

    material: an Elastic, an anisotropic one or a Prony for half-spaces, or one that makes its surface itself.
    speed: of rolling, m/s.
    Raises InputError for a material of which no body is known, and what its body refuses.
    """
    if isinstance(material, Surfaced):
        body = cast(Body, material.surface(is_tire=is_tire, speed=speed))
        return body
    name = "tire" if is_tire else "road"
    raise InputError(
        f"no body is known for the material of the {name}, a {type(material).__name__}; give an Elastic, an "
        "Orthotropic, a Prony or a material with a method surface(is_tire, speed)"
    )


@surface_of.register(Elastic | Prony)
def _(material: Elastic | Prony, *, is_tire: bool, speed: float | None = None) -> Body:
    return half_space(material, is_tire=is_tire, speed=speed)


@surface_of.register
def _(material: Anisotropic, *, is_tire: bool, speed: float | None = None) -> Body:
    return AnisotropicHalfSpace.of(material.stiffness, is_tire=is_tire)


@surface_of.register
def _(material: TransverselyIsotropic, *, is_tire: bool, speed: float | None = None) -> Body:
    return UprightHalfSpace.of(stack_of(Pavement.half_space(material)), is_tire=is_tire)


@surface_of.register
def _(material: InflatedBelt, *, is_tire: bool, speed: float | None = None) -> Body:
    if not is_tire:
        raise InputError("an inflated belt is a tire; give the road an Elastic, an Orthotropic or a Prony")
    return belt_surface(material, speed)


@dataclass(frozen=True)
class Pair:
    """The two bodies of a contact. tire: body 1. road: body 2, with its layers where they are asked for."""

    tire: Body
    road: Body

    @classmethod
    def of(
        cls, tire: Tire, road: Pavement, *, speed: float | None = None, road_compliance: RoadCompliance = "half_space"
    ) -> Pair:
        """The bodies of a tire and a road; the road as a half-space of its top layer, or as its layers.

        speed: of rolling, m/s, for bodies with memory. Raises InputError for what they refuse.
        """
        return cls(surface_of(tire.carcass, is_tire=True, speed=speed), road_surface(road, road_compliance))

    @cached_property
    def both(self) -> Body:
        """Their sum."""
        return Sum.of(self.tire, self.road)


def road_surface(road: Pavement, compliance: RoadCompliance = "half_space") -> Body:
    """The body of a road: a half-space of its top layer, or its layers.

    Raises InputError for another word, for layers that are not elastic and for half-bonded interfaces,
    ConvergenceError for layers whose compliance cannot be fitted.
    """
    if compliance not in get_args(RoadCompliance):
        raise InputError(f'road_compliance must be "half_space" or "layers", got {compliance!r}')
    if compliance == "half_space" or road.is_homogeneous:
        return surface_of(road.surface_material, is_tire=False)
    return layered_road(stack_of(road))
