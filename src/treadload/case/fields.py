"""Fields of a case: numbers with units, and what every table of it has in common."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Annotated, Any

from pydantic import BaseModel, BeforeValidator, ConfigDict

from treadload.units import quantity

Length = Annotated[float, BeforeValidator(lambda v: quantity(v, "m"))]
Pressure = Annotated[float, BeforeValidator(lambda v: quantity(v, "Pa"))]
Stiffness = Annotated[float, BeforeValidator(lambda v: quantity(v, "Pa/m"))]
Force = Annotated[float, BeforeValidator(lambda v: quantity(v, "N"))]
Speed = Annotated[float, BeforeValidator(lambda v: quantity(v, "m/s"))]
Angle = Annotated[float, BeforeValidator(lambda v: quantity(v, "rad"))]
Curvature = Annotated[float, BeforeValidator(lambda v: quantity(v, "rad/m"))]
Number = Annotated[float, BeforeValidator(lambda v: quantity(v, ""))]
Time = Annotated[float, BeforeValidator(lambda v: quantity(v, "s"))]
Kelvin = Annotated[float, BeforeValidator(lambda v: quantity(v, "K"))]
Celsius = Annotated[float, BeforeValidator(lambda v: quantity(v, "degC"))]
PerDegree = Annotated[float, BeforeValidator(lambda v: quantity(v, "1/K"))]
PerDegreeSquared = Annotated[float, BeforeValidator(lambda v: quantity(v, "1/K^2"))]
Frequency = Annotated[float, BeforeValidator(lambda v: quantity(v, "Hz"))]
Compliance = Annotated[float, BeforeValidator(lambda v: quantity(v, "1/Pa"))]
MolarEnergy = Annotated[float, BeforeValidator(lambda v: quantity(v, "J/mol"))]
Conductivity = Annotated[float, BeforeValidator(lambda v: quantity(v, "W/(m K)"))]
HeatCapacity = Annotated[float, BeforeValidator(lambda v: quantity(v, "J/(m^3 K)"))]


class Part(BaseModel):
    """A table of a case: frozen, and no key that it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    def __repr_args__(self) -> Iterable[tuple[str | None, Any]]:
        """What was given; the rest stands at its default."""
        return [(name, value) for name, value in super().__repr_args__() if name in self.model_fields_set]
