"""What repeated load does to the road."""

from treadload.damage.climate import Climate, Season
from treadload.damage.cracks import crack_rose, envelope
from treadload.damage.criterion import Criterion
from treadload.damage.energies import DissipatedEnergy, DistortionEnergy
from treadload.damage.field_shift import FieldShift, field_shifts, read_field_shifts
from treadload.damage.fields import compute_quantities, known_quantities, peak, tension_behind
from treadload.damage.growth import CrackGrowth, FromStrength, Growth, ParisLaw
from treadload.damage.history import add_thermal_stress, residual_after, thermal_stress
from treadload.damage.indices import asphalt_rut, distortion_work, polishing_work, tearing_work
from treadload.damage.interface import BondVerdict, assess_bonds, delaminate, interface_fields
from treadload.damage.invariants import MazarsOnset, MazarsStrain, MeanStress, OctahedralShear, VonMisesStrain
from treadload.damage.laws.aged import AgedLine, AgedSurface, TwoSlopeLine
from treadload.damage.laws.american import (
    AsphaltInstitute,
    AsphaltInstituteSubgrade,
    MepdgBottomUp,
    MepdgTopDown,
    ShellFatigue,
)
from treadload.damage.laws.bond import LEUTNER_MINIMUM, BondStrength, BondUtilisation, InterfaceStrength, ShearFatigue
from treadload.damage.laws.bond_by_test import TimedStrength, passage_rate
from treadload.damage.laws.energy_ratio import EnergyRatio
from treadload.damage.laws.equivalence import AGGRESSIVENESS, aggressiveness, equivalent_axles
from treadload.damage.laws.fatigue import FatigueLaw, FatigueLine, PowerLaw, PowerLine
from treadload.damage.laws.fit import FittedLine, fit_fatigue_line
from treadload.damage.laws.french import RISK, FrenchBituminous, FrenchHydraulic, FrenchSubgrade
from treadload.damage.laws.indian import (
    IrcCementTreated,
    IrcFatigue,
    IrcRutting,
    granular_modulus,
    subgrade_modulus,
)
from treadload.damage.laws.limit import Limit
from treadload.damage.laws.of_layer import OnLayer
from treadload.damage.life import Life
from treadload.damage.listing import laws_listed, listed, quantities_listed
from treadload.damage.miner import miner
from treadload.damage.quantities import (
    BottomExtension,
    Extension,
    HorizontalTension,
    PrincipalTension,
    SubgradeCompression,
    SurfaceExtension,
    VerticalCompression,
    VerticalShear,
)
from treadload.damage.quantity import Quantity
from treadload.damage.ratios import EnergyDemand, OctahedralRatio
from treadload.damage.rutting import Rutting
from treadload.damage.traffic import AxleClass, Traffic, Wander
from treadload.damage.uniform import UniformComparison, compare_uniform
from treadload.damage.verdict import Verdict, assess

__all__ = [
    "AGGRESSIVENESS",
    "LEUTNER_MINIMUM",
    "RISK",
    "AgedLine",
    "AgedSurface",
    "AsphaltInstitute",
    "AsphaltInstituteSubgrade",
    "AxleClass",
    "BondStrength",
    "BondUtilisation",
    "BondVerdict",
    "BottomExtension",
    "Climate",
    "CrackGrowth",
    "Criterion",
    "DissipatedEnergy",
    "DistortionEnergy",
    "EnergyDemand",
    "EnergyRatio",
    "Extension",
    "FatigueLaw",
    "FatigueLine",
    "FieldShift",
    "FittedLine",
    "FrenchBituminous",
    "FrenchHydraulic",
    "FrenchSubgrade",
    "FromStrength",
    "Growth",
    "HorizontalTension",
    "InterfaceStrength",
    "IrcCementTreated",
    "IrcFatigue",
    "IrcRutting",
    "Life",
    "Limit",
    "MazarsOnset",
    "MazarsStrain",
    "MeanStress",
    "MepdgBottomUp",
    "MepdgTopDown",
    "OctahedralRatio",
    "OctahedralShear",
    "OnLayer",
    "ParisLaw",
    "PowerLaw",
    "PowerLine",
    "PrincipalTension",
    "Quantity",
    "Rutting",
    "Season",
    "ShearFatigue",
    "ShellFatigue",
    "SubgradeCompression",
    "SurfaceExtension",
    "TimedStrength",
    "Traffic",
    "TwoSlopeLine",
    "UniformComparison",
    "Verdict",
    "VerticalCompression",
    "VerticalShear",
    "VonMisesStrain",
    "Wander",
    "add_thermal_stress",
    "aggressiveness",
    "asphalt_rut",
    "assess",
    "assess_bonds",
    "compare_uniform",
    "compute_quantities",
    "crack_rose",
    "delaminate",
    "distortion_work",
    "envelope",
    "equivalent_axles",
    "field_shifts",
    "fit_fatigue_line",
    "granular_modulus",
    "interface_fields",
    "known_quantities",
    "laws_listed",
    "listed",
    "miner",
    "passage_rate",
    "peak",
    "polishing_work",
    "quantities_listed",
    "read_field_shifts",
    "residual_after",
    "subgrade_modulus",
    "tearing_work",
    "tension_behind",
    "thermal_stress",
]
