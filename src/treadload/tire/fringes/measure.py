"""Pictures of fringes to the height map of a tread."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import xarray as xr

from treadload.describing import first_line
from treadload.errors import GeometryError, InputError
from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.fringes.asked import Evaluation, Pattern, check, full_level, least_modulation
from treadload.tire.fringes.calibration import CameraProjector, Points, ReferencePlane
from treadload.tire.fringes.gamma import gamma_of, phase_error, without_gamma
from treadload.tire.fringes.harmonics import leftovers
from treadload.tire.fringes.mapping import as_travelled, not_steep, onto_cells, usual_spacing
from treadload.tire.fringes.quality import FringeQuality
from treadload.tire.fringes.steps import Steps, solve_steps, wrapped
from treadload.tire.fringes.unwrapping import Unwrapped, unwrap_by_periods, unwrap_over_picture
from treadload.tire.tire import Tire
from treadload.variables import dataset

# Cells of a map seen in perspective, in pixels.
_PIXELS_PER_CELL = 1.5
# What is worth a warning: error that gamma leaves, rad; share of pixels; order, of half a turn, in deviations;
# doubt of the estimate of gamma; grey levels in the brightest bin.
_RIPPLE, _SHARE, _CLOSE, _DOUBT, _TOP = 0.02, 0.25, 1 / 4, 0.02, 1e-3


@dataclass(frozen=True, eq=False)
class FringeScan:
    """A tread measured with fringes.

    dataset: initial_gap and gap_deviation over (y, x), m. pixels: phase, modulation, brightness, height and its
    deviation over (row, column) of the pictures. quality: how the pictures were understood.
    """

    dataset: xr.Dataset
    pixels: xr.Dataset
    quality: FringeQuality

    def tire(self, **about: Any) -> Tire:
        """The tire of this height map. about: as `Tire.from_height_map` takes it, material or inflation_pressure."""
        return Tire.from_height_map(self.dataset["initial_gap"], **about)

    def summary(self) -> str:
        """The quality, in lines."""
        return str(self.quality)

    __repr__ = first_line


@dataclass(eq=False)
class _Record:
    """What is learnt on the way."""

    warnings: list[str] = field(default_factory=list)
    noise: float = math.nan
    gamma: float = math.nan
    corrected: float = 1.0


def measure_fringes(
    patterns: Sequence[Pattern],
    calibration: ReferencePlane | CameraProjector,
    evaluation: Evaluation | None = None,
) -> FringeScan:
    """Height map of a tread from pictures of it under fringes.

    Phases by least squares over the steps, their order by several patterns or, of one alone, over the picture from an
    anchor; heights by the calibration; pixels in shadow, saturated, of uncertain order or at walls are given up; a
    saturated step is left out where three or more remain. The deviation of a height is what the noise of the pictures
    makes through the modulation, σ_φ = √2 σ_I/(√N B) for N equal steps of modulation B, on tread and reference.
    Raises InputError and GeometryError (nothing is left).
    """
    asked = evaluation or Evaluation()
    patterns = sorted(patterns, key=lambda one: one.fringes)
    check(patterns, calibration, asked)
    full = asked.saturation or full_level(patterns[-1].tread)
    record = _Record()
    _check_top(patterns[-1].tread, asked, full, record)
    shape = patterns[0].tread.shape[1:]
    tread = [_steps(one, one.tread, full) for one in patterns]
    dim = [~(step.modulation >= least_modulation(patterns, asked)) for step in tread]
    lost = np.zeros(shape, dtype=bool)
    for step in tread:
        lost |= ~step.known
    shadow = np.any(dim, axis=0) & ~lost
    _learn(patterns[-1], tread[-1], ~(shadow | lost), asked, record)
    usable = ~(shadow | lost)
    if not usable.any():
        raise GeometryError(
            f"no pixel is left: {lost.mean():.0%} are saturated in too many steps and {shadow.mean():.0%} are "
            f"modulated by less than {asked.shadow:.0%} of the range; change the exposure"
        )
    found, phase, own = _phase(patterns, tread, usable, calibration, asked, record)
    plane_residual, c = math.nan, None
    if isinstance(calibration, ReferencePlane):
        flat, base, deviation = _flat(patterns, full, asked, record)
        on_planes = [_flat(patterns, full, asked, record, k)[0] for k in range(len(calibration.heights))]
        c, e, plane_residual = calibration.coefficients([one - flat for one in on_planes], shape)
        if len(patterns) == 1:
            phase, gone = _alone(wrapped(phase - base), c, e, asked)
            found = replace(found, unsure=gone)
        else:
            phase = phase - flat
        points, sigma = calibration.points(phase, c, e), np.hypot(own, deviation)
        _judge_planes(calibration, plane_residual, record)
    else:
        points, sigma = calibration.points(phase, patterns[-1].fringes), own
    return _mapped(points, sigma, asked, calibration, record, tread, patterns, found, (shadow, lost), plane_residual)


def _steps(pattern: Pattern, pictures: Array, full: float | None) -> Steps:
    return solve_steps(pictures, pattern.shifts, full)


def _learn(pattern: Pattern, steps: Steps, use: BoolArray, asked: Evaluation, record: _Record) -> None:
    """Noise and gamma, of the finest pattern on the tread."""
    count = len(pattern.tread)
    whole = use & (steps.used == count)
    ratio, noise, doubt = leftovers(pattern.tread, steps, pattern.shifts, whole)
    record.noise = asked.noise if asked.noise is not None else noise
    if math.isnan(record.noise):
        record.warnings.append(
            "three steps leave nothing to tell the noise from, so no deviation of the heights is given; give noise "
            "in grey levels, or take four steps or more"
        )
    told = math.isfinite(ratio) and doubt < _DOUBT
    if told:
        with np.errstate(all="ignore"):
            try:
                record.gamma = gamma_of(ratio, asked.contrast)
            except InputError:
                told = False
    record.corrected = gamma_of(ratio, asked.contrast) if asked.gamma == "auto" else float(asked.gamma)
    if told:
        left = phase_error(pattern.shifts, count, record.gamma, asked.contrast)
        if record.corrected != 1:
            left = left - phase_error(pattern.shifts, count, record.corrected, asked.contrast)
        ripple = float(np.sqrt((left**2).mean()))
        if ripple > _RIPPLE:
            record.warnings.append(
                f"the fringes have the harmonics of a gamma of {record.gamma:.2f}, which leave {ripple:.2g} rad rms "
                f'in the phase of {count} steps: give gamma = "auto", or take more steps'
            )


def _corrected(pattern: Pattern, steps: Steps, asked: Evaluation, record: _Record) -> Array:
    if record.corrected == 1:
        return steps.phase
    return without_gamma(steps.phase, pattern.shifts, len(pattern.tread), record.corrected, asked.contrast)


def _phase(
    patterns: Sequence[Pattern],
    steps: Sequence[Steps],
    usable: BoolArray,
    calibration: ReferencePlane | CameraProjector,
    asked: Evaluation,
    record: _Record,
) -> tuple[Unwrapped, Array, Array]:
    """Order of the finest phase, the phase itself where usable, and its deviation, rad."""
    phases = [
        np.where(usable, _corrected(one, step, asked, record), np.nan)
        for one, step in zip(patterns, steps, strict=True)
    ]
    noise = record.noise if math.isfinite(record.noise) else 0.0
    deviations = [step.spread * noise for step in steps]
    own = steps[-1].spread * record.noise
    if len(patterns) == 1:
        if isinstance(calibration, CameraProjector):
            found = unwrap_by_periods(phases, [patterns[0].fringes], deviations)
            return found, found.phase, own
        return Unwrapped(phases[0], 0, (patterns[0].fringes,), 0.0), phases[0], own
    found = unwrap_by_periods(phases, [one.fringes for one in patterns], deviations)
    if found.margin > _CLOSE:
        record.warnings.append(
            f"noise alone brings the median pixel {found.margin:.0%} of the way to a wrong fringe: take more steps, "
            "a brighter picture, or fringe counts that grow more slowly"
        )
    return found, found.phase, own


def _flat(
    patterns: Sequence[Pattern], full: float | None, asked: Evaluation, record: _Record, plane: int | None = None
) -> tuple[Array, Array, Array]:
    """Absolute and wrapped phase on a plane, or the reference (None), and its deviation, rad."""
    phases, deviations = [], []
    for one in patterns:
        pictures = one.reference if plane is None else one.planes[plane]
        assert pictures is not None
        steps = _steps(one, pictures, full)
        dark = ~(steps.modulation >= least_modulation(patterns, asked))
        phases.append(np.where(dark, np.nan, _corrected(one, steps, asked, record)))
        deviations.append(steps.spread * record.noise)
    if not np.isfinite(phases[-1]).any():
        raise InputError("the pictures of the reference plane are dark or saturated everywhere; change the exposure")
    if len(patterns) == 1:
        if plane is None:
            return phases[0], phases[0], deviations[0]
        # Of planes the order is told by their own heights, which grow.
        raise InputError(
            "heights of further planes need patterns of several fringe counts; give distance, baseline and period"
        )
    quiet = [np.nan_to_num(one) for one in deviations]
    return unwrap_by_periods(phases, [one.fringes for one in patterns], quiet).phase, phases[-1], deviations[-1]


def _alone(phase: Array, c: Array, e: Array, asked: Evaluation) -> tuple[Array, int]:
    """Phase above the plane of one pattern, from its anchor."""
    assert asked.anchor is not None
    row, column, height = asked.anchor
    rows, columns = phase.shape
    inside = 0 <= row < rows and 0 <= column < columns
    # h (c + e Δφ) = Δφ.
    value = float(height * c[row, column] / (1 - height * e[row, column])) if inside else 0.0
    return unwrap_over_picture(phase, (row, column), value)


def _judge_planes(calibration: ReferencePlane, residual: float, record: _Record) -> None:
    if calibration.is_linear:
        record.warnings.append(
            "one plane gives the linear form of height against phase; add a second height where the tread is deep"
        )
    if math.isfinite(residual) and residual > 1e-4:
        record.warnings.append(
            f"the planes lie {residual * 1e3:.2f} mm rms from their own calibration; look for a lens that distorts, "
            "gamma, or a wrong height"
        )


def _mapped(
    points: Points,
    sigma: Array,
    asked: Evaluation,
    calibration: ReferencePlane | CameraProjector,
    record: _Record,
    steps: Sequence[Steps],
    patterns: Sequence[Pattern],
    found: Unwrapped,
    masks: tuple[BoolArray, BoolArray],
    plane_residual: float,
) -> FringeScan:
    """Heights on the cells of a map, with what became of the pixels."""
    size = points.height.size
    pixel = usual_spacing(points.x, points.y)
    known = np.isfinite(points.height) & np.isfinite(points.x)
    kept = not_steep(np.where(known, points.height, np.nan), pixel, asked.steepest) if known.any() else known
    deviation = points.per_radian * sigma
    x, y = as_travelled(points.x[kept], points.y[kept], asked.travel)
    straight = (
        isinstance(calibration, ReferencePlane) and (calibration.camera_distance or calibration.distance) is None
    )
    spacing = asked.spacing or pixel * (1.0 if straight else _PIXELS_PER_CELL)
    if kept.any() and spacing < 0.99 * pixel:
        raise InputError(
            f"cells of {spacing * 1e3:.3g} mm are finer than the pixels, {pixel * 1e3:.3g} mm apart; give spacing of "
            "a pixel or more"
        )
    cells = onto_cells(x, y, points.height[kept], deviation[kept], spacing)
    shadow, lost = masks
    spared = kept & np.any([step.used < len(one.tread) for step, one in zip(steps, patterns, strict=True)], axis=0)
    median = _median(deviation[kept])
    quality = FringeQuality(
        shape=(points.height.shape[0], points.height.shape[1]),
        fringes=tuple(one.fringes for one in patterns),
        steps=tuple(len(one.tread) for one in patterns),
        kept=float(kept.mean()),
        shadow=float(shadow.mean()),
        saturated=float(lost.mean()),
        unsure=found.unsure / size,
        steep=float((known & ~kept).mean()),
        spared=float(spared.mean()),
        modulation=_median(steps[-1].modulation[kept]),
        noise=record.noise,
        gamma=record.gamma,
        corrected=record.corrected,
        deviation=median,
        plane_residual=plane_residual,
        cell=spacing,
        filled=cells.filled,
        coverage=float(np.isfinite(cells.height).mean()),
    )
    quality = replace(quality, warnings=(*record.warnings, *_doubts(quality)))
    fields = {
        "initial_gap": (("y", "x"), np.nanmax(cells.height) - cells.height),
        "gap_deviation": (("y", "x"), cells.deviation),
    }
    about = {"tire": "tread measured with fringes", "quality": str(quality)}
    grid = cells.grid
    seen = {
        "fringe_phase": found.phase,
        "fringe_modulation": steps[-1].modulation,
        "fringe_brightness": steps[-1].brightness,
        "fringe_height": np.where(kept, points.height, np.nan),
        "fringe_deviation": np.where(kept, deviation, np.nan),
    }
    rows, columns = points.height.shape
    return FringeScan(
        dataset(fields, {"x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy, **about),
        dataset(
            {name: (("row", "column"), values) for name, values in seen.items()},
            {"row": np.arange(rows), "column": np.arange(columns)},
            least_modulation=least_modulation(patterns, asked),
        ),
        quality,
    )


def _doubts(quality: FringeQuality) -> list[str]:
    told = []
    if quality.shadow > _SHARE:
        told.append(
            f"{quality.shadow:.0%} of the pixels are in shadow; bring camera and projector closer, or brighten"
        )
    if quality.saturated > _SHARE:
        told.append(f"{quality.saturated:.0%} of the pixels are saturated in too many steps; shorten the exposure")
    if quality.unsure > _SHARE:
        told.append(
            f"the fringe of {quality.unsure:.0%} of the pixels is not certain; check the order of the pictures"
        )
    return told


def _check_top(tread: Array, asked: Evaluation, full: float | None, record: _Record) -> None:
    """Say when a camera fills before its file does, or nothing tells when it is full."""
    top = float(tread.max())
    share = float((tread == top).mean())
    if asked.saturation is None and (full is None or top < full) and share > _TOP:
        record.warnings.append(
            f"{share:.1%} of the grey levels are {top:g}, the brightest there is: where that is a full camera, give "
            f"saturation = {top:g}"
        )


def _median(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else math.nan
