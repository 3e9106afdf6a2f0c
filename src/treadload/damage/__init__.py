"""What repeated load does to the road."""

from treadload.damage.american import (
    AsphaltInstitute,
    AsphaltInstituteSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
    ShellFatigue,
)
from treadload.damage.criteria import compute_criteria, peak, tension_behind
from treadload.damage.direction import crack_rose, envelope
from treadload.damage.energy_ratio import EnergyRatio
from treadload.damage.fatigue import FatigueLaw, FatigueLine
from treadload.damage.french import FrenchBituminous, FrenchHydraulic, FrenchSubgrade, equivalent_axles
from treadload.damage.history import add_thermal_stress, residual_after, thermal_stress
from treadload.damage.verdict import Verdict, assess

__all__ = [
    "AsphaltInstitute",
    "AsphaltInstituteSubgrade",
    "EnergyRatio",
    "FatigueLaw",
    "FatigueLine",
    "FrenchBituminous",
    "FrenchHydraulic",
    "FrenchSubgrade",
    "MepdgBottomUp",
    "MepdgTopDown",
    "ShellFatigue",
    "Verdict",
    "add_thermal_stress",
    "assess",
    "compute_criteria",
    "crack_rose",
    "envelope",
    "equivalent_axles",
    "peak",
    "residual_after",
    "tension_behind",
    "thermal_stress",
]
