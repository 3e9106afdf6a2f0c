"""The crack that grows: which criterion starts it, through which layers it runs, its trace and its laws."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.damage.criterion import Criterion
from treadload.damage.growth.intensity import CLOSE, way_through
from treadload.damage.growth.laws import GrowthLaw, ParisLaw, law_of_mix
from treadload.damage.growth.options import CrackGrowth
from treadload.damage.life import Life
from treadload.errors import InputError, nearest
from treadload.kernels.arrays import Array
from treadload.life.seasons import Warm
from treadload.life.thermal_growth import Ends
from treadload.materials.kinds import elastic_part, limit_of, upright
from treadload.pavement import Pavement
from treadload.response import MATERIAL_LENGTH

# Depths that a result tells between initiation and the end, m apart at least.
_STEP = 0.005


@dataclass(frozen=True, eq=False)
class Crack:
    """A crack that a criterion of a life starts.

    road: without the temperatures of a season. number: of the criterion. layer: number of the one where the crack
    starts. ends: of its way. length: at the start, m. trace: its angle from travel towards the right, rad. laws: of
    the layers on its way, from the start.
    """

    road: Pavement
    life: Life
    growth: CrackGrowth
    number: int
    layer: int
    ends: Ends
    length: float
    trace: float
    laws: Sequence[GrowthLaw]

    @classmethod
    def of(cls, road: Pavement, life: Life, growth: CrackGrowth) -> Crack:
        """The crack of a growth in a road. Raises InputError for one that cannot start or has no way."""
        number = _number_of(life, growth.criterion)
        criterion = life.criteria[number]
        layer, upwards = criterion.number(road), criterion.place == "bottom"
        if not upwards and layer != 0:
            raise InputError(
                f"the criterion {criterion.name!r} reads the top of layer {layer + 1}; a crack grows down from the "
                "top of the road, or up from the bottom of a layer"
            )
        if criterion.place == "interface":
            raise InputError(f"the criterion {criterion.name!r} reads a bond, which parts; take one of a layer")
        top, bottom = way_through(road, layer, growth.layers, upwards=upwards)
        length = growth.initial_length or criterion.mean_over or MATERIAL_LENGTH
        if not length < CLOSE * (bottom - top):
            raise InputError(
                f"the crack is {length * 1e3:g} mm long when it starts, and its way only "
                f"{(bottom - top) * 1e3:g} mm; give a shorter initial_length, or more layers"
            )
        laws = _laws(road, growth, layer, upwards)
        ends = Ends(top, bottom, upwards=upwards)
        return cls(road, life, growth, number, layer, ends, length, _trace(life, number, growth), laws)

    @property
    def criterion(self) -> Criterion:
        """What starts it."""
        return self.life.criteria[self.number]

    @property
    def upwards(self) -> bool:
        """True of a crack from the bottom of a layer."""
        return self.ends.upwards

    @property
    def thickness(self) -> float:
        """Length of its way down or up, m."""
        return self.ends.bottom - self.ends.top

    @property
    def lengths(self) -> Array:
        """Depths of the tip at which its growth is solved, m."""
        return np.geomspace(self.length, CLOSE * self.thickness, self.growth.steps)

    @property
    def targets(self) -> Array:
        """Depths that a result states, m: of initiation, every so many mm, the end."""
        step = _STEP * max(1, math.ceil((self.thickness - self.length) / _STEP / 12))
        between = step * np.arange(math.floor(self.length / step) + 1, math.ceil(self.thickness / step - 1e-9))
        inside = between[(between > self.length + 1e-4) & (between < self.thickness - 1e-4)]
        return np.round(np.concatenate([[self.length], inside, [self.thickness]]), 9)

    def law_at(self, warm: Warm, distance: float) -> ParisLaw:
        """The law where the tip is, a distance from the mouth, m, on the road of a season."""
        layers = [self.layer - k if self.upwards else self.layer + k for k in range(len(self.laws))]
        ends = np.cumsum([self.road.layers[k].thickness for k in layers])
        law = self.laws[min(int(np.searchsorted(ends, distance)), len(self.laws) - 1)]
        depth = float(self.road.interfaces[self.layer]) - distance if self.upwards else distance
        material = warm.road.layers[warm.road.layer_at(max(depth, 0.0))].resolved
        return law.at(upright(limit_of(material, "glassy"))[0])

    def __str__(self) -> str:
        growth, trace = self.growth, math.degrees(self.trace)
        end = self.layer - growth.layers + 1 if self.upwards else self.layer + growth.layers - 1
        names = [self.road.layers[k].name or f"layer {k + 1}" for k in (self.layer, end)]
        through = names[0] if self.layer == end else f"{names[0]} to {names[1]}"
        path = growth.path if isinstance(growth.path, str) else f"leaning by {math.degrees(growth.path):g} degrees"
        return f"{'up' if self.upwards else 'down'} through {through}, {path}, trace {trace:z.0f} degrees from travel"


def _number_of(life: Life, name: str) -> int:
    names = [criterion.name for criterion in life.criteria]
    if name not in names:
        raise InputError(f"no criterion {name!r} starts a crack; {nearest(name, names)}")
    return names.index(name)


def _laws(road: Pavement, growth: CrackGrowth, layer: int, upwards: bool) -> list[GrowthLaw]:
    """One for each layer on the way, from where the crack starts."""
    if growth.law is not None:
        return [growth.law] * growth.layers
    way = [layer - k if upwards else layer + k for k in range(growth.layers)]
    return [law_of_mix(elastic_part(road.layers[k].material), road.layers[k].name or f"{k + 1}") for k in way]


def _trace(life: Life, number: int, growth: CrackGrowth) -> float:
    """Angle of the crack's trace from travel towards the right, rad."""
    if isinstance(growth.trace, str):
        return {"longitudinal": 0.0, "transverse": 0.5 * math.pi}[growth.trace]
    if growth.trace is not None:
        return growth.trace
    first = life.dataset.get("first_crack_angle")
    angle = math.nan if first is None else float(first[number])
    if math.isnan(angle):
        raise InputError(
            f"the criterion {growth.criterion!r} does not determine which way its crack runs; give the trace, "
            '"longitudinal" or "transverse"'
        )
    return angle
