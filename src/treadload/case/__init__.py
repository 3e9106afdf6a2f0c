"""A case and its tables."""

from treadload.case.calibration import CalibrationCase
from treadload.case.life import LifeCase
from treadload.case.model import Case

__all__ = ["CalibrationCase", "Case", "LifeCase"]
