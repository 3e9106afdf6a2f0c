"""The road: layers on a half-space or a rigid base, and how they are bonded."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from treadload.describing import as_call
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.layers.depths import SAME_DEPTH, layers_at
from treadload.materials import Material, StressDependent, TemperatureDependent
from treadload.materials.celsius import check_celsius
from treadload.materials.kinds import AnyElastic, elastic_part, limit_of
from treadload.materials.plastic import ElastoPlastic
from treadload.pavement.bonds import BONDED, Parted
from treadload.pavement.catalogue import Structure, find_structure
from treadload.pavement.layer import Layer
from treadload.pavement.temperature import TemperatureProfile


@dataclass(frozen=True)
class Pavement:
    """Layers from the surface down; the last one has no thickness, unless it lies on a rigid base.

    layers: from the surface down. rigid_base: True if the last layer, then with a thickness, is bonded to rock
    that does not move. Raises InputError for a missing or surplus thickness and a bond below the last layer.

    >>> road = tl.Pavement([tl.Layer(tl.Elastic(5e9, 0.35), 0.15), tl.Layer(tl.Elastic(60e6, 0.4))])
    >>> len(road.layers)
    2
    >>> tl.Pavement.from_catalogue("6 BBSG3 / 15 GB3 / PF3", temperature=15).layers[1].name
    'EB-GB3'
    """

    layers: tuple[Layer, ...]
    rigid_base: bool = False

    def __init__(self, layers: Sequence[Layer], *, rigid_base: bool = False) -> None:
        if not isinstance(layers, Iterable):
            raise InputError(f"layers must be a list of Layer, got {type(layers).__name__}; write Pavement([...])")
        object.__setattr__(self, "layers", tuple(layers))
        object.__setattr__(self, "rigid_base", bool(rigid_base))
        if not self.layers:
            raise InputError("a pavement needs at least one layer, got none")
        for number, layer in enumerate(self.layers, start=1):
            if not isinstance(layer, Layer):
                raise InputError(
                    f"layer {number} must be a Layer, got {type(layer).__name__}; write Layer(material, thickness)"
                )
        for number, layer in enumerate(self.layers[:-1], start=1):
            if layer.thickness is None:
                raise InputError(
                    f"layer {number} ({layer.name!r}) of {len(self.layers)} has no thickness; "
                    "only the last layer is semi-infinite"
                )
        last = self.layers[-1]
        if self.rigid_base and last.thickness is None:
            raise InputError(
                f"the last layer ({last.name!r}) lies on a rigid base and needs a thickness, got none; "
                "give one or remove the rigid base"
            )
        if not self.rigid_base and last.thickness is not None:
            raise InputError(
                f"the last layer ({last.name!r}) must have no thickness, "
                f"got {last.thickness} m; add the soil below it as a layer without thickness"
            )
        if last.bond != BONDED:
            raise InputError(
                f"the last layer ({last.name!r}) has no layer below it to be bonded to, got the bond {last.bond}; "
                "give the bond to the layer above the interface"
            )

    @classmethod
    def half_space(
        cls, material: Material | TemperatureDependent | ElastoPlastic | StressDependent, name: str = ""
    ) -> Pavement:
        """A homogeneous half-space."""
        return cls([Layer(material, name=name)])

    @classmethod
    def from_catalogue(
        cls,
        name: str | Structure,
        *,
        temperature: float | Sequence[float | None] | TemperatureProfile | None = None,
        frequency: float | None = None,
    ) -> Pavement:
        """A road by its name in `treadload.catalogue.structures`, or written as layers of the catalogue's mixes.

        name: "6 BBSG3 / 10 GB3 / 10 GB3 / PF3": thickness in cm (or with its unit, "60 mm BBSG3") and mix, "EB-" left
        out or not, from the surface down; the last without thickness. Layers written so are bonded, and half-bonded
        between two that are treated with cement, slag or ash. Or one of those structures itself.
        temperature: as for `at_temperature`; left out, the bituminous layers wait for theirs. frequency: of
        loading, Hz, at which their moduli are read; left out, that of their data, 10 Hz for the French ones.
        Raises InputError for an unknown name, which it compares with the known ones, and as `at_temperature` does.
        """
        structure = name if isinstance(name, Structure) else find_structure(name)
        road = cls(structure.layers(frequency=frequency))
        return road if temperature is None else road.at_temperature(temperature)

    @property
    def surface_material(self) -> AnyElastic:
        """Elastic material of the top layer; of a viscoelastic one the limit of fast loads, see `at_nominal_stress`.

        Raises InputError for a material that needs a temperature.
        """
        return limit_of(self.at_nominal_stress.layers[0].resolved, "glassy")

    @property
    def distinct_layers(self) -> tuple[Layer, ...]:
        """The layers, with neighbours of one material that are bonded taken as one."""
        joined = [self.layers[0]]
        for layer in self.layers[1:]:
            above = joined[-1]
            if above.bond != BONDED or elastic_part(above.material) != elastic_part(layer.material):
                joined.append(layer)
                continue
            assert above.thickness is not None
            thickness = None if layer.thickness is None else above.thickness + layer.thickness
            joined[-1] = replace(above, thickness=thickness, bond=layer.bond)
        return tuple(joined)

    @property
    def interfaces(self) -> Array:
        """Depth of the bottom of every layer that has one, m, downwards; empty for a half-space."""
        return np.cumsum([layer.thickness for layer in self.layers if layer.thickness is not None])

    def layer_at(self, depth: float, side: Literal["above", "below"] = "above") -> int:
        """Number of the layer, from the surface, 0 the top one, that holds a depth, m.

        side: on an interface, within round-off (1e-9 m), the layer above or below it. A rigid base has no number:
        its top belongs to the last layer. Raises InputError for a negative depth and one below a rigid base.
        """
        if not depth >= 0:
            raise InputError(f"depth must be >= 0 m, got {depth:g}; depth counts downwards")
        if not self.reaches(depth):
            raise InputError(
                f"depth {depth:g} m lies below the rigid base at {self.interfaces[-1]:g} m; leave it out"
            )
        return int(layers_at([depth], self.interfaces[: len(self.layers) - 1], side == "below")[0])

    def reaches(self, depth: float) -> bool:
        """False below a rigid base by more than round-off; else True."""
        return not self.rigid_base or depth <= float(self.interfaces[-1]) + SAME_DEPTH

    @property
    def is_homogeneous(self) -> bool:
        """True if the road is one half-space: one material, bonded, without rigid base."""
        return len(self.distinct_layers) == 1 and not self.rigid_base and not self.depends_on_stress

    @property
    def is_viscoelastic(self) -> bool:
        """True if a layer is viscoelastic: its response needs the speed of the load.

        Raises InputError for a layer that needs a temperature.
        """
        return any(
            not layer.depends_on_stress and not isinstance(layer.resolved, AnyElastic) for layer in self.layers
        )

    @property
    def depends_on_stress(self) -> bool:
        """True if the modulus of a layer follows from the loads, see `response.settle`."""
        return any(layer.depends_on_stress for layer in self.layers)

    @property
    def at_nominal_stress(self) -> Pavement:
        """The road with stress-dependent layers under the stress of a usual truck; itself if there is none.

        A contact takes it, for which the moduli of the layers hardly matter.
        """
        if not self.depends_on_stress:
            return self
        return self._with_materials(
            [
                layer.material.nominal if isinstance(layer.material, StressDependent) else layer.material
                for layer in self.layers
            ]
        )

    @property
    def glassy(self) -> Pavement:
        """The elastic road of fast loads: viscoelastic layers at their glassy limit.

        Raises InputError for a layer that needs a temperature.
        """
        return self._with_materials([limit_of(layer.resolved, "glassy") for layer in self.layers])

    @property
    def rubbery(self) -> Pavement:
        """The elastic road of slow loads: viscoelastic layers at their rubbery limit.

        Raises InputError for a layer that needs a temperature, and for a fluid, which has no such limit.
        """
        return self._with_materials([limit_of(layer.resolved, "rubbery") for layer in self.layers])

    @property
    def bond_limits(self) -> tuple[Pavement, ...]:
        """The roads whose mean response is that of this one: itself, or without its half-bonded interfaces two.

        The first of two has all of them bonded, the second all frictionless. Raises InputError for bonds that stand
        for different numbers of others.
        """
        counts = {len(layer.bond.limits) for layer in self.layers} - {1}
        if not counts:
            return (self,)
        if len(counts) > 1:
            raise InputError(f"bonds that stand for {sorted(counts)} others cannot be in one road; take one of them")
        return tuple(
            Pavement(
                [replace(layer, bond=layer.bond.limits[k % len(layer.bond.limits)]) for layer in self.layers],
                rigid_base=self.rigid_base,
            )
            for k in range(counts.pop())
        )

    @property
    def parted(self) -> int | None:
        """Number of the interface, 0 below the top layer, that has debonded and carries friction; None if there is
        none.

        Raises InputError for several.
        """
        debonded = [k for k, layer in enumerate(self.layers) if isinstance(layer.bond, Parted)]
        if len(debonded) > 1:
            names = " and ".join(str(k + 1) for k in debonded)
            raise InputError(
                f"interfaces {names} are both parted with friction, and a response follows one such face; give the "
                "others FRICTIONLESS or Bond(stiffness=...)"
            )
        return debonded[0] if debonded else None

    @property
    def sticking(self) -> Pavement:
        """The road while nothing slides on a parted face: that face bonded; itself if there is none."""
        if self.parted is None:
            return self
        return Pavement(
            [replace(layer, bond=layer.bond.sticking) for layer in self.layers], rigid_base=self.rigid_base
        )

    def at_temperature(
        self, temperature: float | Sequence[float | None] | TemperatureProfile, *, extrapolate: bool = False
    ) -> Pavement:
        """The road with the materials that its layers have at a temperature; others stay as they are.

        temperature: °C, one for all layers; or a list with one per layer, None to leave that layer as it is; or a
        TemperatureProfile, of which a layer takes the temperature at its middle, as is usual.
        extrapolate: True to go beyond the data of materials and profile.
        Raises InputError for what looks like kelvin, a list of another length, temperatures outside the data, and
        a profile for a semi-infinite layer, which has no middle.
        """
        values = self.layer_temperatures(temperature, extrapolate=extrapolate)
        pairs = zip(self.layers, values, strict=True)
        return Pavement([_at(layer, value, extrapolate) for layer, value in pairs], rigid_base=self.rigid_base)

    def layer_temperatures(
        self, temperature: float | Sequence[float | None] | TemperatureProfile, *, extrapolate: bool = False
    ) -> list[float | None]:
        """Temperature that `at_temperature` gives each layer, °C; None where it is not needed or not given.

        Arguments and errors as there.
        """
        if isinstance(temperature, TemperatureProfile):
            return [
                self._middle_temperature(number, temperature, extrapolate) if layer.depends_on_temperature else None
                for number, layer in enumerate(self.layers)
            ]
        if isinstance(temperature, str) or not isinstance(temperature, Iterable):
            return [check_celsius(temperature)] * len(self.layers)
        values = list(temperature)
        if len(values) != len(self.layers):
            raise InputError(
                f"a list of temperatures needs one for each of the {len(self.layers)} layers, None to leave a layer "
                f"as it is, got {len(values)}"
            )
        return [None if value is None else check_celsius(value) for value in values]

    def _middle_temperature(self, number: int, profile: TemperatureProfile, extrapolate: bool) -> float:
        layer = self.layers[number]
        if layer.thickness is None:
            raise InputError(
                f"layer {layer.name!r} is semi-infinite and has no middle to read a temperature profile at; "
                "give a list with one temperature per layer"
            )
        middle = float(self.interfaces[number]) - 0.5 * layer.thickness
        with _naming(layer):
            return profile.temperature_at(middle, extrapolate=extrapolate)

    def _with_materials(self, materials: Sequence[Material | TemperatureDependent | ElastoPlastic]) -> Pavement:
        pairs = zip(self.layers, materials, strict=True)
        return Pavement([replace(layer, material=material) for layer, material in pairs], rigid_base=self.rigid_base)

    __repr__ = as_call


def _at(layer: Layer, temperature: float | None, extrapolate: bool) -> Layer:
    if temperature is None or not layer.depends_on_temperature:
        return layer
    with _naming(layer):
        material = layer.material
        if isinstance(material, TemperatureDependent):
            material = material.at(temperature, extrapolate=extrapolate)
        return replace(layer, material=material, bond=layer.bond.at(temperature))


@contextmanager
def _naming(layer: Layer) -> Iterator[None]:
    """Name the layer in an InputError."""
    try:
        yield
    except InputError as error:
        raise InputError(f"layer {layer.name!r}: {error}") from error
