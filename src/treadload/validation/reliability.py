"""Checks of reliability: the French factor of risk by draws and to the first order."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.damage.laws.french import risk_factor
from treadload.life.reliability.propagation import Quadratic, drawn, first_order
from treadload.validation.check import Check, relative

# Risk; slope b; SN; Sh, m: a base course, a thin course, a treated gravel.
_CASES = {
    "21 cm of asphalt": (-0.2, 0.3, 0.025),
    "8 cm of EME": (-0.2, 0.25, 0.01),
    "treated gravel": (-1 / 15, 1.0, 0.03),
}
_RISK, _DRAWS = 0.05, 100_000
# Decades of strain per m of thickness.
_SLOPE = 2.0


def reliability_checks() -> Iterator[Check]:
    """k_r = 10^(-u b δ) by 10⁵ draws of fatigue and thickness, within 1 % in strain, and to the first order."""
    group, source = "French factor of risk", "NF P98-086, its formula for k_r"
    for name, (slope, scatter, thickness) in _CASES.items():
        damage = math.log(10) * np.array([-_SLOPE * thickness / abs(slope), scatter])
        surface = Quadratic(0.0, damage, np.zeros((2, 2)))
        reference = risk_factor(_RISK, slope, scatter, thickness)
        draws = np.quantile(drawn([surface], 1, _DRAWS, seed=1)[0], 1 - _RISK)
        for how, logarithm, bound in (
            ("10⁵ draws", float(draws), 0.01),
            ("the first order", first_order(surface, _RISK)[0], 1e-9),
        ):
            factor = math.exp(slope * logarithm)
            yield relative(group, f"{name}, risk 5 %: k_r by {how}", factor, reference, bound, source)
