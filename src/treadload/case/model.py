"""A case: one model that is a TOML file, a Python object and a form."""

from __future__ import annotations

import os
import tomllib
from pathlib import Path
from typing import Any, Literal

import tomli_w
from pydantic import Field, ValidationError, model_validator

from treadload.case.fields import Curvature, Force, Length, Number, Part, Speed
from treadload.case.friction import Friction
from treadload.case.road import PavementPart
from treadload.case.tire import TirePart
from treadload.case.words import in_words
from treadload.contact import Rolling
from treadload.contact.viscoelastic import check_rolling
from treadload.damage import FatigueLine
from treadload.errors import InputError
from treadload.tire import Tire


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
            raise InputError(f"{name}: {in_words(error, cls)}") from error

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
