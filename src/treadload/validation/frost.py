"""Checks of frost: the depth of a frozen front beside Neumann's closed form."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.kernels.freezing import FreezingCells, freezing, neumann_front
from treadload.pavement import Moisture
from treadload.validation.check import Check, relative

# Below a surface at so many °C, from the ground's so many °C.
_COLD, _GROUNDS = -5.0, (0.0, 4.0)
_CELL, _DEPTH, _STEP, _DAY = 0.01, 8.0, 6 * 3600.0, 86_400.0


def frost_checks() -> Iterator[Check]:
    """Depth of the front in a granular and a fine soil after one and three months of frost."""
    soils = {"granular, 10 % water": Moisture(), "fine, 20 % water": Moisture(0.20, 1700.0, "fine")}
    for name, soil in soils.items():
        thawed, frozen = ((soil.conductivities[k], soil.capacities[k]) for k in (0, 1))
        for ground in _GROUNDS:
            front = neumann_front(frozen, thawed, soil.latent, _COLD, ground)
            ones = np.ones(round(_DEPTH / _CELL))
            cells = FreezingCells(
                _CELL * ones,
                thawed[0] * ones,
                frozen[0] * ones,
                thawed[1] * ones,
                frozen[1] * ones,
                soil.latent * ones,
            )
            count = round(90 * _DAY / _STEP)
            _, shares = freezing(cells, ground * ones, np.full(count + 1, _COLD), _STEP)
            for days in (30, 90):
                depth = _CELL * float(shares[round(days * _DAY / _STEP)].sum())
                quantity = f"{name}, ground at {ground:g} °C: depth after {days} days, m"
                exact = front * math.sqrt(days * _DAY)
                yield relative("frozen front", quantity, depth, exact, 0.01, "Neumann; Carslaw & Jaeger (1959)")
