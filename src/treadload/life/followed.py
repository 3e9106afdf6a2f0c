"""What a point of the road reads from rest to rest, near the wheels and in the basin around them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self, TypeAlias

import numpy as np

from treadload.damage.criterion import Criterion
from treadload.deferred import xarray as xr
from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.life.basin import Basin
from treadload.life.lines import Lines, straight
from treadload.life.peaks import over_strips, peaks_and_valleys, readings
from treadload.life.wheels import Wheels

# Of a law that states no exponent, and any temperature: exponents hardly depend on it.
_USUAL, _ANY_TEMPERATURE = -0.2, 15.0
Evaluated: TypeAlias = "Callable[[xr.Dataset], tuple[Array, Array | None]]"
"""A quantity of a response, and the tension without which it counts as nothing, see `Criterion.read_uncut`."""


@dataclass(frozen=True, eq=False)
class Followed:
    """Values that a criterion evaluates on lines along travel, from rest to rest.

    x: (nx,), m, of the near field and then of the basin outside it, not in order. read: (rows, nx), on the near rows;
    core: (core, nx), on the core's y, with the peaks between points under the axles. away: (lines, mx), on lines of
    the basin. by_depth, away_by_depth: the same over (depth, line, x). far: (nx,), True of the basin's x.
    """

    x: Array
    read: Array
    core: Array
    away: Array
    by_depth: Array
    away_by_depth: Array
    far: BoolArray

    @classmethod
    def of(
        cls,
        evaluated: Evaluated,
        fields: tuple[xr.Dataset, xr.Dataset, xr.Dataset],
        wheels: Wheels,
        lines: Lines,
        basin: Basin,
        mean_over: float | None,
        power: float,
    ) -> Self:
        """Of fields near (depth, rows, x), of the basin on some of these rows, and on its lines, see `Basin.lines`.

        mean_over: m, None for points. power: of the law, by which damage grows with the value.
        """
        near, outside, far = fields
        uncut, margin = _in_single(*evaluated(near))
        by_depth = readings(uncut, margin)
        away, on_rows = (readings(*_in_single(*evaluated(part))) for part in (far, outside))
        onto = straight(basin.outside_rows, basin.near)
        beside = np.stack([onto @ sheet for sheet in on_rows])
        x, centres = near["x"].to_numpy(), wheels.x.mean(axis=1)
        whole = np.concatenate([by_depth, beside], axis=2)
        read = whole.max(axis=0)
        axle = _axle_of(x, wheels)
        on_core = lines.onto_core @ read
        if mean_over is not None:
            under = axle >= 0
            part = (x[under], uncut[..., under], None if margin is None else margin[..., under])
            for number, peak in enumerate(_axle_peaks(lines, part, centres, power)):
                _set_peak(on_core, np.flatnonzero(axle == number), peak)
        x_all = np.concatenate([x, basin.columns[basin.outside]])
        return cls(x_all, read, on_core, away.max(axis=0), whole, away, np.arange(len(x_all)) >= len(x))


def _in_single(uncut: Array, margin: Array | None) -> tuple[Array, Array | None]:
    """In single numbers, in which the fields behind them are."""
    return uncut.astype(np.float32), None if margin is None else margin.astype(np.float32)


def power_of(criterion: Criterion) -> float:
    """By which the damage of a criterion grows with its reading."""
    return 1 / abs(float(getattr(criterion.law_at(_ANY_TEMPERATURE), "exponent", _USUAL)))


def _axle_peaks(lines: Lines, part: tuple[Array, Array, Array | None], centres: Array, power: float) -> Array:
    """The peak under each axle (axle, ny) on the core's y, between points too; that of strips where they are given.

    part: x of the cells under the axles, uncut and margin there.
    """
    x, uncut, margin = part
    at: dict[str, Any] = {"centres": centres, "turns": 2 * len(centres) - 1}
    if lines.strips is not None:
        return over_strips(lines.strips, x, uncut, margin, power=power, **at)[::2]
    peaks: Array = peaks_and_valleys(x, uncut, margin, smooth=True, **at)[::2] @ lines.onto_core.T
    return peaks


def _set_peak(read: Array, columns: IntArray, peak: Array) -> None:
    """Into readings (n, nx), which have a peak (n,) among some columns: larger ones are cut, the largest is raised.

    A reading that stands next to that peak outside the columns stays.
    """
    inside = read[:, columns]
    highest = inside.argmax(axis=1)
    inside = np.minimum(inside, peak[:, None])
    inside[np.arange(len(read)), highest] = peak
    read[:, columns] = inside


def _axle_of(x: Array, wheels: Wheels) -> Array:
    """Which axle's cells each x belongs to, by number; -1 beside them."""
    half = 0.5 * (wheels.x[0, 1] - wheels.x[0, 0])
    which = np.full(len(x), -1)
    for number, cells in enumerate(wheels.x):
        which[(x > cells[0] - half) & (x < cells[-1] + half)] = number
    return which
