"""Permanent strain of the layers of a road under its traffic, and the rut that it adds up to.

Asphalt follows a power of the passes, ε_p = f ε_r N^b, whose strains of different loads add as f^(1/b) n, by strain
hardening; what is unbound follows a curve of N that is proportional to the strain, so that the mean strain counts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from treadload.errors import InputError, positive
from treadload.units import Length, Number, Share

# Range of water contents that the regression is taken for, and of temperatures of the asphalt, °C.
_WETTEST, COLDEST, WARMEST = 0.4, 5.0, 65.0
# ε_p / ε_r at the first pass and at the thousand millionth.
_FIRST, _LAST, _PASSES = 0.15, 20.0, 1e9
# Calibration of the unbound layers, and of the soil, in 2004.
UNBOUND, SOIL = 1.673, 1.35
CAVEAT = (
    "the rut's factor of depth in the asphalt and the numbers of its soil were read in a public program that codes "
    "NCHRP 1-37A (2004), not in the guide; both were calibrated for strain at points under uniform discs"
)


@dataclass(frozen=True)
class Rutting:
    """How a rut is counted in a life.

    limit: depth of the rut that ends the life, m, > 0, or None. water_content: of soil and unbound layers, a share of
    their dry mass, in (0, 0.4]. calibration: local factor on all of the rut, > 0. Raises InputError.
    Source: NCHRP 1-37A (2004), part 3, chapter 3: asphalt as in `damage.asphalt_rut`; unbound layers and soil after
    Tseng and Lytton (1989), its equations 3.3.10, 3.3.11 and 3.3.19, as coded in ProductOneME (commit c89fe2b).

    >>> ratio = tl.damage.Rutting(limit=0.0127).soil_ratio(1e6)
    >>> f"{ratio:.0f} times the resilient strain after a million load repetitions"
    '14 times the resilient strain after a million load repetitions'
    """

    limit: Length | None = None
    water_content: Share = 0.1
    calibration: Number = 1.0

    def __post_init__(self) -> None:
        if self.limit is not None:
            positive("limit", self.limit, "metres", "15 mm is 0.015")
            if self.limit > 0.2:
                raise InputError(f"limit is the depth of a rut in m, at most 0.2, got {self.limit:g}; 15 mm is 0.015")
        if not 0 < self.water_content <= _WETTEST:
            raise InputError(
                f"water_content must be a share of the dry mass in (0, {_WETTEST:g}], got {self.water_content:g}; "
                "10 % is 0.1"
            )
        positive("calibration", self.calibration, remedy="1 is the law as published")

    def soil_ratio(self, passes: float) -> float:
        """Permanent over resilient vertical strain of an unbound material after passes, > 0, without calibration.

        (ε₀/ε_r) e^(-(ρ/N)^β), log₁₀ β = -0.61119 - 0.017638 W, W the water content in %, which runs from 0.15 at the
        first pass to 20 at the 10⁹th: ρ and ε₀/ε_r follow from these.
        """
        beta = 10 ** (-0.61119 - 1.7638 * self.water_content)
        # With a = ρ^β: ln 20 - ln 0.15 = a (1 - 10⁹^-β).
        a = math.log(_LAST / _FIRST) / (1 - _PASSES**-beta)
        return _FIRST * math.exp(a * (1 - passes**-beta)) if passes >= 1 else _FIRST * passes
