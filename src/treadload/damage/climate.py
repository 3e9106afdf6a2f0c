"""Climate: how warm the road is over the passes of a year."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.damage.shares import check_shares
from treadload.errors import InputError
from treadload.units import Celsius, Share


@dataclass(frozen=True)
class Season:
    """A part of the year with its temperatures.

    name: for tables. share: of the passes, in [0, 1]. temperature: °C, of all layers or one for each, surface
    first.
    """

    name: str
    share: Share
    temperature: Celsius | tuple[Celsius, ...]

    def __post_init__(self) -> None:
        if not 0 <= self.share <= 1:
            raise InputError(f"the share of {self.name!r} must lie in [0, 1], got {self.share}; a month is 1/12")
        if isinstance(self.temperature, Sequence):
            object.__setattr__(self, "temperature", tuple(float(t) for t in self.temperature))
        if not np.isfinite(self.temperature).all():
            raise InputError(f"the temperature of {self.name!r} must be finite, got {self.temperature} °C")


@dataclass(frozen=True)
class Climate:
    """The temperatures of the road over the passes. seasons: whose shares sum to 1. Raises InputError."""

    seasons: tuple[Season, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "seasons", tuple(self.seasons))
        if not self.seasons:
            raise InputError("a climate needs at least one season, got none")
        check_shares("climate", [season.share for season in self.seasons])

    @classmethod
    def constant(cls, temperature: float) -> Climate:
        """One temperature, °C, all year round, such as the equivalent one of a design method."""
        return cls((Season("all year", 1.0, temperature),))

    @classmethod
    def equal_parts(cls, temperatures: Sequence[float], names: Sequence[str] = ()) -> Climate:
        """Seasons of equal share, such as twelve months, with their temperatures, °C."""
        if names and len(names) != len(temperatures):
            raise InputError(f"there are {len(temperatures)} temperatures but {len(names)} names")
        count = len(temperatures)
        labels = names or [f"{k + 1} of {count}" for k in range(count)]
        return cls(tuple(Season(n, 1 / count, t) for n, t in zip(labels, temperatures, strict=True)))
