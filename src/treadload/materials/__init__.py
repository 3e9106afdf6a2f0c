"""Materials: what deforms, and how."""

from treadload.materials.elastic import Elastic
from treadload.materials.huet_sayegh import HuetSayegh, Model2S2P1D
from treadload.materials.kinds import Material, TemperatureDependent, Viscoelastic
from treadload.materials.power_law import PowerLawCreep
from treadload.materials.series import as_prony
from treadload.materials.viscoelastic import Prony

__all__ = [
    "Elastic",
    "HuetSayegh",
    "Material",
    "Model2S2P1D",
    "PowerLawCreep",
    "Prony",
    "TemperatureDependent",
    "Viscoelastic",
    "as_prony",
]
