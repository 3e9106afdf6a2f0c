"""The road and its layers."""

from treadload.pavement.bonds import BONDED, FRICTIONLESS, HALF_BONDED, Bond, HalfBonded
from treadload.pavement.catalogue import Structure, read_structures, structures
from treadload.pavement.rows import LayerRow, layer_rows
from treadload.pavement.structure import Layer, Pavement
from treadload.pavement.temperature import TemperatureProfile

__all__ = [
    "BONDED",
    "FRICTIONLESS",
    "HALF_BONDED",
    "Bond",
    "HalfBonded",
    "Layer",
    "LayerRow",
    "Pavement",
    "Structure",
    "TemperatureProfile",
    "layer_rows",
    "read_structures",
    "structures",
]
