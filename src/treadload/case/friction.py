"""Friction in a case: a number, or the table of a law."""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Tag

from treadload.case.fields import Conductivity, HeatCapacity, Kelvin, Length, Number, Part, Pressure, SlidingSpeed
from treadload.contact import (
    Anisotropic,
    Coulomb,
    Exponential,
    FlashHeating,
    FrictionLaw,
    FrictionMap,
    Heat,
    LinearFalling,
    PressureDependent,
    Rational,
)


class CoulombPart(Part):
    """`friction = { law = "coulomb", coefficient = 0.7 }`, the same as `friction = 0.7`."""

    law: Literal["coulomb"]
    coefficient: Number

    def build(self, folder: Path) -> FrictionLaw:
        """The law."""
        return Coulomb(self.coefficient)


class FallingPart(Part):
    """`friction = { law = "exponential", static = 0.9, kinetic = 0.5, reference_speed = "2 m/s" }`."""

    law: Literal["linear", "rational", "exponential"]
    static: Number
    kinetic: Number
    reference_speed: SlidingSpeed

    def build(self, folder: Path) -> FrictionLaw:
        """The law."""
        numbers = self.static, self.kinetic, self.reference_speed
        if self.law == "linear":
            return LinearFalling(*numbers)
        return Rational(*numbers) if self.law == "rational" else Exponential(*numbers)


class PressurePart(Part):
    """`friction = { law = "pressure", reference = 0.8, reference_pressure = "700 kPa", exponent = 0.15 }`."""

    law: Literal["pressure"]
    reference: Number
    reference_pressure: Pressure
    exponent: Number
    upper: Number | None = None

    def build(self, folder: Path) -> FrictionLaw:
        """The law."""
        return PressureDependent(self.reference, self.reference_pressure, self.exponent, self.upper)


class AnisotropicPart(Part):
    """`friction = { law = "anisotropic", along = 0.8, across = 0.6 }`."""

    law: Literal["anisotropic"]
    along: Number
    across: Number
    base: Friction | None = None

    def build(self, folder: Path) -> FrictionLaw:
        """The law."""
        return Anisotropic(self.along, self.across, law(self.base, folder))


class MapPart(Part):
    """`friction = { law = "map", file = "path.csv", cell = "10 mm" }`."""

    law: Literal["map"]
    file: str
    cell: Length
    base: Friction | None = None

    def build(self, folder: Path) -> FrictionLaw:
        """The law; a relative path starts from the folder."""
        return FrictionMap.from_file(folder / self.file, self.cell, law(self.base, folder))


class HeatPart(Part):
    """`tire = { conductivity = 0.25, heat_capacity = 2e6 }`: W/(m K) and J/(m³ K)."""

    conductivity: Conductivity
    heat_capacity: HeatCapacity

    def build(self) -> Heat:
        """How the body takes up heat."""
        return Heat(self.conductivity, self.heat_capacity)


class FlashPart(Part):
    """`{ law = "flash", base = 0.9, tire = {…}, road = {…}, onset = "50 K", span = "90 K", hot = 0.5 }`."""

    law: Literal["flash"]
    base: Friction
    tire: HeatPart
    road: HeatPart
    onset: Kelvin
    span: Kelvin
    hot: Number

    def build(self, folder: Path) -> FrictionLaw:
        """The law."""
        base = law(self.base, folder)
        assert base is not None
        return FlashHeating(base, self.tire.build(), self.road.build(), self.onset, self.span, self.hot)


LAW_PARTS: dict[str, type[Part]] = {
    "coulomb": CoulombPart,
    "linear": FallingPart,
    "rational": FallingPart,
    "exponential": FallingPart,
    "pressure": PressurePart,
    "anisotropic": AnisotropicPart,
    "map": MapPart,
    "flash": FlashPart,
}


def _kind_of_friction(value: Any) -> str:
    if isinstance(value, dict):
        return str(value.get("law"))
    return str(value.law) if isinstance(value, Part) and hasattr(value, "law") else "number"


def _known_law(value: Any) -> Any:
    """Friction whose law is one of ours. Raises ValueError that says which are."""
    law = value.get("law") if isinstance(value, dict) else None
    # A list or a table where the name should stand has no place in a dictionary.
    if isinstance(value, dict) and (not isinstance(law, str) or law not in LAW_PARTS):
        near = difflib.get_close_matches(str(law), LAW_PARTS, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known are {', '.join(LAW_PARTS)}"
        raise ValueError(
            f"a friction law needs its name, law = …; {hint}" if law is None else f"no law {law!r}; {hint}"
        )
    return value


# A number, or the table of a law.
Friction = Annotated[
    Annotated[Number, Tag("number")]
    | Annotated[CoulombPart, Tag("coulomb")]
    | Annotated[FallingPart, Tag("linear")]
    | Annotated[FallingPart, Tag("rational")]
    | Annotated[FallingPart, Tag("exponential")]
    | Annotated[PressurePart, Tag("pressure")]
    | Annotated[AnisotropicPart, Tag("anisotropic")]
    | Annotated[MapPart, Tag("map")]
    | Annotated[FlashPart, Tag("flash")],
    Discriminator(_kind_of_friction),
    BeforeValidator(_known_law),
]


def law(part: Any, folder: Path) -> FrictionLaw | None:
    """The law of a number or a table; files in it start from the folder."""
    return part if part is None else Coulomb(part) if isinstance(part, float) else part.build(folder)
