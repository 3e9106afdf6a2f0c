"""The fields of the page: keys of a case, with the unit that a person types in."""

from __future__ import annotations

import functools
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from treadload import catalogue
from treadload.case.keys import value_at
from treadload.case.model import DamagePart
from treadload.case.response import ResponsePart
from treadload.case.road import LayerPart, PavementPart
from treadload.case.tire import TirePart
from treadload.contact import Rolling
from treadload.read.signature import descriptions, words_of
from treadload.units import quantity


@dataclass(frozen=True)
class Field:
    """A field. path: of its key in the case. unit: shown beside it and meant by a bare number, "" of a pure one.

    si: the unit of the case. words: what it is. choices: value → label, where it is one of a few; kind: "number",
    "text", "choice" or "flag". otherwise: what an empty field stands for, where the case has no value of its own.
    """

    path: str
    label: str
    unit: str = ""
    si: str = ""
    kind: str = "number"
    choices: Mapping[str, str] | None = None
    words: str = ""
    otherwise: str = ""

    def shown(self, value: Any) -> str:
        """A value of a case as the field shows it, in its unit."""
        if value is None or value == "":
            return ""
        if self.kind == "flag":
            return "true" if value else "false"
        if isinstance(value, list | tuple):
            return ", ".join(self._one(item, several=True) for item in value)
        return self._one(value)

    def _one(self, value: Any, several: bool = False) -> str:
        if self.kind in ("text", "choice") and not self.unit:
            return str(value)
        try:
            number = quantity(value, self.si) / self._factor
        except ValueError:
            return str(value)
        text = f"{number:.10g}"
        return f"{text} {self.unit}".strip() if several else text

    @functools.cached_property
    def _factor(self) -> float:
        return 1.0 if self.si in ("", "degC") and not self.unit else quantity(f"1 {self.unit}", self.si)

    def read(self, text: str) -> Any:
        """What a text means as a value of the case: a bare number is in the field's unit. None for nothing."""
        bare = text.strip()
        if not bare:
            return None
        if self.kind == "flag":
            return bare == "true"
        if self.kind == "list":
            return [self._value(part.strip()) for part in bare.replace(";", ",").split(",") if part.strip()]
        return self._value(bare)

    def _value(self, bare: str) -> Any:
        if self.kind in ("text", "choice"):
            return bare
        if not self.unit or self.si == "degC":
            # A pure number; or what is none, for the reader to say so.
            try:
                return float(bare)
            except ValueError:
                return bare
        # What ends in a digit has no unit: it is in that of the field.
        return f"{bare} {self.unit}" if bare[-1].isdigit() or bare[-1] in ".," else bare


_TIRE = TirePart.about()
_ROAD = PavementPart.about()
_LAYER = LayerPart.about()
_READ = ResponsePart.about()
_DAMAGE = DamagePart.about()
_ROLLING = descriptions(words_of(Rolling), ("friction",))


def _length(path: str, label: str, words: str = "", otherwise: str = "") -> Field:
    return Field(path, label, "mm", "m", words=words, otherwise=otherwise)


SURFACES = {
    "library": "a tread of the library", "profile": "a profile of your own", "example": "the scanned example",
    "scan": "a mesh of your own", "height_map": "a height map of your own",
}  # fmt: skip
"""Where the tire's surface comes from."""
STATES = {
    "free": "rolls freely", "driving": "drives", "braking": "brakes", "turning": "turns",
    "combined": "all of these",
}  # fmt: skip
"""What the wheel does."""
ROADS = {
    "half_space": "one material, endlessly deep",
    "layers": "layers",
    "structure": "a structure of the catalogue",
}
"""How the road is given."""
TITLE = Field("title", "Title", kind="text", words="of summaries and reports")


def tire_fields(surface: str, *, has_belt: bool) -> Iterator[Field]:
    """Fields of the tire."""
    if surface == "library":
        names = {name: name for name in catalogue.tires}
        yield Field("tire.profile", "Tread", kind="choice", choices=names, words=_TIRE["profile"])
    if surface == "profile":
        yield _length("tire.profile.rolling_radius", "Rolling radius", "of the unloaded crown")
        yield _length("tire.profile.crown_radius", "Crown radius", "of the tread arc across the tire")
        yield _length("tire.profile.width", "Tread width", "there is no rubber beyond")
        yield _length("tire.profile.shoulder_radius", "Shoulder radius", "rounding into the sidewall")
    yield Field("tire.inflation_pressure", "Inflation", "bar", "Pa", words=_TIRE["inflation_pressure"],
                otherwise="" if has_belt else "none")  # fmt: skip
    if surface == "scan":
        yield Field("tire.units", "Unit of the mesh", kind="text", words=_TIRE["units"], otherwise="by its size")
        yield _length("tire.nominal_diameter", "Outer diameter", _TIRE["nominal_diameter"], "as scanned")
        yield Field("tire.camber", "Camber", "deg", "rad", words=_TIRE["camber"])
    if surface == "height_map":
        yield Field("tire.units", "Unit of the heights", kind="text", words=_TIRE["units"], otherwise="of the file")
        yield _length("tire.cell", "Cell", _TIRE["cell"], "of the file")


