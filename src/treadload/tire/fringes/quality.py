"""What is known about a measurement with fringes after it was evaluated."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class FringeQuality:
    """How pictures of fringes were understood, and how far to trust them.

    shape: rows and columns. fringes, steps: of each pattern. kept: share of pixels with a height. shadow, saturated,
    unsure, steep: shares given up for low modulation, for too few steps that were not saturated, for an order that is
    not certain or hangs together with nothing, and for neighbours that differ as at walls. spared: share of pixels
    that lost a step to saturation and were kept. modulation: median, grey levels. noise: of a grey level, standard
    deviation. gamma: found in the fringes, NaN if it cannot be told. corrected: gamma that was taken out, or 1.
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

    def __str__(self) -> str:
        patterns = ", ".join(f"{n} steps of {f:g}" for n, f in zip(self.steps, self.fringes, strict=True))
        rows, columns = self.shape
        gone = [
            f"{share:.1%} {why}"
            for share, why in (
                (self.shadow, "in shadow"),
                (self.saturated, "saturated"),
                (self.unsure, "of uncertain order"),
                (self.steep, "at walls"),
            )
            if share > 0
        ]
        noise = "noise unknown" if math.isnan(self.noise) else f"noise {self.noise:.2g}"
        found = "not told" if math.isnan(self.gamma) else f"{self.gamma:.2f}"
        deviation = "unknown" if math.isnan(self.deviation) else f"{self.deviation * 1e3:.3f} mm"
        lines = [
            f"{columns} x {rows} pixels; {patterns} fringes",
            f"{self.kept:.1%} of the pixels have a height" + (f"; {', '.join(gone)}" if gone else ""),
            f"modulation {self.modulation:.3g} grey levels, {noise}, {self.spared:.1%} of the pixels kept without "
            "their saturated steps",
            f"gamma {found}, {'not corrected' if self.corrected == 1 else f'corrected for {self.corrected:.2f}'}",
            f"standard deviation of a height by noise {deviation} (median)"
            + ("" if math.isnan(self.plane_residual) else f", planes within {self.plane_residual * 1e3:.3f} mm rms"),
            f"height map on cells of {self.cell * 1e3:.3g} mm, {self.coverage:.1%} of them with a height, "
            f"{self.filled} between pixels",
        ]
        return "\n".join(lines + [f"warning: {text}" for text in self.warnings])
