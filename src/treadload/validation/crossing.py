"""Checks of a wheel over an obstacle: rigid flat punches with sharp edges on a plane, over a joint, over a drop."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from treadload.contact import cross_obstacle, solve_contact
from treadload.contact.rolling_state import Rolling
from treadload.kernels.arrays import Array, BoolArray
from treadload.materials import Elastic
from treadload.pavement import Pavement, Relief, RoadJoint, RoadStep
from treadload.tire import Tire
from treadload.validation.check import Check, absolute, relative

# Across travel 13 times as long as along it, so that its middle is plane: twice as long moves the shares by 0.06 %.
_LONG, _CELLS, _CELL = 401, 61, 0.5e-3
_HALF = 0.5 * _CELLS * _CELL
_ROAD = Pavement.half_space(Elastic(5.4e9, 0.35))
_WHEEL = Rolling(normal_load=1e4, friction=0.0)
# Half a cell at either edge is uncertain: an error of first order, 0.7 % at most on these cells, twice that on half
# as many.
_BOUND = 1e-2


def crossing_checks() -> Iterator[Check]:
    """Shares of the load of a punch at a place; a step of no height beside no step."""
    group = "crossing"
    flat = np.pad(np.zeros((_LONG, _CELLS)), 2, constant_values=np.nan)
    punch = Tire.from_height_map(flat, _CELL, material=Elastic(2e16, 0.3), name="punch")
    plain = solve_contact(punch, _ROAD, _WHEEL).dataset["pressure"].to_numpy()
    x, pressure = _pressed(punch, RoadStep(0.0))
    yield absolute(
        group, "step of no height beside no step, pressures over the peak",
        np.abs(pressure - plain).max() / plain.max(), 0.0, 0.0, "the same problem",
    )  # fmt: skip
    line = pressure[pressure.shape[0] // 2]
    inner = 15.5 * _CELL
    yield relative(
        group, "flat punch, upright edges: share of the load in its middle half", _share(line, np.abs(x) < inner),
        2 / math.pi * math.asin(inner / _HALF), _BOUND, "Johnson (1985), p = P/π √(b² - x²)",
    )  # fmt: skip
    x, pressure = _pressed(punch, RoadJoint(21 * _CELL, 0.05))
    line = pressure[pressure.shape[0] // 2]
    gap, reach = 10.5 * _CELL, 20.5 * _CELL
    yield relative(
        group, "the same over a joint: share of the halves next to it", _share(line, np.abs(x) < reach),
        2 / math.pi * math.asin(math.sqrt((reach**2 - gap**2) / (_HALF**2 - gap**2))), _BOUND,
        "two strips, p ~ |x|/√((b² - x²)(x² - a²)), as the plane's equation asks; Gladwell (1980)",
    )  # fmt: skip
    x, pressure = _pressed(punch, RoadStep(-0.05))
    line = pressure[pressure.shape[0] // 2]
    # On its trailing half alone, up to the edge of the cell in the middle, which lies half way down.
    edge, first = -0.5 * _CELL, -_HALF
    middle, half = 0.5 * (edge + first), 0.5 * (edge - first)
    near = edge - 8 * _CELL
    yield relative(
        group, "the same, half over a drop: share within 8 of 30 cells of the edge", _share(line, x > near),
        0.5 - math.asin((near - middle) / half) / math.pi, _BOUND, "Johnson (1985), of half the width",
    )  # fmt: skip


def _pressed(punch: Tire, relief: Relief) -> tuple[Array, Array]:
    """Places along travel and pressures (ny, nx) with the punch over the middle of an obstacle."""
    data = cross_obstacle(punch, _ROAD, _WHEEL, relief, positions=[0.0]).dataset
    return data["x"].to_numpy(), data["pressure"].to_numpy()[0]


def _share(line: Array, inside: BoolArray) -> float:
    return float(line[inside].sum() / line.sum())
