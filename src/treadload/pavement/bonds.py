"""How a layer is bonded to the one below it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from treadload.errors import InputError, positive
from treadload.registry import BONDS
from treadload.units import Number, Stiffness

# More than any road's faces have.
_MOST_FRICTION = 5.0


class BondLaw:
    """What every bond between two layers provides.

    stiffness: shear over relative sliding, Pa/m, >= 0, infinite when bonded; a field, or a property that raises
    InputError where it is not known yet.

    >>> bond = tl.pavement.TestedBond((10.0, 30.0), (20e9, 2e9))
    >>> isinstance(bond, tl.pavement.BondLaw), bond.depends_on_temperature
    (True, True)
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

    @property
    def sticking(self) -> BondLaw:
        """The bond while nothing slides: itself, unless it slides only beyond friction."""
        return self

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

    >>> bond = tl.pavement.Bond(1e10)
    >>> f"{0.2e6 / bond.stiffness * 1e6:.0f} µm of sliding under a shear of 0.2 MPa"
    '20 µm of sliding under a shear of 0.2 MPa'
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

    >>> tl.pavement.HalfBonded()
    HalfBonded()
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


@BONDS.register("parted")
@dataclass(frozen=True)
class Parted(BondLaw):
    """A debonded interface: in compression it carries shear up to friction times the pressure, in tension it opens.

    friction: coefficient μ on the face, in [0, 5]. unit_weight: of the layers above, which presses it together
    everywhere, N/m³, > 0; 24 kN/m³ is asphalt. The load comes once, from rest: a wheel that rolls by leaves the face
    slid behind it, which this does not follow. Raises InputError.
    Source: Coulomb's law on a unilateral face, as in Kikuchi and Oden (1988), Contact Problems in Elasticity.

    >>> tl.pavement.Parted(friction=0.7).stiffness
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: an interface that is parted with friction 0.7 has no stiffness: it holds or
    slides, place by place; take Pavement.sticking, or Bond(stiffness=...) for a spring
    """

    friction: Number
    unit_weight: Number = 24e3

    def __post_init__(self) -> None:
        if not 0 <= self.friction <= _MOST_FRICTION:
            raise InputError(
                f"the friction of a parted face must lie in [0, {_MOST_FRICTION:g}], got {self.friction}; "
                "0.5 to 0.8 is usual for asphalt on asphalt"
            )
        positive("unit_weight, of the layers above a parted face,", self.unit_weight, "N/m³", "asphalt has 24e3")

    @property
    def stiffness(self) -> float:  # type: ignore[override]
        """None of its own: raises InputError."""
        raise InputError(
            f"an interface that is {self} has no stiffness: it holds or slides, place by place; take "
            "Pavement.sticking, or Bond(stiffness=...) for a spring"
        )

    @property
    def sticking(self) -> BondLaw:
        """Bonded."""
        return BONDED

    def __str__(self) -> str:
        return f"parted with friction {self.friction:g}"


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
