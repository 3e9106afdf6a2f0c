"""What is known about a measurement with fringes after it was evaluated."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from treadload.describing import Described
from treadload.rows import Row, row


@dataclass(frozen=True)
class FringeQuality(Described):
    """How pictures of fringes were understood, and how far to trust them.

    shape: rows and columns. fringes, steps: of each pattern. kept: share of pixels with a height. shadow, saturated,
    unsure, steep: shares given up for low modulation, for too few steps that were not saturated, for an order that is
    not certain or hangs together with nothing, and for neighbours that differ as at walls. spared: share of pixels
    that lost a step to saturation and were kept. modulation: median, grey levels. noise: of a grey level, standard
    deviation. gamma: found in the fringes, NaN if it cannot be determined. corrected: gamma that was taken out, or 1.
    deviation: median standard deviation of a pixel's height by noise, m. plane_residual: rms of the planes of the
    calibration about it, m, NaN without. cell: of the height map, m. filled: cells between pixels that took the mean
    of their neighbours. coverage: share of its cells with a height. warnings: one sentence each.
    """

    shape: tuple[int, int]
    fringes: tuple[float, ...]
    steps: tuple[int, ...]
    kept: float
    shadow: float
    saturated: float
    unsure: float
    steep: float
    spared: float
    modulation: float
    noise: float
    gamma: float
    corrected: float
    deviation: float
    plane_residual: float
    cell: float
    filled: int
    coverage: float
    warnings: tuple[str, ...] = ()

    title: ClassVar[str] = "Measurement with fringes"

    def rows(self) -> tuple[Row, ...]:
        """Pictures, shares of pixels, modulation, gamma, deviation of heights, and the height map."""
        patterns = ", ".join(f"{n} steps of {f:g}" for n, f in zip(self.steps, self.fringes, strict=True))
        without = {
            "in shadow": self.shadow, "saturated": self.saturated, "of uncertain order": self.unsure,
            "at walls": self.steep,
        }  # fmt: skip
        gone = ", ".join(f"{share:.1%} {why}" for why, share in without.items() if share > 0)
        taken = "not corrected" if self.corrected == 1 else f"corrected for {self.corrected:.2f}"
        lines = [
            row("pixels", f"{self.shape[1]} x {self.shape[0]}; {patterns} fringes"),
            row("kept_pixels", self.kept, note=gone),
            row("pixels_without_steps", self.spared),
            row("fringe_modulation", self.modulation),
            row("grey_noise", self.noise),
            row("gamma", self.gamma, note=taken),
            row("fringe_deviation", self.deviation),
        ]
        if not math.isnan(self.plane_residual):
            lines.append(row("plane_residual", self.plane_residual))
        cells = f"cells of {self.cell * 1e3:.3g} mm, {self.coverage:.1%} of them with a height, {self.filled} between"
        return (*lines, row("grid", f"{cells} pixels"))
