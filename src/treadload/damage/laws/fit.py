"""A fatigue line through tests: least squares of log N, scatter, and predictions of specimens left out."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from treadload.damage.laws.fatigue import check_slope
from treadload.errors import InputError
from treadload.kernels.arrays import Array

_FEWEST = 5


@dataclass(frozen=True, eq=False)
class FittedLine:
    """log₁₀ N = intercept + exponent log₁₀ r + Σ c x, fitted to tests.

    at_a_million: reading that allows 10⁶ repetitions where the covariates are 0. slope: b = 1/exponent. intercept;
    exponent, exponent_error: 1/b and its standard error, 0 where b was fixed. covariates: c. scatter: standard
    deviation of log₁₀ N about the line. unseen: (n,), residuals of log₁₀ N, each by the line through all the rest.
    scores: (n,), ln of the probability density of each, by the line and the scatter of all the rest, nats.

    >>> strains, passes = [200e-6, 170e-6, 140e-6, 110e-6, 80e-6], [8e4, 1.6e5, 4.7e5, 1.5e6, 7.5e6]
    >>> lines = [tl.damage.fit_fatigue_line(strains, passes, slope=slope) for slope in (None, -0.25)]
    >>> [f"{line.scatter:.2f}" for line in lines]  # a fixed slope of -0.25 does not fit these tests
    ['0.02', '0.16']
    """

    at_a_million: float
    slope: float
    intercept: float
    exponent: float
    exponent_error: float
    covariates: tuple[float, ...]
    scatter: float
    unseen: Array
    scores: Array

    @property
    def unseen_scatter(self) -> float:
        """Root mean square of the residuals unseen, log₁₀ N."""
        return float(np.sqrt(np.mean(self.unseen**2)))

    def gain(self, reference: FittedLine) -> float:
        """Standard errors by which squared residuals unseen are smaller than those of another line, paired."""
        apart = reference.unseen**2 - self.unseen**2
        return float(apart.mean() / (apart.std(ddof=1) / math.sqrt(len(apart))))

    def score_gain(self, reference: FittedLine) -> tuple[float, float]:
        """Sum of the log scores unseen over that of another line, and the standard error of it by pairs, nats."""
        apart = self.scores - reference.scores
        return float(apart.sum()), float(apart.std(ddof=1) * math.sqrt(len(apart)))

    def __str__(self) -> str:
        return (
            f"slope {self.slope:.3f}, 1/b = {self.exponent:.2f} ± {self.exponent_error:.2f}, "
            f"scatter {self.scatter:.2f} of log10 N, {self.unseen_scatter:.2f} unseen"
        )


def fit_fatigue_line(
    readings: ArrayLike, passes: ArrayLike, *, slope: float | None = None, covariates: ArrayLike | None = None
) -> FittedLine:
    """Fatigue line through tests that ended in failure; run-outs are the caller's to leave out, and to count.

    readings: (n,), strain or stress, > 0. passes: (n,), repetitions to failure, > 0. slope: b, fixed; left out, it is
    fitted. covariates: (n, m), such as voids, that shift log N. Residuals unseen are those of least squares without
    the specimen, r/(1 - h) with h its leverage. log N is the scattering side: the slope of log r over log N is
    flatter. Raises InputError.

    >>> strains, passes = [200e-6, 170e-6, 140e-6, 110e-6, 80e-6], [8e4, 1.6e5, 4.7e5, 1.5e6, 7.5e6]
    >>> line = tl.damage.fit_fatigue_line(strains, passes)
    >>> f"{line.at_a_million * 1e6:.0f} microstrain at a million, slope {line.slope:.2f}"
    '120 microstrain at a million, slope -0.20'
    """
    r, n = np.asarray(readings, dtype=float), np.asarray(passes, dtype=float)
    if r.ndim != 1 or r.shape != n.shape or len(r) < _FEWEST:
        raise InputError(f"a fatigue line needs {_FEWEST} readings with passes at least, got {r.shape} and {n.shape}")
    if not (np.isfinite(r).all() and np.isfinite(n).all() and (r > 0).all() and (n > 0).all()):
        raise InputError("readings and passes must be positive numbers; leave specimens without them out")
    covariate_columns = (
        np.empty((len(r), 0)) if covariates is None else np.asarray(covariates, dtype=float).reshape(len(r), -1)
    )
    log_r, log_n = np.log10(r), np.log10(n)
    columns = [np.ones(len(r)), *([log_r] if slope is None else []), *covariate_columns.T]
    if slope is not None:
        check_slope(slope)
        log_n = log_n - log_r / slope
    design = np.stack(columns, axis=1)
    if len(r) <= design.shape[1] or np.linalg.matrix_rank(design) < design.shape[1]:
        raise InputError(f"{len(r)} tests cannot fix {design.shape[1]} numbers; give tests at different readings")
    inverse = np.linalg.inv(design.T @ design)
    coefficients = inverse @ (design.T @ log_n)
    left = log_n - design @ coefficients
    scatter = math.sqrt(float(left @ left) / (len(r) - design.shape[1]))
    leverage = np.einsum("ij,jk,ik->i", design, inverse, design)
    exponent = float(coefficients[1]) if slope is None else 1 / slope
    error = scatter * math.sqrt(float(inverse[1, 1])) if slope is None else 0.0
    if not exponent < 0:
        raise InputError(f"the tests last longer at larger readings, exponent {exponent:.2g}; check the columns")
    million = 10 ** ((6 - float(coefficients[0])) / exponent)
    covariate_values = tuple(float(c) for c in coefficients[2 if slope is None else 1 :])
    unseen = left / (1 - leverage)
    # The scatter of all the rest: their squares are less by this specimen's own part.
    free = max(len(r) - design.shape[1] - 1, 1)
    spread = np.maximum((left @ left - left * unseen) / free, np.finfo(float).tiny)
    scores = -0.5 * (np.log(2 * math.pi * spread) + unseen**2 / spread)
    return FittedLine(
        million,
        1 / exponent,
        float(coefficients[0]),
        exponent,
        error,
        covariate_values,
        scatter,
        unseen,
        scores,
    )
