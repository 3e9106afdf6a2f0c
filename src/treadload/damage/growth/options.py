"""What is asked of a crack: where it starts, how long it is then, by which law it grows and along which path."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from treadload.damage.growth.laws import GrowthLaw
from treadload.describing import as_call
from treadload.errors import InputError, positive

Path = Literal["vertical", "kinked"]
# Beyond this from the vertical a crack goes along the road rather than through it.
STEEPEST = math.radians(60.0)
# Points along a crack: 0.03 % of K at 0.95 of a free strip; where its faces touch in part, 2 % of the largest.
# Lengths at which it is solved: passes to the end within 0.5 %.
POINTS, STEPS = 20, 12


@dataclass(frozen=True)
class CrackGrowth:
    """How a crack grows once a criterion has started it.

    criterion: of the life whose damage 1 starts the crack: at the top of the road it grows down, at the bottom of a
    layer up. initial_length: m, of the crack then; left out, the length over which the criterion reads, which is what
    has failed, or 10 mm. law: of growth; left out, that of each layer's mix. trace: "longitudinal", "transverse", an
    angle, rad, from travel towards the right, or left out that of the criterion's first crack; "both" for a
    longitudinal and a transverse crack side by side. A crack starts where the criterion's damage is 1, whichever way
    the strain points; of "both" each where the damage by the strain across it is, if the criterion reads a tensile
    strain at the surface. path: "vertical"; "kinked", each step across the largest hoop stress; or an angle, rad,
    from the vertical, positive to the right of the trace. friction: between the faces. layers: that the crack goes
    through, counted from where it starts.
    steps: lengths at which its stress intensity is solved. points: along the crack at which its faces may open,
    touch and rub. scatter: standard deviation of log₁₀ of the passes to
    initiation; left out, that of the criterion's law or 0.25. Raises InputError.

    >>> tl.damage.CrackGrowth("surface", initial_length=0.005, scatter=2.5)
    Traceback (most recent call last):
        ...
    treadload.errors.InputError: the scatter of log10 of the passes must lie in [0, 2], got 2.5
    """

    criterion: str
    initial_length: float | None = None
    law: GrowthLaw | None = None
    trace: Literal["longitudinal", "transverse", "both"] | float | None = None
    path: Path | float = "vertical"
    friction: float = 0.5
    layers: int = 1
    steps: int = STEPS
    scatter: float | None = None
    points: int = POINTS

    def __post_init__(self) -> None:
        if self.initial_length is not None:
            positive("the initial length of a crack", self.initial_length, "metres", "0.01 is usual")
        if not (math.isfinite(self.friction) and 0 <= self.friction <= 2):
            raise InputError(f"the friction of a crack's faces must lie in [0, 2], got {self.friction}; 0.5 is usual")
        if isinstance(self.path, str) and self.path not in ("vertical", "kinked"):
            raise InputError(f'the path must be "vertical", "kinked" or an angle in rad, got {self.path!r}')
        if not isinstance(self.path, str) and not abs(self.path) <= STEEPEST:
            raise InputError(
                f"the path must lean by at most {math.degrees(STEEPEST):.0f} degrees from the vertical, got "
                f"{math.degrees(self.path):g}"
            )
        if isinstance(self.trace, str) and self.trace not in ("longitudinal", "transverse", "both"):
            raise InputError(
                f'the trace must be "longitudinal", "transverse", "both" or an angle, got {self.trace!r}'
            )
        if self.layers < 1:
            raise InputError(f"a crack goes through at least one layer, got layers = {self.layers}")
        if not 3 <= self.steps <= 40:
            raise InputError(f"steps must lie in [3, 40], got {self.steps}; {STEPS} is the default")
        if not 8 <= self.points <= 96:
            raise InputError(
                f"points along a crack must lie in [8, 96], got {self.points}; {POINTS} are within 2 % of the "
                "largest stress intensity"
            )
        if self.scatter is not None and not 0 <= self.scatter <= 2:
            raise InputError(f"the scatter of log10 of the passes must lie in [0, 2], got {self.scatter}")

    __repr__ = as_call
