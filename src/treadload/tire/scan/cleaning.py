"""What is done about the facets and the noise of a scan, and the warnings about it."""

from __future__ import annotations

import math

from treadload.tire.scan.noise import ROUGH, roughness, smoothing_length
from treadload.tire.scan.options import Smooth
from treadload.tire.scan.surface import Choice

LARGEST_SAG = 0.1e-3  # facets that cut this deep raise the peak pressure by 3 to 4 %
LARGEST_NOISE = 0.05e-3  # noise of this size raises the peak pressure by 5 to 7 % on points 3 to 5 mm apart


def decide_revolve(revolve: Choice, smooth: Smooth, steady: bool, sag: float, noise: float) -> tuple[bool, list[str]]:
    """Whether the meridian of a tread is revolved in place of its facets, and sentences for the user.

    revolve, smooth: as asked for. steady: the tread does not depend on the angle. sag: of the facets under the
    circle, m. noise: m, NaN unknown.
    """
    if revolve is True:
        return True, [] if steady else [
            "the tread is not the same all round the tire: revolving it loses what changes, lugs and grooves across"
        ]
    if revolve == "auto" and steady and sag <= LARGEST_SAG and smooth == "auto" and noise > LARGEST_NOISE:
        # The mean of all angles takes out more than any window, and keeps the edges of ribs sharp.
        return True, [f"{noise * 1e3:.2f} mm of noise: the tread is its meridian revolved instead"]
    if sag <= LARGEST_SAG:
        return False, []
    cut = f"facets cut {sag * 1e3:.1f} mm under the circle"
    if revolve == "auto" and steady:
        return True, [f"{cut}: the tread is its meridian revolved instead"]
    if steady:
        advice = "use revolve=True, as the tread does not depend on the angle"
    else:
        advice = "use a finer mesh: the tread changes round the tire and cannot be revolved"
    return False, [f"{cut} and will show in the contact, their corners as peaks of pressure; {advice}"]


def decide_smoothing(
    smooth: Smooth, revolved: bool, steady: bool, noise: float, spacing: float
) -> tuple[float, list[str]]:
    """Length to smooth a scan over, m (0: not at all), and sentences for the user.

    smooth: as asked for. revolved: the tread is a revolved meridian, which has no noise. steady: it could be.
    noise: m, NaN unknown. spacing: of the points, m.
    """
    if revolved:
        return 0.0, []
    if smooth is not False and smooth != "auto":
        length = float(smooth)
        if noise > LARGEST_NOISE and roughness(noise, spacing, length) > 2 * ROUGH:
            return length, [
                f"the scan has {noise * 1e3:.2f} mm of noise, and smoothing over {length * 1e3:.3g} mm leaves "
                f'pressure peaks; smooth="auto" would take {smoothing_length(noise, spacing) * 1e3:.2g} mm'
            ]
        return length, []
    if not math.isfinite(noise) or noise <= LARGEST_NOISE:
        return 0.0, []
    if smooth == "auto":
        length = smoothing_length(noise, spacing)
        return length, [f"{noise * 1e3:.2f} mm of noise was smoothed over {length * 1e3:.2g} mm"]
    ways = 'smooth="auto"' + (" or, as the tread does not depend on the angle, revolve=True" if steady else "")
    return 0.0, [
        f"the scan has {noise * 1e3:.2f} mm of noise, more than {LARGEST_NOISE * 1e3:g} mm: every point that stands "
        f"out carries load, and the peak pressure is too high; read it with {ways}"
    ]
