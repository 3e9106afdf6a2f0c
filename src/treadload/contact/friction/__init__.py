"""Friction laws: how much shear a pressure can transmit, by slip, direction, place and heat."""

from treadload.contact.friction.heat import FlashHeating, Heat
from treadload.contact.friction.laws import (
    Anisotropic,
    Coulomb,
    Exponential,
    FrictionLaw,
    Interface,
    LinearFalling,
    PressureDependent,
    Rational,
)
from treadload.contact.friction.map import FrictionMap

__all__ = [
    "Anisotropic",
    "Coulomb",
    "Exponential",
    "FlashHeating",
    "FrictionLaw",
    "FrictionMap",
    "Heat",
    "Interface",
    "LinearFalling",
    "PressureDependent",
    "Rational",
]
