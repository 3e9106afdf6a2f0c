"""A case: one model that is a TOML file, a Python object and a form."""

from __future__ import annotations

import difflib
import os
import tomllib
from pathlib import Path
from typing import Annotated, Any, Literal

import tomli_w
from pydantic import BaseModel, BeforeValidator, Discriminator, Field, Tag, ValidationError, model_validator

from treadload.case.fields import (
    Angle,
    Curvature,
    Force,
    Length,
    Number,
    Part,
    Pressure,
    Speed,
    Stiffness,
    Time,
)
from treadload.case.friction import LAW_PARTS, Friction
from treadload.contact import Rolling
from treadload.contact.viscoelastic import check_rolling
from treadload.damage import FatigueLine
from treadload.errors import InputError
from treadload.materials import Elastic, Prony
from treadload.pavement import BONDED, FRICTIONLESS, Bond, Layer, Pavement
from treadload.tire import Tire, TreadProfile, example_mesh

# The word that stands for the tire mesh that ships with the package.
EXAMPLE = "example"


class MaterialPart(Part):
    """`material = { kind = "elastic", modulus = "5400 MPa", poisson = 0.35 }`."""

    kind: Literal["elastic"] = "elastic"
    modulus: Pressure
    poisson: Number

    def build(self) -> Elastic:
        """The material."""
        return Elastic(self.modulus, self.poisson)


class PronyPart(Part):
    """`material = { kind = "prony", modulus = "10 MPa", terms = [[0.7, "10 ms"]], poisson = 0.49 }`."""

    kind: Literal["prony"]
    modulus: Pressure
    terms: tuple[tuple[Number, Time], ...]
    poisson: Number

    def build(self) -> Prony:
        """The material."""
        return Prony(self.modulus, self.terms, self.poisson)


_MATERIAL_PARTS: dict[str, type[Part]] = {"elastic": MaterialPart, "prony": PronyPart}


def _kind_of_material(value: Any) -> str:
    kind = value.get("kind", "elastic") if isinstance(value, dict) else getattr(value, "kind", "elastic")
    return str(kind)


def _known_material(value: Any) -> Any:
    """A material whose kind is one of ours. Raises ValueError that says which are."""
    kind = _kind_of_material(value)
    if kind not in _MATERIAL_PARTS:
        raise ValueError(f"no material of the kind {kind!r}; known are {', '.join(_MATERIAL_PARTS)}")
    return value


# What a tire can be made of; the kind tells the tables apart.
TireMaterial = Annotated[
    Annotated[MaterialPart, Tag("elastic")] | Annotated[PronyPart, Tag("prony")],
    Discriminator(_kind_of_material),
    BeforeValidator(_known_material),
]


