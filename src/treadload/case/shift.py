"""Time and temperature in a case: how the times of a material shift."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Tag

from treadload.case.fields import Celsius, Kelvin, MolarEnergy, Number, Part, PerDegree, PerDegreeSquared
from treadload.case.kinds import known_kind
from treadload.materials import WLF, Arrhenius, QuadraticShift, TabulatedShift


class ShiftPart(Part):
    """What all shifts share: tested = [0, 40], the temperatures of the tests behind them, °C."""

    tested: tuple[Celsius, Celsius] | None = None


class WlfPart(ShiftPart):
    """`shift = { kind = "wlf", c1 = 15, c2 = "120 K", reference = 15 }`."""

    kind: Literal["wlf"]
    c1: Number
    c2: Kelvin
    reference: Celsius

    def build(self) -> WLF:
        """The law."""
        return WLF(self.c1, self.c2, self.reference)


class ArrheniusPart(ShiftPart):
    """`shift = { kind = "arrhenius", activation_energy = "200 kJ/mol", reference = 15 }`."""

    kind: Literal["arrhenius"]
    activation_energy: MolarEnergy
    reference: Celsius

    def build(self) -> Arrhenius:
        """The law."""
        return Arrhenius(self.activation_energy, self.reference)


class QuadraticPart(ShiftPart):
    """`shift = { kind = "quadratic", a1 = -0.4, a2 = 0.0015 }`: ln τ = A₀ + A₁ T + A₂ T², and `tau` that at 0 °C."""

    kind: Literal["quadratic"]
    a1: PerDegree
    a2: PerDegreeSquared
    reference: Celsius = 0.0

    def build(self) -> QuadraticShift:
        """The law."""
        return QuadraticShift(self.a1, self.a2, self.reference)


class TablePart(ShiftPart):
    """`shift = { kind = "table", temperatures = [0, 15, 30], log_factors = [2.1, 0, -1.8], reference = 15 }`."""

    kind: Literal["table"]
    temperatures: tuple[Celsius, ...]
    log_factors: tuple[Number, ...]
    reference: Celsius

    def build(self) -> TabulatedShift:
        """The law."""
        return TabulatedShift(self.temperatures, self.log_factors, self.reference)


SHIFT_PARTS: dict[str, type[Part]] = {
    "wlf": WlfPart,
    "arrhenius": ArrheniusPart,
    "quadratic": QuadraticPart,
    "table": TablePart,
}


def _kind_of_shift(value: Any) -> str:
    return str(value.get("kind") if isinstance(value, dict) else getattr(value, "kind", None))


# How times depend on temperature; the kind tells the tables apart.
Shift = Annotated[
    Annotated[WlfPart, Tag("wlf")]
    | Annotated[ArrheniusPart, Tag("arrhenius")]
    | Annotated[QuadraticPart, Tag("quadratic")]
    | Annotated[TablePart, Tag("table")],
    Discriminator(_kind_of_shift),
    BeforeValidator(lambda value: known_kind(value, SHIFT_PARTS, "shift")),
]
