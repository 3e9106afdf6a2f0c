"""Forces of a footprint rib by rib, each rib in three thirds across: what cells do not blur and pins can measure.

The shear of the outermost cells of a rib depends on the cells without limit; that of its thirds does not.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.gridding.overlap import overlaps

THIRDS = ("left", "middle", "right")


@dataclass(frozen=True, eq=False)
class RibForces:
    """Forces on the thirds of ribs: (3, ribs, 3), N: load, then force of the tire on the road along and to the right.

    NaN where no pin stands on a third.
    """

    values: Array

    @property
    def relative(self) -> Array:
        """(2, ribs, 3): shear along and to the right over the mean pressure of the rib."""
        per_third = np.nanmean(self.values[0], axis=1, keepdims=True)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratios: Array = self.values[1:] / np.where(per_third > 0, per_third, np.nan)
        return ratios

    @property
    def outward(self) -> Array:
        """(ribs,): half of the difference of the lateral shear of the right and left third over its pressure."""
        lateral = self.relative[1]
        half: Array = 0.5 * (lateral[:, 2] - lateral[:, 0])
        return half


def rib_faces(pressure: Array, y: Array, dy: float, edges: Sequence[float] | Array) -> Array:
    """(ribs, 2) left and right end, m, of what presses between the edges (ribs + 1,) of ribs.

    pressure: (ny, nx), Pa, on rows y (ny,) with a distance of dy, m. NaN of a rib that does not press.
    """
    force = pressure.sum(axis=1)
    faces = np.full((len(edges) - 1, 2), np.nan)
    for rib, (left, right) in enumerate(pairwise(edges)):
        rows = np.flatnonzero((force > 0) & (y > left) & (y < right))
        if rows.size:
            faces[rib] = y[rows[0]] - 0.5 * dy, y[rows[-1]] + 0.5 * dy
    return faces


def thirds(faces: Array) -> Array:
    """(ribs, 3, 2) left and right end of the thirds of ribs with these faces (ribs, 2), m."""
    cuts = faces[:, :1] + (faces[:, 1:] - faces[:, :1]) * np.arange(4) / 3
    parts: Array = np.stack([cuts[:, :-1], cuts[:, 1:]], axis=-1)
    return parts


def on_cells(stress: Array, y_edges: Array, dx: float, faces: Array) -> RibForces:
    """Forces on the thirds of cells that cover the tread, cut where a third ends.

    stress: (3, ny, nx), Pa: pressure, traction_x, traction_y. y_edges: (ny + 1,), m. dx: m. faces: (ribs, 2), m.
    """
    per_width = stress.sum(axis=2) * dx
    parts = thirds(faces)
    values = np.full((3, len(faces), 3), np.nan)
    for rib in np.flatnonzero(np.isfinite(faces).all(axis=1)):
        share = overlaps(np.append(parts[rib, :, 0], parts[rib, -1, 1]), y_edges)
        values[:, rib] = per_width @ share.T
    return RibForces(values)


def on_pins(stress: Array, there: BoolArray, y: Array, dx: float, faces: Array) -> RibForces:
    """Forces on the thirds from the pins whose middle stands on them: mean force per width of the pins times the
    width.

    stress: (3, ny, nx), Pa, of pins at y (ny,), m, read every dx, m. there: (ny, nx), False where a reading is
    missing, which counts as none. faces: (ribs, 2), m.
    """
    per_width = np.where(there, stress, 0.0).sum(axis=2) * dx
    per_width[:, ~there.any(axis=1)] = np.nan
    parts = thirds(faces)
    values = np.full((3, len(faces), 3), np.nan)
    for rib in range(len(faces)):
        for third in range(3):
            left, right = parts[rib, third]
            here = (y >= left) & (y < right) & np.isfinite(per_width[0])
            if here.any():
                values[:, rib, third] = per_width[:, here].mean(axis=1) * (right - left)
    return RibForces(values)


def on_sensels(stress: Array, across: Array, area: float, faces: Array) -> RibForces:
    """Forces on the thirds of sensels that lie askew: each belongs to the third that its middle lies on.

    stress: (3, ny, nx), Pa. across: (ny, nx), of the middles, m. area: of a sensel, m². faces: (ribs, 2), m.
    """
    values = np.full((3, len(faces), 3), np.nan)
    for rib, parts in enumerate(thirds(faces)):
        for third, (left, right) in enumerate(parts):
            here = (across >= left) & (across < right)
            if here.any():
                values[:, rib, third] = area * stress[:, here].sum(axis=1)
    return RibForces(values)


def largest(stress: Array, there: BoolArray, y: Array, faces: Array) -> Array:
    """(3, ribs) largest pressure and largest size of either shear among the readings on ribs, Pa; NaN without a
    reading.

    They depend on the size of a pin: compare only what the same pins read. Arguments as in `on_pins`.
    """
    values = np.full((3, len(faces)), np.nan)
    for rib, (left, right) in enumerate(faces):
        here = there & ((y >= left) & (y < right))[:, None]
        if here.any():
            values[:, rib] = np.abs(stress[:, here]).max(axis=1)
    return values
