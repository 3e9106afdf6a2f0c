"""The road in a case: layers or a catalogued structure, how they are bonded, and how warm they are."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Self

from pydantic import BeforeValidator, model_validator

from treadload.case.choices import BOND, PLASTIC, BondTable, PlasticTable, RoadMaterial
from treadload.catalogue import mixes
from treadload.materials import ElastoPlastic, Material, Mix, StressDependent, TemperatureDependent
from treadload.materials.tables import ROAD_MATERIAL
from treadload.pavement import Layer, Pavement, TemperatureProfile
from treadload.read import As, Table, table_of
from treadload.units import Celsius, Frequency, Length


def _finite(value: object) -> object:
    if isinstance(value, str) and value.strip().lower().startswith("inf"):
        raise ValueError(f"a semi-infinite layer is the last one: leave its thickness out, got {value!r}")
    return value


class LayerPart(Table):
    """`[[pavement.layers]]`, from the surface down; the last one has no thickness unless the base is rigid.

    material: a table; or mix. mix: a name of the catalogue of road materials. thickness: left out, the layer is
    semi-infinite; 0, it is absent, and the layers around it meet with the bond of the upper. bond: to the layer
    below, "bonded", "half-bonded", "frictionless", `{ stiffness = "1000 MPa/m" }` or of another kind. name: left out,
    that of the mix. plasticity: how an elastic material yields.
    """

    one_of: ClassVar = ("material", "mix")

    material: RoadMaterial | None = None
    mix: str | None = None
    thickness: Annotated[Length | None, BeforeValidator(_finite)] = None
    name: str = ""
    bond: BondTable = "bonded"
    plasticity: PlasticTable | None = None

    @model_validator(mode="after")
    def _one_material(self) -> LayerPart:
        if (self.material is None) == (self.mix is None):
            got = "none" if self.material is None else "both"
            raise ValueError(f"a layer needs either a material or the name of a mix, got {got} of them")
        if self.plasticity is not None and self.mix is not None:
            raise ValueError("plasticity belongs to an elastic material: give the modulus of the mix as a material")
        return self

    def build(self, frequency: float | None = None) -> Layer:
        """The layer; a mix at a frequency of loading, Hz, is read there."""
        return Layer(self._material(frequency), self.thickness, name=self.label, bond=BOND.build(self.bond))

    @property
    def label(self) -> str:
        """Its name, else that of its mix."""
        return self.name or self.mix or ""

    def _material(self, frequency: float | None) -> Material | TemperatureDependent | ElastoPlastic | StressDependent:
        if self.material is not None:
            material: Any = ROAD_MATERIAL.build(self.material)
            if self.plasticity is not None:
                material = ElastoPlastic(material, PLASTIC.build(self.plasticity))
            return material  # type: ignore[no-any-return]
        assert self.mix is not None
        mix = mixes[self.mix]
        return mix.with_frequency(frequency) if frequency is not None and isinstance(mix, Mix) else mix


def _profile(depths: tuple[Length, ...], values: tuple[Celsius, ...]) -> TemperatureProfile:
    """`temperature = { depths = ["0 mm", "100 mm"], values = [45, 30] }`: each layer takes that of its middle.

    depths: downwards, two or more. values: temperatures there.
    """
    return TemperatureProfile(depths, values)


# °C: of the whole road, of each of its layers, or over depth.
TEMPERATURE = As(Celsius | tuple[Celsius, ...] | table_of(_profile))


class RoadPart(Table):
    """The road's layers, or a structure of the catalogue.

    layers: from the surface down. structure: a name, or layers, "6 BBSG3 / 10 GB3 / 10 GB3 / PF3", see
    `Pavement.from_catalogue`. rigid_base: True if the last layer lies on rock. frequency: of loading, at
    which the catalogue's mixes are read; left out, that of their data, 10 Hz.
    """

    one_of: ClassVar = ("layers", "structure")

    layers: tuple[LayerPart, ...] | None = None
    structure: str | None = None
    rigid_base: bool = False
    frequency: Frequency | None = None

    @model_validator(mode="after")
    def _one_road(self) -> Self:
        if (self.layers is None) == (self.structure is None):
            got = "none" if self.layers is None else "both"
            raise ValueError(f"give either layers or the name of a structure, got {got} of them")
        if self.structure is not None and self.rigid_base:
            raise ValueError("a structure of the catalogue has its own base; rigid_base belongs to layers")
        if self.layers is not None and len(self.absent) == len(self.layers):
            raise ValueError(f"the thickness of all {len(self.layers)} layers is 0, so that no road is left")
        # Refused at its own key, whoever asks for the road first.
        self.untempered()
        return self

    @property
    def absent(self) -> tuple[int, ...]:
        """Numbers of the layers of thickness 0, which the road does not have, from 0 at the surface."""
        return tuple(number for number, layer in enumerate(self.layers or ()) if layer.thickness == 0)

    def untempered(self) -> Pavement:
        """The pavement whose materials still wait for their temperature."""
        if self.structure is not None:
            return Pavement.from_catalogue(self.structure, frequency=self.frequency)
        assert self.layers is not None
        layers = [layer.build(self.frequency) for layer in self.layers if layer.thickness != 0]
        return Pavement(layers, rigid_base=self.rigid_base)


def _waits(part: object) -> bool:
    return isinstance(part, TemperatureDependent) or getattr(part, "depends_on_temperature", False) is True


class PavementPart(RoadPart):
    """`[pavement]`: the road's layers, or a structure of the catalogue, and its temperature.

    temperature: one for all layers, one for each, or a profile over depth. extrapolate: True to go beyond the data of
    the materials.
    """

    temperature: Annotated[Any, TEMPERATURE] = None
    extrapolate: bool = False

    def check_temperature(self) -> None:
        """Refuse a temperature that changes nothing, and a road that waits for one. Raises ValueError."""
        layers = [layer for layer in self.untempered().layers if layer.depends_on_temperature]
        warm = [part for layer in layers for part in (layer.material, layer.bond) if _waits(part)]
        if self.temperature is not None and not warm:
            raise ValueError("temperature changes nothing here: no layer is a mix or has a shift; leave it out")
        if self.frequency is not None and not any(isinstance(material, Mix) for material in warm):
            raise ValueError("frequency changes nothing here: no layer is a bituminous mix of the catalogue")
        if self.temperature is None and warm:
            raise ValueError(f"the road needs a temperature, temperature = 15 in °C: it holds {warm[0]}")

    def build(self) -> Pavement:
        """The pavement at its temperature."""
        road = self.untempered()
        if self.temperature is None:
            return road
        return road.at_temperature(self._temperature(), extrapolate=self.extrapolate)

    def layer_temperatures(self) -> list[float | None]:
        """Temperature of each layer, °C; None where it changes nothing."""
        road = self.untempered()
        if self.temperature is None:
            return [None] * len(road.layers)
        temperatures = road.layer_temperatures(self._temperature(), extrapolate=self.extrapolate)
        pairs = zip(road.layers, temperatures, strict=True)
        return [value if layer.depends_on_temperature else None for layer, value in pairs]

    def _temperature(self) -> float | tuple[float, ...] | TemperatureProfile:
        temperature: float | tuple[float, ...] | TemperatureProfile = TEMPERATURE.build(self.temperature)
        if self.absent and isinstance(temperature, tuple) and len(temperature) == len(self.layers or ()):
            temperature = tuple(value for number, value in enumerate(temperature) if number not in self.absent)
        return temperature
