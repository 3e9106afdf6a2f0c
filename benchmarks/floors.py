"""The floors: one zero-padded convolution of a grid, by pressure and by shear of two components."""

import numpy as np
from timing import best_of

from treadload.contact.influence import Influence


def normal_product(influence: Influence) -> float:
    """Seconds of one product with the normal operator."""
    load = np.random.default_rng(0).random(influence.shape)
    operator = influence.normal
    return best_of(lambda: operator(load), repeats=7)[0]


def rolling_product(influence: Influence) -> float:
    """Seconds of one product with the slip operator of two components."""
    shear = np.random.default_rng(0).random((2, *influence.shape))
    padding, s = influence.padding, influence.rolling

    def product():
        q = padding.forward(shear)
        return padding.inverse(np.stack([s[0, 0] * q[0] + s[0, 1] * q[1], s[1, 0] * q[0] + s[1, 1] * q[1]]))

    return best_of(product, repeats=7)[0]