def groove_fields(count: int) -> Iterator[tuple[Field, ...]]:
    """Fields of each groove of a profile."""
    for number in range(count):
        before = f"tire.profile.grooves.{number}"
        yield (_length(f"{before}.centre", "at y"), _length(f"{before}.width", "wide"),
               _length(f"{before}.depth", "deep"))  # fmt: skip


BELT = Field("tire.belt", "Body", kind="choice", words=_TIRE["belt"],
             choices={"": "half-space", **{name: f"belt, {name}" for name in catalogue.belts}})  # fmt: skip
LOAD = Field("rolling.normal_load", "Load", "kN", "N", words="that the wheel carries")
FRICTION = Field("rolling.friction", "Friction", words=_ROLLING.get("friction", ""))
SPEED = Field("rolling.speed", "Speed", "km/h", "m/s", words="viscoelastic materials need it", otherwise="none")


def rolling_fields(state: str, *, by_force: bool) -> Iterator[Field]:
    """Fields of what the wheel does."""
    if state in ("driving", "braking", "combined"):
        if by_force:
            yield Field("rolling.tractive_force", "Traction", "kN", "N", words="> 0 drives, < 0 brakes")
        else:
            yield Field("rolling.creepage_x", "Creepage along", words="< 0 drives, > 0 brakes")
    if state in ("turning", "combined"):
        if by_force:
            yield Field("rolling.lateral_force", "Side force", "kN", "N", words="of the road, to the right")
        else:
            yield Field("rolling.creepage_y", "Creepage aside", words="to the right")
        yield Field("rolling.spin", "Spin", "rad/m", "rad/m", words="1/R on a curve of radius R to the right")


def layer_fields(number: int, *, mix: bool, last: bool) -> Iterator[Field]:
    """Fields of a layer."""
    before = f"pavement.layers.{number}"
    if not last:
        yield _length(f"{before}.thickness", "Thickness")
    if mix:
        names = {name: name for name in catalogue.mixes}
        yield Field(f"{before}.mix", "Mix", kind="choice", choices=names, words=_LAYER["mix"])
    else:
        yield Field(f"{before}.material.modulus", "Modulus", "MPa", "Pa", words="Young's modulus")
        yield Field(f"{before}.material.poisson", "Poisson", words="Poisson's ratio")
    if not last:
        bonds = {"bonded": "bonded", "half-bonded": "half-bonded", "frictionless": "frictionless"}
        yield Field(f"{before}.bond", "Bond below", kind="choice", choices=bonds, words=_LAYER["bond"])


STRUCTURE = Field("pavement.structure", "Structure", kind="choice", words=_ROAD["structure"],
                  choices={name: name for name in catalogue.structures})  # fmt: skip
TEMPERATURE = Field("pavement.temperature", "Temperature", "°C", "degC", words=_ROAD["temperature"], otherwise="none")
FREQUENCY = Field("pavement.frequency", "Frequency", "Hz", "Hz", words="of loading", otherwise="10")
SPACING = _length("spacing", "Cells", "of the contact", "3")
TOLERANCE = Field("tolerance", "Tolerance", words="relative, of the contact")
DEPTHS = Field("response.depths", "Depths of maps", "mm", "m", kind="list", words=_READ["depths"])
EPSILON = Field("damage.fatigue.epsilon_6", "ε₆", "microstrain", "", words="strain that a million passes allow")
SLOPE = Field("damage.fatigue.slope", "Slope", words="of the fatigue line, log strain over log passes")
STRAIN = Field("damage.strain", "Reads", kind="choice", words=_DAMAGE["strain"],
               choices={"in-plane": "horizontal plane", "principal": "in space"})  # fmt: skip


def default_of(field: Field, case: Any) -> str:
    """What an empty field stands for, as text."""
    value = value_at(case, field.path) if case is not None else None
    return field.shown(value) or field.otherwise
