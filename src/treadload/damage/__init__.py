"""What repeated load does to the road."""

from treadload.damage.american import (
    AsphaltInstitute,
    AsphaltInstituteSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
    ShellFatigue,
)
from treadload.damage.direction import crack_rose, envelope
from treadload.damage.fatigue import FatigueLaw, FatigueLine
from treadload.damage.french import FrenchBituminous, FrenchHydraulic, FrenchSubgrade, equivalent_axles
from treadload.damage.verdict import Verdict, assess

__all__ = [
    "AsphaltInstitute",
    "AsphaltInstituteSubgrade",
    "FatigueLaw",
    "FatigueLine",
    "FrenchBituminous",
    "FrenchHydraulic",
    "FrenchSubgrade",
    "MepdgBottomUp",
    "MepdgTopDown",
    "ShellFatigue",
    "Verdict",
    "assess",
    "crack_rose",
    "envelope",
    "equivalent_axles",
]
