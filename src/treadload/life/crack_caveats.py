"""What a user must know of a crack that was grown: jammed faces, steep paths, interfaces."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from treadload.damage.growth.intensity import CLOSE, Crossing, Way
from treadload.damage.growth.laws import GrowthLaw
from treadload.damage.growth.options import STEEPEST, CrackGrowth
from treadload.kernels.fracture.interface import interface_singularity
from treadload.life.seasons import Warmed
from treadload.materials.kinds import limit_of, upright
from treadload.pavement import Pavement

# Moduli of two joined layers further apart than this are stated; K changes little below.
_ALIKE = 1.25
# A last stretch that takes this much longer or shorter than it is taken to is stated.
_STRETCH = 1.2


def cautions(of_laws: Sequence[str], jammed: int, states: int, way: Way, road: Pavement) -> list[str]:
    """Of the laws, of faces that jam and of the path. of_laws: the laws'. states: of all passages and lengths."""
    caveats = [f"crack growth: {text}" for text in of_laws]
    if jammed:
        caveats.append(
            f"crack growth: the faces jam in {jammed} of {states} states, where they are taken without friction, "
            "which is on the safe side"
        )
    leans = np.abs(np.diff(way.offsets) / np.diff(way.distances)).max()
    if leans > math.tan(STEEPEST) * (1 - 1e-9) and len(way.distances) > 2:
        caveats.append(
            f"crack growth: the path would turn to more than {math.degrees(STEEPEST):.0f} degrees from the vertical, "
            "along the road rather than through it; it is held there"
        )
    if road.is_viscoelastic:
        caveats.append("the weight functions of cracks take viscoelastic layers as they are under fast loads")
    return caveats


def at_the_end(
    crossings: Sequence[Crossing], laws: Sequence[GrowthLaw], warm: Warmed, growth: CrackGrowth,
    ends: tuple[float, float], *, upwards: bool,
) -> list[str]:  # fmt: skip
    """What happens at interfaces: at the end of the way, and where the crack crosses some.

    crossings: of all classes and seasons. laws: of the layers on the way. ends: depths of its top and bottom, m.
    """
    caveats = []
    joined = [_joined(road.road, ends) for road in warm.distinct]
    if growth.layers > 1 and max(joined) > _ALIKE:
        caveats.append(
            "crack growth: the layers that the crack crosses differ in modulus by up to a factor of "
            f"{max(joined):.1f}; their stress intensity is that of one layer of their mean modulus, under the stress "
            "of each, so that what an interface does to a tip close to it is left out"
        )
    section_layers = {(crossing.section.layer, len(crossing.section.strips)) for crossing in crossings}
    ahead = [layer - 1 if upwards else layer + 1 for layer, _ in section_layers]
    if min(ahead) < 0:
        return [*caveats, "crack growth: the rate at 95 % of the way holds to the free surface, where it would rise"]
    if any(layer == count - 1 for layer, count in section_layers):
        return [*caveats, "crack growth: the rate at 95 % of the way holds to the rock below, where it would fall"]
    host = next(iter(section_layers))[0]
    slips = [crossing.section.strips[min(host, ahead[0])].slip for crossing in crossings]
    if max(slips) > 0:
        return [
            *caveats,
            "crack growth: the interface at the end of the way slides, so that a crack may turn along it; its rate "
            "at 95 % of the way holds to the end",
        ]
    orders = [
        interface_singularity(crossing.section.strips[crossing.section.layer], crossing.section.strips[ahead[0]])
        for crossing in crossings
    ]
    exponents = [_exponent(law, warm) for law in laws[-1:]]
    for order in (min(orders), max(orders)):
        left = 1 - max(exponents) * (0.5 - order)
        factor = 1 / left if left > 0 else math.inf
        if not 1 / _STRETCH < factor < _STRETCH:
            long = f"{factor:.2g} times as long" if math.isfinite(factor) else "without end"
            stiff = "stiffer" if order < 0.5 else "softer"
            caveats.append(
                f"crack growth: the layer ahead is {stiff}: at the interface the stress goes as r^-{order:.2f} and K "
                f"{'falls' if order < 0.5 else 'rises'}; the last {100 * (1 - CLOSE):.0f} % of the way, for "
                f"which the rate before it holds, would take {long} (Zak and Williams 1963)"
            )
    return list(dict.fromkeys(caveats))


def _exponent(law: GrowthLaw, warm: Warmed) -> float:
    material = warm.distinct[0].road.layers[0].resolved
    return law.at(upright(limit_of(material, "glassy"))[0]).exponent


def _joined(road: Pavement, ends: tuple[float, float]) -> float:
    """Largest over smallest modulus of the layers between two depths, m."""
    middles = [0.5 * (a + b) for a, b in zip([0.0, *road.interfaces[:-1]], road.interfaces, strict=True)]
    moduli = [
        upright(limit_of(layer.resolved, "glassy"))[0]
        for layer, middle in zip(road.layers, middles, strict=False)
        if ends[0] < middle < ends[1]
    ]
    return max(moduli) / min(moduli) if moduli else 1.0
