"""What matters among many inputs of a case: tornado, Morris screening, Sobol indices."""

from treadload.sweeps.screening.morris import Morris, morris
from treadload.sweeps.screening.sobol import Sobol, sobol
from treadload.sweeps.screening.tornado import Tornado, tornado

__all__ = ["Morris", "Sobol", "Tornado", "morris", "sobol", "tornado"]
