"""How a layer is bonded to the one below it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from treadload.errors import InputError
from treadload.registry import BONDS
from treadload.units import Stiffness


class BondLaw:
    """What every bond between two layers provides.

    stiffness: shear over relative sliding, Pa/m, >= 0, infinite when bonded; a field, or a property that raises
    InputError where it is not known yet.
    """

    stiffness: float

    @property
    def limits(self) -> tuple[BondLaw, ...]:
        """The bonds whose mean response is that of this one; itself, unless it is a rule for several."""
        return (self,)

    @property
    def depends_on_temperature(self) -> bool:
        """True if the stiffness is known only once the temperature is."""
        return False

    def at(self, temperature: float) -> BondLaw:
        """The bond at a temperature of the layer above, °C."""
        return self


BONDS.makes(BondLaw)


@BONDS.register("spring")
@dataclass(frozen=True)
class Bond(BondLaw):
    """How a layer is bonded to the one below: shear = stiffness x relative sliding; the layers never separate.

    stiffness: Pa/m, >= 0; infinite when bonded, 0 without friction. It matters between some 1e9 and 1e12 Pa/m.
    Raises InputError for a negative stiffness.
    Source: Goodman, Taylor and Brekke (1968), J. Soil Mech. Found. Div. ASCE 94, 637-659.
    """

    stiffness: Stiffness

    def __post_init__(self) -> None:
        if isinstance(self.stiffness, str | type(None)) or not self.stiffness >= 0:
            raise InputError(
                f"the stiffness of a bond must be >= 0 Pa/m, got {self.stiffness}; 0 is frictionless, "
                "infinity is bonded"
            )

    def __str__(self) -> str:
        if self == BONDED:
            return "bonded"
        return "frictionless" if self == FRICTIONLESS else f"spring of {self.stiffness / 1e6:g} MPa/m"


@dataclass(frozen=True)
class HalfBonded(BondLaw):
    """The French half-bonded interface: the mean of two responses, one bonded and one frictionless.

    All half-bonded interfaces of a road are bonded in the one and frictionless in the other.
    Source: semi-bonded interfaces of NF P98-086; the rule reproduces both stresses of its table I.5, quoted by a
    secondary source.
    """

    @property
    def stiffness(self) -> float:  # type: ignore[override]
        """None of its own: raises InputError. Solve the roads of `Pavement.bond_limits`."""
        raise InputError(
            "a half-bonded interface has no stiffness: it is the mean of a bonded and a frictionless response; "
            "take the roads of Pavement.bond_limits, or Bond(stiffness=...) for a spring"
        )

    @property
    def limits(self) -> tuple[BondLaw, ...]:
        """Bonded and frictionless."""
        return BONDED, FRICTIONLESS

    def __str__(self) -> str:
        return "half-bonded"


BONDED = Bond(math.inf)
"""No relative sliding."""
HALF_BONDED = HalfBonded()
"""Half-way between bonded and frictionless by the French rule."""
FRICTIONLESS = Bond(0.0)
"""No shear between the layers."""


@BONDS.register("bonded")
def _bonded() -> Bond:
    """No relative sliding."""
    return BONDED


@BONDS.register("half-bonded")
def _half_bonded() -> HalfBonded:
    """Half-way between bonded and frictionless by the French rule."""
    return HALF_BONDED


@BONDS.register("frictionless")
def _frictionless() -> Bond:
    """No shear between the layers."""
    return FRICTIONLESS
