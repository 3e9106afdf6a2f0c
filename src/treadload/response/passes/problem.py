"""What is rolled over what: the load, the layers that can yield, and the piece of road around what does."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import Any, TypedDict

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.materials import Elastic, Perzyna
from treadload.materials.plastic import ElastoPlastic
from treadload.pavement import Pavement
from treadload.response.layered import View
from treadload.response.loads import GridLoad, Load, PlacedLoad, UniformRectangle, gather
from treadload.response.passes.box import MOST_ROWS, Box, Course, courses, over_strength, row_edges
from treadload.response.passes.patches import patch_width
from treadload.response.several import Question, answers
from treadload.response.superposition import merged

# Cells of a box on the longer side of the footprint, where no spacing is given; across, so many on the width of its
# patches where these are narrow, and at most so many times the former.
_CELLS, _ON_PATCH, _FINER = 32, 12, 3
# By which each row of depth is thicker than the one above, on those cells; on finer ones by less in their measure.
_SPREADS = 0.10
# Part of a patch's width over which the largest plastic strain is a mean: pressure that jumps at the edge of a rib
# strains the cell below it the more the smaller it is, while this mean converges.
_MEAN = 0.5
# Rows of depth of a road that is not followed step by step.
FEW_ROWS = 14
# Beyond what yields on the elastic road the box reaches by this part of its size, and this much deeper.
_BESIDE, _DEEPER = 0.2, 1.5
# Depths, in halves of the footprint's longer side, that are searched for yield, and how many.
SEARCHED, _PROBED = 4.0, 14


@dataclass(frozen=True, eq=False)
class Problem:
    """What is rolled over what: loads as cells, the plastic courses, and what a pass is.

    spacing, across: sizes of the cells along and across travel, m. patch: width of what the load presses on, m.
    """

    loads: tuple[Any, ...]
    road: Pavement
    courses: tuple[Course, ...]
    spacing: float
    across: float
    patch: float
    layers: int | None
    depth: float | None
    speed: float | None
    offsets: tuple[float, ...]
    tell: Callable[[str], None]

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Of the footprint along and across, m."""
        along, across = ([load.extent_x for load in self.loads], [load.extent_y for load in self.loads])
        return (
            min(low for low, _ in along), max(high for _, high in along),
            min(low for low, _ in across), max(high for _, high in across),
        )  # fmt: skip

    @property
    def longer(self) -> float:
        """Longer side of the footprint, m."""
        low_x, high_x, low_y, high_y = self.extent
        return max(high_x - low_x, high_y - low_y)

    @property
    def mean_over(self) -> float:
        """Width of the square over which the largest plastic strain is a mean, m."""
        return _MEAN * self.patch

    def row_edges(self, depth: float) -> Array:
        """Edges of rows of depth of cells of these sizes, down to a depth, m."""
        finer = self.across / _across(self.longer, self.patch)
        return row_edges(self.courses, 0.8 * self.across, depth, self.layers, 1 + min(_SPREADS * finer, 1.0))

    def material_at(self, depth: float) -> ElastoPlastic | None:
        """The plastic material at a depth, m; None between its layers."""
        return next((course.material for course in self.courses if course.top <= depth <= course.bottom), None)

    def stress(self, x: Array, y: Array, depths: Array) -> Array:
        """Stress (6, nz, ny, nx), Pa, of the load on the elastic road."""
        view = View(x, y, components=range(6))
        (answer,) = answers(
            [Question(self.loads, self.road, depths)], view, side="below", speed=self.speed, mean_over=None
        )
        return answer.fields.stress


class ZoneKeys(TypedDict, total=False):
    """The fields of a `Zone`, as keywords of the verbs."""

    spacing: float | tuple[float, float] | None
    depth: float | None
    layers: int | None


@dataclass(frozen=True)
class Zone:
    """The box that may yield, see `roll_passes`: size of its cells, m, its depth, m, and rows of cells in it."""

    spacing: float | tuple[float, float] | None = None
    depth: float | None = None
    layers: int | None = None


