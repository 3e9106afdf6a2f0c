"""What matters among many inputs of a case: tornado, Morris screening, Sobol indices."""

from treadload.study.screening.morris import Morris, morris
from treadload.study.screening.sobol import Sobol, sobol
from treadload.study.screening.tornado import Tornado, tornado

__all__ = ["Morris", "Sobol", "Tornado", "morris", "sobol", "tornado"]
