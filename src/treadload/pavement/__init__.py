"""The road and its layers."""

from treadload.pavement.asphalt import bituminous_thickness, is_bituminous, lift_below
from treadload.pavement.bond_tests import QUOTED_STIFFNESS, ShearTest, TestedBond
from treadload.pavement.bonds import BONDED, FRICTIONLESS, HALF_BONDED, Bond, BondLaw, HalfBonded, Parted
from treadload.pavement.catalogue import Structure
from treadload.pavement.frost import Frost, FrostYear, Moisture, frost_index, frost_year
from treadload.pavement.heating import Heat, RoadTemperatures, bells, road_temperatures
from treadload.pavement.layer import Layer
from treadload.pavement.methods import methods_of
from treadload.pavement.obstacles import RoadJoint, RoadPlate, RoadStep
from treadload.pavement.relief import Relief
from treadload.pavement.rows import LayerRow, layer_rows, road_in_words
from treadload.pavement.structure import Pavement
from treadload.pavement.sublayers import divided
from treadload.pavement.temperature import TemperatureProfile
from treadload.pavement.texture import Texture
from treadload.pavement.weather import Weather, read_weather

__all__ = [
    "BONDED",
    "FRICTIONLESS",
    "HALF_BONDED",
    "QUOTED_STIFFNESS",
    "Bond",
    "BondLaw",
    "Frost",
    "FrostYear",
    "HalfBonded",
    "Heat",
    "Layer",
    "LayerRow",
    "Moisture",
    "Parted",
    "Pavement",
    "Relief",
    "RoadJoint",
    "RoadPlate",
    "RoadStep",
    "RoadTemperatures",
    "ShearTest",
    "Structure",
    "TemperatureProfile",
    "TestedBond",
    "Texture",
    "Weather",
    "bells",
    "bituminous_thickness",
    "divided",
    "frost_index",
    "frost_year",
    "is_bituminous",
    "layer_rows",
    "lift_below",
    "methods_of",
    "read_weather",
    "road_in_words",
    "road_temperatures",
]
