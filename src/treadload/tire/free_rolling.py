"""A freely rolling tire by the coefficients of its .tir file: deflection, radii, relaxation lengths."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.free_rolling import DEFAULTS, carcass_stiffnesses, deflection, older_relaxation, radii
from treadload.kernels.magic_formula import Formula

_OLDER = ("PTX1", "PTX2", "PTX3", "PTY1", "PTY2")


@dataclass(frozen=True)
class FreeRolling:
    """State of an upright, freely rolling tire, arrays of one shape.

    deflection: vertical, m. loaded_radius: from the axle to the road, m. effective_rolling_radius: V/ω, m.
    relaxation_length_x, relaxation_length_y: of slip along travel and of the slip angle, m; None where the file has
    no coefficients of them.

    >>> state = tl.tire.FreeRolling(deflection=0.030, loaded_radius=0.470, effective_rolling_radius=0.490)
    >>> f"{25.0 / state.effective_rolling_radius:.0f} rad/s at 25 m/s"
    '51 rad/s at 25 m/s'
    """

    deflection: Array
    loaded_radius: Array
    effective_rolling_radius: Array
    relaxation_length_x: Array | None = None
    relaxation_length_y: Array | None = None


def free_rolling(numbers: Mapping[str, float], formula: Formula, name: str) -> FreeRolling:
    """State of free rolling. numbers: of the file by key, SI. name: of the tire, for errors. Raises InputError."""
    c = {**DEFAULTS, **numbers}
    stiffness = numbers.get("VERTICAL_STIFFNESS", 0.0)
    if not stiffness > 0:
        raise InputError(f"{name} has no VERTICAL_STIFFNESS above 0, from which radii follow; write it, in N/m")
    load, nominal, radius = formula.wheel.load, formula.nominal_load, formula.radius
    share, pressure = load / nominal, formula.wheel.pressure
    size = {"stiffness": stiffness, "radius": radius, "load": nominal}
    free, effective, spin = radii(c, share, pressure, formula.wheel.speed, **size)
    depth = deflection(c, share, pressure, spin, **size)
    if not np.isfinite(depth).all():
        first = (stiffness * radius / nominal) ** 2 - 4 * c["Q_FZ2"]
        largest = nominal * max(first, 0.0) / (4 * abs(c["Q_FZ2"]))
        what = (
            f"cannot carry {float(load[~np.isfinite(depth)].max()):g} N: its parabola of the load ends near "
            f"{largest:.3g} N; give a smaller load"
            if first >= 0
            else f"has no deflection: Q_FZ2 must be {(stiffness * radius / nominal) ** 2 / 4:.3g} at most"
        )
        raise InputError(f"{name} {what} (VERTICAL_STIFFNESS = {stiffness:g} N/m, Q_FZ2 = {c['Q_FZ2']:g})")
    along, across = _relaxation(c, numbers, formula)
    return FreeRolling(depth, free - depth, effective, along, across)


def _relaxation(
    c: Mapping[str, float], numbers: Mapping[str, float], formula: Formula
) -> tuple[Array | None, Array | None]:
    """Relaxation lengths, m: slip stiffnesses over those of the carcass in 6.1, PTX and PTY in 5.2."""
    if not formula.is_newer:
        if not all(numbers.get(key) for key in ("PTX1", "PTY1", "PTY2")):
            return None, None
        terms = {**dict.fromkeys(_OLDER, 0.0), "LSGKP": 1.0, "LSGAL": 1.0, **numbers}
        scale = formula.c["LFZO"]
        return older_relaxation(
            terms, formula.wheel.load, nominal_load=formula.nominal_load, scale=scale, radius=formula.radius
        )
    stiffness = [numbers.get(f"{name}_STIFFNESS", 0.0) for name in ("LONGITUDINAL", "LATERAL")]
    x, y = carcass_stiffnesses(c, formula.df, formula.dp, *stiffness)
    return (
        np.abs(formula.along.slope / x) if stiffness[0] > 0 else None,
        np.abs(formula.across.slope / y) if stiffness[1] > 0 else None,
    )
