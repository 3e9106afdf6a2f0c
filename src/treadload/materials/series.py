"""Any viscoelastic solid as a Prony series, within a tolerance over a range of frequencies."""

from __future__ import annotations

import math

import numpy as np
import scipy

from treadload.errors import InputError
from treadload.kernels.arrays import Array, ComplexArray
from treadload.materials.kinds import Viscoelastic
from treadload.materials.viscoelastic import Prony

# Terms per decade tried in turn. Evenly spaced times leave 2 exp(-π²/ln(spacing)) of a smooth spectrum: 5e-5 with
# two and a half per decade, 7e-8 with four.
_DENSITIES = (1, 1.5, 2, 2.5, 3, 4, 5, 6, 8)
# Times reach this many decades past the range, and then a few more, one per decade, to stand for all that relaxes
# beyond: a modulus that rises by small powers of frequency does so for very long.
_BEYOND, _FAR = 2, np.array([3.0, 4.0, 5.0])
_POINTS = 12


def as_prony(material: Viscoelastic, lowest: float, highest: float, *, tolerance: float = 1e-4) -> Prony:
    """A Prony series whose complex modulus is that of a material over a range of frequencies.

    lowest, highest: the range, rad/s, 0 < lowest < highest. tolerance: largest |E* - E*ₘ| / |E*ₘ| in the range
    and at the glassy limit; the rubbery limit, where there is one, is exact. The smallest number of evenly spaced
    times that serves is taken; shares are not negative. Outside the range the series is no more than bounded by
    the two limits. A Prony series is returned as it is, and so is that of a material which has one, as `prony`.
    Raises InputError for an empty range, and if the tolerance is not reached.
    Method: non-negative least squares, after Baumgaertel & Winter (1989), Rheol. Acta 28, 511-519.

    >>> mix = tl.materials.HuetSayegh(30e9, 50e6, delta=2.3, k=0.22, h=0.65, tau=0.2, poisson=0.35)
    >>> series = tl.materials.as_prony(mix, 1.0, 100.0, tolerance=1e-3)
    >>> abs(complex(series.complex_modulus(62.8)) / complex(mix.complex_modulus(62.8)) - 1) < 1e-3
    True
    """
    if not 0 < lowest < highest < math.inf:
        raise InputError(f"a range of frequencies needs 0 < lowest < highest, rad/s, got {lowest:g} and {highest:g}")
    prony = material if isinstance(material, Prony) else getattr(material, "prony", None)
    if isinstance(prony, Prony):
        return prony
    try:
        long_term = material.rubbery.modulus
    except InputError:
        long_term = 0.0
    glassy = material.glassy.modulus
    decades = math.log10(highest / lowest)
    omega = np.geomspace(lowest, highest, math.ceil(_POINTS * decades) + 3)
    between = np.sqrt(omega[1:] * omega[:-1])
    modulus, checked = material.complex_modulus(omega), material.complex_modulus(between)
    error = math.inf
    for density in _DENSITIES:
        count = math.ceil(density * (decades + 2 * _BEYOND)) + 1
        inner = np.geomspace(10**-_BEYOND / highest, 10**_BEYOND / lowest, count)
        times = np.concatenate([10 ** -_FAR[::-1] / highest, inner, 10**_FAR / lowest])
        rows, spring, values = frequency_rows(omega, modulus, times)
        # The glassy limit is one equation more.
        strengths = solve_non_negative(
            np.vstack([rows, np.full(times.size, 1 / glassy)]),
            np.append(values - long_term * spring, 1 - long_term / glassy),
        )
        series = prony_of(strengths, times, long_term, material.poisson)
        at_once = abs(series.modulus / glassy - 1)
        error = max(at_once, float(np.abs(series.complex_modulus(between) / checked - 1).max()))
        if error <= tolerance:
            return series
    raise InputError(
        f"no Prony series of {_DENSITIES[-1]} terms per decade follows {material} from {lowest:g} to {highest:g} "
        f"rad/s within {tolerance:g}: {error:.1e} is reached; ask for no less than that"
    )


def frequency_rows(omega: Array, modulus: ComplexArray, times: Array) -> tuple[Array, Array, Array]:
    """The equations of relaxation in frequency, real parts before imaginary ones, all over |E*|.

    omega: (n,), rad/s. modulus: (n,), E*, Pa. times: (m,), s. Returns (2n, m), of a unit strength at each time,
    (2n,), of a unit spring, and (2n,), of the modulus.
    """
    scale = 1 / np.abs(modulus)
    wt = 1j * omega[:, None] * times
    rows, values = scale[:, None] * wt / (1 + wt), scale * modulus
    return (
        np.vstack([rows.real, rows.imag]),
        np.concatenate([scale, np.zeros_like(scale)]),
        np.concatenate([values.real, values.imag]),
    )


def solve_non_negative(matrix: Array, target: Array) -> Array:
    """The x ≥ 0 that minimises |matrix · x - target|. Columns are brought to one length first."""
    length = np.linalg.norm(matrix, axis=0)
    # A term that is over before the data begin gives nothing.
    length[length == 0] = 1.0
    return np.asarray(scipy.optimize.nnls(matrix / length, target, maxiter=50 * matrix.shape[1])[0] / length)


def prony_of(strengths: Array, times: Array, long_term: float, poisson: float) -> Prony:
    """The series of terms of given strengths, Pa, and times, s, beside a long-term modulus, Pa.

    Raises InputError if nothing relaxes.
    """
    modulus = long_term + float(strengths.sum())
    kept = strengths > 0
    if not kept.any():
        raise InputError("nothing relaxes in the range of the data; use Elastic instead")
    shares = strengths[kept] / modulus
    return Prony(modulus, tuple(zip(shares.tolist(), times[kept].tolist(), strict=True)), poisson)
