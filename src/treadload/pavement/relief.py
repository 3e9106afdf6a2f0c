"""The surface of a road that is no plane: bumps, joints, texture."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from treadload.kernels.arrays import Array


@runtime_checkable
class Relief(Protocol):
    """How far a road's surface rises above its plane: a frozen description, taken by `solve_contact(relief=...)`.

    It may also have `finest_wave`, m: the shortest wave in it, which cells that are too coarse are compared with.

    >>> isinstance(tl.pavement.RoadStep(0.01), tl.pavement.Relief)
    True
    """

    def height(self, x: Array, y: Array) -> Array:
        """(ny, nx), m, up positive, at the places x (nx,) along travel and y (ny,) to the right, m; all finite."""
        ...
