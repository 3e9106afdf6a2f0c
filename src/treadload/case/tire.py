"""The tire in a case: its surface and what it is made of."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

from pydantic import field_validator, model_validator

from treadload.case.choices import TIRE_MATERIAL, TireMaterial
from treadload.read import As, Table
from treadload.tire import Belt, Tire, TreadProfile, example_mesh
from treadload.tire.keywords import BLOCKS_ROLL
from treadload.tire.library import tread_named
from treadload.units import Angle, Length, Number, Pressure

# The word that stands for the tire mesh that ships with the package.
EXAMPLE = "example"


# A name, a file, or a table.
PROFILE = As(str | TreadProfile)
# A name of the catalogue, or a table.
BELT = As(str | Belt)


class TirePart(Table):
    """`[tire]`: exactly one of scan, profile and height_map, and what the tire is made of.

    scan: a mesh, OBJ, PLY, STL, GLB, OFF, a cloud of points, PLY, text, LAS, LAZ, E57, lines of a laser, TOML, a
    format that another package reads, or "example", the mesh that ships with treadload. profile: a name of the
    library, a TOML file, or a table.
    height_map: a file of the initial gap, or of a surface, X3P, SDF, SUR or AL3D.
    units: of a scan, "mm"; of a height map, "mm" or { gap = "mm", x = "mm", y = "mm" }, where the file names no unit.
    cell: of a height map without coordinates. decimal: "." or ",", of a height map as text. inflation_pressure: gives
    the modulus where there is no material. material: of the tread's half-space. belt: in its place, a name of the
    catalogue or a table; inflation carries it. tread: on a belt, "ribs" with free sides between circumferential
    grooves, or a "layer" without grooves. undertread: of ribs, rubber between the deepest groove and the belt; left
    out, what the tread_thickness of the belt leaves of a profile, 5 mm of a scan or a height map.
    wear: worn off the tread of a profile, evenly along the radius of the wheel.
    Of a scan: nominal_diameter: outer, from which the unit follows.
    rotation: about the axle. camber: lean to the right. revolve: the meridian in place of the facets. fill_holes: of
    the tread. smooth: length to smooth noise over, or "auto". outliers: "remove", "refuse" or "keep" points that
    stick out. roundness: share of the radius by which it may vary. scale: m per unit of the file.
    """

    one_of: ClassVar = ("scan", "profile", "height_map")

    scan: str | None = None
    profile: Annotated[Any, PROFILE] = None
    height_map: str | None = None
    units: str | dict[str, str] | None = None
    decimal: Literal[".", ","] | None = None
    nominal_diameter: Length | None = None
    rotation: Angle = 0.0
    camber: Angle = 0.0
    revolve: bool | Literal["auto"] = "auto"
    fill_holes: bool | Literal["auto"] = "auto"
    smooth: Literal[False, "auto"] | Length = False
    outliers: Literal["remove", "refuse", "keep"] = "remove"
    roundness: Number = 0.02
    scale: Number | None = None
    cell: Length | None = None
    inflation_pressure: Pressure | None = None
    material: TireMaterial | None = None
    belt: Annotated[Any, BELT] = None
    tread: Literal["layer", "ribs"] = "layer"
    undertread: Length | None = None
    wear: Length = 0.0

    @field_validator("tread", mode="before")
    @classmethod
    def _no_blocks(cls, tread: object) -> object:
        if tread == "blocks":
            raise ValueError(f'must be "layer" or "ribs"; {BLOCKS_ROLL}')
        return tread

    @model_validator(mode="after")
    def _one_surface(self) -> TirePart:
        kinds = [name for name in ("scan", "profile", "height_map") if getattr(self, name) is not None]
        if len(kinds) != 1:
            raise ValueError(
                f"give exactly one of scan, profile and height_map, got {' and '.join(kinds) or 'none of them'}"
            )
        if self.belt is not None and self.material is not None:
            raise ValueError("give either material, of a half-space, or belt; the tread's material is tread in belt")
        if self.tread == "ribs" and self.belt is None:
            raise ValueError('tread = "ribs" needs a belt; give belt = "315/80R22.5" or a table, or tread = "layer"')
        if self.undertread is not None and self.tread != "ribs":
            raise ValueError('undertread lies below the grooves of ribs; give tread = "ribs", or leave it out')
        if self.wear and self.profile is None:
            raise ValueError(f"wear is worn off a profile; this tire is a {kinds[0]}, which has the wear that it has")
        if self.profile is not None and self.units is not None:
            raise ValueError("units belongs to a scan or a height_map; this tire is a profile")
        if self.scan is not None and isinstance(self.units, dict):
            raise ValueError('a scan has one unit of length: write units = "mm"')
        if self.decimal is not None and self.height_map is None:
            raise ValueError(f"decimal belongs to a height_map; this tire is a {kinds[0]}")
        only_scan = {
            *("nominal_diameter", "rotation", "camber", "revolve", "fill_holes"),
            *("smooth", "outliers", "roundness", "scale"),
        }
        stray = sorted(only_scan & self.model_fields_set) if self.scan is None else []
        if stray:
            raise ValueError(f"{stray[0]} belongs to a scan; this tire is a {kinds[0]}")
        if self.cell is not None and self.height_map is None:
            raise ValueError(
                f"cell belongs to a height_map; this tire is a {kinds[0]}: set spacing at the top instead"
            )
        return self

    def _belt(self) -> Belt | None:
        belt = BELT.build(self.belt)
        belt = Belt.from_library(belt) if isinstance(belt, str) else belt
        # An undertread makes the thickness of the tread of what the grooves are now.
        return belt.worn(self.wear) if belt is not None and self.wear and self.undertread is None else belt

    def build(self, folder: Path) -> Tire:
        """The tire; relative paths start from the folder."""
        body: dict[str, Any] = {
            "material": TIRE_MATERIAL.build(self.material),
            "inflation_pressure": self.inflation_pressure,
            "belt": self._belt(),
            "tread": self.tread,
            "undertread": self.undertread,
        }
        if self.scan is not None:
            path = example_mesh() if self.scan == EXAMPLE else folder / self.scan
            assert not isinstance(self.units, dict)
            options: dict[str, Any] = {
                "units": self.units, "nominal_diameter": self.nominal_diameter, "rotation": self.rotation,
                "camber": self.camber, "revolve": self.revolve, "fill_holes": self.fill_holes, "smooth": self.smooth,
                "outliers": self.outliers, "roundness": self.roundness, "scale": self.scale,
            }  # fmt: skip
            # A table of a laser's lines names files of its own, which may change while it does not.
            if path.suffix.lower() == ".toml" or not path.is_file():
                return Tire.from_scan(path, **options, **body)
            return replace(_scanned(path, path.stat().st_mtime_ns, tuple(options.items())), **body)
        if self.height_map is not None:
            return Tire.from_height_map(
                folder / self.height_map, self.cell, units=self.units, decimal=self.decimal, **body
            )
        profile = PROFILE.build(self.profile)
        if isinstance(profile, str) and profile.endswith(".toml"):
            profile = TreadProfile.from_toml(folder / profile)
        if self.wear:
            profile = (tread_named(profile) if isinstance(profile, str) else profile).worn(self.wear)
        return Tire.from_profile(profile, **body)


# A case is built more than once, and cases of a study or of a demonstration have the same scan.
@lru_cache(maxsize=1)
def _scanned(path: Path, changed: int, options: tuple[tuple[str, object], ...]) -> Tire:
    how: dict[str, Any] = dict(options)
    return Tire.from_scan(path, **how)
