"""The road and its layers."""

from treadload.pavement.asphalt import bituminous_thickness, is_bituminous, lift_below
from treadload.pavement.bonds import BONDED, FRICTIONLESS, HALF_BONDED, Bond, BondLaw, HalfBonded
from treadload.pavement.catalogue import Structure
from treadload.pavement.layer import Layer
from treadload.pavement.rows import LayerRow, layer_rows, road_in_words
from treadload.pavement.structure import Pavement
from treadload.pavement.temperature import TemperatureProfile

__all__ = [
    "BONDED",
    "FRICTIONLESS",
    "HALF_BONDED",
    "Bond",
    "BondLaw",
    "HalfBonded",
    "Layer",
    "LayerRow",
    "Pavement",
    "Structure",
    "TemperatureProfile",
    "bituminous_thickness",
    "is_bituminous",
    "layer_rows",
    "lift_below",
    "road_in_words",
]
