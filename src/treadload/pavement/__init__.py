"""The road and its layers."""

from treadload.pavement.bonds import BONDED, FRICTIONLESS, HALF_BONDED, Bond, HalfBonded
from treadload.pavement.catalogue import Structure, read_structures, structures
from treadload.pavement.structure import Layer, Pavement
from treadload.pavement.temperature import TemperatureProfile

__all__ = [
    "BONDED",
    "FRICTIONLESS",
    "HALF_BONDED",
    "Bond",
    "HalfBonded",
    "Layer",
    "Pavement",
    "Structure",
    "TemperatureProfile",
    "read_structures",
    "structures",
]
