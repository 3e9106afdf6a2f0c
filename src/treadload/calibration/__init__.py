"""Numbers of a tire from what was measured of it, with their error bars."""

from treadload.calibration.fit import calibrate
from treadload.calibration.solution import Calibration

__all__ = ["Calibration", "calibrate"]
