"""Materials in a case: tables told apart by their kind."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Tag

from treadload.case.fields import Number, Part, Pressure, Time
from treadload.materials import Elastic, Prony


class MaterialPart(Part):
    """`material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }`."""

    kind: Literal["elastic"] = "elastic"
    modulus: Pressure
    poisson: Number

    def build(self) -> Elastic:
        """The material."""
        return Elastic(self.modulus, self.poisson)


class PronyPart(Part):
    """`material = { kind = "prony", modulus = "10 MPa", terms = [[0.7, "10 ms"]], poisson = 0.49 }`."""

    kind: Literal["prony"]
    modulus: Pressure
    terms: tuple[tuple[Number, Time], ...]
    poisson: Number

    def build(self) -> Prony:
        """The material."""
        return Prony(self.modulus, self.terms, self.poisson)


MATERIAL_PARTS: dict[str, type[Part]] = {"elastic": MaterialPart, "prony": PronyPart}


def _kind_of_material(value: Any) -> str:
    kind = value.get("kind", "elastic") if isinstance(value, dict) else getattr(value, "kind", "elastic")
    return str(kind)


def _known_material(value: Any) -> Any:
    """A material whose kind is one of ours. Raises ValueError that says which are."""
    kind = _kind_of_material(value)
    if kind not in MATERIAL_PARTS:
        raise ValueError(f"no material of the kind {kind!r}; known are {', '.join(MATERIAL_PARTS)}")
    return value


# What a tire can be made of; the kind tells the tables apart.
TireMaterial = Annotated[
    Annotated[MaterialPart, Tag("elastic")] | Annotated[PronyPart, Tag("prony")],
    Discriminator(_kind_of_material),
    BeforeValidator(_known_material),
]
