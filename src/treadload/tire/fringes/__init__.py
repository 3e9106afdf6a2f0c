"""Treads measured with fringes of light: phase shifting, unwrapping, heights, and how far to trust them."""

from treadload.tire.fringes.calibration import CameraProjector, ReferencePlane
from treadload.tire.fringes.file import read_fringes
from treadload.tire.fringes.measure import FringeScan, measure_fringes
from treadload.tire.fringes.patterns import Evaluation, Pattern
from treadload.tire.fringes.quality import FringeQuality
from treadload.tire.fringes.render import Rig, look, pictures_of, planned_deviation

__all__ = [
    "CameraProjector",
    "Evaluation",
    "FringeQuality",
    "FringeScan",
    "Pattern",
    "ReferencePlane",
    "Rig",
    "look",
    "measure_fringes",
    "pictures_of",
    "planned_deviation",
    "read_fringes",
]
