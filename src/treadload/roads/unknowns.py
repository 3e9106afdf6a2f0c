"""What is sought of a road: which layers have known moduli, bounds, priors, and where the stiff layer lies."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError, nearest, positive
from treadload.kernels.arrays import Array, ComplexArray
from treadload.materials import Anisotropic, Boyce, Elastic, StressDependent, TemperatureDependent
from treadload.materials.kinds import elastic_part
from treadload.pavement import Layer, Pavement
from treadload.units import quantity

DEPTH = "stiff layer"
"""Name of the depth of the stiff layer among the unknowns."""
STIFF_LAYER = 10.0
"""Depth of the stiff layer below the surface, m, where no other is given: the middle of 7.5 to 12.5 m, where routine
evaluations put it. On a half-space the outer sensors would need a subgrade that stiffens with depth."""
REFERENCE_FREQUENCY = 10.0
"""At which the modulus of a viscoelastic layer is stated as |E*|, Hz."""
# No material of a road is softer or stiffer, Pa; a stiff layer lies at least this far below the top of the last layer
# and no deeper than this below the surface, m: deeper ones are not felt within 2 m of the plate.
BOUNDS = (1e6, 1e11)
_LEAST_DEPTH, _MOST_DEPTH = 0.5, 30.0
_WIDEST = 3.0
# At which mixes are tried, °C.
_MILD = 15.0


@dataclass(frozen=True)
class Unknowns:
    """The question to every basin.

    road: with the moduli of the fixed layers; those of the others are the centres of priors. moduli: numbers of the
    layers whose modulus is sought. bounds: of each, Pa. priors: of each (ln E, standard deviation of it), None for
    none. depth: of the stiff layer below the surface, m; None for the bottom that the road has. seeks_depth: True
    where the depth is sought, between depth_bounds, m.
    """

    road: Pavement
    moduli: tuple[int, ...]
    bounds: tuple[tuple[float, float], ...]
    priors: tuple[tuple[float, float] | None, ...]
    depth: float | None
    seeks_depth: bool = False
    depth_bounds: tuple[float, float] = (0.0, 0.0)

    @property
    def names(self) -> tuple[str, ...]:
        """Of the unknowns: layers, then the stiff layer's depth."""
        layers = layer_names(self.road)
        return (*(layers[number] for number in self.moduli), *((DEPTH,) if self.seeks_depth else ()))

    @property
    def low(self) -> Array:
        """Logarithms of the lower bounds, of Pa and m."""
        return np.log([low for low, _ in self._all_bounds])

    @property
    def high(self) -> Array:
        """Logarithms of the upper bounds."""
        return np.log([high for _, high in self._all_bounds])

    @property
    def _all_bounds(self) -> tuple[tuple[float, float], ...]:
        return (*self.bounds, *((self.depth_bounds,) if self.seeks_depth else ()))


def layer_names(road: Pavement) -> tuple[str, ...]:
    """Names of the layers, each once: "layer 3" where one has none, numbered where several share one."""
    names: list[str] = []
    for number, layer in enumerate(road.layers, start=1):
        name = layer.name or f"layer {number}"
        names.append(name if name not in names else f"{name} {number}")
    return tuple(names)


