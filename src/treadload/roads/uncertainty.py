"""How sure fitted moduli are, drop by drop: error bars, correlation, and what the sensors leave undecided."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.identifiability import UNDECIDED, spread, undecided_in_words
from treadload.kernels.arrays import Array
from treadload.roads.search import Fitted
from treadload.roads.unknowns import DEPTH
from treadload.units import quantity
from treadload.variables import modulus_in_words

Stated = float | str | tuple[float | str, ...]

DEFAULT_ERROR = ("2 %", "0.5 µm")
"""Weights where no error is stated: sensors are accepted at 2 % of a reading, and files round to 1 µm or less. Only
their proportion counts then: the misfit of each basin sets the size."""
SLOPE_ERROR = ("2 %", "10 µm/m")
"""The same of slopes: weights alone, so that sensors near a slope of zero do not rule."""
# A fit that misses its readings by this root mean square of relative differences is flagged: routine evaluations
# accept 2 to 3 %.
LARGEST_MISFIT = 0.03
# Errors that were stated are doubted where a misfit as large comes by chance less often than this.
_CHANCE = 0.01
# Two minima fit alike where their sums of squares differ by less than this many variances, 95 % of one number.
_ALIKE = 3.84


@dataclass(frozen=True)
class SensorError:
    """Standard deviation of a reading: relative and absolute parts, added as squares. stated: by the user.

    absolute: m, or without a unit for slopes.
    """

    relative: float
    absolute: float
    stated: bool
    slopes: bool = False

    @classmethod
    def of(cls, error: Stated | None, *, slopes: bool = False) -> SensorError:
        """error: a part of the reading, 0.02 or "2 %", a length, "2 µm", or both, ("2 %", "2 µm"); None: the default.

        slopes: True where a slope, "10 µm/m", stands in place of a length. Raises InputError.
        """
        parts = {"": 0.0, "m": 0.0}
        usual = 'a slope, "10 µm/m"' if slopes else 'a length, "2 µm"'
        default = SLOPE_ERROR if slopes else DEFAULT_ERROR
        for value in default if error is None else error if isinstance(error, tuple | list) else (error,):
            ends = value.strip() if isinstance(value, str) else ""
            unit = "m" if ends.endswith("m") else ""
            if unit and ends.endswith("/m") != slopes:
                raise InputError(
                    f'error of the sensors must be a part of the reading, "2 %", or {usual}, got {value!r}'
                )
            size = quantity(ends.removesuffix("/m") if unit and slopes else value, unit)
            if not size >= 0 or (not unit and size > 1) or (unit and size > 1e-2):
                raise InputError(
                    "error of the sensors must be a part of the reading up to 1, or a length up to 10 mm, got "
                    f"{value}; "
                    '"2 %", "2 µm" or both are usual'
                )
            parts[unit] = size
        if not any(parts.values()):
            raise InputError('error of the sensors must be above 0, got 0; "2 %", "2 µm" or both are usual')
        return cls(parts[""], parts["m"], error is not None, slopes)

    def at(self, deflection: Array) -> Array:
        """Of deflections, m."""
        return np.hypot(self.relative * np.abs(deflection), self.absolute)

    def __str__(self) -> str:
        unit = "µm/m" if self.slopes else "µm"
        parts = [f"{100 * self.relative:g} %"] * (self.relative > 0)
        parts += [f"{1e6 * self.absolute:g} {unit}"] * (self.absolute > 0)
        return " and ".join(parts)


@dataclass(frozen=True, eq=False)
class Certainty:
    """How sure the unknowns of one drop are.

    deviations: of ln (p,), NaN at a bound and where nothing is decided. correlation: (p, p). scatter: size of the
    errors over what was taken. freedom: readings less unknowns. misfit: root mean square of relative differences.
    undecided: sentences. caveats: why the fit is flagged.
    """

    deviations: Array
    correlation: Array
    scatter: float
    freedom: int
    misfit: float
    undecided: tuple[str, ...]
    caveats: tuple[str, ...]


def certainty(
    names: Sequence[str],
    measured: Array,
    sizes: tuple[Array, Array],
    fits: Fitted,
    row: int,
    error: SensorError,
    widths: Array,
) -> Certainty:
    """Of one drop. measured: (r,), readings. sizes: what misfits are over, and what relative errors are of. fits: of
    which this one stands in a row. widths: of priors (p,), inf for none.

    With a prior the errors count as stated: a prior has a size of its own, that of the misfit does not change it.
    """
    fitted, slopes, at_bound = fits.deflection[row], fits.slopes[row], fits.at_bound[row]
    there = np.isfinite(measured)
    sigma = error.at(sizes[1][there])
    apart = (fitted[there] - measured[there]) / sigma
    misfit = float(np.sqrt(np.mean(((fitted[there] - measured[there]) / sizes[0][there]) ** 2)))
    free = at_bound == 0
    informed = np.isfinite(widths)
    freedom = int(there.sum()) - int((free & ~informed).sum())
    square = float(apart @ apart)
    fixed_size = error.stated or informed.any() or freedom <= 0
    scatter = 1.0 if fixed_size else math.sqrt(square / freedom)
    weighed = np.vstack([slopes[there] / sigma[:, None], np.diag(1 / widths)])
    sure = spread(weighed, free, scatter)
    undecided = undecided_in_words(names, sure.values, sure.directions, scatter)
    lost = ~free & (np.linalg.norm(weighed, axis=0) * UNDECIDED < scatter)
    undecided += [
        f"these data leave {names[k]} undecided: it drifted to its bound" for k in map(int, np.flatnonzero(lost))
    ]
    if fits.gap[row] < _ALIKE * scatter**2:
        undecided += _two_minima(names, fits.x[row], fits.rival[row])
    caveats = []
    if misfit > LARGEST_MISFIT:
        caveats.append(f"misfit above {100 * LARGEST_MISFIT:g} %: {100 * misfit:.2g} %")
    if error.stated and freedom > 0 and scipy.special.chdtrc(freedom, square) < _CHANCE:
        caveats.append(
            f"misfit beyond the stated error of the sensors: {math.sqrt(square / freedom):.2g} times as large"
        )
    return Certainty(sure.deviations, sure.correlation, scatter, freedom, misfit, tuple(undecided), tuple(caveats))


def _two_minima(names: Sequence[str], best: Array, rival: Array) -> list[str]:
    """A sentence where two sets of numbers, on either side of what fits worse, fit alike."""
    differ = [int(k) for k in np.flatnonzero(np.abs(rival - best) > math.log1p(UNDECIDED))]
    if not differ:
        return []
    pairs = ", ".join(
        f"{names[k]} {modulus_in_words(math.exp(best[k]))} or {modulus_in_words(math.exp(rival[k]))}"
        if names[k] != DEPTH
        else f"{names[k]} {math.exp(best[k]):.3g} m or {math.exp(rival[k]):.3g} m"
        for k in differ
    )
    sought = " and ".join(names[k] for k in differ)
    return [f"these data leave {sought} undecided: two sets fit alike, {pairs}"]
