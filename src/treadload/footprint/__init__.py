"""Measured footprints: readers, what they measure, and how a computed contact compares with them."""

from treadload.footprint.comparison import FootprintComparison, compare
from treadload.footprint.footprint import Footprint
from treadload.footprint.frames import Frames
from treadload.footprint.measures import Measures
from treadload.footprint.reading import is_sensor_file, read_footprint
from treadload.footprint.registration import Registration, register

__all__ = [
    "Footprint",
    "FootprintComparison",
    "Frames",
    "Measures",
    "Registration",
    "compare",
    "is_sensor_file",
    "read_footprint",
    "register",
]
