"""Rubber on a road's texture: a patch that stands for all of it, under mean pressures.

A texture has waves far below the cells on which a wheel is solved. So the two scales are solved apart: the wheel on a
plane gives the mean pressure, and here a patch of texture, repeated or mirrored for ever, is pressed by it into the
rubber. Pressure p ≥ 0 minimises ½ p·A p + p·h at a mean; A is one factor for every wave of the patch.

Sources: Stanley & Kato (1997), J. Tribol. 119, 481-485; Polonsky & Keer (1999), Wear 231, 206-219; Yastrebov,
Anciaux & Molinari (2017), J. Mech. Phys. Solids 107, 469-493, for the area that cells at the rims of the contact have
too much (its factor as tamaas 2.9.0 implements it; the original was not read).
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, TypedDict, Unpack

import numpy as np

from treadload.citations import TEXTURE
from treadload.composing import BaseResult, Holds
from treadload.contact.friction.laws import PressureDependent
from treadload.contact.rough_theory import asperity_area, persson_area
from treadload.contact.solution import Contact
from treadload.contact.tread_layer import TreadRubber, wave_that_matters
from treadload.deferred import xarray as xr
from treadload.errors import ConvergenceError, InputError, positive
from treadload.kernels.arrays import Array, BoolArray
from treadload.kernels.complementarity import projected_cg
from treadload.kernels.gridding.periodic import Endless
from treadload.materials import Elastic, Prony
from treadload.pavement.texture.description import Texture
from treadload.rows import Row, row
from treadload.variables import SAMPLE, dataset

# Of the rim of the contact, in cells, that the cells count too much: (π - 1 + ln 2)/24.
_RIM = (math.pi - 1 + math.log(2)) / 24
_MOST_CELLS, _MOST_STEPS, _MOST_PRESSURES = 4_200_000, 3000, 64
# Classes of local pressure, of the peak.
_CLASSES, _LOWEST = 60, 1e-3
# Where a warning is due: slopes that are no longer small, and waves of the mean that a patch must hold.
_STEEP, _FEWEST_WAVES = 0.5, 6
# Row and variable by mean pressure.
_BY_PRESSURE = (
    ("real_area_ratio",) * 2, ("persson_area_ratio",) * 2, ("largest_pressure", "peak_pressure"), ("mean_gap",) * 2,
)  # fmt: skip
# Of the pressures of a wheel, from its largest down, and how many.
_OF_PEAK, _STEPS = 0.05, 7


@dataclass(frozen=True, eq=False)
class TextureContact(BaseResult, group="texture"):
    """Rubber on a patch of texture under several mean pressures.

    dataset: over mean_pressure the share of the area that touches (real_area_ratio), the mean gap, the peak pressure,
    and the predictions of Persson's theory and of independent asperities; over local_pressure as well the share of
    the load that pressures above it carry, and of the area under them; texture_height and pressure over (y, x) at
    reference_pressure. stats: iterations, seconds. warnings: sentences. texture, rubber: the question.

    >>> from treadload.pavement.texture import self_affine
    >>> texture = self_affine(0.016, 0.001, hurst=0.8, shortest=0.004, rms_height=1e-4)
    >>> result = tl.contact.solve_texture(texture, tl.Elastic(6e6, 0.5), [1e5, 2e5])
    >>> f"{result.area_ratio([1.5e5])[0]:.0%} of the area touches at 150 kPa"
    '54% of the area touches at 150 kPa'
    """

    title: ClassVar[str] = "Contact with a texture"
    holds: ClassVar[Holds] = Holds(
        {
            "mean_pressure": "mean_pressure", "local_pressure": "local_pressure", "y": "y", "x": "x",
            "real_area_ratio mean_gap peak_pressure persson_area_ratio asperity_area_ratio": "mean_pressure",
            "load_share_above area_share_above": "mean_pressure local_pressure",
            "texture_height pressure": "y x",
            "reference_pressure": "",
        },
        maybe={"real_area contact_area": ""},
        not_nan="real_area_ratio pressure texture_height mean_pressure",
        numbers="dx dy modulus poisson rms_slope rms_height",
        texts="rubber",
        positive="dx dy modulus mean_pressure",
        sizes={"mean_pressure": (1, np.inf)},
    )  # fmt: skip

    dataset: xr.Dataset
    stats: Mapping[str, Any] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()

    def cites(self) -> tuple[str, ...]:
        """Methods of rough contact."""
        return TEXTURE

    def area_ratio(self, pressure: Array) -> Array:
        """Share of the area that touches at mean pressures, Pa, of any shape: along the curve, proportional below it.

        Raises InputError above the largest mean pressure that was solved.
        """
        p, ratio = (self.dataset[name].to_numpy() for name in ("mean_pressure", "real_area_ratio"))
        wanted = np.asarray(pressure, dtype=float)
        if wanted.size and not float(np.nanmax(wanted)) <= p[-1] * (1 + 1e-9):
            raise InputError(
                f"the texture was solved up to {p[-1] / 1e3:.4g} kPa, and {float(np.nanmax(wanted)) / 1e3:.4g} kPa "
                "is asked for; give solve_texture larger pressures"
            )
        return np.asarray(np.interp(wanted, [0.0, *p], [0.0, *ratio]))

    def friction_law(self, shear_strength: float) -> PressureDependent:
        """An effective law of friction on this texture: shear_strength, Pa, on the area that really touches.

        μ(p) = strength · A(p)/(A₀ p), fitted by μ_ref (p/p_ref)^(-n) over the pressures that were solved. Adhesion on
        the real area alone: the loss in rubber that texture kneads is not in it. For `Rolling(friction=...)`.
        """
        positive("shear_strength", shear_strength, "Pa", "dry rubber has some 1e6")
        p, ratio = (self.dataset[name].to_numpy() for name in ("mean_pressure", "real_area_ratio"))
        friction = shear_strength * ratio / p
        middle = math.exp(float(np.log(p).mean()))
        slope = float(np.polyfit(np.log(p / middle), np.log(friction), 1)[0]) if p.size > 1 else 0.0
        reference = math.exp(float(np.log(friction).mean()))
        exponent = min(max(-slope, 0.0), 1 / 3)
        return PressureDependent(reference, middle, exponent, upper=max(float(friction.max()), reference))

    @property
    def heading(self) -> str:
        """The rubber."""
        return str(self.dataset.attrs["rubber"])

    def rows(self) -> tuple[Row, ...]:
        """The texture, and area, gap and peak pressure by mean pressure."""
        d, a = self.dataset, self.dataset.attrs
        sizes = f"{d.sizes['x']} x {d.sizes['y']} cells of {a['dx'] * 1e3:.3g} x {a['dy'] * 1e3:.3g} mm"
        lines = [row("grid", sizes), *(row(name, a[name]) for name in ("rms_height", "rms_slope"))]
        for number, mean in enumerate(d["mean_pressure"].to_numpy()):
            lines += [
                row(key, float(d[name][number]), group=f"mean pressure {mean / 1e3:.4g} kPa", display=SAMPLE.get(key))
                for key, name in _BY_PRESSURE
            ]
        if "real_area" in d and "contact_area" in d:
            share = float(d.real_area / d.contact_area)
            lines.append(row("real_area", float(d.real_area), note=f"{100 * share:.3g} % of the wheel's contact"))
        return tuple(lines)


class TreadKeys(TypedDict, total=False):
    """Of the tread under the texture: its thickness, m, the speed, m/s, and the wave, m, that rubber is read at."""

    thickness: float | None
    speed: float | None
    wave: float | None


def _tread(
    rubber: Elastic | Prony,
    mean_wave: float,
    *,
    thickness: float | None = None,
    speed: float | None = None,
    wave: float | None = None,
) -> TreadRubber:
    return TreadRubber.of(rubber, thickness, speed, wave_that_matters(mean_wave, wave))


def solve_texture(
    texture: Texture,
    rubber: Elastic | Prony,
    pressures: Sequence[float] | Array | Contact,
    *,
    reference: float | None = None,
    tolerance: float = 1e-4,
    progress: Callable[[str], None] | None = None,
    **film: Unpack[TreadKeys],
) -> TextureContact:
    """Rubber pressed on a texture: how much of the area touches, under what pressure.

    texture: a patch that stands for the road, filled and levelled; one that continues at its ends is repeated, any
    other mirrored. A profile is taken as ridges across. rubber: of the tread, its own modulus, not that of a
    half-space that stands for the tire; a Prony is read at frequency speed over wave, |E*|. The road is rigid beside
    it. pressures: mean ones, Pa; or a Contact, whose pressures from a twentieth of the peak to the peak serve, and
    whose real area is then given. film: thickness= of the tread on its belt, m, None: deep; speed=, m/s; wave=, m,
    left out `texture.mean_wave`. reference: the one of the pressures, Pa, whose fields are kept; left out, the mean
    of a Contact or the middle of the list. tolerance: of the gap where it should be closed, relative to the approach.
    No friction, no adhesion, no water. Raises InputError for drop-outs and pressures that are none, ConvergenceError
    with the residual reached.

    >>> from treadload.pavement.texture import self_affine
    >>> texture = self_affine(0.016, 0.001, hurst=0.8, shortest=0.004, rms_height=1e-4)
    >>> result = tl.contact.solve_texture(texture, tl.Elastic(6e6, 0.5), [1e5, 2e5])
    >>> [f"{share:.0%}" for share in result.dataset.real_area_ratio.values]  # of the area touches at 100 and 200 kPa
    ['40%', '68%']
    """
    began = time.perf_counter()
    tell = progress or (lambda text: None)
    heights = texture.whole("the contact with a texture")
    if heights.size > _MOST_CELLS:
        raise InputError(
            f"the patch of texture has {heights.size} points, more than {_MOST_CELLS:.1e}; cut a smaller one, "
            "pavement.texture.cut"
        )
    if not np.ptp(heights) > 0:
        raise InputError("the texture is flat: all its heights are the same, and everything touches")
    if not 1e-10 <= tolerance <= 1e-2:
        raise InputError(f"tolerance must lie in [1e-10, 1e-2], got {tolerance:g}; 1e-4 is the default")
    wheel = pressures if isinstance(pressures, Contact) else None
    steps, kept = _steps(pressures, reference)
    tread = _tread(rubber, texture.mean_wave, **film)
    cells = Endless(heights.shape, texture.dx, texture.dy, mirrored=not texture.periodic)
    compliance = tread.compliance(cells.waves)
    stiffness = np.divide(1.0, compliance, out=np.zeros_like(compliance), where=compliance > 0)
    # A mean residual must not be lost where all cells touch.
    stiffness[0, 0] = stiffness[stiffness > 0].min()
    product, inverse = cells.operator(compliance), cells.operator(stiffness)
    below = heights.max() - heights
    start = np.where(below <= np.quantile(below, 0.1), 1.0, 0.0)
    rows: list[dict[str, float]] = []
    pressed: dict[float, Array] = {}
    iterations, residual = 0, 0.0
    for mean in steps:
        tell(f"rubber on texture under {mean / 1e3:.4g} kPa")
        solution = projected_cg.solve(
            product, below, start, total=mean * heights.size, precondition=inverse, tolerance=tolerance,
            max_iterations=_MOST_STEPS,
        )  # fmt: skip
        if not solution.converged:
            raise ConvergenceError(
                f"rubber on texture under {mean / 1e3:.4g} kPa stopped after {solution.iterations} iterations with a "
                f"residual of {solution.residual:.2e}, above the tolerance of {tolerance:.2e}; raise the tolerance, "
                "or take short waves out of the texture (band_pass)",
                solution.residual,
            )
        start = solution.pressure
        iterations, residual = iterations + solution.iterations, max(residual, solution.residual)
        gap = below + solution.compliance - solution.level
        pressed[mean] = solution.pressure
        rows.append(
            {
                "real_area_ratio": _touching(solution.pressure > 0, cells.mirrored),
                "mean_gap": max(float(gap.mean()), 0.0),
                "peak_pressure": float(solution.pressure.max()),
            }
        )
    data = _dataset(texture, tread, steps, rows, pressed, kept)
    if wheel is not None:
        p = wheel.dataset["pressure"].to_numpy()
        ratio = np.interp(p, [0.0, *steps], [0.0, *(row["real_area_ratio"] for row in rows)])
        data = data.assign(dataset({
            "real_area": ((), float(ratio.sum()) * wheel.cell_area), "contact_area": ((), wheel.area),
        }, {}).data_vars)  # fmt: skip
    stats = {
        "iterations": iterations,
        "residual": residual,
        "cells": heights.size,
        "seconds": time.perf_counter() - began,
    }
    return TextureContact(data, stats, tuple(_caveats(texture, tread, rows)))


def _steps(pressures: Sequence[float] | Array | Contact, reference: float | None) -> tuple[list[float], float]:
    """The mean pressures, rising, and the one whose fields are kept."""
    if isinstance(pressures, Contact):
        p = pressures.dataset["pressure"].to_numpy()
        peak, mean = float(p.max()), float(p[p > 0].mean())
        wanted = [*np.geomspace(_OF_PEAK * peak, peak, _STEPS), mean if reference is None else reference]
        kept = wanted[-1]
    else:
        wanted = [float(value) for value in np.atleast_1d(np.asarray(pressures, dtype=float))]
        if not wanted or len(wanted) > _MOST_PRESSURES or not np.isfinite(wanted).all() or min(wanted) <= 0:
            raise InputError(
                f"pressures must be 1 to {_MOST_PRESSURES} numbers of Pa above 0, got "
                f"{list(np.atleast_1d(pressures))[:4]}"
            )
        kept = sorted(wanted)[len(wanted) // 2] if reference is None else float(reference)
    steps = sorted({float(value) for value in wanted})
    if kept not in steps:
        raise InputError(f"reference must be one of the pressures, got {kept:g} Pa; they are {steps} Pa")
    return steps, kept


def _touching(touches: BoolArray, mirrored: bool) -> float:
    """Share of the cells that touch, less what the cells at the rim have too much."""
    ny, nx = touches.shape
    rims = 0
    for axis in (0, 1):
        if touches.shape[axis] > 1:
            rims += int((touches ^ np.roll(touches, 1, axis)).sum())
            if mirrored:
                rims -= int((np.take(touches, 0, axis) ^ np.take(touches, -1, axis)).sum())
    # Of ridges, a rim is a point and no corner is rounded: the cells count it right on the mean.
    taken = _RIM * rims if min(ny, nx) > 1 else 0.0
    return max(float(touches.sum()) - taken, 0.0) / touches.size


def _dataset(
    texture: Texture,
    tread: TreadRubber,
    steps: Sequence[float],
    rows: Sequence[Mapping[str, float]],
    pressed: Mapping[float, Array],
    kept: float,
) -> xr.Dataset:
    peak = max(row["peak_pressure"] for row in rows)
    classes = np.concatenate([[0.0], np.geomspace(_LOWEST * peak, peak, _CLASSES - 1)])
    load, area = np.zeros((len(steps), _CLASSES)), np.zeros((len(steps), _CLASSES))
    for number, mean in enumerate(steps):
        sorted_p = np.sort(pressed[mean].ravel())
        from_above = np.concatenate([np.cumsum(sorted_p[::-1])[::-1], [0.0]])
        first = np.searchsorted(sorted_p, classes, side="right")
        load[number] = from_above[first] / sorted_p.sum()
        area[number] = (sorted_p.size - first) / sorted_p.size
    over = ("mean_pressure",)
    p = np.array(steps)
    modulus, slope = tread.plane_modulus, texture.rms_slope
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        **{name: (over, np.array([row[name] for row in rows])) for name in rows[0]},
        "persson_area_ratio": (over, persson_area(p, modulus, slope)),
        "asperity_area_ratio": (over, np.minimum(asperity_area(p, modulus, slope), 1.0)),
        "load_share_above": ((*over, "local_pressure"), load),
        "area_share_above": ((*over, "local_pressure"), area),
        "texture_height": (("y", "x"), texture.heights),
        "pressure": (("y", "x"), pressed[kept]),
        "reference_pressure": ((), kept),
    }
    places = {"mean_pressure": p, "local_pressure": classes, "y": texture.y, "x": texture.x}
    return dataset(
        fields, places, dx=texture.dx, dy=texture.dy, modulus=tread.modulus, poisson=tread.poisson,
        rms_slope=slope, rms_height=texture.rms_height, rubber=str(tread), texture=texture.summary(),
    )  # fmt: skip


def _caveats(texture: Texture, tread: TreadRubber, rows: Sequence[Mapping[str, float]]) -> list[str]:
    caveats = []
    if texture.rms_slope > _STEEP:
        caveats.append(
            f"the texture has an rms slope of {texture.rms_slope:.3g}, and slopes are taken as small (below "
            f"{_STEEP:g}): area and peak pressure are those of linear theory; take short waves out "
            "(band_pass) and state which"
        )
    waves = texture.length / texture.mean_wave
    if waves < _FEWEST_WAVES:
        caveats.append(
            f"the patch of {texture.length * 1e3:.4g} mm holds {waves:.2g} of the texture's mean waves of "
            f"{texture.mean_wave * 1e3:.3g} mm: it may not stand for the road; take a longer one"
        )
    if texture.is_profile:
        caveats.append(
            "the texture is a profile, taken as ridges across: stones touch less, and give way more easily"
        )
    if rows[-1]["peak_pressure"] > tread.modulus:
        caveats.append(
            f"the peak pressure of {rows[-1]['peak_pressure'] / 1e6:.3g} MPa lies above the modulus of the rubber, "
            f"{tread.modulus / 1e6:.3g} MPa: linear elasticity is beyond its range there"
        )
    return caveats
