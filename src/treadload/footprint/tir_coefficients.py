"""Coefficients of the Magic Formula from curves over slip: bounded least squares, and which of them are undecided."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from treadload.footprint.slip_curves import SlipCurve
from treadload.kernels.arrays import Array
from treadload.kernels.magic_formula import DEFAULTS, ROLLING, Wheel, evaluate, words

Bounds = Mapping[str, tuple[float, float, float]]

# Start, lowest and highest value of each coefficient, by the curves that decide it. Without bounds fits of solved
# curves end at C or E that mean nothing; these hold whatever a pneumatic tire on a dry or wet road can have.
ALONG: Bounds = {
    "PCX1": (1.2, 1, 2), "PDX1": (0.7, 0.05, 3), "PDX2": (0, -1, 1), "PEX1": (-2, -20, 1), "PEX2": (0, -20, 1),
    "PEX3": (0, -20, 20), "PEX4": (0, -10, 10), "PKX1": (12, 1, 200), "PKX2": (0, -50, 50), "PKX3": (0, -3, 3),
    "PHX1": (0, -0.02, 0.02), "PHX2": (0, -0.02, 0.02), "PVX1": (0, -0.05, 0.05), "PVX2": (0, -0.05, 0.05),
}  # fmt: skip
ACROSS: Bounds = {
    "PCY1": (1.5, 1, 2), "PDY1": (0.7, 0.05, 3), "PDY2": (0, -1, 1), "PEY1": (0.5, -20, 1), "PEY2": (0, -20, 1),
    "PKY1": (-12, -200, -0.5), "PKY2": (1.5, 0.1, 20),
}  # fmt: skip
MOMENT: Bounds = {
    "QBZ1": (8, 0.5, 60), "QBZ2": (0, -50, 50), "QBZ3": (0, -50, 50), "QCZ1": (1.2, 0.5, 3), "QDZ1": (0.05, 0, 1),
    "QDZ2": (0, -1, 1), "QEZ1": (0, -20, 1), "QEZ2": (0, -20, 20), "QEZ3": (0, -20, 20),
}  # fmt: skip
COMBINED: Bounds = {
    "RBX1": (8, 0.5, 60), "RBX2": (5, -60, 60), "RCX1": (1, 0.5, 2), "REX1": (-0.5, -20, 1), "REX2": (0, -20, 20),
    "RBY1": (8, 0.5, 60), "RBY2": (5, -60, 60), "RCY1": (1, 0.5, 2), "REY1": (-0.5, -20, 1), "REY2": (0, -20, 20),
}  # fmt: skip
FIXED = {"PKY4": 2.0}
"""Over loads on the rising side PKY4 and PKY2 trade off: any PKY4 of 0.5 to 2 fits as well with another PKY2."""
ALONG_PRESSURE: Bounds = {"PPX1": (0, -3, 3), "PPX2": (0, -3, 3), "PPX3": (0, -1, 1), "PPX4": (0, -1, 1)}
ACROSS_PRESSURE: Bounds = {"PPY1": (0, -3, 3), "PPY2": (0, -1.2, 1.2), "PPY3": (0, -1, 1), "PPY4": (0, -1, 1)}
MOMENT_PRESSURE: Bounds = {"PPZ1": (0, -3, 3)}
QUADRATIC_IN_PRESSURE = ("PPX2", "PPX4", "PPY4")
"""Coefficients that take two pressures beside the nominal one."""
CAMBER = tuple(
    words(
        "PDX3 RBX3 PDY3 PEY4 PEY5 PKY3 PKY5 PKY6 PKY7 PVY3 PVY4 PPY5 RBY4 RVY3 QBZ4 QBZ5 QDZ3 QDZ4 QDZ8 QDZ9 QDZ10 "
        "QDZ11 QEZ5 QHZ3 QHZ4 PPZ2 SSZ3 SSZ4"
    )
)
ONE_SIDED = tuple(words("RHX1 PEY3 PHY1 PHY2 PVY1 PVY2 RBY3 RHY1 RHY2 QBZ9 QBZ10 QDZ6 QDZ7 QEZ4 QHZ1 QHZ2 SSZ1"))
INDUCED = ("RVY1", "RVY2", "RVY4", "RVY5", "RVY6", "SSZ2")
PRESSED = (*ALONG_PRESSURE, *ACROSS_PRESSURE, *MOMENT_PRESSURE, "PFZ1", "PCFX3", "PCFY3")
SPEEDS = ("QSY2", "QSY3", "QSY4", "QSY5", "QSY6")
RESISTANCE = tuple(ROLLING)
"""Coefficients that nothing is solved for: camber, sides that differ, forces of one slip by the second, pressure."""

_STARTS = {name: start for part in (ALONG, ACROSS, MOMENT, COMBINED) for name, (start, *_) in part.items()}
# Coefficients that shape a curve have no default without which it would still be one.
_SHAPES = frozenset(
    ["PCX1", "PDX1", "PKX1", "PCY1", "PDY1", "PKY1", "PKY2", "QBZ1", "QCZ1", "QDZ1", "RBX1", "RCX1", "RBY1", "RCY1"]
)
# Rise of the rms over the load below which the curves do not decide a coefficient, and the share of the width between
# bounds within which it has ended at one of them.
_NOTICED, _AT_BOUND = 2e-5, 1e-4
# Rise beyond that, by slopes, which no second fit takes back.
_HOPELESS = 5e-4
# Directions of coefficients that change nothing, over the one that changes most.
_NOTHING = 1e-9


@dataclass(frozen=True)
class _Best:
    """A fit: values by name, slopes (n, coefficients) of what is left at them, its rms, and values at a bound."""

    values: Mapping[str, float]
    slopes: Array
    rms: float
    at_bounds: frozenset[str] = frozenset()

    def rises(self) -> Mapping[str, float]:
        """Rms with each coefficient at its default and the others fitted again, by the slopes here."""
        size = np.linalg.norm(self.slopes, axis=0)
        size[size == 0] = 1.0
        _, singular, right = np.linalg.svd(self.slopes / size, full_matrices=False)
        with np.errstate(divide="ignore"):
            weight = np.where(singular > _NOTHING * singular[0], 1 / np.maximum(singular, 1e-300) ** 2, np.inf)
        # Diagonal of the inverse of J'J: the square of how far a coefficient moves at the price of one.
        with np.errstate(invalid="ignore"):
            parts = np.where(right == 0, 0.0, right**2 * weight[:, None])
        spread = parts.sum(0) / size**2
        count = self.slopes.shape[0]
        return {
            name: float(np.sqrt(self.rms**2 + (value - DEFAULTS[name]) ** 2 / cost / count))
            for (name, value), cost in zip(self.values.items(), spread, strict=True)
        }


@dataclass
class Draft:
    """Coefficients as fitted so far.

    nominal_load: N. radius: of the unloaded tire, m. pressure: nominal inflation pressure, Pa; None without.
    values: by name. undecided: those that the curves leave open, at their defaults. at_bounds: that ended at a bound.
    """

    nominal_load: float
    radius: float
    pressure: float | None
    values: dict[str, float] = field(default_factory=lambda: {**_STARTS, **FIXED})
    undecided: dict[str, float] = field(default_factory=lambda: dict(FIXED))
    at_bounds: list[str] = field(default_factory=list)

    def fit(self, bounds: Bounds, curves: Sequence[SlipCurve], variables: Sequence[str]) -> None:
        """Fit coefficients within bounds to variables of curves, each over its load; moments over load times radius.

        A coefficient is undecided if the rms of all these curves rises by less than 0.002 % once it is fixed at its
        default and the others are fitted again, without one more of them at a bound. The Jacobian gives the order in
        which coefficients are tried.
        """
        remainder = self._remainder(curves, variables)
        best = _solved({name: start for name, (start, *_) in bounds.items()}, bounds, remainder)
        allowed, decided = best.rms + _NOTICED, set(_SHAPES)
        while candidates := [name for name in best.values if name not in decided]:
            rises = best.rises()
            name = min(candidates, key=lambda key: rises[key])
            rest = {key: value for key, value in best.values.items() if key != name}
            before = self.values.get(name, 0.0)
            self.values[name] = DEFAULTS[name]
            trial = _solved(rest, bounds, remainder) if rises[name] < allowed + _HOPELESS else None
            if trial is not None and trial.rms <= allowed and not trial.at_bounds - best.at_bounds:
                best = trial
                self.undecided[name] = DEFAULTS[name]
                continue
            decided.add(name)
            self.values[name] = before
        self.values.update(best.values)
        self.at_bounds += sorted(best.at_bounds)

    def _remainder(
        self, curves: Sequence[SlipCurve], variables: Sequence[str]
    ) -> Callable[[Mapping[str, float]], Array]:
        """What coefficients leave of all these curves, (n,)."""
        load = np.concatenate([np.full(curve.slip.size, curve.normal_load) for curve in curves])
        slip = np.concatenate([curve.slip for curve in curves])
        # Angles to the right are negative in ISO.
        angle = -np.concatenate([curve.slip_angle for curve in curves])
        nominal = self.pressure or 1.0
        pressure = np.concatenate(
            [np.full(curve.slip.size, (curve.inflation_pressure or nominal) / nominal) for curve in curves]
        )
        wheel = Wheel(load, slip, angle, np.zeros_like(load), pressure, np.ones_like(load))
        signs = {"tractive_force": 1.0, "lateral_force": -1.0, "aligning_moment": -1.0}
        aims = [signs[name] * np.concatenate([getattr(curve, name) for curve in curves]) for name in variables]
        names = {"tractive_force": "longitudinal", "lateral_force": "lateral", "aligning_moment": "aligning"}
        levers = [load * (self.radius if name == "aligning_moment" else 1.0) for name in variables]

        def remainder(values: Mapping[str, float]) -> Array:
            out = evaluate(
                {**self.values, **values}, wheel, nominal_load=self.nominal_load, radius=self.radius, is_newer=True
            )
            parts = [
                (getattr(out, names[name]) - aim) / lever
                for name, aim, lever in zip(variables, aims, levers, strict=True)
            ]
            return np.concatenate(parts)

        return remainder


def _solved(start: Mapping[str, float], bounds: Bounds, remainder: Callable[[Mapping[str, float]], Array]) -> _Best:
    """The least squares within bounds, from a start."""
    from scipy.optimize import least_squares

    names = list(start)
    if not names:
        left = remainder({})
        return _Best({}, np.zeros((left.size, 0)), float(np.sqrt(np.mean(left**2))))
    low, high = np.array([bounds[name][1:] for name in names]).T

    def off(values: Array) -> Array:
        return remainder(dict(zip(names, values.tolist(), strict=True)))

    # x_scale "jac": coefficients differ by four orders of magnitude.
    begin = np.clip([start[name] for name in names], low, high)
    best = least_squares(off, begin, bounds=(low, high), x_scale="jac", max_nfev=400)
    values = dict(zip(names, best.x.tolist(), strict=True))
    near = np.minimum(best.x - low, high - best.x) < _AT_BOUND * (high - low)
    ended = frozenset(name for name, is_near in zip(names, near, strict=True) if is_near)
    return _Best(values, np.asarray(best.jac), float(np.sqrt(np.mean(best.fun**2))), ended)
