"""Parametric treads: a revolved meridian with grooves, defined at every point."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from treadload.describing import as_call
from treadload.errors import GeometryError, InputError
from treadload.files import parse_toml, text_of
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.tire.grooves import EDGE, Groove, LateralGrooves, check_finite, rounding_start, trench
from treadload.tire.quality import ScanQuality
from treadload.units import Length, quantity

EXTENT_HEIGHT = 0.060  # a contact never climbs this far up the tread, m
EXTENT_MARGIN = 0.012  # bare road beside the tread, m


@dataclass(frozen=True)
class TreadProfile:
    """A tread given by its radii and its grooves.

    rolling_radius: of the unloaded crown in the plane of the wheel, m. crown_radius: of the tread arc across
    the tire, m. width: of the tread, m; there is no material beyond. shoulder_radius: rounding where the
    tread turns into a vertical sidewall, m, tangent to both; 0 for a square shoulder. grooves, lateral: cut
    into it; where two meet, the deeper one counts. name, source, notes: free text.
    caveats: what is not certain about it, a sentence each. vehicle: kind that the tire is for, e.g. "truck or bus";
    a remedy by another tire stays within one kind.
    Raises InputError when a number is out of bounds or a groove leaves the tread.

    >>> tread = tl.tire.TreadProfile(rolling_radius=0.5, crown_radius=0.8, width=0.25)
    >>> tread.width
    0.25
    """

    rolling_radius: Length
    crown_radius: Length
    width: Length
    shoulder_radius: Length = 0.0
    grooves: tuple[Groove, ...] = ()
    lateral: tuple[LateralGrooves, ...] = ()
    name: str = ""
    source: str = ""
    notes: str = ""
    caveats: tuple[str, ...] = ()
    vehicle: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "grooves", tuple(self.grooves))
        object.__setattr__(self, "lateral", tuple(self.lateral))
        object.__setattr__(self, "caveats", tuple(self.caveats))
        check_finite(self, "tread profile", ("rolling_radius", "crown_radius", "width"))
        for name, low, high in (("rolling_radius", 0.05, 3.0), ("width", 0.02, 2.0)):
            if not low <= getattr(self, name) <= high:
                raise InputError(
                    f"tread profile: {name} must lie between {low} and {high} m, got {getattr(self, name):g}; "
                    "lengths are in metres"
                )
        half = 0.5 * self.width
        if not self.crown_radius > half:
            raise InputError(
                f"tread profile: crown_radius must exceed half the width ({half:g} m), got {self.crown_radius:g} m"
            )
        if not 0 <= self.shoulder_radius <= half:
            raise InputError(
                f"tread profile: shoulder_radius must lie between 0 and half the width ({half:g} m), "
                f"got {self.shoulder_radius:g} m"
            )
        deepest = max([0.0, *(g.depth for g in self.grooves), *(g.depth for g in self.lateral)])
        if self._arc(half) + self.shoulder_radius + deepest >= self.rolling_radius:
            raise InputError(
                f"tread profile: arc, shoulder and grooves together reach the axle ({self.rolling_radius:g} m); "
                "check that all lengths are in metres"
            )
        for groove in self.grooves:
            if abs(groove.centre) + 0.5 * groove.width > half:
                raise InputError(
                    f"tread profile: the groove at y = {groove.centre:g} m, {groove.width:g} m wide, leaves the "
                    f"tread (half width {half:g} m)"
                )

    @classmethod
    def from_toml(cls, path: str | Path) -> TreadProfile:
        """Profile of a TOML file: the keys are the arguments of the class; m and rad, or text with a unit."""
        path = Path(path)
        if not os.path.isfile(path):
            raise InputError(
                f"no tread profile file {str(path)!r}; check the path, or give a name of `treadload catalogue tires`"
            )
        return cls.from_dict(parse_toml(text_of(path, "the TOML file of a tread profile"), repr(path.name)))

    @classmethod
    def from_dict(cls, table: Mapping[str, object]) -> TreadProfile:
        """Profile of plain tables, as to_dict gives them; text carries its unit. Raises InputError."""
        # pydantic is loaded when a table is read, not before.
        from treadload.read import read

        profile: TreadProfile = read(cls, table, "tread profile")
        return profile

    def to_dict(self) -> dict[str, object]:
        """Plain tables of numbers and text; from_dict reads them back."""
        return {key: value for key, value in _plain_table(asdict(self)).items() if value not in ("", [])}

    def to_toml(self) -> str:
        """TOML text; from_toml reads it back from a file."""
        import tomli_w

        return tomli_w.dumps(self.to_dict())

    @property
    def ribs(self) -> int:
        """Ribs that its circumferential grooves leave; 0 where it has none of them, or lateral grooves."""
        return len(self.grooves) + 1 if self.grooves and not self.lateral else 0

    def worn(self, wear: float | str) -> TreadProfile:
        """The tread after `wear`, m, has been worn off it, the same everywhere along the radius of the wheel.

        The radius shrinks, grooves become shallower, and narrower where their walls slope; arc, width, shoulders and
        the floors with their tie bars stay: a groove worn down to its tie bar is gone. Raises InputError for a
        negative wear, and for one that leaves no groove of a tread with grooves.

        >>> new = TreadProfile(0.5, 1.0, 0.2, grooves=(Groove(0.0, 0.01, 0.015),))
        >>> old = new.worn("6 mm")
        >>> old.rolling_radius, round(old.grooves[0].depth, 9)
        (0.494, 0.009)
        """
        depth = quantity(wear, "m")
        cuts = [*(groove.clear_depth for groove in self.grooves), *(lateral.depth for lateral in self.lateral)]
        deepest = max(cuts, default=0.25 * self.rolling_radius)
        if not 0 <= depth < deepest:
            raise InputError(
                f"wear must be at least 0 and less than {deepest * 1e3:g} mm, the depth of the deepest groove"
                f"{' above its tie bar' if any(groove.tie_bar for groove in self.grooves) else ''}, got "
                f"{depth * 1e3:g} mm"
                if cuts
                else f"wear must be at least 0 and less than {deepest * 1e3:g} mm, a quarter of the radius, got "
                f"{depth * 1e3:g} mm"
            )
        return replace(
            self,
            rolling_radius=self.rolling_radius - depth,
            grooves=tuple(cut for groove in self.grooves if (cut := groove.worn(depth)) is not None),
            lateral=tuple(lug for lateral in self.lateral if (lug := lateral.worn(depth)) is not None),
        )

    def drop(self, y: Array) -> Array:
        """Meridian: how far the surface lies below the crown circle at y, grooves included but lateral ones not.

        y: any shape, m to the right. Returns the same shape, m, ≥ 0; NaN beyond the width.
        """
        y = np.asarray(y, dtype=np.float64)
        out = self._smooth_drop(y)
        return np.asarray(out + self._groove_depth(y), dtype=np.float64)

    def gap(self, x: Array, y: Array) -> Array:
        """Gap from the tread to the plane that touches it at its lowest point.

        x: (nx,), m along travel from below the axle. y: (ny,), m to the right of the middle of the tread.
        Returns (ny, nx), m, ≥ 0; NaN beside the tread and beyond the wheel.
        The wheel is a circle, not a parabola. Walls of lateral grooves stand square to the road, not to the
        tread: below the ribs they are off by depth·x/radius, on the ribs they are exact.
        """
        x = np.atleast_1d(np.asarray(x, dtype=np.float64))
        y = np.atleast_1d(np.asarray(y, dtype=np.float64))
        return np.asarray(np.maximum(self._raw_gap(x, y) - self._lowest, 0.0), dtype=np.float64)

    def __str__(self) -> str:
        return (
            f"tread {self.name or '(unnamed)'}: radius {self.rolling_radius * 1e3:g} mm, crown radius "
            f"{self.crown_radius * 1e3:g} mm, width {self.width * 1e3:g} mm, {len(self.grooves)} grooves"
            + (f", {tied} with tie bars" if (tied := sum(groove.tie_bar > 0 for groove in self.grooves)) else "")
            + (f", {len(self.lateral)} sets of lateral grooves" if self.lateral else "")
        )

    def _arc(self, y: Array | float) -> Array:
        # x²/(R + √(R² − x²)) is R − √(R² − x²) without its loss of digits.
        square = np.square(y)
        return square / (self.crown_radius + np.sqrt(np.maximum(self.crown_radius**2 - square, 0.0)))

    def _smooth_drop(self, y: Array) -> Array:
        half, radius = 0.5 * self.width, self.shoulder_radius
        into = np.clip(np.abs(y) - (half - radius), 0.0, radius)
        drop = self._arc(np.minimum(np.abs(y), half)) + radius - np.sqrt(np.maximum(radius**2 - into**2, 0.0))
        return np.asarray(np.where(np.abs(y) > half + EDGE, np.nan, drop), dtype=np.float64)

    def _groove_depth(self, y: Array) -> Array:
        depth = np.zeros_like(y)
        for g in self.grooves:
            away = np.abs(y - g.centre)
            depth = np.maximum(depth, trench(away, g.width, g.clear_depth, g.wall_angle, g.edge_radius))
        return depth

    def _lateral_depth(self, along: Array, y: Array) -> Array:
        """Depth of the lateral grooves at the arc length `along` (m) and y, same shapes."""
        depth = np.zeros(np.broadcast_shapes(along.shape, y.shape))
        for g in self.lateral:
            place = along - y * math.tan(g.angle) - g.offset
            away = np.abs((place + 0.5 * g.pitch) % g.pitch - 0.5 * g.pitch) * math.cos(g.angle)
            cut = trench(away, g.width, g.depth, g.wall_angle, g.edge_radius)
            if g.y_range is not None:
                low, high = g.y_range
                ends = trench(np.abs(y - 0.5 * (low + high)), high - low, g.depth, g.wall_angle, g.edge_radius)
                cut = np.minimum(cut, ends)
            depth = np.maximum(depth, cut)
        return depth

    def _raw_gap(self, x: Array, y: Array) -> Array:
        """Gap to the plane below the crown circle."""
        smooth = self._smooth_drop(y)[:, None]
        depth = self._groove_depth(y)[:, None]
        if self.lateral:
            angle = np.arcsin(np.clip(x[None, :] / (self.rolling_radius - smooth), -1.0, 1.0))
            depth = np.maximum(depth, self._lateral_depth(self.rolling_radius * angle, y[:, None]))
        radius = self.rolling_radius - smooth - depth
        square = radius**2 - np.square(x)[None, :]
        with np.errstate(invalid="ignore"):
            rise = np.square(x)[None, :] / (radius + np.sqrt(np.where(square > 0, square, np.nan)))
        return np.asarray(smooth + depth + rise, dtype=np.float64)

    @cached_property
    def _lowest(self) -> float:
        """Raw gap of the lowest point: above 0 when a groove takes the very crown away."""
        edges = [
            g.centre + side * (0.5 * g.width + rounding_start(g.wall_angle, g.edge_radius) + 2 * EDGE)
            for g in self.grooves
            for side in (-1, 1)
        ]
        y = np.union1d(np.linspace(-0.5, 0.5, 2001) * self.width, edges)
        x = np.zeros(1)
        if self.lateral:
            reach = min(max(g.pitch for g in self.lateral), 0.5 * self.rolling_radius)
            x = np.linspace(-reach, reach, 401)
            y = y[::10]
        with np.errstate(all="ignore"):
            return float(np.nanmin(self._raw_gap(x, y)))

    __repr__ = as_call


@dataclass(frozen=True)
class ProfileSurface:
    """The surface of a parametric tread, sampled at cell centres.

    >>> tread = tl.tire.ProfileSurface(tl.tire.TreadProfile(rolling_radius=0.5, crown_radius=1.0, width=0.2))
    >>> gap = tread.height_map(tl.response.Grid.centred(0.2, 0.2, 0.02))
    >>> f"gap of {gap[5, -1] * 1e3:.1f} mm 90 mm ahead of the axle"
    'gap of 8.2 mm 90 mm ahead of the axle'
    """

    profile: TreadProfile

    def __str__(self) -> str:
        return str(self.profile)

    @property
    def extent(self) -> tuple[float, float]:
        """(length, width), m: where the tread is within 60 mm of the road, and its width with a margin."""
        height = min(EXTENT_HEIGHT, 0.5 * self.profile.rolling_radius)
        chord = 2 * math.sqrt(height * (2 * self.profile.rolling_radius - height))
        return chord, self.profile.width + 2 * EXTENT_MARGIN

    @property
    def fixed_grid(self) -> Grid | None:
        """None: any grid will do."""
        return None

    @property
    def quality(self) -> ScanQuality | None:
        """None: no scan."""
        return None

    @property
    def outer_radius(self) -> float:
        """Radius of the unloaded crown, m."""
        return self.profile.rolling_radius

    @property
    def crown_arc_radius(self) -> float:
        """Radius of the tread arc across, m."""
        return self.profile.crown_radius

    def height_map(self, grid: Grid) -> Array:
        """(ny, nx) gap at the cell centres, m; NaN beside the tread. Raises GeometryError if no cell meets it."""
        gap = self.profile.gap(grid.x, grid.y)
        if np.isnan(gap).all():
            raise GeometryError(
                f"no cell of the grid ({grid}) lies under the tread, which is {self.profile.width:g} m wide; "
                "put the grid's origin under the axle"
            )
        return gap


def _plain_table(table: Mapping[str, object]) -> dict[str, object]:
    """Tuples as lists and without None, as TOML wants them."""
    return {key: _plain_tables(item) for key, item in table.items() if item is not None}


def _plain_tables(value: object) -> object:
    if isinstance(value, Mapping):
        return _plain_table(value)
    if isinstance(value, tuple | list):
        return [_plain_tables(item) for item in value]
    return value
