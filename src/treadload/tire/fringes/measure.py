"""Pictures of fringes to the height map of a tread."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Unpack

import numpy as np

from treadload.deferred import xarray as xr
from treadload.describing import Described
from treadload.errors import GeometryError, InputError
from treadload.kernels.arrays import Array, BoolArray
from treadload.rows import Row
from treadload.tire.fringes.calibration import CameraProjector, Points, ReferencePlane
from treadload.tire.fringes.gamma import gamma_of, phase_error, without_gamma
from treadload.tire.fringes.harmonics import leftovers
from treadload.tire.fringes.mapping import as_travelled, not_steep, onto_cells, usual_spacing
from treadload.tire.fringes.patterns import Evaluation, Pattern, check, full_level, least_modulation
from treadload.tire.fringes.quality import FringeQuality
from treadload.tire.fringes.steps import Steps, solve_steps, wrapped
from treadload.tire.fringes.unwrapping import Unwrapped, unwrap_by_periods, unwrap_over_picture
from treadload.tire.keywords import BodyKeys
from treadload.tire.tire import Tire
from treadload.variables import dataset

# Cells of a map seen in perspective, in pixels.
_PIXELS_PER_CELL = 1.5
# What is worth a warning: error that gamma leaves, rad; share of pixels; order, of half a turn, in deviations;
# uncertainty of the estimate of gamma; grey levels in the brightest bin.
_RIPPLE, _SHARE, _CLOSE, _UNCERTAINTY, _TOP = 0.02, 0.25, 1 / 4, 0.02, 1e-3


@dataclass(frozen=True, eq=False)
class FringeScan(Described):
    """A tread measured with fringes.

    dataset: initial_gap and gap_deviation over (y, x), m. pixels: phase, modulation, brightness, height and its
    deviation over (row, column) of the pictures. quality: how the pictures were understood.
    """

    dataset: xr.Dataset
    pixels: xr.Dataset
    quality: FringeQuality

    def tire(self, **about: Unpack[BodyKeys]) -> Tire:
        """The tire of this height map. about: as `Tire.from_height_map` takes it, material or inflation_pressure."""
        return Tire.from_height_map(self.dataset["initial_gap"], **about)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences for the user."""
        return self.quality.warnings

    def rows(self) -> tuple[Row, ...]:
        """The quality."""
        return self.quality.rows()


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
    options = evaluation or Evaluation()
    patterns = sorted(patterns, key=lambda pattern: pattern.fringes)
    check(patterns, calibration, options)
    full = options.saturation or full_level(patterns[-1].tread)
    record = _Record()
    _check_top(patterns[-1].tread, options, full, record)
    shape = patterns[0].tread.shape[1:]
    tread = [_steps(pattern, pattern.tread, full) for pattern in patterns]
    dim = [~(step.modulation >= least_modulation(patterns, options)) for step in tread]
    lost = np.zeros(shape, dtype=bool)
    for step in tread:
        lost |= ~step.valid
    shadow = np.any(dim, axis=0) & ~lost
    _learn(patterns[-1], tread[-1], ~(shadow | lost), options, record)
    usable = ~(shadow | lost)
    if not usable.any():
        raise GeometryError(
            f"no pixel is left: {lost.mean():.0%} are saturated in too many steps and {shadow.mean():.0%} are "
            f"modulated by less than {options.shadow:.0%} of the range; change the exposure"
        )
    unwrapped, phase, spread = _phase(patterns, tread, usable, calibration, options, record)
    plane_residual, c = math.nan, None
    if isinstance(calibration, ReferencePlane):
        flat, base, deviation = _flat(patterns, full, options, record)
        on_planes = [_flat(patterns, full, options, record, k)[0] for k in range(len(calibration.heights))]
        c, e, plane_residual = calibration.coefficients([on_plane - flat for on_plane in on_planes], shape)
        if len(patterns) == 1:
            phase, gone = _alone(wrapped(phase - base), c, e, options)
            unwrapped = replace(unwrapped, unsure=gone)
        else:
            phase = phase - flat
        points, sigma = calibration.points(phase, c, e), np.hypot(spread, deviation)
        _judge_planes(calibration, plane_residual, record)
    else:
        points, sigma = calibration.points(phase, patterns[-1].fringes), spread
    pixels = _Pixels(points, sigma, unwrapped, shadow, lost)
    return _mapped(pixels, options, calibration, record, list(zip(tread, patterns, strict=True)), plane_residual)


def _steps(pattern: Pattern, pictures: Array, full: float | None) -> Steps:
    return solve_steps(pictures, pattern.shifts, full)


