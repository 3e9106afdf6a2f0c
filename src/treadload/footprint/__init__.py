"""Measured footprints: readers, measures, a computed contact beside them; other data of a tire."""

from treadload.footprint.comparison import FootprintComparison, compare
from treadload.footprint.footprint import Footprint
from treadload.footprint.frames import Frames
from treadload.footprint.interpolation import FootprintSet
from treadload.footprint.measured import Measured, Unknown
from treadload.footprint.measures import Measures
from treadload.footprint.pin_sampling import sample_pins, write_pins
from treadload.footprint.reading import is_pin_table, is_sensor_file, read_footprint
from treadload.footprint.registration import Registration, register
from treadload.footprint.tir_fit import FittedFormula, magic_formula
from treadload.footprint.tire_card import TireCard, tire_card

__all__ = [
    "FittedFormula",
    "Footprint",
    "FootprintComparison",
    "FootprintSet",
    "Frames",
    "Measured",
    "Measures",
    "Registration",
    "TireCard",
    "Unknown",
    "compare",
    "is_pin_table",
    "is_sensor_file",
    "magic_formula",
    "read_footprint",
    "register",
    "sample_pins",
    "tire_card",
    "write_pins",
]