def pose(
    structure: Pavement,
    *,
    fixed: Collection[str] = (),
    bounds: Mapping[str, tuple[float | str, float | str]] | None = None,
    priors: Mapping[str, float | str | tuple[float | str, float | str]] | None = None,
    stiff_layer: float | str | tuple[float | str, float | str] | None = STIFF_LAYER,
    memory: bool = False,
) -> Unknowns:
    """The question to a structure, checked; arguments as those of `backcalculate`. Raises InputError.

    memory: whether what was measured takes viscoelastic layers; else it takes stress-dependent ones.
    """
    if not isinstance(structure, Pavement):
        raise InputError(f"structure must be a Pavement, got {type(structure).__name__}")
    names = layer_names(structure)
    _check_layers(structure, names, memory)
    for what, keys in (("fixed", fixed), ("bounds", bounds or {}), ("priors", priors or {})):
        wrong = next((name for name in keys if name not in names and (what != "bounds" or name != DEPTH)), None)
        if wrong is not None:
            raise InputError(f"{what}: the structure has no layer {wrong!r}; {nearest(str(wrong), names)}")
    without_search = set(fixed)
    clash = sorted(without_search & {*(bounds or {}), *(priors or {})})
    if clash:
        raise InputError(f"{clash[0]!r} is fixed and has bounds or a prior as well; leave one of them out")
    for number, layer in enumerate(structure.layers):
        if names[number] in without_search and isinstance(layer.material, TemperatureDependent):
            raise InputError(f"{names[number]!r} is fixed and depends on temperature; give its modulus as Elastic")
    sought = tuple(number for number, name in enumerate(names) if name not in without_search)
    if not sought:
        raise InputError("all layers are fixed: nothing is sought; leave a layer out of fixed")
    limits = tuple(_bounds(names[number], (bounds or {}).get(names[number])) for number in sought)
    centres = tuple(
        _prior(names[number], structure.layers[number], (priors or {}).get(names[number])) for number in sought
    )
    road, depth, sought_depth, depth_bounds = _bottom(structure, stiff_layer)
    if sought_depth and structure.depends_on_stress:
        raise InputError(
            "the depth of the stiff layer cannot be sought together with stress-dependent layers, whose division "
            'over depth follows it; state one depth, stiff_layer="10 m", and compare several'
        )
    return Unknowns(road, sought, limits, centres, depth, sought_depth, depth_bounds)


def poisson_of(layer: Layer) -> float:
    """Poisson's ratio of a layer, also of one whose modulus waits for a temperature."""
    material = elastic_part(layer.material)
    settled = material.at(_MILD) if isinstance(material, TemperatureDependent) else material
    if isinstance(settled, StressDependent):
        settled = settled.nominal
    assert not isinstance(settled, Anisotropic)  # `_check_layers` has seen to it
    return float(settled.poisson)


def modulus_of(layer: Layer) -> float:
    """Young's modulus of a layer, Pa; |E*| at the reference frequency of a viscoelastic one.

    Of a stress-dependent one at the nominal stress. NaN of one that waits for a temperature.
    """
    material = elastic_part(layer.material)
    return math.nan if isinstance(material, TemperatureDependent) else modulus_at(material)


def modulus_at(material: object) -> float:
    """Young's modulus of a material, Pa; |E*| at the reference frequency of a viscoelastic one."""
    if isinstance(material, StressDependent):
        material = material.nominal
    if isinstance(material, Elastic):
        return float(material.modulus)
    assert hasattr(material, "complex_modulus")
    return float(np.abs(material.complex_modulus(np.array([2 * math.pi * REFERENCE_FREQUENCY])))[0])


def has_memory(layer: Layer) -> bool:
    """True of a viscoelastic layer, also of one that waits for a temperature."""
    material = elastic_part(layer.material)
    settled = material.at(_MILD) if isinstance(material, TemperatureDependent) else material
    return hasattr(settled, "complex_modulus")


def relative_modulus(layer: Layer, omega: Array, temperature: float) -> ComplexArray:
    """E*(ω) over |E*| at the reference frequency, both at a temperature, °C; 1 of an elastic layer.

    omega: rad/s, > 0. Raises InputError outside the data of a material, and where it needs a temperature that is
    NaN.
    """
    material = elastic_part(layer.material)
    if not has_memory(layer):
        return np.ones(len(omega), complex)
    if isinstance(material, TemperatureDependent):
        if not math.isfinite(temperature):
            raise InputError(f"layer {layer.name!r} needs the temperature of the asphalt, and none is known here")
        material = material.at(temperature)
    assert hasattr(material, "complex_modulus")
    modulus: ComplexArray = material.complex_modulus(omega)
    return modulus / modulus_at(material)


def _check_layers(structure: Pavement, names: tuple[str, ...], memory: bool) -> None:
    for name, layer in zip(names, structure.layers, strict=True):
        material = elastic_part(layer.material)
        if isinstance(material, Elastic):
            continue
        if isinstance(material, TemperatureDependent) and isinstance(material.at(_MILD), Elastic):
            continue
        if memory and has_memory(layer):
            continue
        if isinstance(material, StressDependent):
            _check_law(name, material, memory)
            continue
        raise InputError(
            f"layer {name!r} is {material}: a static basin takes isotropic elastic layers and mixes with a modulus "
            "over temperature; give an Elastic with its Poisson's ratio"
        )
    if len(structure.bond_limits) > 1 or structure.parted is not None:
        raise InputError(
            "half-bonded and debonded interfaces with friction have no single static basin; take BONDED, "
            "FRICTIONLESS or Bond(stiffness=...)"
        )


