"""Structures as road engineers write them: "6 BBSG3 / 10 GB3 / 10 GB3 / PF3", layers from the surface down."""

from __future__ import annotations

import re
from collections.abc import Sequence

from treadload.errors import InputError
from treadload.materials.library import mixes
from treadload.materials.mixture import HydraulicMix, RoadMaterial
from treadload.pavement.bonds import BONDED, HALF_BONDED, BondLaw
from treadload.units import leading_number

EXAMPLE = "6 BBSG3 / 10 GB3 / 10 GB3 / PF3"
# European names of asphalt begin so; engineers leave it out.
_PREFIX = "EB-"
_UNIT = re.compile(r"(mm|cm|m)\s+(.+)")
_METRES = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}


def read_layers(text: str) -> list[tuple[RoadMaterial, float | None]]:
    """Materials and thicknesses, m, of a structure: layers from the surface down with "/" between.

    A layer is its thickness and the name of a mix or platform of the catalogue, "EB-" left out or not; the thickness
    is in cm, or in the unit behind it: "6,5 BBSG3", "6.5 cm BBSG3", "65 mm EB-BBSG3". The last has no thickness and
    is semi-infinite. Raises InputError.
    """
    parts = [part.strip() for part in text.split("/")]
    layers = [_layer(part) for part in parts[:-1]]
    last = parts[-1]
    if re.match(r"[0-9.,+\-]", last):
        raise InputError(
            f"the last layer, {last!r}, has a thickness, but must be semi-infinite: add what lies below it, such as "
            "a platform, PF3, or write the layers one by one above a rigid base"
        )
    return [*layers, (mixes[last], None)]


def bonds(materials: Sequence[RoadMaterial]) -> list[BondLaw]:
    """Bond of each layer to the one below by the French method: half-bonded between two treated with a binder other
    than bitumen, bonded everywhere else.

    The rule is that of the semi-rigid structure of table I.5 of NF P98-086; see its caveat in the catalogue.
    """
    pairs = zip(materials, [*materials[1:], None], strict=True)
    return [
        HALF_BONDED if isinstance(above, HydraulicMix) and isinstance(below, HydraulicMix) else BONDED
        for above, below in pairs
    ]


def in_words(layers: Sequence[tuple[RoadMaterial, float | None]]) -> str:
    """The structure in this notation, thicknesses in cm."""
    return " / ".join(
        material.name.removeprefix(_PREFIX) if thickness is None else _course(material, thickness)
        for material, thickness in layers
    )


def _course(material: RoadMaterial, thickness: float) -> str:
    return f"{thickness * 100:.10g} {material.name.removeprefix(_PREFIX)}"


def _layer(part: str) -> tuple[RoadMaterial, float]:
    if not part:
        raise InputError(f'there is nothing between two "/"; write it like "{EXAMPLE}"')
    try:
        number, rest = leading_number(part)
    except InputError as error:
        raise InputError(
            f'{error}; a layer is its thickness in cm and its mix, "6 BBSG3", and only the last has no thickness'
        ) from error
    with_unit = _UNIT.fullmatch(rest)
    unit, name = (with_unit[1], with_unit[2]) if with_unit else ("cm", rest)
    if not number > 0:
        raise InputError(f"the thickness of {part!r} must be > 0")
    if not name:
        raise InputError(f'{part!r} names no mix; write it like "{EXAMPLE}"')
    # As a person would write it in m: 0.06, not 0.06000000000000001.
    return mixes[name], float(f"{number * _METRES[unit]:.12g}")
