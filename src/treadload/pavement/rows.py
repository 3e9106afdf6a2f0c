"""The layers of a road as rows, what a table of a summary or a report shows, and in words."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.materials import Anisotropic, StressDependent
from treadload.materials.kinds import AnyElastic, upright
from treadload.pavement.bonds import BONDED
from treadload.pavement.layer import Layer
from treadload.pavement.structure import Pavement

# At which the modulus of a viscoelastic layer is given: the usual one of traffic, Hz.
FREQUENCY = 10.0


@dataclass(frozen=True)
class LayerRow:
    """A layer in plain values.

    name: of the layer. thickness: m, None where it is semi-infinite. modulus: Young's, Pa; of a viscoelastic
    material |E*| at `frequency`, Hz, which is None otherwise. poisson: Poisson's ratio; of an anisotropic material
    both are those under vertical stress. bond: to the layer below, in words; empty below the last. temperature: °C,
    None where it is not known. material: in words. anisotropic: True if the words
    alone state all of its moduli, also those over stress, whose `modulus` is that under a usual truck.

    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    >>> base = tl.pavement.layer_rows(road)[1]
    >>> f"{base.name}: {base.thickness * 1e3:.0f} mm of {base.modulus / 1e6:.0f} MPa, {base.bond}"
    'EB-GB3: 150 mm of 9000 MPa, bonded'
    """

    name: str
    thickness: float | None
    modulus: float
    frequency: float | None
    poisson: float
    bond: str
    temperature: float | None
    material: str
    anisotropic: bool = False


def layer_rows(road: Pavement, temperatures: Sequence[float | None] = ()) -> tuple[LayerRow, ...]:
    """The layers from the surface down.

    road: at its temperature. temperatures: °C, one per layer, those that chose its materials.
    Raises InputError for a layer that still needs a temperature.

    >>> road = tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15)
    >>> [(row.name, round(row.modulus / 1e6)) for row in tl.pavement.layer_rows(road)]  # MPa
    [('EB-BBSG3', 7000), ('EB-GB3', 9000), ('PF3', 120)]
    """
    known_temperatures = [*temperatures, *[None] * (len(road.layers) - len(temperatures))]
    return tuple(
        _row(layer, temperature, _bond_below(road, number))
        for number, (layer, temperature) in enumerate(zip(road.layers, known_temperatures, strict=True))
    )


def road_in_words(road: Pavement) -> str:
    """The layers of a road in one line.

    >>> tl.pavement.road_in_words(tl.Pavement.half_space(tl.Elastic(60e6, 0.35)))
    'layer (half-space): elastic, E = 60 MPa, ν = 0.35'
    """
    layers = []
    for layer in road.layers:
        depth = "half-space" if layer.thickness is None else f"{layer.thickness * 1e3:g} mm"
        bond = "" if layer.bond == BONDED else f", {layer.bond} below"
        layers.append(f"{layer.name or 'layer'} ({depth}): {layer.material}{bond}")
    return "; ".join([*layers, "rigid base"] if road.rigid_base else layers)


def _row(layer: Layer, temperature: float | None, bond: str) -> LayerRow:
    if isinstance(layer.material, StressDependent):
        nominal = layer.material.nominal
        return LayerRow(
            *(layer.name, layer.thickness, nominal.modulus, None, nominal.poisson, bond, temperature),
            str(layer.material),
            anisotropic=True,
        )
    material = layer.resolved
    frequency = None
    if isinstance(material, AnyElastic):
        modulus, poisson = upright(material)
    else:
        frequency, poisson = FREQUENCY, material.poisson
        modulus = float(np.abs(material.complex_modulus(2 * math.pi * FREQUENCY)))
    return LayerRow(
        *(layer.name, layer.thickness, modulus, frequency, poisson, bond, temperature, str(material)),
        anisotropic=isinstance(material, Anisotropic),
    )


def _bond_below(road: Pavement, number: int) -> str:
    """Bond of a layer to what lies below it, in words."""
    if number < len(road.layers) - 1:
        return str(road.layers[number].bond)
    return f"{BONDED} to a rigid base" if road.rigid_base else ""
