"""Temperature over depth, and which of it a layer takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError
from treadload.materials.celsius import check_celsius


@dataclass(frozen=True)
class TemperatureProfile:
    """Temperature over depth, linear between the given depths.

    depths: m, increasing, from the surface down, at least two. temperatures: °C, one per depth.
    A layer takes the temperature at its middle.
    Raises InputError.

    >>> hot = tl.pavement.TemperatureProfile([0.0, 0.2], [38.0, 24.0])
    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=hot)
    >>> [round(layer.material.modulus / 1e6) for layer in road.layers]  # MPa
    [1328, 3196, 120]
    """

    depths: tuple[float, ...]
    temperatures: tuple[float, ...]

    def __init__(self, depths: Sequence[float], temperatures: Sequence[float]) -> None:
        object.__setattr__(self, "depths", tuple(float(depth) for depth in depths))
        object.__setattr__(self, "temperatures", tuple(check_celsius(value) for value in temperatures))
        if len(self.depths) != len(self.temperatures) or len(self.depths) < 2:
            raise InputError(
                "a temperature profile needs at least two depths and a temperature for each, got "
                f"{len(self.depths)} depths and {len(self.temperatures)} temperatures"
            )
        if not (np.isfinite(self.depths).all() and self.depths[0] >= 0 and (np.diff(self.depths) > 0).all()):
            raise InputError(
                f"the depths of a temperature profile must be >= 0 m and increase, got {list(self.depths)} m"
            )

    def temperature_at(self, depth: float, *, extrapolate: bool = False) -> float:
        """Temperature, °C, at a depth, m.

        extrapolate: beyond the profile its nearest temperature holds. Raises InputError there otherwise.
        """
        first, last = self.depths[0], self.depths[-1]
        if not extrapolate and not first <= depth <= last:
            raise InputError(
                f"depth {depth:g} m lies outside the temperature profile's {first:g} to {last:g} m; extend the "
                "profile, or let its nearest temperature hold with extrapolate=True"
            )
        return float(np.interp(depth, self.depths, self.temperatures))

    def __str__(self) -> str:
        points = zip(self.depths, self.temperatures, strict=True)
        return ", ".join(f"{temperature:g} °C at {depth * 1e3:g} mm" for depth, temperature in points)
