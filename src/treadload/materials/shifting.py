"""Master curves: isotherms brought to one temperature by shifting them along the axis of log time."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from treadload.describing import as_call
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.materials.measured import FrequencySweep, Measured, RelaxationTest
from treadload.materials.temperature import TabulatedShift

# Points to a segment between data when the area between curves is taken.
_FINE = 16


@dataclass(frozen=True, eq=False)
class MasterCurve:
    """Isotherms at one temperature.

    data: all points at the reference temperature. temperatures: (n,), °C, coldest first. log_factors: (n,), log₁₀ aT,
    0 at the reference. reference: °C. isotherms: as measured, coldest first. mismatch: rms of ln |E*| of neighbours
    where they overlap once shifted: near the relative scatter of the data if one shift serves.

    >>> cold = tl.materials.RelaxationTest([1.0, 10.0, 100.0], [8e9, 4e9, 2e9], temperature=10.0)
    >>> warm = tl.materials.RelaxationTest([1.0, 10.0, 100.0], [4e9, 2e9, 1e9], temperature=20.0)
    >>> curve = tl.materials.master_curve([cold, warm], reference=10.0)
    >>> round(float(curve.data.time.max()))  # s: the warm test stands for times ten times as long
    1000
    """

    data: Measured
    temperatures: tuple[float, ...]
    log_factors: tuple[float, ...]
    reference: float
    isotherms: tuple[Measured, ...]
    mismatch: float

    @property
    def shift(self) -> TabulatedShift:
        """The shift factors as a law. Raises InputError if they do not fall with rising temperature."""
        return TabulatedShift(self.temperatures, self.log_factors, self.reference)

    def __str__(self) -> str:
        return (
            f"master curve at {self.reference:g} °C of {len(self.isotherms)} isotherms, {self.temperatures[0]:g} to "
            f"{self.temperatures[-1]:g} °C; {self.data}; neighbours agree to {self.mismatch:.1%}"
        )

    __repr__ = as_call


def master_curve(isotherms: Sequence[Measured], reference: float) -> MasterCurve:
    """Isotherms shifted to a reference temperature, each to fit its neighbour where their moduli overlap.

    isotherms: all FrequencySweep or all RelaxationTest, each with its temperature, at least two that differ.
    reference: °C, within the temperatures; between them log aT is interpolated.
    Only |E*| or E(t) is used, and no model of the material or of the shift: fit one to the result, with
    `fit_prony(curve.data, ...)` and `WLF.fit(curve.temperatures, curve.log_factors, curve.reference)`.
    Returns a MasterCurve. Raises InputError if neighbours do not overlap.
    Method: Gergesova et al. (2011), Rheol. Acta 50, 1-16; ISO 18437-6 (closed-form shifting: the shift is the area
    between two curves over the height they share).

    >>> cold = tl.materials.RelaxationTest([1.0, 10.0, 100.0], [8e9, 4e9, 2e9], temperature=10.0)
    >>> warm = tl.materials.RelaxationTest([1.0, 10.0, 100.0], [4e9, 2e9, 1e9], temperature=20.0)
    >>> [round(shift, 3) for shift in tl.materials.master_curve([cold, warm], reference=10.0).log_factors]
    [0.0, -1.0]
    """
    ordered = _checked(isotherms)
    temperatures = np.array([float(data.temperature or 0.0) for data in ordered])
    if not temperatures[0] <= reference <= temperatures[-1]:
        raise InputError(
            f"reference must lie within the temperatures measured, {temperatures[0]:g} to {temperatures[-1]:g} °C, "
            f"got {reference:g} °C"
        )
    curves = [_curve(data) for data in ordered]
    steps, squares = [], []
    for (cold, warm), (low, high) in zip(itertools.pairwise(curves), itertools.pairwise(temperatures), strict=True):
        step, mismatch = _step(cold, warm, f"{low:.4g} and {high:.4g} °C")
        steps.append(step)
        squares.append(mismatch**2)
    # A warm curve lies at faster reduced rates the less its factor: log aT falls by each step.
    logs = np.concatenate([[0.0], np.cumsum(steps)])
    logs -= scipy.interpolate.PchipInterpolator(temperatures, logs)(reference)
    shifted = [data.shifted(10**log, reference) for data, log in zip(ordered, logs, strict=True)]
    return MasterCurve(
        _together(shifted, reference),
        tuple(temperatures.tolist()),
        tuple(logs.tolist()),
        reference,
        ordered,
        float(np.sqrt(np.mean(squares))),
    )


def _checked(isotherms: Sequence[Measured]) -> tuple[Measured, ...]:
    if len(isotherms) < 2 or len({type(data) for data in isotherms}) != 1:
        raise InputError(
            f"a master curve needs two or more isotherms, all FrequencySweep or all RelaxationTest, got "
            f"{len(isotherms)} of {', '.join(sorted({type(data).__name__ for data in isotherms})) or 'none'}"
        )
    if any(data.temperature is None for data in isotherms):
        raise InputError("every isotherm needs its temperature, °C; give it as `temperature`")
    ordered = tuple(sorted(isotherms, key=lambda data: data.temperature or 0.0))
    for before, after in itertools.pairwise(ordered):
        if before.temperature == after.temperature:
            raise InputError(f"two isotherms are at {after.temperature:g} °C; put their points together in one")
    return ordered


def _curve(data: Measured) -> Array:
    """(2, n): log₁₀ of rate, ω or 1/t, rising, and ln of the modulus, refined by a monotone cubic."""
    if isinstance(data, FrequencySweep):
        rate, height = np.log10(data.omega), np.log(np.abs(data.modulus))
    else:
        rate, height = -np.log10(data.time[::-1]), np.log(data.modulus[::-1])
    rate, first = np.unique(rate, return_index=True)
    fine = np.interp(np.arange((rate.size - 1) * _FINE + 1) / _FINE, np.arange(rate.size), rate)
    return np.array([fine, scipy.interpolate.PchipInterpolator(rate, height[first])(fine)])


def _step(cold: Array, warm: Array, between: str) -> tuple[float, float]:
    """Change of log aT from a colder to a warmer curve, and their rms mismatch in ln of the modulus afterwards.

    The cold curve is higher at equal rate. Brought to its temperature the warm one lies at the rate ω · 10^step.
    """
    # Noise may reverse a flat curve: its ends count, and the way between them.
    low = max(cold[1, 0], warm[1, 0])
    high = min(cold[1, -1], warm[1, -1])
    if not high > low:
        raise InputError(
            f"the isotherms at {between} share no modulus, so the shift between them is undetermined; measure at "
            "a temperature between, or over more decades"
        )
    step = (_area(cold, low, high) - _area(warm, low, high)) / (high - low)
    left, right = max(cold[0, 0], warm[0, 0] + step), min(cold[0, -1], warm[0, -1] + step)
    if not right > left:
        return step, 0.0
    common = np.linspace(left, right, 40)
    gap = np.interp(common, *cold) - np.interp(common - step, *warm)
    return step, float(np.sqrt(np.mean(gap**2)))


def _area(curve: Array, low: float, high: float) -> float:
    """∫ rate d(height) along a curve between two heights."""
    rate, height = curve
    cut = np.clip(height, low, high)
    # Where a piece crosses a bound its clipped part has its middle elsewhere.
    slope = np.diff(height)
    share = np.divide(0.5 * (cut[1:] + cut[:-1]) - height[:-1], slope, out=np.full_like(slope, 0.5), where=slope != 0)
    return float(((rate[:-1] + share * np.diff(rate)) * np.diff(cut)).sum())


def _together(parts: Sequence[Measured], reference: float) -> Measured:
    sweeps = [part for part in parts if isinstance(part, FrequencySweep)]
    if sweeps:
        return FrequencySweep(
            np.concatenate([s.omega for s in sweeps]),
            np.concatenate([s.storage for s in sweeps]),
            np.concatenate([s.loss for s in sweeps]),
            reference,
        )
    tests = [part for part in parts if isinstance(part, RelaxationTest)]
    return RelaxationTest(
        np.concatenate([t.time for t in tests]), np.concatenate([t.modulus for t in tests]), reference
    )
