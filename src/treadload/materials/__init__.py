"""Materials: what deforms, and how."""

from treadload.materials.elastic import Elastic
from treadload.materials.kinds import Material, TemperatureDependent, Viscoelastic
from treadload.materials.viscoelastic import Prony

__all__ = ["Elastic", "Material", "Prony", "TemperatureDependent", "Viscoelastic"]
