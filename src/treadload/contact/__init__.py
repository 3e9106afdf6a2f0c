"""Contact of tire and road: pressure, shear, stick and slip."""

from treadload.contact.curve import CreepCurve, creep_curve
from treadload.contact.flash import FlashHeating, Heat
from treadload.contact.friction import (
    Anisotropic,
    Coulomb,
    Exponential,
    FrictionLaw,
    LinearFalling,
    PressureDependent,
    Rational,
)
from treadload.contact.friction_map import FrictionMap
from treadload.contact.maneuver import STRAIGHT, Maneuver
from treadload.contact.resistance import RollingResistance, rolling_resistance
from treadload.contact.solution import Contact
from treadload.contact.solve import solve_contact
from treadload.contact.transient import TransientResult, solve_transient
from treadload.contact.turning import TurnResult, turn_on_the_spot
from treadload.contact.wheel import Rolling

__all__ = [
    "STRAIGHT",
    "Anisotropic",
    "Contact",
    "Coulomb",
    "CreepCurve",
    "Exponential",
    "FlashHeating",
    "FrictionLaw",
    "FrictionMap",
    "Heat",
    "LinearFalling",
    "Maneuver",
    "PressureDependent",
    "Rational",
    "Rolling",
    "RollingResistance",
    "TransientResult",
    "TurnResult",
    "creep_curve",
    "rolling_resistance",
    "solve_contact",
    "solve_transient",
    "turn_on_the_spot",
]
