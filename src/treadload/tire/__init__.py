"""The tire: scans, height maps and parametric treads to the gap that the contact solver takes."""

from treadload.tire.belt import Belt, InflatedBelt, LateralBelt
from treadload.tire.free_rolling import FreeRolling
from treadload.tire.grooves import Groove, LateralGrooves, equal_ribs
from treadload.tire.library import TireMesh, example_mesh
from treadload.tire.magic_formula import MagicFormula, TireForces
from treadload.tire.modulus import modulus_from_inflation
from treadload.tire.quality import GrooveMeasure, ScanQuality
from treadload.tire.surface import HeightMapSurface, Surface
from treadload.tire.tire import Tire
from treadload.tire.tread import ProfileSurface, TreadProfile
from treadload.tire.wear import Wear

__all__ = [
    "Belt",
    "FreeRolling",
    "Groove",
    "GrooveMeasure",
    "HeightMapSurface",
    "InflatedBelt",
    "LateralBelt",
    "LateralGrooves",
    "MagicFormula",
    "ProfileSurface",
    "ScanQuality",
    "Surface",
    "Tire",
    "TireForces",
    "TireMesh",
    "TreadProfile",
    "Wear",
    "equal_ribs",
    "example_mesh",
    "modulus_from_inflation",
]
