"""Numbers of a tire from what was measured of it, with their error bars."""

from treadload.study.calibration.fit import calibrate
from treadload.study.calibration.solution import Calibration

__all__ = ["Calibration", "calibrate"]
