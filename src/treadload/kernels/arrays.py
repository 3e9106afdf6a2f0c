"""Array types shared by the kernels."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]
ComplexArray = NDArray[np.complexfloating[Any, Any]]
Numbers = NDArray[np.inexact[Any]]
"""Real or complex, as what it is made of."""
Reals = Array | float
"""A number for each of some points, or the number that stands for all of them."""
Values = Numbers | complex
"""As `Reals`, real or complex."""
IntArray = NDArray[np.integer[Any]]
BoolArray = NDArray[np.bool_]