def problem_of(
    loads: Load | Sequence[Load],
    road: Pavement,
    zone: Zone,
    *,
    speed: float | None = None,
    offsets: Sequence[float] | None = None,
    wander: float | None = None,
    tell: Callable[[str], None] | None = None,
) -> Problem:
    """The question, checked; arguments as of `roll_passes`. Raises InputError."""
    spacing, depth, layers = zone.spacing, zone.depth, zone.layers
    placed: tuple[PlacedLoad, ...] = gather(loads)
    among = courses(road)
    if not among:
        raise InputError(
            "no layer of this road can yield; give one of them an ElastoPlastic(elastic, law) as its material"
        )
    for layer in road.layers:
        if not isinstance(layer.resolved, Elastic):
            raise InputError(
                f"layer {layer.name!r} is {layer.resolved}: passes are known over layers that are elastic or "
                "elastoplastic; give it an Elastic with its modulus at the time of loading"
            )
    along, across = spacing if isinstance(spacing, tuple | list) and len(spacing) == 2 else (spacing, spacing)
    for name, value in (("spacing", along), ("spacing across", across), ("depth", depth), ("wander", wander)):
        if value is not None:
            positive(name, value, "metres", "leave it out for the default")
    if layers is not None and (
        isinstance(layers, bool) or not isinstance(layers, int) or not 2 <= layers <= MOST_ROWS
    ):
        raise InputError(
            f"layers must be a whole number in [2, {MOST_ROWS}], got {layers!r}; leave it out for the default"
        )
    viscous = any(isinstance(course.material.law, Perzyna) for course in among)
    if viscous and not (isinstance(speed, int | float) and 0 < speed < math.inf):
        raise InputError(f"a law of Perzyna follows the time under the load: give the speed, m/s, > 0, got {speed!r}")
    if depth is not None and depth <= among[0].top:
        raise InputError(
            f"depth {depth:g} m does not reach the first layer that can yield, {among[0].top:g} m down; raise it"
        )
    if offsets is not None and wander is not None:
        raise InputError("offsets are the places of the wheel and wander their spread: give one of them")
    if offsets is not None:
        places = np.asarray(offsets, float).ravel()
        if not places.size or not np.isfinite(places).all():
            raise InputError(f"offsets must be finite numbers of metres, got {offsets!r}")
    else:
        places = np.zeros(1) if wander is None else wander * _normal_places()
    cells = tuple(merged([load.cell if isinstance(load, UniformRectangle) else load for load in placed]))
    question = Problem(
        cells, road, among, 0.0, 0.0, patch_width(cells), layers, depth, speed, tuple(places.tolist()),
        (lambda text: None) if tell is None else tell,
    )  # fmt: skip
    if along is not None and across is not None:
        return replace(question, spacing=float(along), across=float(across))
    finest = max((cell.grid.dx for cell in cells if isinstance(cell, GridLoad) and cell.grid.nx > 1), default=0.0)
    longest = max(question.longer / _CELLS, finest)
    return replace(question, spacing=longest, across=_across(question.longer, question.patch))


def _across(longer: float, patch: float) -> float:
    """Size of the cells across travel, m, where no spacing is given."""
    widest = longer / _CELLS
    return max(min(widest, patch / _ON_PATCH), widest / _FINER)


def _normal_places(count: int = 32) -> Array:
    """Places of unit deviation, evenly spread in an order that fills the whole at once (van der Corput's)."""
    order = [int(f"{k:05b}"[::-1], 2) for k in range(count)]
    return np.array([NormalDist().inv_cdf((k + 0.5) / count) for k in order])


@dataclass(frozen=True, eq=False)
class _Probed:
    """Yield functions over strengths of the virgin road, (nz, ny, nx), and where; coarse: of x and y, m."""

    x: Array
    y: Array
    depths: Array
    over: Array
    coarse: float


def _probed(question: Problem) -> _Probed:
    """The elastic road around the footprint, as far as it may yield."""
    low_x, high_x, low_y, high_y = question.extent
    step, half = question.spacing, 0.5 * max(high_x - low_x, high_y - low_y)
    coarse = max(step, 2 * half / _CELLS)
    top, last = question.courses[0].top, question.courses[-1].bottom
    deepest = min(last, top + SEARCHED * half if question.depth is None else question.depth)
    x, y = (
        np.arange(math.floor((low - half) / coarse), math.ceil((high + half) / coarse) + 1) * coarse
        for low, high in ((low_x, high_x), (low_y, high_y))
    )
    depths = top + np.geomspace(min(step, deepest - top) / 2, (deepest - top) * (1 - 1e-9), _PROBED)
    stress = question.stress(x, y, depths)
    over = np.full(stress.shape[1:], -1.0)
    for row, depth in enumerate(depths):
        material = question.material_at(float(depth))
        if material is not None:
            over[row] = over_strength(material, stress[:, row])
    return _Probed(x, y, depths, over, coarse)


def first_yield(question: Problem) -> float:
    """Multiple of the load at which the road first yields, to the cells that it is looked for on."""
    most = 1 + float(_probed(question).over.max())
    if not most > 0:
        raise InputError("no multiple of this load makes the road yield: it presses nowhere")
    return 1 / most


def probe(question: Problem) -> Box | None:
    """A box around what yields on the elastic road; None where nothing does."""
    search = _probed(question)
    x, y, depths, coarse = search.x, search.y, search.depths, search.coarse
    top = question.courses[0].top
    yields = search.over > 0
    if not yields.any():
        return None
    rows, lines, columns = (np.flatnonzero(yields.any(axis=axes)) for axes in ((1, 2), (0, 2), (0, 1)))
    below = float(depths[min(rows[-1] + 1, len(depths) - 1)])
    deep = question.depth if question.depth is not None else top + _DEEPER * (below - top)
    dx, dy = question.spacing, question.across
    places = [round(offset / dy) for offset in question.offsets]
    left, right = -min(0, *places), max(0, *places)
    nx, x0 = _covering(x[columns[0]], x[columns[-1]], coarse, dx)
    ny, y0 = _covering(y[lines[0]], y[lines[-1]], coarse, dy)
    return Box(nx, ny + left + right, dx, dy, x0, y0 - left * dy, question.row_edges(deep))


def _covering(low: float, high: float, coarse: float, step: float) -> tuple[int, float]:
    """Number of cells and centre of the first around what yields, found to within a coarse step, m."""
    beside = coarse + max(2 * step, _BESIDE * (high - low + step))
    count = math.ceil((high - low + 2 * beside) / step - 1e-9)
    return count, 0.5 * (low + high) - 0.5 * (count - 1) * step
