"""Depths and the interfaces that they fall on: equal within round-off, read on one side or the other."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from treadload.kernels.arrays import Array, BoolArray

# Depths this near to each other, m, count as one. Sums of thicknesses and millimetres turned to metres differ by
# 1e-16 of a depth, a file keeps nine decimals; stress changes by less than 1e-6 of itself over a thousand times as
# much.
SAME_DEPTH = 1e-9


def same_depth(a: ArrayLike, b: ArrayLike) -> BoolArray:
    """Whether depths, m, are the same within round-off."""
    same: BoolArray = np.asarray(np.abs(np.subtract(a, b)) <= SAME_DEPTH)
    return same


def on_interface(depths: ArrayLike, interfaces: ArrayLike) -> BoolArray:
    """Whether each of depths (n,) falls on one of the interfaces, m: (n,)."""
    same = same_depth(np.atleast_1d(depths)[:, None], np.atleast_1d(interfaces)[None])
    return np.asarray(same.any(axis=1))


def snapped(depths: Sequence[float] | Array, interfaces: Array) -> Array:
    """Depths (n,), m, those on an interface as exactly its own number; the nearest one's where two are so near."""
    wanted = np.asarray(depths, dtype=float)
    if not len(interfaces) or not len(wanted):
        return wanted
    nearest = interfaces[np.abs(wanted[:, None] - interfaces[None]).argmin(axis=1)]
    return np.where(same_depth(wanted, nearest) & (wanted > 0), nearest, wanted)


def layers_at(depths: Sequence[float] | Array, interfaces: Array, below: bool | Sequence[bool] | Array) -> Array:
    """Numbers (n,) of the layers, from the surface, that hold depths (n,), m.

    interfaces: depths of the bottoms of all layers but the last, rising, m. below: whether a depth on an interface
    belongs to the layer below it, for all or each.
    """
    exact = snapped(depths, interfaces)
    sides = [np.searchsorted(interfaces, exact, side="left"), np.searchsorted(interfaces, exact, side="right")]
    return np.where(exact > 0, np.where(below, sides[1], sides[0]), 0)
