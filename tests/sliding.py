"""Shear of gross sliding: the limit of rolling and turning when the rigid slip outgrows what bodies give way."""

import numpy as np


def sliding_shear(bound, rigid, axes=(1.0, 1.0)):
    """q = -μp D² w/|D w| (2, ny, nx) on body 1, Pa, D = diag(axes): it takes the most work that friction allows.

    bound: μp (ny, nx), Pa. rigid: direction of the slip w (2, ny, nx), of any size; no shear where it vanishes.
    """
    axes = np.reshape(axes, (2, 1, 1))
    size = np.hypot(*(axes * rigid))
    return -(axes**2) * rigid * np.divide(bound, size, out=np.zeros_like(bound), where=size > 0)
