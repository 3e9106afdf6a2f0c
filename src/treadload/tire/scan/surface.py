"""The surface of a scanned tread, cast on to any grid."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
import scipy
from numpy.typing import NDArray

from treadload.errors import GeometryError
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.cross_section import TreadSection, lateral_obstacle, measured_section
from treadload.tire.crown import arc_radius
from treadload.tire.quality import ScanQuality
from treadload.tire.scan.rays import Caster, radial, revolved, vertical
from treadload.tire.surface import fingerprint
from treadload.tire.tread import EXTENT_HEIGHT, EXTENT_MARGIN
from treadload.tire.unrolled import groove_depth, median_meridian

Choice = bool | Literal["auto"]

DEEPEST = 0.045  # a hit further below the crown went through a hole, m
VOID_MARGIN = 0.005
EXTENT_DROP = 0.030  # where the shoulder has fallen this far the tread ends, m
CONTACT_GAP = 0.020  # a loaded tire flattens about this much, m
RIB_BAND = 0.003
SMALL_HOLES = 0.02
SECTOR = math.radians(40)
STANDARD_SPACING = 3e-3
FIRST_CONTACT = 0.995
CROWN_BAND = 0.005
ALONG_WALLS, MERIDIANS = 0.25e-3, 24  # places across, m, and meridians of which walls of grooves are measured


@dataclass(frozen=True, eq=False)
class ScanSurface:
    """A scanned tread in the frame of its wheel.

    vertices: (n, 3), m: x along travel, y along the axle to the right, z down, origin on the axle amid the tread,
    already turned by the chosen rotation. faces: (m, 3). camber: rad, positive when the top leans to the right.
    across: (k,) places across the tread, m; meridian: (k,) median radius there and envelope: (k,) radius of the tops
    of ribs and lugs there, m, NaN where unknown.
    report: the quality of the scan. fill_holes: True, False or "auto" (only when they are at most 2 % of the tread).
    """

    vertices: Array
    faces: NDArray[np.int64]
    camber: float
    across: Array
    meridian: Array
    envelope: Array
    report: ScanQuality
    fill_holes: Choice = "auto"
    source: str = ""

    @cached_property
    def _digest(self) -> str:
        return fingerprint(
            self.vertices, self.faces, self.camber, self.meridian, self.envelope, self.report, self.fill_holes
        )

    def __eq__(self, surface: object) -> bool:
        if not isinstance(surface, ScanSurface):
            return NotImplemented
        return self._digest == surface._digest

    def __hash__(self) -> int:
        return hash(self._digest)

    def __getstate__(self) -> dict[str, object]:
        # Ray casters do not travel between processes; they are built again where they are needed.
        return {k: v for k, v in self.__dict__.items() if k in self.__dataclass_fields__}

    def __repr__(self) -> str:
        return f"ScanSurface({self.source!r}, radius {self.report.crown_radius:.4f} m)"

    def __str__(self) -> str:
        return (
            f"scan {self.source}: radius {self.report.crown_radius * 1e3:.1f} mm, width "
            f"{self.report.width * 1e3:.1f} mm, {len(self.report.grooves)} grooves"
        )

    @property
    def fixed_grid(self) -> Grid | None:
        """None: any grid will do."""
        return None

    @property
    def quality(self) -> ScanQuality | None:
        """How good the scan was."""
        return self.report

    @property
    def outer_radius(self) -> float:
        """Radius of the crown, m."""
        return self.report.crown_radius

    @cached_property
    def crown_arc_radius(self) -> float | None:
        """Radius of the tread across, over the tops of its ribs, m; see `crown.arc_radius`."""
        drop = self.report.crown_radius - self.envelope
        with np.errstate(invalid="ignore"):
            return arc_radius(self.across, np.where(drop < EXTENT_DROP, drop, np.nan))

    @cached_property
    def cross_section(self) -> TreadSection:
        """Ends and circumferential grooves, of the median of some meridians whose places lie 0.25 mm apart."""
        radius, obstacle = self.report.crown_radius, lateral_obstacle(self.report.interrupted)
        with np.errstate(invalid="ignore"):
            rows = self.across[self.envelope > radius - EXTENT_DROP]
        # As many places to the left of the middle as to the right: an even tread has an even section.
        half = math.ceil(float(np.abs(rows).max()) / ALONG_WALLS)
        y = ALONG_WALLS * np.arange(-half, half + 1)
        y = y[(y > rows[0]) & (y < rows[-1])]
        if obstacle:
            return TreadSection(float(y[0]), float(y[-1]), obstacle=obstacle, measured=True)
        theta = 2 * math.pi * (np.arange(MERIDIANS) + 0.37) / MERIDIANS
        turn = radial(Caster(self.vertices, self.faces), theta, y, 1.5 * radius, radius - self.deepest)
        height = median_meridian(turn) - radius
        if not np.isfinite(height).all():
            places = ", ".join(f"{1e3 * place:.0f}" for place in y[~np.isfinite(height)][:4])
            obstacle = f"the floor of a groove at y = {places} mm was not scanned; scan it from more directions"
            return TreadSection(float(y[0]), float(y[-1]), obstacle=obstacle, measured=True)
        return measured_section(y, height, self.report.grooves, self.crown_arc_radius)

    @property
    def extent(self) -> tuple[float, float]:
        """(length, width), m: where the tread is within 60 mm of the road, and its width with a margin."""
        radius = self.report.crown_radius
        height = min(EXTENT_HEIGHT, 0.2 * radius)
        # Lugs may cover less than half of the turn: their tops carry, not the median.
        with np.errstate(invalid="ignore"):
            tread = self.across[self.envelope > radius - EXTENT_DROP]
        width = 2 * float(np.abs(tread).max()) + 2 * EXTENT_MARGIN
        return 2 * math.sqrt(height * (2 * radius - height)), width

    def with_report(self, report: ScanQuality) -> ScanSurface:
        """The same surface with another report, about the same radius; the ray casters are kept."""
        surface = replace(self, report=report)
        surface.__dict__.update({k: v for k, v in self.__dict__.items() if k in ("_caster", "_revolved", "coverage")})
        return surface

    def height_map(self, grid: Grid) -> Array:
        """(ny, nx) gap, m, cast vertically from the cell centres to the tread.

        The plane of first contact touches the tread without its noise (see first_contact); what stands above it
        counts as gap 0. Hits more than 45 mm below the crown are not tread. Holes take the median over the angle at
        the same place across, by fill_holes; with "auto", those in grooves round the tire always.
        Raises GeometryError when holes remain where the contact will be, or when no cell meets the tread.
        """
        low, missing, predicted = self._cast(grid)
        tread = np.isfinite(predicted)
        if not tread.any():
            raise GeometryError(
                f"no cell of the grid ({grid}) meets the scanned tread, which is {self.extent[1]:.3f} m wide; "
                "put the grid's origin under the axle"
            )
        if self.fill_holes == "auto":
            # A groove is the same all round the tire; what is left are holes in ribs and blocks.
            floor = missing & self._in_grooves(grid.y)[:, None]
            low, missing = np.where(floor, predicted, low), missing & ~floor
        share = missing.sum() / max(1, tread.sum())
        if self.fill_holes is True or (self.fill_holes == "auto" and share <= SMALL_HOLES):
            low = np.where(missing, predicted, low)
        else:
            self._refuse_holes(grid, missing, predicted)
        return np.asarray(np.maximum(self.first_contact - low, 0.0), dtype=np.float64)

    def filled(self, grid: Grid) -> BoolArray:
        """(ny, nx) True where the gap comes from the rest of the turn, as no ray met the scan."""
        return self._cast(grid)[1]

    @cached_property
    def first_contact(self) -> float:
        """Height of the road below the axle at first contact, m.

        The crown, freed of its roundness and smoothed over five cells of 3 mm along travel: its highest point when
        the scan has no noise, its 99.5 % quantile less one standard deviation of the noise when it has.
        With 0.3 mm noise on vertices 2.5 to 5 mm apart this is within 0.05 mm; the highest point is 0.4 mm off.
        """
        length, width = self.extent
        grid = Grid.centred(0.5 * length, width, STANDARD_SPACING)
        low, _, _ = self._cast(grid)
        radius = self.report.crown_radius
        level = np.where(np.isfinite(low), low + radius - np.sqrt(radius**2 - grid.x**2), -np.inf)
        smooth = scipy.ndimage.median_filter(level, size=(1, 5), mode="nearest")
        finite = smooth[np.isfinite(smooth)]
        if finite.size == 0:
            raise GeometryError(
                "the scan has no tread below the axle; choose another rotation=, so that the scanned part "
                "faces the road"
            )
        top = float(finite.max())
        noise = _noise(np.where(smooth > top - CROWN_BAND, level, np.nan))
        # Without noise the top is right; with it the quantile still stands about one deviation too high.
        return top - min(top - float(np.quantile(finite, FIRST_CONTACT)) + noise, 4 * noise)

    @cached_property
    def coverage(self) -> tuple[float, int]:
        """Fraction of the tread in the extent that was met by rays from the road, and the number of holes."""
        _, missing, predicted = self._cast(Grid.centred(*self.extent, STANDARD_SPACING))
        tread = np.isfinite(predicted)
        return 1 - float(missing.sum() / max(1, tread.sum())), int(scipy.ndimage.label(missing)[1])

    @property
    def deepest(self) -> float:
        """Depth below the crown, m, down to which hits of rays are tread."""
        return self.report.crown_radius - self._floor

    @cached_property
    def _floor(self) -> float:
        """Radius below which a hit went through a hole, m; voids of a lugged tread may be deeper than grooves."""
        radius = self.report.crown_radius
        with np.errstate(invalid="ignore"):
            tread = (self.envelope > radius - EXTENT_DROP) & (self.meridian > 0)
        low = float(self.meridian[tread].min()) if tread.any() else radius
        return min(radius - DEEPEST, low - VOID_MARGIN)

    @cached_property
    def _caster(self) -> Caster:
        if self.report.revolved:
            return self._revolved
        # No vertical ray from the road ends on the upper part of the wheel: dense scans build faster without it.
        lower = self.vertices[:, 2][self.faces].max(axis=1) > 0.5 * self.report.crown_radius
        return Caster(self.vertices, self.faces[lower])

    @cached_property
    def _revolved(self) -> Caster:
        return revolved(self.across, self.meridian, SECTOR)

    def _cast(self, grid: Grid) -> tuple[Array, BoolArray, Array]:
        """Lowest points of the tread, where they are missing, and what the revolved meridian has there."""
        radius = self.report.crown_radius
        predicted = vertical(self._revolved, grid.x, grid.y, radius, self.camber, self._floor)
        if self.report.revolved:
            return predicted, np.zeros(grid.shape, dtype=bool), predicted
        low = vertical(self._caster, grid.x, grid.y, radius, self.camber, self._floor)
        return low, np.isnan(low) & np.isfinite(predicted), predicted

    def _in_grooves(self, y: Array) -> BoolArray:
        """(ny,) True where a groove that runs round the tire is deeper than a rib may be uneven."""
        deep = np.interp(y, self.across, (groove_depth(self.across, self.meridian) > RIB_BAND).astype(float))
        near = np.zeros(len(y), dtype=bool)
        for groove in self.report.grooves:
            near |= np.abs(y - groove.centre) < groove.width
        return np.asarray(near & (deep > 0.5), dtype=bool)

    def _refuse_holes(self, grid: Grid, missing: BoolArray, predicted: Array) -> None:
        grooves = groove_depth(self.across, self.meridian) > RIB_BAND
        rib = np.interp(grid.y, self.across, (~grooves).astype(np.float64)) > 0.5
        with np.errstate(invalid="ignore"):
            contact = (self.first_contact - predicted < CONTACT_GAP) & rib[:, None]
        holes = missing & contact
        if holes.any():
            share = holes.sum() / contact.sum()
            x, y = grid.x[holes.any(axis=0)], grid.y[holes.any(axis=1)]
            raise GeometryError(
                f"the scan has holes in {share:.1%} of the area where the contact will be ({holes.sum()} of "
                f"{contact.sum()} cells, x from {x.min() * 1e3:.0f} to {x.max() * 1e3:.0f} mm, y from "
                f"{y.min() * 1e3:.0f} to {y.max() * 1e3:.0f} mm); turn the wheel with rotation=, or fill them "
                "from the rest of the turn with fill_holes=True (--fill-holes yes; right for circumferential grooves)"
            )


def _noise(level: Array) -> float:
    """Standard deviation of the noise along the rows of a map, m, from differences over two cells.

    Facets and the turn of the tread leave these constant, so that their median absolute deviation sees noise only.
    """
    bend = level[:, 4:] - 2 * level[:, 2:-2] + level[:, :-4]
    bend = bend[np.isfinite(bend)]
    if bend.size < 10:
        return 0.0
    return 1.4826 * float(np.median(np.abs(bend - np.median(bend)))) / math.sqrt(6)
