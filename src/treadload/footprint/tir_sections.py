"""Sections of a .tir file beside the curves: vertical force, radii, carcass, rolling resistance, and ranges."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from treadload.footprint.free_states import FreeState
from treadload.kernels.arrays import Array
from treadload.kernels.free_rolling import DEFAULTS, deflection

# The sink of the effective radius falls off at small loads, which curves at working loads do not show.
BREFF = DEFAULTS["BREFF"]


@dataclass(frozen=True)
class Sections:
    """Coefficients of free rolling and standing, fitted to states of a tire.

    vertical, structural, rolling: by key; the last two may be empty. residuals: rms of the fit over the solve, by
    name of the quantity.
    """

    vertical: Mapping[str, float]
    structural: Mapping[str, float]
    rolling: Mapping[str, float]
    residuals: Mapping[str, float]


def fit_sections(states: Sequence[FreeState], nominal_load: float, radius: float, pressure: float | None) -> Sections:
    """Fit them. states: at three loads or more at the nominal pressure, and at further pressures. SI."""
    load = np.array([state.normal_load for state in states]) / nominal_load
    over = [1.0 if pressure is None else (state.inflation_pressure or pressure) / pressure for state in states]
    dp = np.array(over) - 1
    fit = _Fit(load, dp, dp == 0, nominal_load, radius)
    residuals: dict[str, float] = {}
    vertical = fit.vertical(np.array([state.deflection for state in states]), residuals)
    vertical |= fit.effective(np.array([state.effective_rolling_radius for state in states]), vertical, residuals)
    structural: dict[str, float] = {}
    for key, letter, attribute in (
        ("LONGITUDINAL", "X", "fore_aft_stiffness"),
        ("LATERAL", "Y", "lateral_stiffness"),
    ):
        values = np.array([getattr(state, attribute) for state in states])
        structural |= fit.carcass(values, key, letter, residuals, attribute)
    moments = [state.resisting_moment for state in states if state.resisting_moment is not None]
    rolling = fit.resistance(np.array(moments), residuals) if len(moments) == len(states) else {}
    return Sections({"FNOMIN": nominal_load, **vertical}, structural, rolling, residuals)


@dataclass(frozen=True)
class _Fit:
    """load: over the nominal one. dp: increment of the pressure. nominal: where that is zero. All (n,)."""

    load: Array
    dp: Array
    nominal: Array
    nominal_load: float
    radius: float

    @property
    def has_pressures(self) -> bool:
        return not bool(self.nominal.all())

    def vertical(self, depth: Array, residuals: dict[str, float]) -> dict[str, float]:
        """A parabola of the load over the deflection, through zero, and its growth with the pressure."""
        x = depth / self.radius
        terms = np.column_stack([x, x**2])
        first, second = np.linalg.lstsq(terms[self.nominal], self.load[self.nominal], rcond=None)[0]
        slope = float(np.sqrt(max(first**2 + 4 * second, 0.0)))
        out = {"VERTICAL_STIFFNESS": slope * self.nominal_load / self.radius, "Q_FZ2": float(second)}
        if self.has_pressures:
            out["PFZ1"] = _growth(self.dp, self.load / (terms @ [first, second]))
        size = {"stiffness": out["VERTICAL_STIFFNESS"], "radius": self.radius, "load": self.nominal_load}
        fitted = deflection({**DEFAULTS, **out}, self.load, 1 + self.dp, 0 * self.load, **size)
        residuals["approach"] = _rms(fitted / depth)
        return out

    def effective(
        self, effective: Array, vertical: Mapping[str, float], residuals: dict[str, float]
    ) -> dict[str, float]:
        """Sink of the effective radius: two terms over the load, neither of which lifts it above the free one."""
        from scipy.optimize import lsq_linear

        sink = self.nominal_load / (vertical["VERTICAL_STIFFNESS"] * (1 + vertical.get("PFZ1", 0.0) * self.dp))
        terms = np.column_stack([sink * np.arctan(BREFF * self.load), sink * self.load])
        peak, share = lsq_linear(terms, self.radius - effective, bounds=(0, np.inf)).x
        residuals["effective_rolling_radius"] = _rms((self.radius - terms @ [peak, share]) / effective)
        return {"Q_RE0": 1.0, "BREFF": BREFF, "DREFF": float(peak), "FREFF": float(share)}

    def carcass(
        self, stiffness: Array, key: str, letter: str, residuals: dict[str, float], name: str
    ) -> dict[str, float]:
        """A stiffness of the standing tire: quadratic in the load, linear in the pressure."""
        df = self.load - 1
        terms = np.column_stack([np.ones_like(df), df, df**2])
        values = np.linalg.lstsq(terms[self.nominal], stiffness[self.nominal], rcond=None)[0]
        over_load = terms @ values
        growth = _growth(self.dp, stiffness / over_load) if self.has_pressures else 0.0
        residuals[name] = _rms(over_load * (1 + growth * self.dp) / stiffness)
        first, second = values[1:] / values[0]
        out = {f"{key}_STIFFNESS": float(values[0]), f"PCF{letter}1": float(first), f"PCF{letter}2": float(second)}
        return out | ({f"PCF{letter}3": growth} if self.has_pressures else {})

    def resistance(self, moment: Array, residuals: dict[str, float]) -> dict[str, float]:
        """Rolling resistance: powers of the load and of the pressure."""
        columns = [np.ones_like(self.load), np.log(self.load)]
        columns += [np.log1p(self.dp)] if self.has_pressures else []
        terms = np.column_stack(columns)
        powers = np.linalg.lstsq(terms, np.log(moment), rcond=None)[0]
        residuals["rolling_resistance_moment"] = _rms(np.exp(terms @ powers) / moment)
        out = {"QSY1": float(np.exp(powers[0])) / (self.radius * self.nominal_load), "QSY7": float(powers[1])}
        return out | ({"QSY8": float(powers[2])} if self.has_pressures else {})


def _growth(dp: Array, ratio: Array) -> float:
    """Slope g of a ratio 1 + g dp."""
    return float(dp @ (ratio - 1) / (dp @ dp))


def _rms(ratio: Array) -> float:
    return float(np.sqrt(np.mean((ratio - 1) ** 2)))