def _check_law(name: str, material: StressDependent, memory: bool) -> None:
    if memory:
        raise InputError(
            f"layer {name!r} is {material}: rolling wheels and time histories are fitted with one modulus a layer; "
            "give an Elastic, or fit the peaks of a falling weight at several loads"
        )
    if isinstance(material.law, Boyce):
        raise InputError(
            f"layer {name!r} is {material}, whose Poisson's ratio follows the stress as well; basins take the laws "
            "KTheta, Uzan, Universal and Bilinear, at a Poisson's ratio that is stated"
        )


def _bounds(name: str, limits: tuple[float | str, float | str] | None) -> tuple[float, float]:
    if limits is None:
        return BOUNDS
    low, high = (quantity(value, "Pa") for value in _pair(f"bounds of {name}", limits))
    if not 0 < low < high:
        raise InputError(f"bounds of {name} must be two moduli above 0 that rise, got {low:g} and {high:g} Pa")
    return low, high


def _prior(
    name: str, layer: Layer, prior: float | str | tuple[float | str, float | str] | None
) -> tuple[float, float] | None:
    """Mean of ln E and its deviation.

    prior: coefficient of variation about the layer's modulus, or (modulus, it).
    """
    if prior is None:
        return None
    if isinstance(prior, tuple | list):
        centre, variation = _pair(f"prior of {name}", prior)
        modulus = quantity(centre, "Pa")
    else:
        modulus, variation = modulus_of(layer), prior
    if math.isnan(modulus):
        raise InputError(f"the prior of {name} needs a modulus, (modulus, coefficient of variation): it has none yet")
    positive(f"prior of {name}: modulus", modulus, "Pa")
    part = quantity(variation, "")
    if not 0 < part <= _WIDEST:
        raise InputError(
            f"the prior of {name} needs a coefficient of variation in (0, {_WIDEST:g}], got {part:g}; 0.3 is usual"
        )
    return math.log(modulus), math.sqrt(math.log1p(part * part))


def _pair(what: str, pair: object) -> tuple[float | str, float | str]:
    if not isinstance(pair, tuple | list) or len(pair) != 2:
        raise InputError(f"{what} must be two values, got {pair!r}")
    return pair[0], pair[1]


def _bottom(
    structure: Pavement, stiff_layer: float | str | tuple[float | str, float | str] | None
) -> tuple[Pavement, float | None, bool, tuple[float, float]]:
    """The road, the depth of the stiff layer or None, whether the depth is sought, and its bounds."""
    if structure.rigid_base:
        if isinstance(stiff_layer, tuple | list):
            raise InputError("the structure has a rigid base of its own: leave stiff_layer out, or the rigid base")
        return structure, float(structure.interfaces[-1]), False, (0.0, 0.0)
    if stiff_layer is None:
        return structure, None, False, (0.0, 0.0)
    top = float(structure.interfaces[-1]) if len(structure.layers) > 1 else 0.0
    if isinstance(stiff_layer, tuple | list):
        low, high = (quantity(value, "m") for value in _pair("stiff_layer", stiff_layer))
        if not top + _LEAST_DEPTH <= low < high <= _MOST_DEPTH:
            raise InputError(
                f"stiff_layer must rise from at least {top + _LEAST_DEPTH:g} m, {_LEAST_DEPTH:g} m below the top of "
                f"the last layer, to at most {_MOST_DEPTH:g} m, got {low:g} and {high:g} m"
            )
        return structure, math.sqrt(low * high), True, (low, high)
    depth = quantity(stiff_layer, "m")
    if not depth >= top + _LEAST_DEPTH:
        raise InputError(
            f"stiff_layer must lie at least {_LEAST_DEPTH:g} m below the top of the last layer at {top:g} m, got "
            f"{depth:g} m; give its depth below the surface, or None for a half-space"
        )
    return structure, depth, False, (0.0, 0.0)
