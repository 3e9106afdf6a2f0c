"""From a raw tire mesh to a tread surface: pose, units, points that stick out, noise, facets, holes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import scipy

from treadload.errors import GeometryError, InputError
from treadload.grid import Grid
from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.cross_section import interrupted_share
from treadload.tire.quality import Outlier, ScanQuality
from treadload.tire.scan import cloud_file, laser  # noqa: F401  # their readers register themselves
from treadload.tire.scan import meridian as unrolling
from treadload.tire.scan import outliers as sticking
from treadload.tire.scan.axis import Axis, across, fit_axis, sample_surface
from treadload.tire.scan.cleaning import LARGEST_NOISE, decide_revolve, decide_smoothing
from treadload.tire.scan.ground import largest_piece, without_ground
from treadload.tire.scan.mesh_file import Mesh, read_mesh
from treadload.tire.scan.noise import BAND, apart, radial_noise, smoothed, unrolled
from treadload.tire.scan.options import ScanOptions
from treadload.tire.scan.rays import Caster, radial
from treadload.tire.scan.surface import DEEPEST, EXTENT_DROP, SECTOR, SMALL_HOLES, STANDARD_SPACING, ScanSurface
from treadload.tire.scan.units import check_diameter, scale_of
from treadload.tire.unrolled import SHALLOWEST, WIDEST, find_grooves, median_meridian, top_meridian

POSSIBLE_PROPORTIONS = (0.1, 0.8)  # width over outer diameter
SMALLEST_ARC, WARNED_ARC = 45, 90  # of the turn, degrees
CORNERS, CORNER = 3, 20  # so many gaps, so many degrees wide, are between the corners of something else
APART, LIKE = 0.03, 0.3  # two treads lie so far apart, m, and the narrower is so wide over the wider
LUG_WINDOW = math.radians(30)  # the next lug is nearer than this
LEVEL = 0.5  # what rises more is a wall or the end of the tread
BESIDE_WALLS = 0.001  # points this near to walls may be on them, m
WALLS = 0.002  # noise may put the edge of a rib this far into its groove, m
DEEP_GROOVE = 0.9  # a groove is one on so much of the turn


def read_scan(path: str | Path, options: ScanOptions | None = None) -> ScanSurface:
    """Tread surface of a mesh file in any pose.

    path: OBJ, PLY, STL, GLB, OFF, a cloud, or the TOML of a laser's lines. options, as in `Tire.from_scan`:
    nominal_diameter gives the unit or, when none fits within 3 %, the scale; without it and units, the one unit that
    gives a diameter between 0.4 and 1.6 m serves. The reference of rotation is the file's -z (or -y, -x when the axle
    lies along it), for a partial scan its middle. A flat floor in the scan is removed when no tire is found with it.
    The axle's right end is the one that points along the positive axis of the file.
    Raises InputError, GeometryError.
    """
    options = options or ScanOptions()
    mesh = read_mesh(path)
    name = Path(path).name
    try:
        return _build(mesh, name, options, [])
    except (GeometryError, InputError):
        # With a floor the axle is not found; what is wrong then may look like wrong units.
        for rest, notes in _without_clutter(mesh, name):
            try:
                return _build(rest, name, options, notes)
            except (GeometryError, InputError):
                pass
        raise


def _without_clutter(mesh: Mesh, name: str) -> Iterator[tuple[Mesh, list[str]]]:
    """The mesh without its floor, without small pieces, without both; sentences about it. Raises GeometryError."""
    notes: list[str] = []
    rest = without_ground(mesh)
    if rest is not None:
        dropped = len(mesh.faces) - len(rest.faces)
        notes = [f"a flat floor of {dropped} triangles was removed; the tread on it may be flattened"]
        yield rest, notes
    rest = mesh if rest is None else rest
    main, number = largest_piece(rest, name)
    if number:
        dropped = len(rest.faces) - len(main.faces)
        yield main, [*notes, f"{number} pieces of {dropped} triangles apart from the tire were left out"]


@dataclass(frozen=True, eq=False)
class _Unrolled:
    """A tire seen from around, m: turn (ny, nt) is its radius at y (ny,) and theta (nt,), top (ny,) its envelope."""

    theta: Array
    y: Array
    turn: Array
    top: Array
    sag: float
    crown: float
    caster: Caster

    @classmethod
    def of(cls, mesh: Mesh, outer: float) -> _Unrolled:
        low, high = mesh.vertices[:, 1].min(), mesh.vertices[:, 1].max()
        cells = max(8, int((high - low) / 1e-3))
        y = 0.5 * (low + high) + (high - low) / cells * (np.arange(cells) - 0.5 * (cells - 1))
        # Off the whole degrees, where drawn meshes have their edges.
        theta = np.arange(0.013, 2 * np.pi, math.radians(1))
        floor = outer - 2 * DEEPEST
        # What lies deeper is no tread, and counts as nothing met.
        radius = np.hypot(mesh.vertices[:, 0], mesh.vertices[:, 2])
        high = radius > floor
        faces = mesh.faces[high[mesh.faces].any(axis=1)]
        caster = Caster(mesh.vertices, faces)
        turn = radial(caster, theta, y, 1.5 * outer, floor)
        top = top_meridian(turn)
        sag = unrolling.facet_sag(mesh.vertices, mesh.faces, unrolling.beside(mesh.vertices, y, top))
        largest = float(radius[faces].max()) if len(faces) else math.inf
        return cls(theta, y, turn, top, sag, unrolling.crown(top, sag, turn, largest), caster)

    def scaled(self, factor: float) -> _Unrolled:
        lengths = {name: getattr(self, name) * factor for name in ("y", "turn", "top", "sag", "crown")}
        return replace(self, **lengths)


def _build(mesh: Mesh, name: str, options: ScanOptions, notes: list[str]) -> ScanSurface:
    """Surface of a mesh that holds a tire and nothing else."""
    mesh, far = sticking.without_needles(mesh)
    axis = fit_axis(*sample_surface(mesh.vertices, mesh.faces))
    _check_tire(mesh, axis, name)
    label, scale, warnings = scale_of(2 * axis.radius, options.units, options.nominal_diameter, name, options.scale)
    warnings += notes
    frame = _frame(mesh.vertices - axis.origin, axis, options.rotation)
    mesh = replace(mesh, vertices=scale * (mesh.vertices - axis.origin) @ frame)
    far = replace(far, where=scale * (far.where - axis.origin) @ frame)
    seen = _Unrolled.of(mesh, scale * axis.radius)
    _check_seen(seen, name)
    noise, flat, tread = _noise(mesh, seen)
    mesh, outliers = _without_outliers(mesh, seen, noise, far, options.outliers, name)
    are_lugs = options.outliers == "remove" and len(outliers) > sticking.MOST
    kept = options.outliers == "keep" or are_lugs
    if outliers:
        warnings.append(sticking.in_words(outliers, options.outliers == "keep", are_lugs))
    if outliers and not kept:
        seen = _Unrolled.of(mesh, scale * axis.radius)
        _check_seen(seen, name)
        noise, flat, tread = _noise(mesh, seen)
    _check_round(seen, options.roundness, name)
    arc = _degrees(seen)
    if arc < WARNED_ARC:
        warnings.append(
            f"the scan has tread on {arc:.0f}° of the turn, less than {WARNED_ARC}°: its axle may be 0.1° and "
            "0.3 mm off, several times that with 1 mm of noise or more; scan more of the turn"
        )
    rescaled = False
    if label == "scaled" and options.nominal_diameter is not None:
        factor = 0.5 * options.nominal_diameter / seen.crown
        rescaled = True
        scale, mesh, seen = scale * factor, replace(mesh, vertices=mesh.vertices * factor), seen.scaled(factor)
        noise, flat = noise * factor, flat * factor
    # The axle was fitted to most of the points; the tread is what rays from around met.
    check_diameter(2 * seen.crown, label, name)

    vertices, y = _amid_tread(mesh.vertices, seen)
    rows = seen.top > seen.crown - EXTENT_DROP
    meridian, envelope, crown = median_meridian(seen.turn), seen.top, seen.crown
    steady = unrolling.is_steady(seen.turn, meridian, rows, seen.sag, noise)
    turning, why = decide_revolve(options.revolve, options.smooth, steady, seen.sag, noise)
    warnings += why
    # Noise raises what is high on most of the turn; where nothing changes round it the middle will do.
    part = 0.5 if steady and noise > LARGEST_NOISE else DEEP_GROOVE
    floor = scale * axis.radius - 2 * DEEPEST
    ribbed = unrolling.high_meridian(seen.turn, part)
    floored = unrolling.with_floors(ribbed, crown, floor)
    shallowest = SHALLOWEST if steady else unrolling.shallowest_groove(seen.turn, seen.top)
    grooves = find_grooves(y, floored, crown, shallowest)
    if grooves and floored is not ribbed and (floored == floor).any():
        warnings.append(
            f"no ray met the floor of a groove within {(crown - floor) * 1e3:.0f} mm below the crown: the grooves "
            "are deeper than their depths here, or their floors were not scanned"
        )
    void = unrolling.wide_voids(y, np.where(rows, seen.top, np.nan)) & rows
    if void.any():
        warnings.append(
            f"{void.sum() * (y[1] - y[0]) * 1e3:.0f} mm of the width lie in voids wider than the "
            f"{WIDEST * 1e3:.0f} mm of a groove: none of them is listed, and all count as void"
        )
    land = unrolling.land_ratio(y, seen.turn, seen.top, rows, grooves)
    if turning:
        highest = float(unrolling.without_spikes(meridian).max())
        meridian = envelope = meridian + min(0.75 * seen.sag, crown - highest)
        crown = min(highest + 0.75 * seen.sag, crown)
    over = unrolling.scatter(seen.turn, meridian)[rows]
    spacing = apart(flat, tread) if options.smooth is not False else math.nan
    length, why = decide_smoothing(options.smooth, turning, steady, noise, spacing)
    warnings += why
    if length > 0:
        use = (flat[:, 2] > crown - DEEPEST) & (np.abs(flat[:, 0]) < (SECTOR + 3 * length / crown) * crown)
        level = np.interp(vertices[:, 1], y, unrolling.between_walls(y, envelope, WALLS))
        heights = smoothed(flat - level[:, None] * np.array([0.0, 0.0, 1.0]), use, length, noise)
        vertices = _at_radius(vertices, heights + level)
    quality = ScanQuality(
        n_points=len(mesh.vertices),
        n_faces=len(mesh.faces),
        units=label,
        scale=scale,
        crown_radius=crown,
        width=float(np.ptp(vertices[:, 1])),
        facet_sag=seen.sag,
        axis_residual=scale * axis.residual,
        theta_spread=float(np.sqrt(np.nanmean(over**2))) if np.isfinite(over).any() else math.nan,
        coverage=1.0,
        holes=0,
        hole_fraction=0.0,
        watertight=mesh.watertight,
        revolved=turning,
        grooves=grooves,
        noise=noise,
        smoothing=length,
        outliers=tuple(outliers),
        land_ratio=land,
        interrupted=interrupted_share(y[rows], seen.turn[rows], grooves),
    )
    if mesh.dropped:
        warnings.append(f"{mesh.dropped} triangles without area were left out")
    surface = ScanSurface(
        vertices, mesh.faces, float(options.camber), y, meridian, envelope, quality, options.fill_holes, name
    )
    if not (turning or length > 0 or rescaled or (outliers and kept)):
        surface.__dict__["_caster"] = seen.caster.moved(np.array([0.0, y[0] - seen.y[0], 0.0]))
    coverage, holes = surface.coverage
    if coverage < 1 - SMALL_HOLES:
        warnings.append(f"{1 - coverage:.1%} of the tread over the road was not scanned ({holes} holes)")
        try:
            surface.height_map(Grid.centred(*surface.extent, STANDARD_SPACING))
        except GeometryError as error:
            warnings.append(f"a contact with this scan will be rejected: {error}")
    quality = replace(quality, coverage=coverage, holes=holes, hole_fraction=1 - coverage, warnings=tuple(warnings))
    return surface.with_report(quality)


def _check_tire(mesh: Mesh, axis: Axis, name: str) -> None:
    along = (mesh.vertices - axis.origin) @ axis.direction
    proportion = float(np.ptp(along)) / (2 * axis.radius)
    low, high = POSSIBLE_PROPORTIONS
    if not low <= proportion <= high:
        raise GeometryError(
            f"{name!r} is {proportion:.2f} times as wide as its diameter, a tire is between {low} and {high} times; "
            "check that the file holds one tire and nothing else (no rim, ground or fixture)"
        )


def _without_outliers(
    mesh: Mesh, seen: _Unrolled, noise: float, far: sticking.Moved, wanted: str, name: str
) -> tuple[Mesh, list[Outlier]]:
    """The mesh without points that stick out of the tread, and which they were; raises GeometryError as wanted.

    far: points that were brought back before the axle was known, with the places where they had been.
    """
    high = max(sticking.LOWEST, sticking.DEVIATIONS * noise if math.isfinite(noise) else 0.0)
    reference = sticking.tread_reference(
        mesh.vertices, seen.y, seen.top + seen.sag, seen.turn, seen.theta, seen.crown - EXTENT_DROP
    )
    groups = sticking.find_outliers(mesh, reference, high)
    middle = sum(unrolling.reach(seen.y, seen.top, seen.crown - EXTENT_DROP)) / 2
    outliers = sticking.named(mesh, reference, groups, far, middle)
    if not outliers:
        return mesh, []
    has_lugs = unrolling.shallowest_groove(seen.turn, seen.top) > SHALLOWEST
    are_lugs = wanted == "remove" and len(outliers) > sticking.MOST and noise < LARGEST_NOISE and has_lugs
    if wanted == "keep" or are_lugs:
        return replace(mesh, vertices=far.undone(mesh.vertices)), outliers
    if wanted == "refuse" or len(outliers) > sticking.MOST:
        raise GeometryError(
            f"{name!r} sticks out of its tread in {len(outliers)} {'place' if len(outliers) == 1 else 'places'} "
            f"({'the highest ' if len(outliers) > 1 else ''}{outliers[0]})"
            + ("" if wanted == "refuse" else f", more than the {sticking.MOST} that are taken for errors")
            + '; clean the scan, or leave them in it with outliers="keep" where they belong to the tire'
        )
    return sticking.without_outliers(mesh, [far.points, *groups]), outliers


def _noise(mesh: Mesh, seen: _Unrolled) -> tuple[float, Array, BoolArray]:
    """Noise of the points, m, the unrolled vertices and which of them are tops of ribs and lugs."""
    flat = unrolled(mesh.vertices, seen.crown)
    height = unrolling.beside(mesh.vertices, seen.y, seen.top)
    with np.errstate(invalid="ignore"):
        tread = (np.abs(flat[:, 2] - height) < BAND + seen.sag) & (height > seen.crown - EXTENT_DROP)
    level = unrolling.is_level(seen.y, seen.top, BESIDE_WALLS, LEVEL)
    tread &= np.interp(mesh.vertices[:, 1], seen.y, level.astype(np.float64)) == 1
    over = np.stack([flat[:, 0], flat[:, 1], flat[:, 2] - height], axis=1)
    return radial_noise(over, mesh.faces, tread), flat, tread


def _check_seen(seen: _Unrolled, name: str) -> None:
    """Rays from around must meet a tread."""
    if _degrees(seen) < SMALLEST_ARC or not seen.crown - seen.sag > 0:
        raise GeometryError(
            f"{name!r} has tread on {_degrees(seen):.0f}° of the turn, at least {SMALLEST_ARC}° are needed for its "
            "axle; scan more of the tire, or check that the file holds one"
        )
    # A box reaches its outer radius with its corners only; a tire that was scanned in parts has few of them.
    holes, count = scipy.ndimage.label(~np.tile(np.isfinite(seen.turn).any(axis=0), 2))
    gaps = [run[0] for run in scipy.ndimage.find_objects(holes, max_label=count)]
    corners = sum(gap.stop - gap.start > CORNER for gap in gaps if 0 < gap.start < seen.turn.shape[1])
    if corners >= CORNERS:
        raise GeometryError(
            f"{name!r} is not round: it reaches its outer radius in {corners} places with more than {CORNER}° "
            "between them; check that the file holds one tire and nothing else (no rim, ground or fixture)"
        )
    with np.errstate(invalid="ignore"):
        if seen.sag > EXTENT_DROP or not (seen.top > seen.crown - EXTENT_DROP).any():
            raise GeometryError(
                f"the facets of {name!r} cut {seen.sag * 1e3:.0f} mm under the circle through their corners and "
                f"hide its tread of {EXTENT_DROP * 1e3:.0f} mm; export the mesh finer"
            )
        high = np.asarray(seen.top > seen.crown - EXTENT_DROP)
    runs, count = scipy.ndimage.label(~high)
    gaps = [run[0] for run in scipy.ndimage.find_objects(runs, max_label=count)]
    wide = [gap for gap in gaps if gap.start > 0 and gap.stop < len(high) and np.ptp(seen.y[gap]) > APART]
    for gap in wide:
        left, right = high[: gap.start].sum(), high[gap.stop :].sum()
        if min(left, right) > LIKE * max(left, right):
            raise GeometryError(
                f"{name!r} holds two treads side by side, {np.ptp(seen.y[gap]) * 1e3:.0f} mm apart; cut one tire out "
                "of the scan"
            )


def _degrees(seen: _Unrolled) -> float:
    """Of the turn that has tread."""
    return 360 * float(np.isfinite(seen.turn).any(axis=0).mean())


def _check_round(seen: _Unrolled, roundness: float, name: str) -> None:
    """A tire has the same radius at every angle, between its lugs as well; a box does not."""
    seen_columns = np.asarray(np.isfinite(seen.turn).any(axis=0))
    tops = np.full(len(seen_columns), -np.inf)
    tops[seen_columns] = np.nanmax(seen.turn[:, seen_columns], axis=0)
    window = round(LUG_WINDOW / (seen.theta[1] - seen.theta[0]))
    tops = scipy.ndimage.maximum_filter1d(tops, window, mode="wrap")[seen_columns]
    middle = float(np.median(tops))
    out = float(np.quantile(np.abs(tops - middle), 0.9))
    if out > roundness * seen.crown:
        raise GeometryError(
            f"{name!r} is not round: its radius varies by {out * 1e3:.0f} mm about {middle * 1e3:.0f} mm, more than "
            f"{roundness:.1%}; check that the file holds one tire and nothing else (no rim, ground or fixture), or "
            f"allow it with roundness={math.ceil(100 * out / seen.crown + 0.1) / 100:g} (--roundness, or roundness "
            "in the case)"
        )


def _frame(points: Array, axis: Axis, rotation: float) -> Array:
    """(3, 3) with the directions of travel, right and down as columns. points: (n, 3) from the axis' origin."""
    right = axis.direction
    right = right * np.sign(right[np.argmax(np.abs(right))])
    reference = next(-e for e in np.eye(3)[[2, 1, 0]] if abs(e @ right) < math.cos(math.pi / 4))
    first, second = across(right)
    if axis.arc < math.radians(300):
        # A scan of a part of the turn: its middle faces the road.
        tread = points[np.hypot(points @ first, points @ second) > 0.9 * axis.radius]
        turn = np.unique(np.round(np.arctan2(tread @ second, tread @ first), 1))
        reference = np.cos(turn).sum() * first + np.sin(turn).sum() * second
    down = reference - (reference @ right) * right
    down /= np.linalg.norm(down)
    ahead = np.cross(right, down)
    down = math.cos(rotation) * down + math.sin(rotation) * ahead
    return np.stack([np.cross(right, down), right, down], axis=1)


def _amid_tread(vertices: Array, seen: _Unrolled) -> tuple[Array, Array]:
    """Shift along the axle so that y = 0 is the middle of the tread."""
    shift = 0.5 * sum(unrolling.reach(seen.y, seen.top, seen.crown - EXTENT_DROP))
    return vertices - np.array([0.0, shift, 0.0]), seen.y - shift


def _at_radius(vertices: Array, radius: Array) -> Array:
    """The vertices moved along the radius."""
    factor = radius / np.maximum(np.hypot(vertices[:, 0], vertices[:, 2]), 1e-9)
    return vertices * np.stack([factor, np.ones_like(factor), factor], axis=1)
