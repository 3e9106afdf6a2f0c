"""Phase, modulation and brightness of a picture from steps of a fringe pattern, pixel by pixel."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array, BoolArray

TURN = 2 * math.pi
# Three unknowns a pixel: brightness, and two parts of the modulation.
FEWEST = 3
# More pictures of one pattern than anybody takes, and what the bits of a pixel's pattern of steps hold.
MOST = 64
# Steps whose places leave one of the unknowns open: the smallest over the largest singular value.
_OPEN = 1e-3


@dataclass(frozen=True, eq=False)
class Steps:
    """What the steps of one pattern give at every pixel.

    phase: wrapped, rad, in (-π, π]; NaN where fewer than three steps are left. modulation, brightness: grey levels.
    spread: standard deviation of the phase for noise of one grey level, rad. used: steps that were not saturated.
    """

    phase: Array
    modulation: Array
    brightness: Array
    spread: Array
    used: Array

    @property
    def valid(self) -> BoolArray:
        """Where there is a phase."""
        return np.isfinite(self.phase)


def even_shifts(count: int) -> Array:
    """Shifts (count,), rad, of equal parts of a turn. Raises InputError for fewer than three."""
    _check_count(count)
    return TURN * np.arange(count) / count


def solve_steps(pictures: Array, shifts: Sequence[float] | None = None, saturation: float | None = None) -> Steps:
    """Phase of every pixel by least squares over the steps I_n = A + B cos(φ + δ_n).

    pictures: (n, rows, columns), grey levels, n ≥ 3. shifts: δ (n,), rad, of any known values; left out, equal parts
    of a turn. saturation: grey level at which the camera is full; a step that reaches it in a pixel is left out
    there. The noise's part of the phase has the standard deviation σ_I·spread; with n equal steps that is
    √2 σ_I/(√n B). Raises InputError for fewer than three pictures, or shifts that leave the phase open.
    Source: Zuo et al. (2018), Opt. Lasers Eng. 109, 23-59 (review of phase shifting).
    """
    count = len(pictures)
    _check_count(count)
    delta = even_shifts(count) if shifts is None else np.asarray(shifts, dtype=float)
    if delta.shape != (count,):
        raise InputError(
            f"{count} pictures need as many shifts, got {delta.size}; a step is missing, or its shift is"
        )
    if not np.isfinite(delta).all():
        raise InputError(f"shifts must be finite angles in rad, got {delta.tolist()}")
    design = np.stack([np.ones(count), np.cos(delta), -np.sin(delta)], axis=1)
    if _is_open(design):
        raise InputError(
            f"the {count} shifts {np.round(np.degrees(delta), 1).tolist()}° leave the phase open; three of them must "
            "differ, not by whole turns and not all by half a turn"
        )
    shape = pictures.shape[1:]
    grey = pictures.reshape(count, -1)
    full = np.zeros(grey.shape, dtype=bool) if saturation is None else grey >= saturation
    bits = np.zeros(grey.shape[1], dtype=np.uint64)
    for step in range(count):
        bits |= full[step].astype(np.uint64) << np.uint64(step)
    parts = np.full((3, grey.shape[1]), np.nan)
    spread = np.full(grey.shape[1], np.nan)
    for pattern in np.unique(bits):
        here = np.nonzero(bits == pattern)[0]
        kept = np.array([not (int(pattern) >> step) & 1 for step in range(count)])
        rows = design[kept]
        if kept.sum() < FEWEST or _is_open(rows):
            continue
        values = grey[np.ix_(kept, here)].astype(np.float64)
        solution = np.linalg.lstsq(rows, values, rcond=None)[0]
        parts[:, here] = solution
        scatter = np.linalg.inv(rows.T @ rows)[1:, 1:]
        # Across the direction of (cos φ, sin φ), over its length.
        square = solution[1] ** 2 + solution[2] ** 2
        with np.errstate(divide="ignore", invalid="ignore"):
            across = np.stack([-solution[2], solution[1]])
            spread[here] = np.sqrt(np.einsum("ik,ij,jk->k", across, scatter, across)) / square
    modulation = np.hypot(parts[1], parts[2])
    return Steps(
        np.arctan2(parts[2], parts[1]).reshape(shape),
        modulation.reshape(shape),
        parts[0].reshape(shape),
        spread.reshape(shape),
        (count - full.sum(axis=0)).reshape(shape),
    )


def wrapped(phase: Array) -> Array:
    """A phase folded into (-π, π]."""
    return np.asarray(-((-phase + math.pi) % TURN - math.pi), dtype=np.float64)


def _check_count(count: int) -> None:
    if not FEWEST <= count <= MOST:
        raise InputError(f"a pattern needs {FEWEST} to {MOST} pictures, one a step, got {count}")


def _is_open(design: Array) -> bool:
    size = np.linalg.svd(design, compute_uv=False)
    return bool(len(size) < FEWEST or size[-1] < _OPEN * size[0])
