"""Free rolling by the Magic Formula files: deflection, radii, and the stiffnesses behind relaxation lengths.

Arrays in, arrays out. The names are those of the sections [VERTICAL] and [STRUCTURAL] of a file.

Sources: Besselink, Schmeitz & Pacejka (2010), An improved Magic Formula/Swift tyre model that can handle inflation
pressure changes, Vehicle System Dynamics 48(S1), 337-352, equations 1 to 7 (load, radii) and 17 to 19 (relaxation);
Pacejka (2002), Tyre and Vehicle Dynamics, for the relaxation lengths of version 5.2.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from treadload.kernels.arrays import Array

VERTICAL = ["Q_FZ2", "PFZ1", "Q_V2", "Q_RE0", "Q_V1", "BREFF", "DREFF", "FREFF"]
STRUCTURAL = ["PCFX1", "PCFX2", "PCFX3", "PCFY1", "PCFY2", "PCFY3"]
DEFAULTS: Mapping[str, float] = {**dict.fromkeys([*VERTICAL, *STRUCTURAL], 0.0), "Q_RE0": 1.0, "BREFF": 8.4}
"""Coefficients of this module, with what they are where a file leaves them out."""

# Turns of the wheel speed against the radius that it grows by; each one gains three digits or more.
_ROUNDS = 20


def deflection(
    c: Mapping[str, float],
    share: Array,
    pressure: Array,
    spin: Array,
    *,
    stiffness: float,
    radius: float,
    load: float,
) -> Array:
    """Vertical deflection ρ, m, of a tire that rolls freely: the root of F_z(ρ) (equations 2 to 4).

    share: F_z over the nominal load, > 0. pressure: over the nominal one. spin: ω R_0 over the reference speed.
    stiffness: slope of the load at the nominal one, N/m. radius: R_0, m. load: nominal, N. NaN beyond the largest
    load of a parabola that bends down, and for a slope that the parabola cannot have.
    """
    second = c["Q_FZ2"]
    with np.errstate(invalid="ignore"):
        first = np.sqrt((stiffness * radius / load) ** 2 - 4 * second)
        scaled = share / ((1 + c["Q_V2"] * np.abs(spin)) * (1 + c["PFZ1"] * (pressure - 1)))
        # The root of first x + second x² = scaled, without loss of digits where second is small.
        out: Array = radius * 2 * scaled / (first + np.sqrt(first**2 + 4 * second * scaled))
    return out


def radii(
    c: Mapping[str, float],
    share: Array,
    pressure: Array,
    speed: Array,
    *,
    stiffness: float,
    radius: float,
    load: float,
) -> tuple[Array, Array, Array]:
    """Radius R_Ω of the free spinning tire, effective rolling radius R_e, m, and ω R_0 over the reference speed.

    speed: of rolling, over the reference speed; the other arguments are those of `deflection`. Equations 1 and 7; the
    speed of the wheel is V/R_e, which is found by iteration.
    """
    sink = load / (stiffness * (1 + c["PFZ1"] * (pressure - 1)))
    sink = sink * (c["DREFF"] * np.arctan(c["BREFF"] * share) + c["FREFF"] * share)
    free = radius * c["Q_RE0"] + 0 * sink
    spin = 0 * sink
    for _ in range(_ROUNDS):
        spin = speed * radius / (free - sink)
        grown = radius * (c["Q_RE0"] + c["Q_V1"] * spin**2)
        if np.allclose(grown, free, rtol=1e-14, atol=0):
            break
        free = grown
    return free, free - sink, spin


def carcass_stiffnesses(
    c: Mapping[str, float], df: Array, dp: Array, along: float, across: float
) -> tuple[Array, Array]:
    """Stiffnesses C_x, C_y of a standing tire, N/m (equations 17, 18).

    df, dp: increments of load and pressure over the nominal ones. along, across: at both, N/m.
    """
    x = along * (1 + c["PCFX1"] * df + c["PCFX2"] * df**2) * (1 + c["PCFX3"] * dp)
    y = across * (1 + c["PCFY1"] * df + c["PCFY2"] * df**2) * (1 + c["PCFY3"] * dp)
    return x, y


def older_relaxation(
    c: Mapping[str, float], load: Array, *, nominal_load: float, scale: float, radius: float
) -> tuple[Array, Array]:
    """Relaxation lengths σ_κ, σ_α of an upright tire by PTX and PTY, m: version 5.2.

    c: PTX1 to PTX3, PTY1, PTY2, LSGKP and LSGAL. load, nominal_load: N. scale: LFZO, of the nominal load.
    """
    scaled = nominal_load * scale
    df = load / scaled - 1
    along = (c["PTX1"] + c["PTX2"] * df) * np.exp(-c["PTX3"] * df) * c["LSGKP"] * radius * load / nominal_load
    across = c["PTY1"] * np.sin(2 * np.arctan(load / (c["PTY2"] * scaled))) * radius * scale * c["LSGAL"]
    return along, across
