"""Materials of a road in a case: elastic, or viscoelastic with times that may depend on temperature."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Annotated, Literal

from pydantic import BeforeValidator, Discriminator, Tag

from treadload.case.fields import Compliance, Modulus, Number, Part, Time
from treadload.case.kinds import known_kind
from treadload.case.materials import MaterialPart, kind_of_material
from treadload.case.shift import Shift
from treadload.materials import (
    HuetSayegh,
    Material,
    Model2S2P1D,
    PowerLawCreep,
    Prony,
    TemperatureDependent,
    Thermorheological,
    published_material,
)

Viscoelastic = Prony | HuetSayegh | Model2S2P1D | PowerLawCreep


class ViscoelasticPart(Part, ABC):
    """What all viscoelastic materials of a road share.

    shift: how their times depend on temperature; without it the material is the same at all.
    """

    shift: Shift | None = None

    @abstractmethod
    def at_reference(self) -> Viscoelastic:
        """The material at the reference temperature of the shift."""

    def build(self) -> Material | TemperatureDependent:
        """The material; one that waits for its temperature if it has a shift."""
        material = self.at_reference()
        if self.shift is None:
            return material
        return Thermorheological(material, self.shift.build(), self.shift.tested)


class RoadPronyPart(ViscoelasticPart):
    """`material = { kind = "prony", modulus = "10 GPa", terms = [[0.7, "10 ms"]], poisson = 0.35 }`."""

    kind: Literal["prony"]
    modulus: Modulus
    terms: tuple[tuple[Number, Time], ...]
    poisson: Number

    def at_reference(self) -> Prony:
        """The material at the reference temperature of the shift."""
        return Prony(self.modulus, self.terms, self.poisson)


class HuetSayeghPart(ViscoelasticPart):
    """`material = { kind = "huet-sayegh", glassy_modulus = "40 GPa", static_modulus = "18 MPa", delta = 2.4, … }`."""

    kind: Literal["huet-sayegh"]
    glassy_modulus: Modulus
    static_modulus: Modulus
    delta: Number
    k: Number
    h: Number
    tau: Time
    poisson: Number

    def at_reference(self) -> HuetSayegh:
        """The material at the reference temperature of the shift."""
        return HuetSayegh(
            self.glassy_modulus, self.static_modulus, self.delta, self.k, self.h, self.tau, self.poisson
        )


class Model2S2P1DPart(ViscoelasticPart):
    """`material = { kind = "2s2p1d", … }`: as huet-sayegh, and beta."""

    kind: Literal["2s2p1d"]
    glassy_modulus: Modulus
    static_modulus: Modulus
    delta: Number
    k: Number
    h: Number
    beta: Number
    tau: Time
    poisson: Number

    def at_reference(self) -> Model2S2P1D:
        """The material at the reference temperature of the shift."""
        return Model2S2P1D(
            self.glassy_modulus, self.static_modulus, self.delta, self.k, self.h, self.beta, self.tau, self.poisson
        )


class PowerLawCreepPart(ViscoelasticPart):
    """`material = { kind = "power-law-creep", instantaneous_compliance = "2.5e-5 1/MPa", … }`."""

    kind: Literal["power-law-creep"]
    instantaneous_compliance: Compliance
    long_term_compliance: Compliance
    tau: Time
    exponent: Number
    poisson: Number

    def at_reference(self) -> PowerLawCreep:
        """The material at the reference temperature of the shift."""
        return PowerLawCreep(
            self.instantaneous_compliance, self.long_term_compliance, self.tau, self.exponent, self.poisson
        )


class PublishedPart(Part):
    """`material = { kind = "published", name = "ViscoRoute" }`: of the catalogue of viscoelastic materials."""

    kind: Literal["published"]
    name: str

    def build(self) -> Material | TemperatureDependent:
        """The material. Raises InputError for an unknown name."""
        return published_material(self.name).material


ROAD_PARTS: dict[str, type[Part]] = {
    "elastic": MaterialPart,
    "prony": RoadPronyPart,
    "huet-sayegh": HuetSayeghPart,
    "2s2p1d": Model2S2P1DPart,
    "power-law-creep": PowerLawCreepPart,
    "published": PublishedPart,
}

# What a layer can be made of; the kind tells the tables apart.
RoadMaterial = Annotated[
    Annotated[MaterialPart, Tag("elastic")]
    | Annotated[RoadPronyPart, Tag("prony")]
    | Annotated[HuetSayeghPart, Tag("huet-sayegh")]
    | Annotated[Model2S2P1DPart, Tag("2s2p1d")]
    | Annotated[PowerLawCreepPart, Tag("power-law-creep")]
    | Annotated[PublishedPart, Tag("published")],
    Discriminator(kind_of_material),
    BeforeValidator(lambda value: known_kind(value, ROAD_PARTS, "material", "elastic")),
]
