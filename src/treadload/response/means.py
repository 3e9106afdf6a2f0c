"""Means of stress and strain over cubes of road under the same loads, wherever and however often they are read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from treadload import variables
from treadload.deferred import xarray as xr
from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.gridding.precorrected import FINE, ROUGH, Keeper
from treadload.kernels.layers.synthesis import FULL, SEARCH
from treadload.pavement import Pavement
from treadload.response.fields import COMPONENTS, tensor_fields
from treadload.response.layered import View
from treadload.response.loads import PlacedLoad, UniformRectangle
from treadload.response.material import windows
from treadload.response.several import Loads, Question, all_spread, answers, without_indexes
from treadload.response.solution import Response
from treadload.response.superposition import merged

_ALL = tuple(range(len(COMPONENTS)))
_TENSORS = tuple(f"{tensor}_{name}" for tensor in ("stress", "strain") for name in COMPONENTS)


@dataclass(frozen=True, eq=False)
class Means:
    """Stress and strain under the loads of a response as means over cubes of its road.

    The same as `solve_response` gives with `mean_over`, without displacement and what follows from the tensors. What
    depends on the loads and not on the points is computed once: the loads spread over the cube, and the fields
    between which points below a half-space, or a top layer, interpolate.
    response: of `solve_response`, with its road. length: side of the cube, m. loads: those of the response, at points
    of their own. spread: the same as means over squares of that side.
    """

    response: Response
    length: float
    loads: Loads
    spread: Loads
    _kept: Keeper = field(default_factory=Keeper)

    @classmethod
    def of(cls, response: Response, length: float) -> Means:
        """Of a response, over cubes of a side, m. Raises InputError for a response without its road."""
        if response.road is None:
            raise InputError(
                "a mean over the road needs a response whose road can be solved again, got one without it"
            )
        loads = cells_of(response.loads)
        return cls(response, length, loads, all_spread(loads, length))

    @property
    def road(self) -> Pavement:
        """The road of the response."""
        assert self.response.road is not None
        return self.response.road

    def at(self, depths: Array, x: Array, y: Array, *, rough: bool = False) -> xr.Dataset:
        """Stress and strain (depth, y, x) on a grid; depths: (nz,), x: (mx,), y: (my,), m.

        rough: whether 1e-6 of the largest value will do, to find where that lies.
        """
        view = View(
            x, y, components=_ALL, accuracy=SEARCH if rough else FULL,
            kept=self._kept.with_order(ROUGH if rough else FINE),
        )  # fmt: skip
        (answer,) = answers(
            [Question(self.loads, self.road, depths)], view, side=self.response.side, speed=self.response.speed,
            mean_over=self.length, spread={id(self.loads): self.spread},
        )  # fmt: skip
        tensors = tensor_fields(answer.fields.stress, answer.fields.strain)
        return _dataset(tensors, depths, x, y, self.length)

    def at_points_of(self, solved: Response, depths: Array) -> xr.Dataset:
        """`at` on the points of a response under the first of the loads, whose fields are not solved again.

        solved: a response on a grid (depth, y, x), with loads of which those of `response` are shares: the first of
        them of its loads, the others of as many again, see `superposition.mean_loads`; or `response` itself.
        depths: of `solved`, m. Its fields serve at depths that stand for themselves alone, see
        `material.windows`, unless stress was added to them, or a face that slides or opens forbids to add fields.
        """
        data, road = solved.dataset, self.road
        x, y = data["x"].to_numpy(), data["y"].to_numpy()
        later_loads = self.response.loads[len(solved.loads) :]
        local = np.array([low == high for low, high in map(self.reads, depths)])
        if (
            not local.any()
            or solved.restrained
            or (later_loads and road.parted is not None)
            or not set(_TENSORS) <= set(data)
        ):
            return self.at(depths, x, y)
        depths_before = data["depth"].to_numpy()
        share = len(solved.loads) / len(self.response.loads)
        added: dict[str, tuple[tuple[str, ...], Array]] = {
            name: (("depth", "y", "x"), np.zeros(())) for name in _TENSORS
        }
        if later_loads:
            (answer,) = answers(
                [Question(cells_of(later_loads), road, depths[local])], View(x, y, components=_ALL, accuracy=FULL),
                side=self.response.side, speed=self.response.speed, mean_over=None,
            )  # fmt: skip
            added = tensor_fields(answer.fields.stress, answer.fields.strain)
        means = None if local.all() else self.at(depths[~local], x, y)
        fields = {}
        for name, (dims, part) in added.items():
            field = np.empty((len(depths), len(y), len(x)))
            # Not the array with its coordinates, which cost more than small fields.
            before = data.variables[name].transpose(*dims).to_numpy()
            for row in np.flatnonzero(local):
                np.multiply(before[np.flatnonzero(depths_before == depths[row])[0]], share, out=field[row])
            if later_loads:
                field[local] += part
            if means is not None:
                field[~local] = means[name].to_numpy()
            fields[name] = (dims, field)
        return _dataset(fields, depths, x, y, self.length)

    def reads(self, depth: float) -> tuple[float, float]:
        """From which depth to which, m, the cube at a depth, m, reaches; equal where the point itself is read."""
        layer = self.road.layer_at(depth, self.response.side)
        read = windows(np.array([depth]), self.length, self.road.interfaces, [layer])
        return float(read.low[0]), float(read.high[0])


def _dataset(
    fields: Mapping[str, tuple[tuple[str, ...], Array]], depths: Array, x: Array, y: Array, length: float
) -> xr.Dataset:
    """As `variables.dataset` makes it, but without indexes, which cost as much as the fields of few points."""
    places = without_indexes(depths, y, x)
    tensors = {name: xr.Variable(dims, values, variables.attributes(name)) for name, (dims, values) in fields.items()}
    return xr.Dataset(tensors, places, {"mean_over": length})


def cells_of(loads: Sequence[PlacedLoad]) -> Loads:
    """Loads as they are solved: rectangles as cells, and those that share cells as one."""
    return merged([load.cell if isinstance(load, UniformRectangle) else load for load in loads])
