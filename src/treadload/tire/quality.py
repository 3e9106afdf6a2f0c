"""What is known about a scan after it was read."""

from __future__ import annotations

import math
from dataclasses import dataclass

# By so much lower a wall is told besides the depth, m.
_LOWER = 0.3e-3
# Truck tires have up to six grooves round the tire, bicycle and farm tires no more than twice as many.
_MOST_LISTED = 12


@dataclass(frozen=True)
class GrooveMeasure:
    """One circumferential groove of a scan.

    centre: distance to the right of the middle of the tread, m. width: at half its depth, m.
    depth: floor below the mean of the ribs beside it, as a gauge that bridges the groove measures it, m. floor: floor
    below the crown, m. lower_wall: height of the lower of its two walls, m; NaN in files of earlier versions.

    >>> groove = tl.tire.GrooveMeasure(centre=0.04, width=0.010, depth=0.0123, floor=0.0125)
    >>> f"{(groove.depth - 1.6e-3) * 1e3:.1f} mm above the legal limit of 1.6 mm"
    '10.7 mm above the legal limit of 1.6 mm'
    """

    centre: float
    width: float
    depth: float
    floor: float
    lower_wall: float = math.nan


@dataclass(frozen=True)
class Outlier:
    """One place where a scan sticks out of the tire.

    points: number of vertices. height: over the tread, m. angle: rad ahead of the place over the road.
    y: place across, m, to the right of the middle of the tread.
    """

    points: int
    height: float
    angle: float
    y: float

    def __str__(self) -> str:
        angle = round(math.degrees(self.angle))
        turn = f"{abs(angle)}° {'ahead of' if angle >= 0 else 'behind'} the road"
        return f"{self.height * 1e3:.3g} mm high at y = {self.y * 1e3:.0f} mm, {turn}"


@dataclass(frozen=True)
class ScanQuality:
    """How a scan was understood and how good it is.

    n_points, n_faces: after merging vertices and dropping degenerate faces.
    units: unit of the file ("m", "mm", ..., or "scaled" when a nominal diameter set it). scale: m per file unit.
    crown_radius: largest radius of the tread (99.5 % quantile), m. width: overall width along the axle, m.
    facet_sag: how far the largest facets of the tread cut under the circle, m. axis_residual: rms over the
    angle of the radius of the tread envelope, m; roundness in noise, facets and blocks together.
    theta_spread: rms scatter over the angle of the radius about its median, m, on the tread.
    coverage: fraction of the tread over the road (the extent of the tire, 3 mm cells) that vertical rays met.
    holes: number of connected regions that they did not meet. hole_fraction: 1 - coverage. watertight: of the mesh.
    revolved: True when the meridian was revolved in place of the facets. grooves: from left to right.
    warnings: one sentence each. noise: standard deviation of the error of single points along the radius, m, as
    scanned; NaN when there are too few points. smoothing: standard deviation of the window that removed it, m, or 0.
    outliers: places that stuck out of the tread, the highest first. land_ratio: share of the tread that ribs, blocks
    and lugs make up, grooves less than 3 mm deep among them; NaN where it is not known. interrupted: share of the
    faces between grooves round the tire that lies in lateral grooves, sipes or holes; NaN where it is not known.
    """

    n_points: int
    n_faces: int
    units: str
    scale: float
    crown_radius: float
    width: float
    facet_sag: float
    axis_residual: float
    theta_spread: float
    coverage: float
    holes: int
    hole_fraction: float
    watertight: bool
    revolved: bool
    grooves: tuple[GrooveMeasure, ...] = ()
    warnings: tuple[str, ...] = ()
    noise: float = math.nan
    smoothing: float = 0.0
    outliers: tuple[Outlier, ...] = ()
    land_ratio: float = math.nan
    interrupted: float = math.nan

    def __str__(self) -> str:
        lines = [
            f"{self.n_points} points, {self.n_faces} faces, {'closed' if self.watertight else 'open'} mesh, "
            f"1 unit of the file = {self.scale:g} m ({self.units})",
            f"crown radius {self.crown_radius * 1e3:.1f} mm, width {self.width * 1e3:.1f} mm, "
            f"facet sag {self.facet_sag * 1e3:.2f} mm, axis residual {self.axis_residual * 1e3:.2f} mm",
            ("noise unknown" if math.isnan(self.noise) else f"noise {self.noise * 1e3:.2f} mm")
            + (f", smoothed over {self.smoothing * 1e3:.1f} mm" if self.smoothing else "")
            + f", points that stick out {sum(outlier.points for outlier in self.outliers)}",
            f"coverage {self.coverage:.1%}, holes {self.holes}"
            + ("" if math.isnan(self.land_ratio) else f", land ratio {self.land_ratio:.0%}")
            + (", revolved from its meridian" if self.revolved else ""),
        ]
        listed = self.grooves
        if len(listed) > _MOST_LISTED:
            depths = [1e3 * groove.depth for groove in listed]
            lines.append(
                f"{len(depths)} grooves, {min(depths):.1f} to {max(depths):.1f} mm deep: no ribbed tread has so many"
            )
            listed = ()
        lines += [
            f"groove at y = {g.centre * 1e3:+.1f} mm: {g.width * 1e3:.1f} mm wide, {g.depth * 1e3:.1f} mm deep"
            + (f", {g.lower_wall * 1e3:.1f} mm at its lower wall" if g.depth - g.lower_wall > _LOWER else "")
            for g in listed
        ]
        lines += [f"warning: {text}" for text in self.warnings]
        return "\n".join(lines)
