"""Array types shared by the kernels."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
ComplexArray = NDArray[np.complexfloating[Any, Any]]
Numbers = NDArray[np.inexact[Any]]
"""Real or complex, as what it is made of."""
IntArray = NDArray[np.integer[Any]]
BoolArray = NDArray[np.bool_]
