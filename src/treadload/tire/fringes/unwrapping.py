"""From a wrapped phase to the fringe it belongs to: by several periods, or over the picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import scipy

from treadload.errors import InputError, how_to_install
from treadload.kernels.arrays import Array, BoolArray
from treadload.tire.fringes.steps import TURN, wrapped

# A pattern of at most so many fringes over the projector is never more than one turn.
ONE_TURN = 1.0
_SAME = 1e-9
# Part of half a turn by which the ladder may miss before a pixel is given up.
SURE = 0.8


@dataclass(frozen=True, eq=False)
class Unwrapped:
    """phase: rad, counted from the projector's edge; NaN where not known. unsure: pixels given up for their order.

    margin: of the worst of the frequencies, measured and synthetic, standard deviation of the miss over the half turn
    at which the order is wrong, at the median pixel.
    """

    phase: Array
    unsure: int
    margin: float


@dataclass(frozen=True, eq=False)
class _Rung:
    fringes: float
    phase: Array
    deviation: Array


def unwrap_by_periods(phases: Sequence[Array], fringes: Sequence[float], deviations: Sequence[Array]) -> Unwrapped:
    """Phase of the finest of several patterns, whose order follows from the coarser ones, each pixel by itself.

    phases: wrapped, rad, in (-π, π], one a pattern. fringes: periods of each over the width of the projector, not
    necessarily whole. deviations: standard deviation of each, rad. A pattern of at most one period begins the ladder
    (hierarchical); where there is none, differences of two phases make patterns of as many fringes as theirs differ
    by, and differences of these, until one has at most one (heterodyne). Each level determines the order of the next.
    Raises InputError where no difference comes down to one fringe.
    Source: Zuo et al. (2016), Opt. Lasers Eng. 85, 84-103.
    """
    rungs = _ladder([_Rung(*row) for row in zip(map(float, fringes), phases, deviations, strict=True)])
    # Of one turn or less: folded so that it is centred on the projector.
    base = rungs[0]
    centre = math.pi * base.fringes
    phase, deviation = centre + wrapped(base.phase - centre), base.deviation
    unsure = np.zeros(phase.shape, dtype=bool)
    margin = 0.0
    for low, high in pairwise(rungs):
        grown = high.fringes / low.fringes
        guess = phase * grown
        order = np.round((guess - high.phase) / TURN)
        with np.errstate(invalid="ignore"):
            miss = np.abs(guess - high.phase - TURN * order) / math.pi
            unsure |= miss > SURE
            spread = np.hypot(deviation * grown, high.deviation) / math.pi
        finite = spread[np.isfinite(spread)]
        margin = max(margin, float(np.median(finite))) if finite.size else margin
        phase, deviation = high.phase + TURN * order, high.deviation
    return Unwrapped(np.where(unsure, np.nan, phase), int(unsure.sum()), margin)


def _ladder(patterns: list[_Rung]) -> list[_Rung]:
    """Rungs from one fringe or less to the finest, with differences where the patterns themselves do not reach."""
    patterns = sorted(patterns, key=lambda rung: rung.fringes)
    for low, high in pairwise(patterns):
        if high.fringes - low.fringes < _SAME:
            raise InputError(f"two patterns have {low.fringes:g} fringes; give each once")
    rungs, level = patterns, patterns
    while rungs[0].fringes > ONE_TURN + _SAME:
        level = sorted(
            (
                _Rung(
                    high.fringes - low.fringes,
                    wrapped(high.phase - low.phase),
                    np.hypot(high.deviation, low.deviation),
                )
                for low, high in pairwise(level)
                if high.fringes - low.fringes > _SAME
            ),
            key=lambda rung: rung.fringes,
        )
        if not level:
            counts = ", ".join(f"{rung.fringes:g}" for rung in patterns)
            raise InputError(
                f"patterns of {counts} fringes leave the fringe of a pixel open: add one of a single fringe, "
                "or choose counts whose differences come down to one, such as 64, 63 and 56"
            )
        rungs = sorted([*level, *rungs], key=lambda rung: rung.fringes)
    # Of rungs alike the measured one, or the first difference, serves.
    kept: list[_Rung] = []
    for rung in rungs:
        if kept and rung.fringes < kept[-1].fringes + _SAME:
            kept[-1] = rung
        else:
            kept.append(rung)
    start = max(k for k, rung in enumerate(kept) if rung.fringes <= ONE_TURN + _SAME)
    return kept[start:]


def unwrap_over_picture(phase: Array, anchor: tuple[int, int], value: float) -> tuple[Array, int]:
    """A wrapped phase made continuous over the picture, from a pixel whose phase is known to half a turn.

    phase: wrapped, rad, NaN where not known. anchor: row and column. value: the phase there, rad. Only pixels that
    hang together with the anchor are kept, since the order beyond a gap cannot be known; steps of half a fringe or
    more between neighbours, as at walls of grooves, come out wrong and are not seen. Returns the phase, rad, and how
    many known pixels were given up. Raises InputError where the anchor is not known, or scikit-image is missing.
    Source: Herráez et al. (2002), Appl. Opt. 41, 7437, by scikit-image.
    """
    try:
        from skimage.restoration import unwrap_phase
    except ImportError as error:
        raise InputError(
            f"one pattern alone is unwrapped by scikit-image, which is not installed: {how_to_install('fringes')}, "
            "or give patterns of several fringe counts"
        ) from error

    valid = np.isfinite(phase)
    rows, columns = phase.shape
    row, column = anchor
    if not (0 <= row < rows and 0 <= column < columns) or not valid[row, column]:
        raise InputError(
            f"the anchor at row {row}, column {column} has no phase: it must lie on a bright place of the "
            f"{rows} x {columns} pixels"
        )
    parts, _ = scipy.ndimage.label(valid)
    here: BoolArray = parts == parts[row, column]
    unwrap: Any = unwrap_phase
    smooth = np.asarray(unwrap(np.ma.array(np.where(here, phase, 0.0), mask=~here), rng=0).filled(np.nan))
    turns = np.round((value - smooth[row, column]) / TURN)
    return smooth + TURN * turns, int(valid.sum() - here.sum())
