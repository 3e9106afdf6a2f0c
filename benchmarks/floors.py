"""The floors: one zero-padded convolution of a grid, by pressure and by shear of two components."""

import time

import numpy as np
from timing import best_of

from treadload.contact.bodies.influence import Influence


def normal_product(influence: Influence, clock=time.perf_counter) -> float:
    """Seconds of one product with the normal operator."""
    load = np.random.default_rng(0).random(influence.shape)
    operator = influence.normal
    return best_of(lambda: operator(load), 7, clock)[0]


def rolling_product(influence: Influence, clock=time.perf_counter) -> float:
    """Seconds of one product with the compliance of two components."""
    shear = np.random.default_rng(0).random((2, *influence.shape))
    padding = influence.padding
    xx, yy, xy = influence.tangential(padding)

    def product():
        x, y = padding.forward(shear)
        return padding.inverse(np.stack([xx * x + xy * y, xy * x + yy * y]))

    return best_of(product, 7, clock)[0]
