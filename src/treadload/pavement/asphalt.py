"""How much asphalt lies in a road: the thickness that fatigue laws ask for."""

from __future__ import annotations

from treadload.errors import InputError
from treadload.materials import (
    AtStress,
    HydraulicMix,
    Material,
    Mix,
    StressDependent,
    TemperatureDependent,
    Unbound,
)
from treadload.materials.kinds import AnyElastic, elastic_part, upright
from treadload.pavement.bonds import FRICTIONLESS
from treadload.pavement.layer import Layer
from treadload.pavement.structure import Pavement

# An elastic layer softer than this, Pa, is not asphalt: the stiffest unbound material of the catalogue has 600 MPa,
# the softest mix at 40 °C 800 MPa.
_UNBOUND = 0.7e9


def bituminous_thickness(road: Pavement, layer: int) -> float:
    """Thickness of all bituminous layers that lie on each other around one of them, m.

    layer: the bituminous one, counted from the surface, 0 is the top one, negative from the bottom. Wearing, binder
    and base courses count alike, whatever their bonds: laws were fitted to the whole. A mix of the catalogue and a
    viscoelastic material are bituminous; unbound and hydraulic materials of the catalogue and elastic ones below 700
    MPa are not. Above, the modulus does not decide. Raises InputError for a neighbour of which it is not known, and a
    layer that is not bituminous or is semi-infinite.

    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3")
    >>> round(tl.pavement.bituminous_thickness(road, 1), 3)
    0.21
    """
    number = _number(road, layer)
    course = road.layers[number]
    if course.thickness is None or is_bituminous(elastic_part(course.material)) is False:
        why = "is semi-infinite" if course.thickness is None else f"is not asphalt ({course.material})"
        raise InputError(
            f"layer {number + 1} {course.name!r} {why}; ask for a bituminous layer, or give the thickness"
        )
    total = course.thickness
    for step in (-1, 1):
        at = number + step
        while 0 <= at < len(road.layers) and _counts(road.layers[at], at):
            thickness = road.layers[at].thickness
            assert thickness is not None
            total += thickness
            at += step
    return total


def is_bituminous(material: Material | TemperatureDependent | StressDependent) -> bool | None:
    """Whether a material is bituminous; None where it cannot be known, see `bituminous_thickness`.

    >>> tl.pavement.is_bituminous(tl.catalogue.mixes["GB3"])
    True
    """
    if isinstance(material, Unbound | HydraulicMix | StressDependent | AtStress):
        return False
    if isinstance(material, AnyElastic):
        return False if upright(material)[0] < _UNBOUND else None
    return True


def lift_below(road: Pavement, layer: int) -> bool:
    """True where the layer below is of the same bituminous material and is bonded to it: two lifts of one course.

    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 8 GB3 / 8 GB3 / PF3")
    >>> [tl.pavement.lift_below(road, layer) for layer in (0, 1)]
    [False, True]
    """
    number = _number(road, layer)
    if number + 1 >= len(road.layers):
        return False
    upper, below = road.layers[number], road.layers[number + 1]
    return isinstance(upper.material, Mix) and upper.material == below.material and upper.bond != FRICTIONLESS


def _number(road: Pavement, layer: int) -> int:
    count = len(road.layers)
    if not -count <= layer < count:
        raise InputError(f"the road has {count} layers, {-count} to {count - 1}; there is no layer {layer}")
    return layer % count


def _counts(layer: Layer, number: int) -> bool:
    """Whether a neighbour adds to the asphalt."""
    if layer.thickness is None:
        return False
    bituminous = is_bituminous(elastic_part(layer.material))
    if bituminous is None:
        raise InputError(
            f"layer {number + 1} {layer.name!r} ({layer.material}) may be asphalt or bound by cement, so that the "
            "thickness of all asphalt is not known; give it as thickness, or build the layer of a catalogued mix"
        )
    return bituminous
