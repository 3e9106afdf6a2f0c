"""Maximum likelihood of a table: parameters, their standard errors, profiles and intervals."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from treadload.errors import ConvergenceError
from treadload.kernels.arrays import Array
from treadload.life.field.likelihood import Kind, Parameters, Sections, log_likelihood

# Half of the 95 % quantile of χ² with one degree of freedom.
DROP = 1.92
# Parameters as they are searched for: ln of the level, the scatter and the lag, and the power.
NAMES = ("level", "scatter", "lag", "power")
# Where ln of the level (years), of the scatter and of the lag (years) and the power are searched: beyond, a table
# tells nothing.
_BOUNDS = {
    "level": (math.log(0.05), math.log(2000.0)),
    "scatter": (math.log(0.05), math.log(10.0)),
    "lag": (math.log(0.02), math.log(500.0)),
    "power": (-5.0, 5.0),
}
# Of the second differences that give standard errors, in ln and in the power.
_STEP = 2e-3
_START = {"level": math.log(6.0), "scatter": math.log(0.8), "lag": math.log(4.0), "power": 0.0}


@dataclass(frozen=True)
class Model:
    """Which parameters are fitted by which likelihood.

    kind: of likelihood. with_power: True where the power of the mechanics is fitted; else it is `power`. power: where
    it is not fitted, 0 for ages alone, 1 for mechanics times a factor.
    """

    kind: Kind = "overlay-lag"
    with_power: bool = False
    power: float = 0.0

    @property
    def names(self) -> tuple[str, ...]:
        """Parameters that are fitted."""
        lag = ("lag",) if self.kind == "overlay-lag" else ()
        return ("level", "scatter", *lag, *(("power",) if self.with_power else ()))

    def parameters(self, values: Mapping[str, float]) -> Parameters:
        """Of the values that are searched for."""
        lag = math.exp(values["lag"]) if "lag" in values else math.inf
        power = values.get("power", self.power)
        return Parameters(math.exp(values["level"]), math.exp(values["scatter"]), lag, power)


@dataclass(frozen=True, eq=False)
class Fit:
    """The parameters of a model that make a table most likely.

    values: ln of level, scatter and lag, and the power, by name. log_likelihood: at the maximum, nats.
    """

    model: Model
    sections: Sections
    values: Mapping[str, float]
    log_likelihood: float

    @property
    def parameters(self) -> Parameters:
        """Level, scatter, lag and power."""
        return self.model.parameters(self.values)

    @cached_property
    def covariance(self) -> Array:
        """Covariance of the values by the curvature of the log likelihood; NaN where it has no maximum."""
        names = self.model.names
        at = np.array([self.values[name] for name in names])
        steps = _STEP * np.eye(len(names))
        hessian = np.empty((len(names), len(names)))
        for i, first in enumerate(steps):
            for j, second in enumerate(steps):
                along = self._total(at + first + second) + self._total(at - first - second)
                across = self._total(at + first - second) + self._total(at - first + second)
                hessian[i, j] = (across - along) / (4 * _STEP**2)
        try:
            inverse = np.linalg.inv(hessian)
        except np.linalg.LinAlgError:
            return np.full_like(hessian, math.nan)
        return np.asarray(inverse if np.all(np.diag(inverse) > 0) else np.full_like(hessian, math.nan))

    @property
    def errors(self) -> dict[str, float]:
        """Standard errors of the values."""
        return dict(zip(self.model.names, map(float, np.sqrt(np.diag(self.covariance))), strict=True))

    def _total(self, at: Array) -> float:
        values = dict(zip(self.model.names, at, strict=True))
        return float(log_likelihood(self.sections, self.model.parameters(values), self.model.kind).sum())

    def profile(self, name: str, value: float) -> float:
        """Log likelihood with a parameter held at a value and the others fitted, less the maximum, nats.

        name: "level", "scatter" and "lag" as ln, or "power".
        """
        return _maximum(self.sections, self.model, {name: value}, self.values)[1] - self.log_likelihood

    def interval(self, name: str) -> tuple[float, float]:
        """95 % interval of a value by its profile; an end at the bounds of the search is -inf or inf."""
        best, error = self.values[name], self.errors[name]
        step = error if math.isfinite(error) and error > 0 else 0.3
        ends = []
        for sign, bound in zip((-1.0, 1.0), _BOUNDS[name], strict=True):
            inside, outside = best, best + 2 * sign * step
            while sign * (bound - outside) > 0 and self.profile(name, outside) > -DROP:
                inside, outside = outside, outside + sign * step
            if sign * (bound - outside) <= 0:
                ends.append(sign * math.inf)
                continue
            root = scipy.optimize.brentq(lambda value: self.profile(name, value) + DROP, inside, outside, xtol=1e-3)
            ends.append(float(root))
        return ends[0], ends[1]


def fit(sections: Sections, model: Model) -> Fit:
    """The parameters that make what the sections show most likely. Raises ConvergenceError."""
    values, best = _maximum(sections, model, {}, _START)
    return Fit(model, sections, values, best)


def _maximum(
    sections: Sections, model: Model, fixed: Mapping[str, float], start: Mapping[str, float]
) -> tuple[dict[str, float], float]:
    """Values of all parameters of a model at the maximum, some of them fixed, and the log likelihood there."""
    free = [name for name in model.names if name not in fixed]

    def loss(at: Array) -> float:
        values = {**fixed, **dict(zip(free, at, strict=True))}
        return -float(log_likelihood(sections, model.parameters(values), model.kind).sum())

    first = np.array([start.get(name, _START[name]) for name in free])
    optimum = scipy.optimize.minimize(loss, first, method="L-BFGS-B", bounds=[_BOUNDS[name] for name in free])
    if not np.isfinite(optimum.fun):
        raise ConvergenceError(f"the likelihood of {len(sections)} sections has no maximum: {optimum.message}")
    return {**fixed, **dict(zip(free, map(float, optimum.x), strict=True))}, -float(optimum.fun)
