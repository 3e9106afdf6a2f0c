"""What repeated load does to the road."""

from treadload.damage.cracks import crack_rose, envelope
from treadload.damage.criteria.design import DesignCriterion
from treadload.damage.criteria.energy_ratio import EnergyRatio
from treadload.damage.criteria.fields import compute_criteria, peak, tension_behind
from treadload.damage.history import add_thermal_stress, residual_after, thermal_stress
from treadload.damage.interface import BondCriterion, BondVerdict, assess_bonds, delaminate, interface_fields
from treadload.damage.laws.american import (
    AsphaltInstitute,
    AsphaltInstituteSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
    ShellFatigue,
)
from treadload.damage.laws.bond import LEUTNER_MINIMUM, InterfaceStrength, ShearFatigue
from treadload.damage.laws.equivalence import equivalent_axles
from treadload.damage.laws.fatigue import FatigueLaw, FatigueLine, PowerLaw
from treadload.damage.laws.french import FrenchBituminous, FrenchHydraulic, FrenchSubgrade
from treadload.damage.laws.of_layer import OnLayer
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
    "OnLayer",
    "PowerLaw",
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
