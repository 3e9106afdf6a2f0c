"""The road in a case: layers or a catalogued structure, how they hold together, and how warm they are."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Discriminator, Tag, model_validator

from treadload.case.asphalt import RoadMaterial
from treadload.case.fields import Celsius, Frequency, Length, Part, Stiffness
from treadload.materials import Material, Mix, TemperatureDependent, mix
from treadload.pavement import (
    BONDED,
    FRICTIONLESS,
    HALF_BONDED,
    Bond,
    HalfBonded,
    Layer,
    Pavement,
    TemperatureProfile,
)

BOND_TAGS = ("word", "spring")
TEMPERATURE_TAGS = ("one", "layers", "depths")
_BONDS: dict[str, Bond | HalfBonded] = {
    "bonded": BONDED,
    "half-bonded": HALF_BONDED,
    "frictionless": FRICTIONLESS,
}


class BondPart(Part):
    """`bond = { stiffness = "1000 MPa/m" }`."""

    stiffness: Stiffness


def _known_bond(value: Any) -> Any:
    """A bond in one of our forms. Raises ValueError that says which they are."""
    if isinstance(value, dict | BondPart) or (isinstance(value, str) and value in _BONDS):
        return value
    raise ValueError(f'a bond is {", ".join(map(repr, _BONDS))} or {{ stiffness = "1000 MPa/m" }}, got {value!r}')


def _finite(value: Any) -> Any:
    if isinstance(value, str) and value.strip().lower().startswith("inf"):
        raise ValueError(f"a semi-infinite layer is the last one: leave its thickness out, got {value!r}")
    return value


class LayerPart(Part):
    """`[[pavement.layers]]`, from the surface down; the last one has no thickness unless the base is rigid.

    material: a table, or mix: a name of the catalogue of road materials. bond, to the layer below: "bonded",
    "half-bonded", "frictionless" or `{ stiffness = "1000 MPa/m" }`. name: left out, that of the mix.
    """

    material: RoadMaterial | None = None
    mix: str | None = None
    thickness: Annotated[Length | None, BeforeValidator(_finite)] = None
    name: str = ""
    bond: Annotated[
        Annotated[Literal["bonded", "half-bonded", "frictionless"], Tag("word")] | Annotated[BondPart, Tag("spring")],
        Discriminator(lambda v: "word" if isinstance(v, str) else "spring"),
        BeforeValidator(_known_bond),
    ] = "bonded"

    @model_validator(mode="after")
    def _one_material(self) -> LayerPart:
        if (self.material is None) == (self.mix is None):
            got = "none" if self.material is None else "both"
            raise ValueError(f"a layer needs either a material or the name of a mix, got {got} of them")
        return self

    def build(self, frequency: float | None = None) -> Layer:
        """The layer; a mix at a frequency of loading, Hz, is read there."""
        bond = Bond(self.bond.stiffness) if isinstance(self.bond, BondPart) else _BONDS[self.bond]
        return Layer(self._material(frequency), self.thickness, name=self.name or self.mix or "", bond=bond)

    def _material(self, frequency: float | None) -> Material | TemperatureDependent:
        if self.material is not None:
            return self.material.build()
        assert self.mix is not None
        found = mix(self.mix)
        return found.with_frequency(frequency) if frequency is not None and isinstance(found, Mix) else found


class ProfilePart(Part):
    """`temperature = { depths = ["0 mm", "100 mm"], values = [45, 30] }`: each layer takes that of its middle."""

    depths: tuple[Length, ...]
    values: tuple[Celsius, ...]

    def build(self) -> TemperatureProfile:
        """The profile."""
        return TemperatureProfile(self.depths, self.values)


def _kind_of_temperature(value: Any) -> str:
    if isinstance(value, dict | ProfilePart):
        return "depths"
    return "layers" if isinstance(value, list | tuple) else "one"


# °C: of the whole road, of each of its layers, or over depth.
Temperature = Annotated[
    Annotated[Celsius, Tag("one")]
    | Annotated[tuple[Celsius, ...], Tag("layers")]
    | Annotated[ProfilePart, Tag("depths")],
    Discriminator(_kind_of_temperature),
]


class PavementPart(Part):
    """`[pavement]`: the road's layers, or a structure of the catalogue, and its temperature.

    structure: a name, or layers, "6 BBSG3 / 10 GB3 / 10 GB3 / PF3", see `Pavement.from_catalogue`. temperature: °C,
    one, one a layer, or over depth. frequency: of loading, Hz, at which the catalogue's mixes are read; left out,
    that of their data, 10 Hz. extrapolate: True to go beyond the data of the materials.
    """

    layers: tuple[LayerPart, ...] | None = None
    structure: str | None = None
    rigid_base: bool = False
    temperature: Temperature | None = None
    frequency: Frequency | None = None
    extrapolate: bool = False

    @model_validator(mode="after")
    def _one_road(self) -> PavementPart:
        if (self.layers is None) == (self.structure is None):
            got = "none" if self.layers is None else "both"
            raise ValueError(f"give either layers or the name of a structure, got {got} of them")
        if self.structure is not None and self.rigid_base:
            raise ValueError("a structure of the catalogue has its own base; rigid_base belongs to layers")
        return self

    @model_validator(mode="after")
    def _one_temperature(self) -> PavementPart:
        warm = [layer.material for layer in self.untempered().layers if layer.depends_on_temperature]
        if self.temperature is not None and not warm:
            raise ValueError("temperature changes nothing here: no layer is a mix or has a shift; leave it out")
        if self.frequency is not None and not any(isinstance(material, Mix) for material in warm):
            raise ValueError("frequency changes nothing here: no layer is a bituminous mix of the catalogue")
        if self.temperature is None and warm:
            raise ValueError(f"the road needs a temperature, temperature = 15 in °C: it holds {warm[0]}")
        return self

    def untempered(self) -> Pavement:
        """The pavement whose materials still wait for their temperature."""
        if self.structure is not None:
            return Pavement.from_catalogue(self.structure, frequency=self.frequency)
        assert self.layers is not None
        return Pavement([layer.build(self.frequency) for layer in self.layers], rigid_base=self.rigid_base)

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
        found = road.layer_temperatures(self._temperature(), extrapolate=self.extrapolate)
        pairs = zip(road.layers, found, strict=True)
        return [value if layer.depends_on_temperature else None for layer, value in pairs]

    def _temperature(self) -> float | tuple[float, ...] | TemperatureProfile:
        assert self.temperature is not None
        return self.temperature.build() if isinstance(self.temperature, ProfilePart) else self.temperature
