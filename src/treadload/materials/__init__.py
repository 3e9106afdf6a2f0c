"""Materials: what deforms, and how."""

from treadload.materials.ageing import Aged, GlobalAging
from treadload.materials.aggregates import Aggregates
from treadload.materials.anisotropic import Anisotropic, TransverselyIsotropic
from treadload.materials.elastic import Elastic
from treadload.materials.fit import MaterialFit, fit_2s2p1d, fit_huet_sayegh, fit_prony
from treadload.materials.huet_sayegh import HuetSayegh, Model2S2P1D
from treadload.materials.kinds import Material, Solid, TemperatureDependent, Viscoelastic
from treadload.materials.measured import (
    FrequencySweep,
    RelaxationTest,
    read_isotherms,
    read_master_curve,
    read_shift_factors,
)
from treadload.materials.mixture import HydraulicMix, Mix, RoadMaterial, Unbound
from treadload.materials.orthotropic import Orthotropic
from treadload.materials.plastic import (
    DruckerPrager,
    ElastoPlastic,
    MohrCoulomb,
    PassesPowerLaw,
    Perzyna,
    PlasticLaw,
    Swift,
    VonMises,
)
from treadload.materials.power_law import PowerLawCreep
from treadload.materials.published import PublishedMaterial
from treadload.materials.series import as_prony
from treadload.materials.shifting import MasterCurve, master_curve
from treadload.materials.stress_dependent import AtStress, StressDependent, UnboundByStress
from treadload.materials.stress_laws import Bilinear, Boyce, KTheta, ModulusLaw, Universal, Uzan
from treadload.materials.temperature import WLF, Arrhenius, QuadraticShift, TabulatedShift, Thermorheological
from treadload.materials.viscoelastic import Prony

__all__ = [
    "WLF",
    "Aged",
    "Aggregates",
    "Anisotropic",
    "Arrhenius",
    "AtStress",
    "Bilinear",
    "Boyce",
    "DruckerPrager",
    "Elastic",
    "ElastoPlastic",
    "FrequencySweep",
    "GlobalAging",
    "HuetSayegh",
    "HydraulicMix",
    "KTheta",
    "MasterCurve",
    "Material",
    "MaterialFit",
    "Mix",
    "Model2S2P1D",
    "ModulusLaw",
    "MohrCoulomb",
    "Orthotropic",
    "PassesPowerLaw",
    "Perzyna",
    "PlasticLaw",
    "PowerLawCreep",
    "Prony",
    "PublishedMaterial",
    "QuadraticShift",
    "RelaxationTest",
    "RoadMaterial",
    "Solid",
    "StressDependent",
    "Swift",
    "TabulatedShift",
    "TemperatureDependent",
    "Thermorheological",
    "TransverselyIsotropic",
    "Unbound",
    "UnboundByStress",
    "Universal",
    "Uzan",
    "Viscoelastic",
    "VonMises",
    "as_prony",
    "fit_2s2p1d",
    "fit_huet_sayegh",
    "fit_prony",
    "master_curve",
    "read_isotherms",
    "read_master_curve",
    "read_shift_factors",
]
