"""Daily thermal stress in the stress intensity of a crack: a cycle a day beside the passages of the traffic."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from treadload.damage.climate import MONTHS, Climate
from treadload.damage.growth.intensity import Crossing, Way, faces_along, modes, section_of
from treadload.damage.growth.options import CrackGrowth
from treadload.damage.thermal import DAYS
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.life.seasons import Warm, warmed
from treadload.life.thermal import daily_stress, instant
from treadload.materials.kinds import elastic_part
from treadload.pavement import Pavement
from treadload.pavement.asphalt import is_bituminous


@dataclass(frozen=True)
class Ends:
    """Depths between which a crack runs, m, and which way. Raises InputError."""

    top: float
    bottom: float
    upwards: bool

    def __post_init__(self) -> None:
        if not self.top < self.bottom:
            raise InputError(
                f"a crack's way must go down from {self.top:g} m, got its lower end at {self.bottom:g} m"
            )

    @property
    def mouth(self) -> float:
        """Depth where the crack starts, m."""
        return self.bottom if self.upwards else self.top


@dataclass(frozen=True, eq=False)
class DailyIntensity:
    """Stress intensity that the weather alone makes.

    ranges: (month, length), Pa √m, of the mean day: Irwin's sum of the modes, largest less smallest of the hours.
    roads: by month, at the hour of the largest tension at the mouth.
    """

    ranges: Array
    roads: tuple[Warm, ...]

    def yearly_growth(self, rate: Callable[[Warm, int, Array], Array]) -> Array:
        """Growth of a year (length,), m. rate: growth of a cycle, m, in a road, at a length by number, of a range."""
        total = np.zeros(self.ranges.shape[1])
        for days, road, row in zip(DAYS, self.roads, self.ranges, strict=True):
            total += days * np.array([float(rate(road, k, value)) for k, value in enumerate(row)])
        return total


def daily_intensity(
    road: Pavement, climate: Climate, distances: Array, way: Way, lengths: Array, growth: CrackGrowth, ends: Ends
) -> DailyIntensity | None:
    """Stress intensity over the mean day of each month; None where the climate asks for no daily thermal stress.

    road: whose materials wait for their temperature. distances: from the mouth, m, at which stress is read. way: of
    the crack, its tip at lengths (k,), m. ends: between which it runs. The restrained stress of
    `life.thermal.daily_stress` is that of the uncracked road; the same in all horizontal directions, it opens a
    crack of any trace and shears one that leans. What is not bituminous has none, nor has a material
    that does not state how it relaxes.
    """
    thermal, days = climate.thermal, climate.days
    if thermal is None or days is None:
        return None
    depths = ends.mouth - distances if ends.upwards else ends.mouth + distances
    owner = np.array([road.layer_at(float(depth)) for depth in np.clip(depths, 0.0, None)])
    stress = np.zeros((len(MONTHS), len(days.hours), len(distances)))
    for number in np.unique(owner):
        material = elastic_part(road.layers[number].material)
        if is_bituminous(material) is False or thermal.unknown(material):
            continue
        relaxing, expansion, _ = thermal.of(material)
        at = owner == number
        warmth = np.stack([_columns(days.depths, month, depths[at]) for month in days.temperatures])
        stress[:, :, at] = np.moveaxis(daily_stress(relaxing, expansion, days.hours, np.moveaxis(warmth, 1, 0)), 0, 1)
    if not stress.any():
        return None
    ranges, roads = np.zeros((len(MONTHS), len(lengths))), []
    for month, name in enumerate(MONTHS):
        hour = int(stress[month, :, 0].argmax())
        season = instant(climate, days.depths, days.temperatures[month, hour], name)
        warm = warmed(road, (), season)
        section, poisson = section_of(warm.road, ends.top, ends.bottom)
        tensors = np.zeros((6, len(distances), 1, len(days.hours)))
        tensors[0, :, 0] = tensors[1, :, 0] = stress[month].T
        crossing = Crossing(tensors, distances, np.zeros(1), days.hours, section, ends.upwards, poisson, 1)
        for k, length in enumerate(lengths):
            faces = faces_along(section, way.until(length), float(length), upwards=ends.upwards, points=growth.points)
            # The same everywhere along the road: where the path leads does not matter.
            here = replace(faces, x=np.zeros_like(faces.x))
            factors = modes(crossing, here, 0.0, growth.friction)[0][0]
            first, second, third = np.ptp(factors, axis=0)
            ranges[month, k] = np.sqrt(first**2 + second**2 + third**2 / (1 - poisson))
        roads.append(warm)
    return DailyIntensity(ranges, tuple(roads))


def _columns(depths: Array, temperatures: Array, at: Array) -> Array:
    """Temperatures (hour, n) at depths, linear between those known."""
    return np.stack([np.interp(at, depths, row) for row in temperatures])
