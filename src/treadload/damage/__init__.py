"""What repeated load does to the road."""

from treadload.damage.american import (
    AsphaltInstitute,
    AsphaltInstituteSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
    ShellFatigue,
)
from treadload.damage.bond import LEUTNER_MINIMUM, InterfaceStrength, ShearFatigue
from treadload.damage.criteria import compute_criteria, peak, tension_behind
from treadload.damage.design import DesignCriterion
from treadload.damage.direction import crack_rose, envelope
from treadload.damage.energy_ratio import EnergyRatio
from treadload.damage.fatigue import FatigueLaw, FatigueLine
from treadload.damage.french import FrenchBituminous, FrenchHydraulic, FrenchSubgrade, equivalent_axles
from treadload.damage.history import add_thermal_stress, residual_after, thermal_stress
from treadload.damage.interface import BondCriterion, BondVerdict, assess_bonds, delaminate, interface_fields
from treadload.damage.miner import Life, miner
from treadload.damage.traffic import AxleClass, Climate, Season, Traffic, Wander
from treadload.damage.verdict import Verdict, assess

__all__ = [
    "LEUTNER_MINIMUM",
    "AsphaltInstitute",
    "AsphaltInstituteSubgrade",
    "AxleClass",
    "BondCriterion",
    "BondVerdict",
    "Climate",
    "DesignCriterion",
    "EnergyRatio",
    "FatigueLaw",
    "FatigueLine",
    "FrenchBituminous",
    "FrenchHydraulic",
    "FrenchSubgrade",
    "InterfaceStrength",
    "Life",
    "MepdgBottomUp",
    "MepdgTopDown",
    "Season",
    "ShearFatigue",
    "ShellFatigue",
    "Traffic",
    "Verdict",
    "Wander",
    "add_thermal_stress",
    "assess",
    "assess_bonds",
    "compute_criteria",
    "crack_rose",
    "delaminate",
    "envelope",
    "equivalent_axles",
    "interface_fields",
    "miner",
    "peak",
    "residual_after",
    "tension_behind",
    "thermal_stress",
]
