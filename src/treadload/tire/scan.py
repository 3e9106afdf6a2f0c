"""From a raw tire mesh to a tread surface: pose, units, holes, facets."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from treadload.errors import GeometryError, InputError
from treadload.kernels.arrays import Array, BoolArray
from treadload.tire import meridian as unrolling
from treadload.tire.axis import Axis, across, fit_axis, sample_surface
from treadload.tire.ground import without_ground
from treadload.tire.mesh_file import Mesh, read_mesh
from treadload.tire.quality import ScanQuality
from treadload.tire.rays import Caster, radial
from treadload.tire.scan_surface import DEEPEST, EXTENT_DROP, SMALL_HOLES, Choice, ScanSurface

UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "inch": 0.0254}
_UNIT_NAMES = {
    **{name: name for name in UNITS},
    **{"metre": "m", "meter": "m", "metres": "m", "meters": "m", "millimetre": "mm", "millimeter": "mm"},
    **{
        "millimetres": "mm",
        "millimeters": "mm",
        "centimetre": "cm",
        "centimeter": "cm",
        "in": "inch",
        "inches": "inch",
    },
}
GUESSED_DIAMETERS = (0.4, 1.6)
POSSIBLE_DIAMETERS = (0.2, 4.5)
POSSIBLE_PROPORTIONS = (0.1, 0.8)  # width over outer diameter
UNIT_MATCH = 0.03

LARGEST_SAG = 0.001
ROUNDNESS = 0.02


def read_scan(
    path: str | Path,
    *,
    units: str | None = None,
    nominal_diameter: float | None = None,
    rotation: float = 0.0,
    camber: float = 0.0,
    revolve: Choice = "auto",
    fill_holes: Choice = "auto",
) -> ScanSurface:
    """Tread surface of a mesh file in any pose.

    path: OBJ, PLY, STL, GLB or OFF. units: "m", "cm", "mm" or "inch"; nominal_diameter: outer diameter, m, that
    tells the unit or, when none fits within 3 %, the scale; without both, the one unit that gives a diameter
    between 0.4 and 1.6 m. rotation: rad, brings the tread that much ahead of the reference down to the road; the
    reference is the file's -z (or -y, -x when the axle lies along it), for a partial scan its middle. camber: rad,
    positive when the top leans to the right. revolve: True replaces the facets by their revolved meridian, "auto"
    does so when they cut deeper than 1 mm under the circle and the tread does not depend on the angle.
    fill_holes: as in ScanSurface.
    A flat floor in the scan is taken away when no tire is found with it.
    The axle's right end is the one that points along the positive axis of the file.
    Raises InputError, GeometryError.
    """
    _check_options(nominal_diameter, rotation, camber, revolve, fill_holes)
    unit = _unit_name(units)
    mesh = read_mesh(path)
    name = Path(path).name

    def build(tire: Mesh, notes: list[str]) -> ScanSurface:
        return _build(tire, name, unit, nominal_diameter, rotation, camber, revolve, fill_holes, notes)

    try:
        return build(mesh, [])
    except (GeometryError, InputError):
        # With a floor the axle is not found; what is wrong then may look like wrong units.
        rest = without_ground(mesh)
        if rest is None:
            raise
        dropped = len(mesh.faces) - len(rest.faces)
        note = f"a flat floor of {dropped} triangles was taken away; the tread that stood on it may be flattened"
        try:
            return build(rest, [note])
        except (GeometryError, InputError):
            pass
        raise


def _build(
    mesh: Mesh,
    name: str,
    unit: str | None,
    nominal_diameter: float | None,
    rotation: float,
    camber: float,
    revolve: Choice,
    fill_holes: Choice,
    notes: list[str],
) -> ScanSurface:
    """Surface of a mesh that holds a tire and nothing else; arguments as in read_scan."""
    axis = fit_axis(*sample_surface(mesh.vertices, mesh.faces))
    _check_tire(mesh, axis, name)
    label, scale, warnings = _scale(2 * axis.radius, unit, nominal_diameter, name)
    warnings += notes
    vertices = scale * _to_wheel(mesh, axis, rotation)
    outer = scale * axis.radius

    low, high = vertices[:, 1].min(), vertices[:, 1].max()
    cells = int((high - low) / 1e-3)
    y = 0.5 * (low + high) + 1e-3 * (np.arange(cells) - 0.5 * (cells - 1))
    # Off the whole degrees, where drawn meshes have their edges.
    theta = np.arange(0.013, 2 * np.pi, math.radians(2))
    turn = radial(Caster(vertices, mesh.faces), theta, y, 1.5 * outer, outer - 2 * DEEPEST)
    sag = unrolling.facet_sag(vertices, mesh.faces, 1.5 * outer, outer - DEEPEST)
    top = unrolling.top_meridian(turn)
    crown = unrolling.crown(top, sag)
    _check_round(turn, crown, name)
    if label == "scaled" and nominal_diameter is not None:
        factor = 0.5 * nominal_diameter / crown
        scale, vertices = scale * factor, vertices * factor
        y, turn, top = y * factor, turn * factor, top * factor
        sag, crown = sag * factor, crown * factor
    vertices, y = _amid_tread(vertices, y, top, crown)
    meridian = unrolling.median_meridian(turn)
    turning, why = _decide_revolve(revolve, sag, turn, meridian, crown)
    warnings += why
    if turning:
        meridian = meridian + 0.75 * sag
    over = unrolling.scatter(turn, meridian)[_tread_rows(meridian, crown)]
    spread = float(np.sqrt(np.nanmean(over**2))) if np.isfinite(over).any() else math.nan
    quality = ScanQuality(
        n_points=len(mesh.vertices),
        n_faces=len(mesh.faces),
        units=label,
        scale=scale,
        crown_radius=crown,
        width=float(np.ptp(vertices[:, 1])),
        facet_sag=sag,
        axis_residual=scale * axis.residual,
        theta_spread=spread,
        coverage=1.0,
        holes=0,
        hole_fraction=0.0,
        watertight=mesh.watertight,
        revolved=turning,
        grooves=unrolling.find_grooves(y, meridian, crown),
    )
    if mesh.dropped:
        warnings.append(f"{mesh.dropped} triangles without area were left out")
    surface = ScanSurface(vertices, mesh.faces, float(camber), y, meridian, quality, fill_holes, name)
    coverage, holes = surface.coverage
    if coverage < 1 - SMALL_HOLES:
        warnings.append(f"{1 - coverage:.1%} of the tread over the road has no scan ({holes} holes)")
    quality = replace(quality, coverage=coverage, holes=holes, hole_fraction=1 - coverage, warnings=tuple(warnings))
    return surface.with_report(quality)


def _check_options(diameter: float | None, rotation: float, camber: float, revolve: Choice, fill: Choice) -> None:
    if diameter is not None and not POSSIBLE_DIAMETERS[0] <= diameter <= POSSIBLE_DIAMETERS[1]:
        raise InputError(
            f"nominal_diameter must lie between {POSSIBLE_DIAMETERS[0]} and {POSSIBLE_DIAMETERS[1]} m, "
            f"got {diameter:g}; give it in m, a 315/80R22.5 has 1.076"
        )
    if not math.isfinite(rotation):
        raise InputError(f"rotation must be a finite angle in rad, got {rotation}")
    if not abs(camber) <= math.radians(15):
        raise InputError(f"camber must lie within ±0.262 rad (15°), got {camber}; give it in rad")
    for name, value in (("revolve", revolve), ("fill_holes", fill)):
        if value not in (True, False, "auto"):
            raise InputError(f'{name} must be True, False or "auto", got {value!r}')


def _unit_name(units: str | None) -> str | None:
    if units is None:
        return None
    name = _UNIT_NAMES.get(str(units).strip().lower())
    if name is None:
        raise InputError(f"unknown units {units!r} of a scan; use one of {', '.join(UNITS)}")
    return name


def _check_tire(mesh: Mesh, axis: Axis, name: str) -> None:
    along = (mesh.vertices - axis.origin) @ axis.direction
    proportion = float(np.ptp(along)) / (2 * axis.radius)
    low, high = POSSIBLE_PROPORTIONS
    if not low <= proportion <= high:
        raise GeometryError(
            f"{name!r} is {proportion:.2f} times as wide as its diameter, a tire is between {low} and {high} times; "
            "check that the file holds one tire and nothing else (no rim, ground or fixture)"
        )


def _check_round(turn: Array, crown: float, name: str) -> None:
    """A tire has the same radius at every angle, a box has not."""
    known = np.isfinite(turn)
    seen = known.any(axis=0)
    if seen.sum() < turn.shape[1] * 30 / 360:
        raise GeometryError(
            f"{name!r} has tread on {seen.mean() * 360:.0f}° of the turn, at least 30° are needed; "
            "scan more of the tire, or check that the file holds one"
        )
    tops = np.nanmax(turn[:, seen], axis=0)
    middle = float(np.median(tops))
    out = float(np.quantile(np.abs(tops - middle), 0.9))
    if out > ROUNDNESS * crown:
        raise GeometryError(
            f"{name!r} is not round: its radius varies by {out * 1e3:.0f} mm about {middle * 1e3:.0f} mm, more than "
            f"{ROUNDNESS:.0%}; check that the file holds one tire and nothing else (no rim, ground or fixture)"
        )


def _scale(diameter: float, unit: str | None, nominal: float | None, name: str) -> tuple[str, float, list[str]]:
    """Unit, metres per unit of the file and warnings. diameter: outer, in the unit of the file. nominal: m."""
    warnings = []
    if unit is not None:
        scale = UNITS[unit]
        if nominal is not None and abs(diameter * scale / nominal - 1) > UNIT_MATCH:
            warnings.append(
                f"the outer diameter is {diameter * scale:.4g} m in {unit} and not the nominal {nominal:.4g} m"
            )
    elif nominal is not None:
        off = {key: abs(diameter * value / nominal - 1) for key, value in UNITS.items()}
        unit = min(off, key=lambda key: off[key])
        scale = UNITS[unit]
        if off[unit] > UNIT_MATCH:
            unit, scale = "scaled", nominal / diameter
            warnings.append(
                f"no unit makes {diameter:.4g} in the file the nominal diameter; scaled by {scale:.6g} m per unit"
            )
    else:
        low, high = GUESSED_DIAMETERS
        fits = [key for key, value in UNITS.items() if low <= diameter * value <= high]
        if len(fits) != 1:
            found = ", ".join(f"{diameter * value:.3g} m in {key}" for key, value in UNITS.items())
            raise InputError(
                f"the units of {name!r} cannot be told: its outer diameter of {diameter:.4g} would be {found}, and "
                f"{'none' if not fits else 'more than one'} lies between {low} and {high} m; give units= or "
                "nominal_diameter="
            )
        unit, scale = fits[0], UNITS[fits[0]]
    low, high = POSSIBLE_DIAMETERS
    if not low <= diameter * scale <= high:
        raise InputError(
            f"in {unit} the tire of {name!r} would have an outer diameter of {diameter * scale:.3g} m, outside "
            f"{low} to {high} m; give other units= or nominal_diameter="
        )
    return unit, scale, warnings


def _to_wheel(mesh: Mesh, axis: Axis, rotation: float) -> Array:
    """Vertices in the frame of the wheel, in the unit of the file."""
    right = axis.direction
    right = right * np.sign(right[np.argmax(np.abs(right))])
    reference = next(-e for e in np.eye(3)[[2, 1, 0]] if abs(e @ right) < math.cos(math.pi / 4))
    first, second = across(right)
    points = mesh.vertices - axis.origin
    if axis.arc < math.radians(300):
        # A scan of a part of the turn: its middle faces the road.
        tread = points[np.hypot(points @ first, points @ second) > 0.9 * axis.radius]
        turn = np.unique(np.round(np.arctan2(tread @ second, tread @ first), 1))
        reference = np.cos(turn).sum() * first + np.sin(turn).sum() * second
    down = reference - (reference @ right) * right
    down /= np.linalg.norm(down)
    ahead = np.cross(right, down)
    down = math.cos(rotation) * down + math.sin(rotation) * ahead
    return np.asarray(points @ np.stack([np.cross(right, down), right, down], axis=1), dtype=np.float64)


def _tread_rows(meridian: Array, crown: float) -> BoolArray:
    with np.errstate(invalid="ignore"):
        return np.asarray(meridian > crown - EXTENT_DROP, dtype=bool)


def _amid_tread(vertices: Array, y: Array, top: Array, crown: float) -> tuple[Array, Array]:
    """Shift along the axle so that y = 0 is the middle of the tread."""
    left, right = unrolling.reach(y, top, crown - EXTENT_DROP)
    shift = 0.5 * (left + right)
    return vertices - np.array([0.0, shift, 0.0]), y - shift


def _decide_revolve(
    revolve: Choice, sag: float, turn: Array, meridian: Array, crown: float
) -> tuple[bool, list[str]]:
    over = unrolling.scatter(turn, meridian)[_tread_rows(meridian, crown)]
    over = np.abs(over[np.isfinite(over)])
    steady = over.size > 0 and float(np.quantile(over, 0.95)) < max(1.5 * sag, LARGEST_SAG)
    if revolve is True:
        return True, [] if steady else [
            "the tread is not the same all round the tire: revolving it loses what changes"
        ]
    if sag <= LARGEST_SAG:
        return False, []
    if revolve == "auto" and steady:
        return True, [f"facets cut {sag * 1e3:.1f} mm under the circle: the tread is its meridian revolved instead"]
    advice = "use a finer mesh" if not steady else "use revolve=True, as the tread does not depend on the angle"
    return False, [f"facets cut {sag * 1e3:.1f} mm under the circle and will show in the contact; {advice}"]
