"""Elastic materials and Prony series in a case, and what a tire can be made of."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Tag

from treadload.case.fields import Modulus, Number, Part, Time
from treadload.case.kinds import known_kind
from treadload.materials import Elastic, Prony


class MaterialPart(Part):
    """`material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }`."""

    kind: Literal["elastic"] = "elastic"
    modulus: Modulus
    poisson: Number

    def build(self) -> Elastic:
        """The material."""
        return Elastic(self.modulus, self.poisson)


class PronyPart(Part):
    """`material = { kind = "prony", modulus = "10 MPa", terms = [[0.7, "10 ms"]], poisson = 0.49 }`."""

    kind: Literal["prony"]
    modulus: Modulus
    terms: tuple[tuple[Number, Time], ...]
    poisson: Number

    def build(self) -> Prony:
        """The material."""
        return Prony(self.modulus, self.terms, self.poisson)


TIRE_PARTS: dict[str, type[Part]] = {"elastic": MaterialPart, "prony": PronyPart}


def kind_of_material(value: Any) -> str:
    """The kind that a table or a part of a case names; elastic if it names none."""
    kind = value.get("kind", "elastic") if isinstance(value, dict) else getattr(value, "kind", "elastic")
    return str(kind)


# What a tire can be made of; the kind tells the tables apart.
TireMaterial = Annotated[
    Annotated[MaterialPart, Tag("elastic")] | Annotated[PronyPart, Tag("prony")],
    Discriminator(kind_of_material),
    BeforeValidator(lambda value: known_kind(value, TIRE_PARTS, "material", "elastic")),
]
