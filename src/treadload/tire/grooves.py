"""Grooves of a parametric tread."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.units import Angle, Length

# A wall that falls on a cell centre must fall on the same side left and right.
EDGE = 1e-9


@dataclass(frozen=True)
class Groove:
    """A groove round the tire.

    centre: distance to the right of the middle of the tread, m. width: between the walls where they would
    meet the tread unrounded, m. depth: below the tread, m. wall_angle: of the walls from the vertical, rad,
    opening outwards. edge_radius: rounding of the upper edges, m, tangent to tread and wall. tie_bar: height of a
    rubber bridge between the walls above the floor of the groove, m, taken as continuous along travel; 0 for none.
    Raises InputError when the walls or the rounding do not fit, and for a tie bar as high as the groove is deep.

    >>> groove = tl.tire.Groove(0.0, 0.010, 0.015, tie_bar=0.004)
    >>> round(groove.clear_depth, 9)
    0.011
    """

    centre: Length
    width: Length
    depth: Length
    wall_angle: Angle = 0.0
    edge_radius: Length = 0.0
    tie_bar: Length = 0.0

    def __post_init__(self) -> None:
        check_finite(self, "groove", ("centre", "tie_bar"))
        _check_trench("groove", self.width, self.depth, self.wall_angle, self.edge_radius)
        if not (self.tie_bar >= 0 and self.clear_depth > 0.5 * EDGE):
            raise InputError(
                f"groove: tie_bar must be at least 0 and less than the depth of the groove, {self.depth:g} m, got "
                f"{self.tie_bar:g} m; it is the height of the bar above the floor of the groove: leave out a groove "
                "that the bar fills"
            )

    @property
    def clear_depth(self) -> float:
        """Depth of the groove down to its tie bar, m; the whole depth where it has none."""
        return self.depth - self.tie_bar

    def worn(self, wear: float) -> Groove | None:
        """The same groove below a tread worn by `wear`, m: None where it is gone, or worn down to its tie bar."""
        return None if wear >= self.clear_depth - EDGE else worn_groove(self, wear)


@dataclass(frozen=True)
class LateralGrooves:
    """Grooves across the tread, repeated round the tire.

    pitch: distance between two of them along the circumference at the crown, m. width: perpendicular to the groove,
    m. depth, wall_angle, edge_radius: as in Groove. angle: from the axle towards travel on the right-hand side, rad.
    y_range: (from, to) in m, for lugs on a part of the width; None for all of it. offset: circumferential place of
    one of them at y = 0, m. Raises InputError when the walls or the rounding do not fit.

    >>> tl.tire.LateralGrooves(pitch=0.030, width=0.006, depth=0.012).worn(0.004).depth
    0.008
    """

    pitch: Length
    width: Length
    depth: Length
    wall_angle: Angle = 0.0
    edge_radius: Length = 0.0
    angle: Angle = 0.0
    y_range: tuple[Length, Length] | None = None
    offset: Length = 0.0

    def __post_init__(self) -> None:
        check_finite(self, "lateral groove", ("pitch", "angle", "offset"))
        _check_trench("lateral groove", self.width, self.depth, self.wall_angle, self.edge_radius)
        if not abs(self.angle) < math.radians(80):
            raise InputError(
                f"lateral groove: angle must lie within ±1.39 rad (80°) of the axle, got {self.angle} rad"
            )
        land = self.pitch * math.cos(self.angle) - self.width - 2 * rounding_start(self.wall_angle, self.edge_radius)
        if not land > 0:
            raise InputError(
                f"lateral groove: no tread is left between grooves {self.width:g} m wide at a pitch of "
                f"{self.pitch:g} m ({land:g} m); widen the pitch or narrow the grooves"
            )
        if self.y_range is not None:
            try:
                low, high = (float(value) for value in self.y_range)
            except (TypeError, ValueError):
                low = high = math.nan
            if not (math.isfinite(low) and math.isfinite(high) and low < high):
                raise InputError(
                    f"lateral groove: y_range must be (from, to) in m with from < to, got {self.y_range}"
                )
            object.__setattr__(self, "y_range", (low, high))

    def worn(self, wear: float) -> LateralGrooves | None:
        """The same grooves below a tread worn by `wear`, m, as in Groove."""
        return worn_groove(self, wear)


Cut = TypeVar("Cut", Groove, LateralGrooves)


def worn_groove(groove: Cut, wear: float) -> Cut | None:
    """A groove whose tread is worn by `wear`, m: its floor and walls stay, its rounded edges move with the tread."""
    if wear >= groove.depth - EDGE:
        return None
    width = groove.width - 2 * wear * math.tan(groove.wall_angle)
    return replace(groove, width=width, depth=groove.depth - wear)


def equal_ribs(
    tread_width: float,
    number: int,
    width: float,
    depth: float,
    wall_angle: float = 0.0,
    edge_radius: float = 0.0,
    tie_bar: float = 0.0,
) -> tuple[Groove, ...]:
    """`number` equal grooves that leave number + 1 equal ribs on a tread of `tread_width`.

    Lengths in m, wall_angle in rad; tie_bar: height of a bar in every groove. Raises InputError when no rib is left.

    >>> len(tl.tire.equal_ribs(0.25, 5, 0.010, 0.015))
    5
    """
    rib = (tread_width - number * width) / (number + 1)
    if number < 0 or not rib > 0:
        raise InputError(
            f"{number} grooves of {width:g} m leave no rib on a tread of {tread_width:g} m; "
            "use fewer or narrower ones"
        )
    first = -0.5 * tread_width + rib + 0.5 * width
    places = (first + i * (rib + width) for i in range(number))
    return tuple(Groove(place, width, depth, wall_angle, edge_radius, tie_bar) for place in places)


def rounding_start(wall_angle: float, edge_radius: float) -> float:
    """Distance from an unrounded edge to where its rounding starts, m."""
    return edge_radius * math.tan(0.5 * (0.5 * math.pi - wall_angle))


def trench(away: Array, width: float, depth: float, wall_angle: float, edge_radius: float) -> Array:
    """Depth (m, ≥ 0) of a trapezoidal trench with rounded upper edges, `away` (m, ≥ 0) from its middle."""
    half, tangent = 0.5 * width, rounding_start(wall_angle, edge_radius)
    start = half + tangent
    on_wall = half - tangent * math.sin(wall_angle)
    slope = math.tan(wall_angle)
    sloping = slope > 0
    wall = np.clip((half - away) / slope, 0.0, depth) if sloping else np.where(away < half - EDGE, depth, 0.0)
    into = np.clip(start - away, 0.0, edge_radius)
    rounded = edge_radius - np.sqrt(edge_radius**2 - into**2)
    return np.asarray(np.where(away > on_wall - EDGE, np.minimum(rounded, depth), wall), dtype=np.float64)


def check_finite(owner: object, what: str, names: tuple[str, ...]) -> None:
    """Raise InputError unless the named attributes are finite numbers."""
    for name in names:
        value = getattr(owner, name)
        if isinstance(value, bool) or not isinstance(value, int | float | np.floating) or not math.isfinite(value):
            raise InputError(f"{what}: {name} must be a finite number (m, rad), got {value!r}")


def _check_trench(what: str, width: float, depth: float, wall_angle: float, edge_radius: float) -> None:
    for name, value in (("width", width), ("depth", depth)):
        if not (math.isfinite(value) and 0 < value < 0.5):
            raise InputError(f"{what}: {name} must lie between 0 and 0.5 m, got {value:g}; lengths are in metres")
    if not 0 <= wall_angle < 0.5 * math.pi:
        raise InputError(f"{what}: wall_angle must lie in [0, π/2) rad from the vertical, got {wall_angle:g}")
    if not (math.isfinite(edge_radius) and edge_radius >= 0):
        raise InputError(f"{what}: edge_radius must be ≥ 0 m, got {edge_radius:g}")
    if depth * math.tan(wall_angle) > 0.5 * width + 1e-12:
        raise InputError(
            f"{what}: walls at {wall_angle:g} rad meet before the floor at {depth:g} m; for a width of {width:g} m "
            f"the angle can be at most {math.atan(0.5 * width / depth):.4g} rad"
        )
    if rounding_start(wall_angle, edge_radius) * math.cos(wall_angle) > depth + 1e-12:
        raise InputError(
            f"{what}: edge_radius {edge_radius:g} m reaches below the floor at {depth:g} m; use a smaller one"
        )