class TirePart(Part):
    """`[tire]`: exactly one of scan, profile and height_map, and what the tire is made of."""

    scan: str | None = None
    profile: str | dict[str, Any] | None = None
    height_map: str | None = None
    units: str | None = None
    nominal_diameter: Length | None = None
    rotation: Angle = 0.0
    camber: Angle = 0.0
    revolve: bool | Literal["auto"] = "auto"
    fill_holes: bool | Literal["auto"] = "auto"
    cell: Length | None = None
    inflation_pressure: Pressure | None = None
    material: TireMaterial | None = None

    @model_validator(mode="after")
    def _one_surface(self) -> TirePart:
        given = [name for name in ("scan", "profile", "height_map") if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(
                f"give exactly one of scan, profile and height_map, got {' and '.join(given) or 'none of them'}"
            )
        only_scan = {"units", "nominal_diameter", "rotation", "camber", "revolve", "fill_holes"}
        stray = sorted(only_scan & self.model_fields_set) if self.scan is None else []
        if stray:
            raise ValueError(f"{stray[0]} belongs to a scan; this tire is a {given[0]}")
        if self.cell is not None and self.height_map is None:
            raise ValueError(
                f"cell belongs to a height_map; this tire is a {given[0]}: set spacing at the top instead"
            )
        return self

    def build(self, folder: Path) -> Tire:
        """The tire; relative paths start from the folder."""
        body: dict[str, Any] = {
            "material": None if self.material is None else self.material.build(),
            "inflation_pressure": self.inflation_pressure,
        }
        if self.scan is not None:
            path = example_mesh() if self.scan == EXAMPLE else folder / self.scan
            return Tire.from_scan(
                path,
                units=self.units,
                nominal_diameter=self.nominal_diameter,
                rotation=self.rotation,
                camber=self.camber,
                revolve=self.revolve,
                fill_holes=self.fill_holes,
                **body,
            )
        if self.height_map is not None:
            return Tire.from_height_map(folder / self.height_map, self.cell, **body)
        profile = self.profile
        if isinstance(profile, dict):
            return Tire.from_profile(TreadProfile.from_dict(profile), **body)
        assert profile is not None
        if profile.endswith(".toml"):
            return Tire.from_profile(TreadProfile.from_toml(folder / profile), **body)
        return Tire.from_profile(profile, **body)


class BondPart(Part):
    """`bond = { stiffness = "1000 MPa/m" }`."""

    stiffness: Stiffness


class LayerPart(Part):
    """`[[pavement.layers]]`, from the surface down; the last one has no thickness unless the base is rigid.

    bond, to the layer below: "bonded", "frictionless" or `{ stiffness = "1000 MPa/m" }`.
    """

    material: MaterialPart
    thickness: Length | None = None
    name: str = ""
    bond: Annotated[
        Annotated[Literal["bonded", "frictionless"], Tag("word")] | Annotated[BondPart, Tag("spring")],
        Discriminator(lambda v: "word" if isinstance(v, str) else "spring"),
    ] = "bonded"

    def build(self) -> Layer:
        """The layer."""
        if isinstance(self.bond, BondPart):
            bond = Bond(self.bond.stiffness)
        else:
            bond = FRICTIONLESS if self.bond == "frictionless" else BONDED
        return Layer(self.material.build(), self.thickness, name=self.name, bond=bond)


class PavementPart(Part):
    """`[pavement]`: the road's layers."""

    layers: tuple[LayerPart, ...] = Field(min_length=1)
    rigid_base: bool = False

    def build(self) -> Pavement:
        """The pavement."""
        return Pavement([layer.build() for layer in self.layers], rigid_base=self.rigid_base)


class RollingPart(Part):
    """`[rolling]`: the load, the friction, and forces or creepages."""

    normal_load: Force | None = None
    approach: Length | None = None
    friction: Friction
    tractive_force: Force | None = None
    creepage_x: Number | None = None
    lateral_force: Force | None = None
    creepage_y: Number | None = None
    spin: Curvature = 0.0
    speed: Speed | None = None

    def build(self, folder: Path = Path(".")) -> Rolling:
        """The rolling state; a friction map is read from the folder."""
        friction = self.friction if isinstance(self.friction, float) else self.friction.build(folder)
        return Rolling(**{**dict(self), "friction": friction})


class ResponsePart(Part):
    """`[response]`: depths of the maps, and how deep the vertical slices through the worst point go."""

    depths: tuple[Length, ...] = (0.0,)
    slice_depth: Length = 0.06

    @model_validator(mode="after")
    def _downwards(self) -> ResponsePart:
        if not self.depths:
            raise ValueError("depths needs at least one depth, got none; 0 is the surface")
        if min(self.depths) < 0:
            raise ValueError(f"depths must be >= 0, got {min(self.depths):g} m; depth counts downwards")
        if len(set(self.depths)) != len(self.depths):
            raise ValueError(f"depths must differ from each other, got {list(self.depths)} m")
        if self.slice_depth <= 0:
            raise ValueError(f"slice_depth must be > 0, got {self.slice_depth:g} m")
        return self


class FatiguePart(Part):
    """`fatigue = { epsilon_6 = "120 microstrain", slope = -0.2 }`."""

    epsilon_6: Number
    slope: Number

    def build(self) -> FatigueLine:
        """The fatigue line."""
        return FatigueLine(self.epsilon_6, self.slope)


class DamagePart(Part):
    """`[damage]`: the fatigue line, and which strain it reads at which of the response's depths."""

    fatigue: FatiguePart
    strain: Literal["principal", "in-plane"] = "principal"
    depth: Length = 0.0


class Case(Part):
    """Everything that a computation needs, checked.

    Numbers are SI; in a TOML file a quoted number carries its unit.
    """

    title: str = ""
    spacing: Length | None = None
    tolerance: Number = 1e-6
    tire: TirePart
    pavement: PavementPart
    rolling: RollingPart
    response: ResponsePart = ResponsePart()
    damage: DamagePart | None = None
    folder: Path = Field(default=Path("."), exclude=True, repr=False)

    @model_validator(mode="after")
    def _buildable(self) -> Case:
        if not 1e-12 <= self.tolerance <= 1e-2:
            raise ValueError(f"tolerance must lie in [1e-12, 1e-2], got {self.tolerance:g}; 1e-6 is the default")
        # Building what is cheap to build finds wrong values before any file is read.
        self.pavement.build()
        self.rolling.build(self.folder)
        if self.tire.material is not None:
            check_rolling(self.tire.material.build(), self.pavement.build().surface_material, self.rolling.speed)
        if self.damage is not None:
            self.damage.fatigue.build()
            if self.damage.depth not in self.response.depths:
                raise ValueError(
                    f"damage.depth {self.damage.depth:g} m is none of response.depths "
                    f"{list(self.response.depths)} m; add it there"
                )
        return self

    @classmethod
    def from_dict(cls, table: dict[str, Any], *, folder: Path | str = ".", name: str = "case") -> Case:
        """Case from nested tables as a TOML file holds them. Raises InputError that names the key."""
        try:
            return cls.model_validate({**table, "folder": Path(folder)})
        except ValidationError as error:
            raise InputError(f"{name}: {_in_words(error)}") from error

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Case:
        """Case from a TOML file; paths in it start from its folder. Raises InputError."""
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except OSError as error:
            raise InputError(f"cannot read the case {path}: {error.strerror or error}") from error
        except UnicodeDecodeError as error:
            raise InputError(f"{path} is not a text file in UTF-8, so it is no case; give a TOML file") from error
        return cls.from_text(text, folder=path.parent, name=str(path))

    @classmethod
    def from_text(cls, text: str, *, folder: Path | str = ".", name: str = "case") -> Case:
        """Case from TOML text. Raises InputError."""
        try:
            table = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            raise InputError(f"{name} is not valid TOML: {error}") from error
        return cls.from_dict(table, folder=folder, name=name)

    def to_toml(self) -> str:
        """The case as TOML text in SI units; what was left out stays out."""
        return tomli_w.dumps(self.model_dump(mode="json", exclude_unset=True, exclude_none=True))

    def build_tire(self) -> Tire:
        """The tire, read from its file if it has one."""
        return self.tire.build(self.folder)


def _in_words(error: ValidationError) -> str:
    return "; ".join(_one_error(item) for item in error.errors())


def _one_error(item: Any) -> str:
    place = ".".join(_without_tags(item["loc"]))
    message = str(item["msg"]).removeprefix("Value error, ")
    if item["type"] == "extra_forbidden":
        known = _keys(item["loc"][:-1])
        near = difflib.get_close_matches(str(item["loc"][-1]), known, n=1)
        hint = f"did you mean {near[0]!r}?" if near else f"known here: {', '.join(known)}"
        return f"unknown key {place!r}; {hint}"
    if item["type"] == "missing":
        return f"{place!r} is missing"
    return f"{place}: {message}" if place else message


_BOND_TAGS = ("word", "spring")
_TAGS = {
    "friction": (*LAW_PARTS, "number"),
    "base": (*LAW_PARTS, "number"),
    "material": tuple(_MATERIAL_PARTS),
    "bond": _BOND_TAGS,
}


def _without_tags(location: tuple[Any, ...]) -> list[str]:
    """Parts of a location without the names of friction laws and materials, by which tables are told apart."""
    before = ("", *location)
    return [str(part) for part, last in zip(location, before, strict=False) if part not in _TAGS.get(str(last), ())]


def _keys(location: tuple[Any, ...]) -> list[str]:
    """Keys that the table at this location knows."""
    model: Any = Case
    for part in location:
        if isinstance(part, int) or part in ("number", *_BOND_TAGS):
            continue
        tables = {**LAW_PARTS, **_MATERIAL_PARTS}
        if part in tables and part not in model.model_fields:
            model = tables[part]
            continue
        annotation = model.model_fields[part].annotation
        candidates = [getattr(one, "__origin__", one) for one in (annotation, *getattr(annotation, "__args__", ()))]
        # The name of the law or material that follows says which of its tables is meant.
        model = next((one for one in candidates if isinstance(one, type) and issubclass(one, BaseModel)), model)
    return [name for name in model.model_fields if name != "folder"]