def _learn(pattern: Pattern, steps: Steps, use: BoolArray, evaluation: Evaluation, record: _Record) -> None:
    """Noise and gamma, of the finest pattern on the tread."""
    count = len(pattern.tread)
    whole = use & (steps.used == count)
    ratio, noise, uncertainty = leftovers(pattern.tread, steps, pattern.shifts, whole)
    record.noise = evaluation.noise if evaluation.noise is not None else noise
    if math.isnan(record.noise):
        record.warnings.append(
            "three steps leave nothing to determine the noise from, so no deviation of the heights is given; give "
            "noise in grey levels, or take four steps or more"
        )
    certain = math.isfinite(ratio) and uncertainty < _UNCERTAINTY
    if certain:
        with np.errstate(all="ignore"):
            try:
                record.gamma = gamma_of(ratio, evaluation.contrast)
            except InputError:
                certain = False
    record.corrected = gamma_of(ratio, evaluation.contrast) if evaluation.gamma == "auto" else float(evaluation.gamma)
    if certain:
        left = phase_error(pattern.shifts, count, record.gamma, evaluation.contrast)
        if record.corrected != 1:
            left = left - phase_error(pattern.shifts, count, record.corrected, evaluation.contrast)
        ripple = float(np.sqrt((left**2).mean()))
        if ripple > _RIPPLE:
            record.warnings.append(
                f"the fringes have the harmonics of a gamma of {record.gamma:.2f}, which leave {ripple:.2g} rad rms "
                f'in the phase of {count} steps: give gamma = "auto", or take more steps'
            )


def _corrected(pattern: Pattern, steps: Steps, evaluation: Evaluation, record: _Record) -> Array:
    if record.corrected == 1:
        return steps.phase
    return without_gamma(steps.phase, pattern.shifts, len(pattern.tread), record.corrected, evaluation.contrast)


def _phase(
    patterns: Sequence[Pattern],
    steps: Sequence[Steps],
    usable: BoolArray,
    calibration: ReferencePlane | CameraProjector,
    evaluation: Evaluation,
    record: _Record,
) -> tuple[Unwrapped, Array, Array]:
    """Order of the finest phase, the phase itself where usable, and its deviation, rad."""
    phases = [
        np.where(usable, _corrected(pattern, step, evaluation, record), np.nan)
        for pattern, step in zip(patterns, steps, strict=True)
    ]
    noise = record.noise if math.isfinite(record.noise) else 0.0
    deviations = [step.spread * noise for step in steps]
    noise_phase = steps[-1].spread * record.noise
    if len(patterns) == 1:
        if isinstance(calibration, CameraProjector):
            unwrapped = unwrap_by_periods(phases, [patterns[0].fringes], deviations)
            return unwrapped, unwrapped.phase, noise_phase
        return Unwrapped(phases[0], 0, 0.0), phases[0], noise_phase
    unwrapped = unwrap_by_periods(phases, [pattern.fringes for pattern in patterns], deviations)
    if unwrapped.margin > _CLOSE:
        record.warnings.append(
            f"noise alone brings the median pixel {unwrapped.margin:.0%} of the way to a wrong fringe: take more "
            "steps, a brighter picture, or fringe counts that grow more slowly"
        )
    return unwrapped, unwrapped.phase, noise_phase


def _flat(
    patterns: Sequence[Pattern], full: float | None, evaluation: Evaluation, record: _Record, plane: int | None = None
) -> tuple[Array, Array, Array]:
    """Absolute and wrapped phase on a plane, or the reference (None), and its deviation, rad."""
    phases, deviations = [], []
    for pattern in patterns:
        pictures = pattern.reference if plane is None else pattern.planes[plane]
        assert pictures is not None
        steps = _steps(pattern, pictures, full)
        dark = ~(steps.modulation >= least_modulation(patterns, evaluation))
        phases.append(np.where(dark, np.nan, _corrected(pattern, steps, evaluation, record)))
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
    quiet = [np.nan_to_num(deviation) for deviation in deviations]
    return (
        unwrap_by_periods(phases, [pattern.fringes for pattern in patterns], quiet).phase,
        phases[-1],
        deviations[-1],
    )


def _alone(phase: Array, c: Array, e: Array, evaluation: Evaluation) -> tuple[Array, int]:
    """Phase above the plane of one pattern, from its anchor."""
    assert evaluation.anchor is not None
    row, column, height = evaluation.anchor
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


@dataclass(frozen=True, eq=False)
class _Pixels:
    """Heights of the pixels, the deviation of their phase, rad, and which are in shadow or saturated."""

    points: Points
    sigma: Array
    unwrapped: Unwrapped
    shadow: BoolArray
    lost: BoolArray


