"""The tire: a tread surface and what it is made of."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Unpack, get_args

import numpy as np
from numpy.typing import ArrayLike

from treadload.describing import as_call
from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.materials import Anisotropic, Elastic, Prony
from treadload.materials.kinds import Surfaced
from treadload.tables import real_array
from treadload.tire.belt import Belt, InflatedBelt
from treadload.tire.cells import cell_of
from treadload.tire.cross_section import TreadSection, lateral_obstacle
from treadload.tire.keywords import BLOCKS_ROLL, BodyKeys, ScanKeys, TireMaterial, Tread
from treadload.tire.library import tread_named
from treadload.tire.modulus import check_inflation_pressure, modulus_from_inflation
from treadload.tire.quality import ScanQuality
from treadload.tire.rib_rows import gap_on_faces, with_bands
from treadload.tire.ribs import RibGroup, cross_section_of, ribs_between
from treadload.tire.surface import (
    Raised,
    Surface,
    centred_height_map,
    in_metres,
    of_variable,
    read_height_map,
    units_by_name,
)
from treadload.tire.symmetry import is_mirrored
from treadload.tire.tread import ProfileSurface, TreadProfile
from treadload.tire.undertread import belt_below_ribs, check_rubber_of_ribs, replaces_thickness

if TYPE_CHECKING:
    import xarray as xr

POISSON_OF_RUBBER = 0.5
RibSides = Literal["free", "filled", "unknown", "none"]
# A body stiffer than this, Pa, is no rubber, and its ribs do not bulge.
_STIFFEST_RUBBER = 1e8


@dataclass(frozen=True)
class Tire:
    """A tire, as the road meets it.

    surface: of the tread. material: of the half-space that stands for the tire, elastic, anisotropic or, for steady
    rolling, viscoelastic; or one that makes a surface of its own (`materials.kinds.Surfaced`). belt: in its place, a
    tread on an inflated belt. inflation_pressure: Pa, gives the modulus when there is neither; a belt needs it.
    name: free text. tread: on a belt, a "layer" without grooves, or "ribs" with free sides between circumferential
    grooves. undertread: of ribs, rubber between the floor of the deepest groove and the belt, m; left out, what the
    tread_thickness of the belt leaves below the grooves of a profile, and 5 mm below those of a scan or a height map.
    Build it with from_height_map, from_profile or from_scan. Tires with equal contents are equal.

    >>> tire = tl.Tire.from_profile("315/80R22.5", inflation_pressure=820e3)
    >>> f"{tire.outer_radius * 1e3:.0f} mm", len(tire.surface.profile.grooves)  # unloaded radius, grooves
    ('538 mm', 4)
    """

    surface: Surface
    material: TireMaterial | None = None
    inflation_pressure: float | None = None
    name: str = ""
    belt: Belt | None = None
    tread: Tread = "layer"
    undertread: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.surface, Surface):
            raise InputError(
                f"a tire needs a surface, got {type(self.surface).__name__}; "
                "use Tire.from_height_map, Tire.from_profile or Tire.from_scan"
            )
        if self.material is not None and not isinstance(self.material, TireMaterial):
            raise InputError(
                "material must be an Elastic, an anisotropic one, a Prony or what makes a surface of its own, got "
                f"{self.material!r}"
            )
        if self.inflation_pressure is not None:
            object.__setattr__(self, "inflation_pressure", check_inflation_pressure(self.inflation_pressure))
        if self.belt is not None:
            if not isinstance(self.belt, Belt):
                raise InputError(f'belt must be a Belt, such as Belt.from_library("315/80R22.5"), got {self.belt!r}')
            if self.material is not None:
                raise InputError(
                    "give either material, of a half-space, or belt, not both; the material of the tread is "
                    "Belt(tread=...)"
                )
        if self.tread not in get_args(Tread):
            remedy = f"; {BLOCKS_ROLL}" if str(self.tread) == "blocks" else ""
            raise InputError(f'tread must be "layer" or "ribs", got {self.tread!r}{remedy}')
        if self.tread == "ribs":
            if self.belt is None:
                raise InputError('tread = "ribs" needs a belt: give belt, such as Belt.from_library("315/80R22.5")')
            object.__setattr__(self, "belt", self.belt.under_ribs())
            self._check_ribs()
        elif self.undertread is not None:
            raise InputError(
                f"undertread = {self.undertread:g} m lies below the grooves of ribs, and this tread is a layer; give "
                'tread = "ribs", or the tread_thickness of the belt'
            )

    def _check_ribs(self) -> None:
        """Refuse ribs that the surface, the undertread or the rubber does not allow. Raises InputError."""
        assert self.belt is not None
        check_rubber_of_ribs(self.belt, self.undertread)
        if self.cross_section is None:
            raise InputError(
                f"ribs: the grooves of a {type(self.surface).__name__} are not known; give a TreadProfile, a scan or "
                'a height map, or tread = "layer"'
            )
        assert self.ribs

    @classmethod
    def from_height_map(
        cls,
        gap: ArrayLike | xr.DataArray | str | PathLike[str],
        spacing: float | Sequence[float] | None = None,
        *,
        units: str | Mapping[str, str] | None = None,
        decimal: Literal[".", ","] | None = None,
        **body: Unpack[BodyKeys],
    ) -> Tire:
        """Tire of a map of its initial gap.

        body: material=, inflation_pressure=, name=, belt=, tread= and undertread= of `Tire`.
        gap: (ny, nx) in m, distance of the tread from the plane it touches, curvature included; NaN where there is no
        material. Its minimum is shifted to 0, so heights above any horizontal plane will do. Or a DataArray, or the
        path of a NetCDF file (variable `initial_gap` or the only 2-D one), over y and x, whose attributes `units` are
        followed; or the path of a matrix as CSV, text, NPY or NPZ; or of heights of a tread from surface metrology,
        X3P, SDF, SUR or AL3D, which bring spacing and unit. spacing: cell size, m, or (dx, dy); coordinates
        bring their own. units: "mm", or {"gap": "mm"}, of what names no unit: the gap of a matrix (else m), gap, x
        and y of a NetCDF file (else refused). decimal: "." or ",", where a text can be read in two ways. The map
        keeps its cells: the contact is solved on them. `str` shows what was read. Raises InputError for infinite
        values, a wrong shape, a missing spacing or unit, a cell of a text that is neither a number nor empty, NaN,
        NA, N/A, NoData or null; GeometryError for NaN only.
        """
        cell = cell_of(spacing)
        if isinstance(gap, str | PathLike):
            surface = read_height_map(Path(gap), cell, units, decimal)
            named: BodyKeys = {**body, "name": body.get("name") or Path(gap).name}
            return cls(surface, **named)
        units_of = units_by_name(units)
        if hasattr(gap, "dims") and hasattr(gap, "coords"):
            labelled: Any = gap
            return cls(of_variable(labelled, cell, units_of), **body)
        if cell is None:
            raise InputError("a height map needs the spacing of its cells in m, e.g. spacing=3e-3")
        return cls(centred_height_map(in_metres(real_array(gap, "a height map"), units_of), cell), **body)

    @classmethod
    def from_profile(
        cls,
        profile: TreadProfile | str,
        **body: Unpack[BodyKeys],
    ) -> Tire:
        """Tire of a parametric tread.

        profile: a TreadProfile, or the name of one in the catalogue, e.g. "315/80R22.5". body: material=,
        inflation_pressure=, name=, belt=, tread= and undertread= of `Tire`. tread: of a belt, "ribs" for
        ribs with free sides between the grooves, "layer" for rubber without grooves. undertread: as in `Tire`.
        Raises InputError when the catalogue does not have it, and for ribs of lateral or too deep grooves.
        """
        shape = tread_named(profile) if isinstance(profile, str) else profile
        if not isinstance(shape, TreadProfile):
            raise InputError(f"profile must be a TreadProfile or the name of one, got {profile!r}")
        named: BodyKeys = {**body, "name": body.get("name") or shape.name}
        return cls(ProfileSurface(shape), **named)

    @classmethod
    def from_scan(
        cls,
        path: str | PathLike[str],
        **how: Unpack[ScanKeys],
    ) -> Tire:
        """Tire of a scan in any pose, of the whole turn or of a part of it from 45° on.

        path: a mesh, OBJ, PLY, STL, GLB or OFF, a cloud of points, PLY, text (XYZ, TXT, CSV, ASC, PTS), LAS, LAZ
        or E57, or the TOML of a laser's lines. how: material=, inflation_pressure=, name=, belt=, tread= and
        undertread= of `Tire`, and what follows. units: of the file, "m", "cm", "mm" or "inch"; nominal_diameter:
        outer, m; scale: m per unit of the file, a known length over its measure there; without any, the unit is the
        one that gives a diameter between 0.4 and 1.6 m. rotation: rad, brings the tread that much ahead down to the
        road. camber: rad, positive when the top leans to the right.
        revolve: replace the facets by their revolved meridian; "auto": when they cut deeper than 0.1 mm under the
        circle and the tread does not depend on the angle, so that ribs are revolved and lugs and blocks are not.
        fill_holes: by the median round the tire; "auto": in grooves round the tire, elsewhere up to 2 %.
        smooth: length, m, over which noise is smoothed (standard deviation of the window); "auto": as far as the
        noise asks, when it is above 0.05 mm. outliers: points that stick out of the tread further than noise takes
        them are put back ("remove"), end in an error ("refuse") or stay ("keep").
        roundness: share of the radius by which it may vary round the tire.
        tread, undertread: as in `Tire`; "ribs" have the walls of the meridian's grooves as measured, each with the
        straight line nearest to it.
        Raises InputError (file, units, trimesh missing) and GeometryError (no tire in it).
        """
        # Reading a scan needs trimesh, which is an extra.
        from treadload.tire.scan.options import ScanOptions
        from treadload.tire.scan.pipeline import read_scan

        body: Any = {key: how.pop(key) for key in BodyKeys.__annotations__ if key in how}  # type: ignore[misc]
        surface = read_scan(Path(path), ScanOptions(**how))  # type: ignore[misc]
        return cls(surface, **{**body, "name": body.get("name") or Path(path).stem})

    @property
    def carcass(self) -> TireMaterial | InflatedBelt:
        """What gives way under the tread: the belt under its inflation, or a half-space that stands for the tire.

        That of the material, or else from the inflation pressure, ν = 0.5. Raises InputError as `Belt.inflated`.
        """
        if self.belt is not None:
            if self.inflation_pressure is None:
                raise InputError(
                    "a belt carries by its inflation: give inflation_pressure in Pa, a truck tire is near 820e3"
                )
            belt = self._belt_below_ribs
            inflated = belt.inflated(self.inflation_pressure, self.outer_radius, self.crown_arc_radius)
            return replace(inflated, ribs=self.ribs)
        if self.material is not None:
            return self.material
        if self.inflation_pressure is None:
            raise InputError(
                "the tire has neither a material nor an inflation pressure; give material=Elastic(3e6, 0.5) "
                "or inflation_pressure=820e3 (Pa)"
            )
        return Elastic(modulus_from_inflation(self.inflation_pressure), POISSON_OF_RUBBER)

    @property
    def ribs(self) -> tuple[RibGroup, ...]:
        """Ribs with free sides on the belt; empty where the tread is a layer."""
        if self.tread != "ribs":
            return ()
        section, belt = self.cross_section, self._belt_below_ribs
        assert section is not None
        groups = ribs_between(section, belt.tread_thickness)
        surface = self._tread_surface
        return with_bands(groups, surface.profile) if isinstance(surface, ProfileSurface) else groups

    @property
    def cross_section(self) -> TreadSection | None:
        """Ends and circumferential grooves of the tread; None where its surface does not know them."""
        return cross_section_of(self._tread_surface)

    @property
    def _tread_surface(self) -> Surface:
        """The tread, without the road's relief that it stands above."""
        return self.surface.tread_surface if isinstance(self.surface, Raised) else self.surface

    @property
    def rib_sides(self) -> RibSides:
        """How the sides of the tread's ribs are: "free" to bulge, or "filled", as a layer or a half-space has them.

        "unknown" where the surface does not know its grooves or has lateral ones, "none" of a tread without grooves
        and of a body that is no rubber.
        """
        if self.tread == "ribs":
            return "free"
        if isinstance(self.material, Elastic) and self.material.modulus > _STIFFEST_RUBBER:
            return "none"
        quality = self.quality
        if quality is not None:
            return "unknown" if lateral_obstacle(quality.interrupted) else "filled" if quality.grooves else "none"
        section = self.cross_section
        if section is None or section.obstacle:
            return "unknown"
        return "filled" if section.channels else "none"

    @property
    def has_undertread(self) -> bool:
        """True where the undertread of ribs makes the thickness of the tread, in place of the belt's own."""
        if self.tread != "ribs":
            return False
        return replaces_thickness(self.cross_section, self.undertread)

    @property
    def _belt_below_ribs(self) -> Belt:
        """The belt with the thickness of tread that the undertread leaves; its neutral line stays where it is."""
        assert self.belt is not None
        return belt_below_ribs(self.belt, self.cross_section, self.undertread) if self.tread == "ribs" else self.belt

    @property
    def elastic(self) -> Elastic | Anisotropic | Surfaced | InflatedBelt:
        """The same, of a tire without memory. Raises InputError for a viscoelastic one."""
        carcass = self.carcass
        material = carcass.belt.tread if isinstance(carcass, InflatedBelt) else carcass
        if isinstance(material, Prony):
            raise InputError(
                f"this problem knows elastic tires only, got a viscoelastic one ({material}); "
                "give one of its limits, material.glassy or material.rubbery"
            )
        assert not isinstance(carcass, Prony)
        return carcass

    def row_slip(self, grid: Grid) -> Array:
        """Rigid slip along x of rows that roll on other radii, over rolling speed (ny, 1); see `InflatedBelt`."""
        if self.belt is None or self.belt.belt_radius is None:
            return np.zeros((grid.ny, 1))
        carcass = self.carcass
        assert isinstance(carcass, InflatedBelt)
        return carcass.row_slip(grid.y)[:, None]

    @property
    def fixed_grid(self) -> Grid | None:
        """The only grid that the tread is known on, or None when any grid will do."""
        return self.surface.fixed_grid

    @property
    def extent(self) -> tuple[float, float]:
        """(length, width), m: the largest piece of road around the contact that the tread can describe."""
        return self.surface.extent

    @property
    def quality(self) -> ScanQuality | None:
        """How good the scan is; None when the tread was not scanned."""
        return self.surface.quality

    @property
    def camber(self) -> float:
        """Lean of the wheel, rad, positive when the top leans to the right; 0 for a tread given as it lies."""
        return float(getattr(self.surface, "camber", 0.0))

    @property
    def outer_radius(self) -> float | None:
        """Radius of the unloaded crown, m, of a height map by its curvature along travel; None where it has none."""
        radius = getattr(self.surface, "outer_radius", None)
        return None if radius is None else float(radius)

    @property
    def crown_arc_radius(self) -> float | None:
        """Radius of the unloaded tread across, m, over the tops of its ribs; inf if it is flat, None if unknown."""
        radius = getattr(self.surface, "crown_arc_radius", None)
        return None if radius is None else float(radius)

    @property
    def camber_spin(self) -> float:
        """Spin of the leaning wheel on a straight path, rad/m: -sin(camber)/R.

        As a vector, the turn of V/R about the axle points to the left; the wheel that leans to the right lifts it by
        sin(camber), and z is down. On a circle to the right its 1/R_path can cancel this: the wheel rolls as a cone.
        Zero for an upright tire, and where no radius is known.
        """
        quality = self.quality
        return 0.0 if quality is None else 0.0 - math.sin(self.camber) / quality.crown_radius

    @property
    def is_symmetric(self) -> bool:
        """True if the tread is its own mirror image in the plane of the wheel; never of a scan, which is as it is."""
        return _is_symmetric(self)

    def height_map(self, grid: Grid) -> Array:
        """(ny, nx) gap in m at the cell centres, ≥ 0, to the plane at first contact; NaN where there is no material.

        On the ribs of a profile it is the mean over what a row of cells stands for of a rib, see `tire.rib_rows`.
        Raises InputError when the tread is known on another grid only, GeometryError when it has no usable
        surface there.
        """
        surface = self._tread_surface
        if self.tread != "ribs" or not isinstance(surface, ProfileSurface):
            return self.surface.height_map(grid)
        gap = gap_on_faces(surface.profile, grid, self.ribs, surface.height_map(grid))
        return self.surface.above_road(gap, grid) if isinstance(self.surface, Raised) else gap

    def __str__(self) -> str:
        parts: list[Any] = [self.name or "tire", self.surface]
        if self.material is not None:
            parts.append(self.material)
        if self.inflation_pressure is not None:
            parts.append(f"inflated to {self.inflation_pressure / 1e3:g} kPa")
            if self.belt is not None:
                parts.append(self.belt)
            elif self.material is None:
                # What the contact will be solved with.
                modulus = modulus_from_inflation(self.inflation_pressure) / 1e6
                parts.append(f"E = {modulus:.4g} MPa by the inflation pressure, ν = {POISSON_OF_RUBBER:g}")
        return "; ".join(str(part) for part in parts)

    __repr__ = as_call


@lru_cache(maxsize=32)
def _is_symmetric(tire: Tire) -> bool:
    return is_mirrored(tire.surface)
