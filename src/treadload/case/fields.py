"""Fields of a case: numbers with units, and what every table of it has in common."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict

from treadload.units import quantity


@dataclass(frozen=True)
class Unit:
    """What a number of a case is counted in, for whoever shows it.

    symbol: of the SI unit, "" of a pure number, or the kind of quantity where people count it in a unit of its own.
    """

    symbol: str


Length = Annotated[float, Unit("m"), BeforeValidator(lambda v: quantity(v, "m"))]
Pressure = Annotated[float, Unit("Pa"), BeforeValidator(lambda v: quantity(v, "Pa"))]
Stiffness = Annotated[float, Unit("Pa/m"), BeforeValidator(lambda v: quantity(v, "Pa/m"))]
Force = Annotated[float, Unit("N"), BeforeValidator(lambda v: quantity(v, "N"))]
Speed = Annotated[float, Unit("m/s"), BeforeValidator(lambda v: quantity(v, "m/s"))]
Angle = Annotated[float, Unit("rad"), BeforeValidator(lambda v: quantity(v, "rad"))]
Curvature = Annotated[float, Unit("rad/m"), BeforeValidator(lambda v: quantity(v, "rad/m"))]
Number = Annotated[float, Unit(""), BeforeValidator(lambda v: quantity(v, ""))]
Time = Annotated[float, Unit("s"), BeforeValidator(lambda v: quantity(v, "s"))]
Kelvin = Annotated[float, Unit("K"), BeforeValidator(lambda v: quantity(v, "K"))]
Celsius = Annotated[float, Unit("degC"), BeforeValidator(lambda v: quantity(v, "degC"))]
PerDegree = Annotated[float, Unit("1/K"), BeforeValidator(lambda v: quantity(v, "1/K"))]
PerDegreeSquared = Annotated[float, Unit("1/K^2"), BeforeValidator(lambda v: quantity(v, "1/K^2"))]
Frequency = Annotated[float, Unit("Hz"), BeforeValidator(lambda v: quantity(v, "Hz"))]
Compliance = Annotated[float, Unit("1/Pa"), BeforeValidator(lambda v: quantity(v, "1/Pa"))]
MolarEnergy = Annotated[float, Unit("J/mol"), BeforeValidator(lambda v: quantity(v, "J/mol"))]
Conductivity = Annotated[float, Unit("W/(m K)"), BeforeValidator(lambda v: quantity(v, "W/(m K)"))]
HeatCapacity = Annotated[float, Unit("J/(m^3 K)"), BeforeValidator(lambda v: quantity(v, "J/(m^3 K)"))]

# The outermost unit of a field tells what people count it in: moduli in MPa where other pressures are in kPa.
Modulus = Annotated[Pressure, Unit("modulus")]
Radius = Annotated[Length, Unit("radius")]
SlidingSpeed = Annotated[Speed, Unit("sliding speed")]
Strain = Annotated[Number, Unit("strain")]
Share = Annotated[Number, Unit("share")]
Acceleration = Annotated[Number, Unit("m/s^2")]
Years = Annotated[Number, Unit("years")]
PerYear = Annotated[Number, Unit("1/year")]


class Part(BaseModel):
    """A table of a case: frozen, and no key that it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    def __repr_args__(self) -> Iterable[tuple[str | None, Any]]:
        """What was given; the rest stands at its default."""
        return [(name, value) for name, value in super().__repr_args__() if name in self.model_fields_set]