def _mapped(
    pixels: _Pixels,
    evaluation: Evaluation,
    calibration: ReferencePlane | CameraProjector,
    record: _Record,
    phases: Sequence[tuple[Steps, Pattern]],
    plane_residual: float,
) -> FringeScan:
    """Heights on the cells of a map, with what became of the pixels. phases: of every pattern."""
    points, sigma, unwrapped = pixels.points, pixels.sigma, pixels.unwrapped
    size = points.height.size
    pixel = usual_spacing(points.x, points.y)
    finite = np.isfinite(points.height) & np.isfinite(points.x)
    kept = not_steep(np.where(finite, points.height, np.nan), pixel, evaluation.steepest) if finite.any() else finite
    deviation = points.per_radian * sigma
    x, y = as_travelled(points.x[kept], points.y[kept], evaluation.travel)
    straight = (
        isinstance(calibration, ReferencePlane) and (calibration.camera_distance or calibration.distance) is None
    )
    spacing = evaluation.spacing or pixel * (1.0 if straight else _PIXELS_PER_CELL)
    if kept.any() and spacing < 0.99 * pixel:
        raise InputError(
            f"cells of {spacing * 1e3:.3g} mm are finer than the pixels, {pixel * 1e3:.3g} mm apart; give spacing of "
            "a pixel or more"
        )
    cells = onto_cells(x, y, points.height[kept], deviation[kept], spacing)
    spared = kept & np.any([step.used < len(pattern.tread) for step, pattern in phases], axis=0)
    median = _median(deviation[kept])
    quality = FringeQuality(
        shape=(points.height.shape[0], points.height.shape[1]),
        fringes=tuple(pattern.fringes for _, pattern in phases),
        steps=tuple(len(pattern.tread) for _, pattern in phases),
        kept=float(kept.mean()),
        shadow=float(pixels.shadow.mean()),
        saturated=float(pixels.lost.mean()),
        unsure=unwrapped.unsure / size,
        steep=float((finite & ~kept).mean()),
        spared=float(spared.mean()),
        modulation=_median(phases[-1][0].modulation[kept]),
        noise=record.noise,
        gamma=record.gamma,
        corrected=record.corrected,
        deviation=median,
        plane_residual=plane_residual,
        cell=spacing,
        filled=cells.filled,
        coverage=float(np.isfinite(cells.height).mean()),
    )
    quality = replace(quality, warnings=(*record.warnings, *_caveats(quality)))
    fields = {
        "initial_gap": (("y", "x"), np.nanmax(cells.height) - cells.height),
        "gap_deviation": (("y", "x"), cells.deviation),
    }
    about = {"tire": "tread measured with fringes", "quality": str(quality)}
    grid = cells.grid
    seen = {
        "fringe_phase": unwrapped.phase,
        "fringe_modulation": phases[-1][0].modulation,
        "fringe_brightness": phases[-1][0].brightness,
        "fringe_height": np.where(kept, points.height, np.nan),
        "fringe_deviation": np.where(kept, deviation, np.nan),
    }
    rows, columns = points.height.shape
    return FringeScan(
        dataset(fields, {"x": grid.x, "y": grid.y}, dx=grid.dx, dy=grid.dy, **about),
        dataset(
            {name: (("row", "column"), values) for name, values in seen.items()},
            {"row": np.arange(rows), "column": np.arange(columns)},
            least_modulation=least_modulation([pattern for _, pattern in phases], evaluation),
        ),
        quality,
    )


def _caveats(quality: FringeQuality) -> list[str]:
    caveats = []
    if quality.shadow > _SHARE:
        caveats.append(
            f"{quality.shadow:.0%} of the pixels are in shadow; bring camera and projector closer, or brighten"
        )
    if quality.saturated > _SHARE:
        caveats.append(f"{quality.saturated:.0%} of the pixels are saturated in too many steps; shorten the exposure")
    if quality.unsure > _SHARE:
        caveats.append(
            f"the fringe of {quality.unsure:.0%} of the pixels is not certain; check the order of the pictures"
        )
    return caveats


def _check_top(tread: Array, evaluation: Evaluation, full: float | None, record: _Record) -> None:
    """Warn of a camera that saturates below the largest value of its file, or whose saturation is unknown."""
    top = float(tread.max())
    share = float((tread == top).mean())
    if evaluation.saturation is None and (full is None or top < full) and share > _TOP:
        record.warnings.append(
            f"{share:.1%} of the grey levels are {top:g}, the brightest there is: where that is a full camera, give "
            f"saturation = {top:g}"
        )


def _median(values: Array) -> float:
    finite = values[np.isfinite(values)]
    return float(np.median(finite)) if finite.size else math.nan
