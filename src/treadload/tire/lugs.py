"""A tread with blocks as a tire brings it: where its blocks are and the gap that they leave to the road."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from treadload.errors import InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array
from treadload.tire.blocks import BlockPattern, blocks_of
from treadload.tire.grooves import Groove, LateralGrooves, trench
from treadload.tire.surface import Surface
from treadload.tire.tire import Tire
from treadload.tire.tread import ProfileSurface, TreadProfile


@dataclass(frozen=True)
class LuggedTread:
    """Blocks of a tread. pattern: of them. smooth: the tread without lateral grooves. lateral: these."""

    pattern: BlockPattern
    smooth: Surface
    lateral: tuple[LateralGrooves, ...]

    def gap(self, x: Array, y: Array, place: float = 0.0) -> Array:
        """Gap (ny, nx), m, of the faces of the blocks to the road, lateral grooves left out but for their edges.

        x, y: of even cells, from the axle, m. place: of the axle on the tread, m.
        """
        grid = Grid(x.size, y.size, float(x[1] - x[0]), float(y[1] - y[0]), float(x[0]), float(y[0]))
        gap = self.smooth.height_map(grid)
        for groove in self.lateral:
            if groove.edge_radius > 0:
                gap = gap + _edges(groove, x + place, y)
        return np.asarray(gap)


def lugged_tread(tire: Tire, lateral: tuple[LateralGrooves, ...] = ()) -> LuggedTread:
    """The blocks of a tire on a belt.

    lateral: grooves that cut a tread that has none of its own, as a scan of ribs; without, the lugs of a scan.
    Raises InputError for a tire without a belt, a profile with lateral grooves besides, a height map,
    and as `blocks_of` and `scanned_blocks`.
    """
    if tire.belt is None:
        raise InputError('blocks need a belt: give belt, such as Belt.from_library("315/80R22.5")')
    surface = tire.surface
    if isinstance(surface, ProfileSurface):
        profile = surface.profile
        if profile.lateral and lateral:
            raise InputError("the profile has lateral grooves already; leave `lateral` out, or give them there")
        cut = replace(profile, lateral=profile.lateral or tuple(lateral))
        smooth: Surface = ProfileSurface(replace(profile, lateral=()))
        return LuggedTread(blocks_of(cut, tire.belt.tread_thickness), smooth, cut.lateral)
    if surface.fixed_grid is not None or surface.quality is None:
        raise InputError("a height map is known on its own cells only; give a TreadProfile or a scan")
    if not lateral:
        # Reading a scan needs trimesh, which is an extra.
        from treadload.tire.scan.lug_outlines import scanned_blocks
        from treadload.tire.scan.surface import ScanSurface

        if not isinstance(surface, ScanSurface):
            raise InputError(f"blocks are read of a scan or a TreadProfile, got {type(surface).__name__}")
        return LuggedTread(*scanned_blocks(surface, tire.belt.tread_thickness), ())
    return LuggedTread(blocks_of(_measured(tire, tuple(lateral)), tire.belt.tread_thickness), surface, tuple(lateral))


def _measured(tire: Tire, lateral: tuple[LateralGrooves, ...]) -> TreadProfile:
    """The tread of a scan as its circumferential grooves were measured, walls upright, with lateral grooves."""
    quality = tire.surface.quality
    assert quality is not None
    width = _land_width(tire)
    grooves = tuple(
        Groove(groove.centre, groove.width, groove.depth)
        for groove in quality.grooves
        if abs(groove.centre) + 0.5 * groove.width < 0.5 * width
    )
    crown = tire.crown_arc_radius
    return TreadProfile(
        rolling_radius=quality.crown_radius,
        crown_radius=max(crown if crown is not None and np.isfinite(crown) else 10.0, 0.51 * width),
        width=width,
        grooves=grooves,
        lateral=lateral,
        name=tire.name,
    )


# A shoulder ends where the tread has fallen this far below the arc of the crown, m.
_SHOULDER = 8e-3
_LOOK = 1e-3


def _land_width(tire: Tire) -> float:
    """Width of the tread between the shoulders, m, symmetric."""
    _, width = tire.extent
    count = int(width / _LOOK) | 1
    grid = Grid(2, count, _LOOK, _LOOK, -0.5 * _LOOK, -(count // 2) * _LOOK)
    drop = np.nan_to_num(tire.height_map(grid).min(1), nan=np.inf)
    crown = tire.crown_arc_radius
    arc = 0.0 if crown is None or not np.isfinite(crown) else np.square(grid.y) / (2 * crown)
    land = np.abs(grid.y[drop - arc < _SHOULDER])
    return 2 * float(min(-grid.y[drop - arc < _SHOULDER].min(), land.max())) + _LOOK


def _edges(groove: LateralGrooves, x: Array, y: Array) -> Array:
    """Depth (ny, nx), m, of the rounded edges of lateral grooves, as far as the face of a block reaches."""
    place = x[None, :] - y[:, None] * np.tan(groove.angle) - groove.offset
    away = np.abs((place + 0.5 * groove.pitch) % groove.pitch - 0.5 * groove.pitch) * np.cos(groove.angle)
    cut = trench(
        np.maximum(away, 0.5 * groove.width), groove.width, groove.depth, groove.wall_angle, groove.edge_radius
    )
    if groove.y_range is not None:
        low, high = groove.y_range
        cut = np.where(((y >= low) & (y <= high))[:, None], cut, 0.0)
    return np.asarray(cut)
