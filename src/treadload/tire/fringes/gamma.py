"""The projector's gamma: its estimate from the steps, and the phase that it would have left alone."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.tire.fringes.steps import TURN, even_shifts, solve_steps, wrapped

# Gammas of projectors and screens.
RANGE = (0.3, 4.0)
_TABLE, _AVERAGE = 4096, 512


def light(phase: Array, gamma: float, contrast: float = 1.0) -> Array:
    """What a projector gives off for the fringe (1 + contrast·cos φ)/2, of its full light."""
    return np.asarray(((1 + contrast * np.cos(phase)) / 2) ** gamma, dtype=np.float64)


def second_harmonic(gamma: float, contrast: float = 1.0) -> float:
    """Second over first harmonic of the light; (γ - 1)/(γ + 2) at full contrast.

    Source: Guo, He and Chen (2004), Appl. Opt. 43, 2906, for the series of cos^2γ(φ/2).
    """
    phase = TURN * (np.arange(_AVERAGE) + 0.5) / _AVERAGE
    grey = light(phase, gamma, contrast)
    return float((grey * np.cos(2 * phase)).sum() / (grey * np.cos(phase)).sum())


def gamma_of(ratio: float, contrast: float = 1.0) -> float:
    """Gamma whose light has this ratio of the second to the first harmonic, see `harmonics.leftovers`.

    contrast: of the projected fringe, (max - min)/(max + min) of the values sent to the projector. Light of the room
    does not matter, a camera that is not linear does. Raises InputError where no gamma has it.
    """
    low, high = RANGE
    if math.isnan(ratio):
        raise InputError(
            "gamma cannot be determined from three steps, or where no bright pixel kept all of its steps: give it as "
            "a number, or take four steps or more"
        )
    if not second_harmonic(low, contrast) < ratio < second_harmonic(high, contrast):
        raise InputError(
            f"the second harmonic of the fringes is {ratio:.3f} of the first, which no gamma between {low} and "
            f"{high} makes; look for unequal steps, or give gamma as a number"
        )
    return float(scipy.optimize.brentq(lambda gamma: second_harmonic(gamma, contrast) - ratio, low, high, xtol=1e-6))


def phase_error(shifts: Sequence[float] | None, count: int, gamma: float, contrast: float = 1.0) -> Array:
    """Error (4096,), rad, that gamma leaves in the phase of these steps, over true phases from 0 to 2π."""
    low, high = RANGE
    if not (math.isfinite(gamma) and low <= gamma <= high):
        raise InputError(f"gamma must lie between {low} and {high}, got {gamma:g}")
    if not 0 < contrast <= 1:
        raise InputError(f"contrast must lie above 0 and up to 1, got {contrast:g}; 1 is black to full light")
    delta = even_shifts(count) if shifts is None else np.asarray(shifts, dtype=float)
    true = TURN * np.arange(_TABLE) / _TABLE
    steps = solve_steps(light(true[None, None, :] + delta[:, None, None], gamma, contrast), list(delta))
    return wrapped(steps.phase[0] - true)


def without_gamma(
    phase: Array, shifts: Sequence[float] | None, count: int, gamma: float, contrast: float = 1.0
) -> Array:
    """The wrapped phase less what gamma adds to it in these steps.

    phase: rad, of `solve_steps`. A pixel that lost a step to saturation is corrected as if it had not, which leaves
    it a part of the error. Returns rad in (-π, π]. Raises InputError for a gamma that no projector has.
    """
    error = phase_error(shifts, count, gamma, contrast)
    seen = TURN * np.arange(_TABLE) / _TABLE + error
    if not (np.diff(seen) > 0).all():
        raise InputError(f"a gamma of {gamma:g} folds the phase of {count} steps; take more steps")
    return wrapped(phase - np.interp(phase % TURN, seen, error, period=TURN))
