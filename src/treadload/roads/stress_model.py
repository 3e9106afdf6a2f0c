"""Basins that roads with stress-dependent layers would show: drops of a station, each with moduli of its own load.

The unknown of such a layer is the size of its law, stated as the modulus at the nominal stress. The moduli of its
sublayers follow from the stress on the axis of the plate, as in `response.settle`, for many roads side by side.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.kernels.layers.axis import AxisIntegral
from treadload.kernels.layers.settlement import Columns
from treadload.kernels.mixing import AndersonOfMany
from treadload.materials import StressDependent
from treadload.pavement import Pavement
from treadload.pavement.stress_sublayers import StressSublayers
from treadload.roads.model import BasinModel, OverBasins, models, springs_between
from treadload.roads.station_loads import StationLoads
from treadload.roads.unknowns import Unknowns, poisson_of

# Largest difference of a modulus, in ln, between the law and the road where a state is settled; rounds at most;
# rounds whose differences are mixed; largest step in ln.
SETTLED = 1e-7
_ROUNDS, _MEMORY, _LONGEST = 60, 6, 1.5
# Rounds to the state that others start from.
_FIRST = 4
# Of the slopes, in ln: states are settled to 1e-7, so that a difference over this has four digits, and its curvature
# moves a slope by some 1e-3 of itself, which a search does not feel.
_STEP = 1e-3


@dataclass(frozen=True, eq=False)
class LinearLoads(OverBasins):
    """The same drops on linear layers, each with one modulus for all loads: what starts are found with.

    static: one drop of 1 N for each station. loads: (n, K), N.
    """

    static: BasinModel
    loads: Array

    @property
    def load(self) -> Array:
        """First load of each station (n,), N."""
        return np.asarray(self.loads[:, 0])

    @property
    def size(self) -> int:
        """Nodes of a structure."""
        return self.static.size

    @property
    def geometry(self) -> Array:
        """Numbers that stations of the same geometry share (n, ...)."""
        return self.static.geometry

    @property
    def coarse(self) -> LinearLoads:
        """Itself."""
        return self

    def rows(self, at: IntArray) -> LinearLoads:
        """The model of some of the stations."""
        return LinearLoads(self.static.rows(at), self.loads[at])

    def deflection(self, x: Array) -> Array:
        """Deflections (n, v, K · s), m."""
        return self._loaded(self.static.deflection(x))

    def with_slopes(self, x: Array) -> tuple[Array, Array]:
        """Deflections, and their slopes over x (n, v, K · s, p), m."""
        values, slopes = self.static.with_slopes(x)
        return self._loaded(values), np.stack([self._loaded(slopes[..., k]) for k in range(x.shape[-1])], axis=-1)

    def _loaded(self, values: Array) -> Array:
        each = values[:, :, None, :] * self.loads[:, None, :, None]
        return np.asarray(each.reshape(*values.shape[:2], -1))


@dataclass(frozen=True, eq=False)
class StressModel(OverBasins):
    """Deflections of the drops of stations, over logarithms of the unknowns x (n, v, p).

    static: one drop of 1 N for each station, on linear layers. loads: (n, K), N. columns: of the sublayers, for the
    deflection. halves: the same with each stress-dependent one cut where its stress is taken, for the stress. axis:
    its integral. cuts: numbers of the layers of `halves` above these cuts. owner, half_owner: place among the present
    layers of each layer of `columns` and `halves`. parts, half_parts: which sublayer that depends on stress each of
    them is, -1 for none. materials: of these sublayers (m). vertical, horizontal: stress of the road's weight at the
    cuts (n, m), Pa. pressure: below the plate (n, K), Pa. start: ln of the moduli of the sublayers over the nominal
    ones that states start from (n, K, m).
    """

    static: BasinModel
    loads: Array
    columns: Columns
    halves: Columns
    axis: AxisIntegral
    cuts: tuple[int, ...]
    owner: IntArray
    half_owner: IntArray
    parts: IntArray
    half_parts: IntArray
    materials: tuple[StressDependent, ...]
    vertical: Array
    horizontal: Array
    pressure: Array
    start: Array

    @property
    def load(self) -> Array:
        """First load of each station (n,), N."""
        return np.asarray(self.loads[:, 0])

    @property
    def size(self) -> int:
        """Nodes of a structure: of the stress under each load, which is kept for the way down."""
        return 4 * len(self.axis.nodes) * int(self.pressure.shape[1])

    @property
    def geometry(self) -> Array:
        """Numbers that stations of the same geometry share (n, ...)."""
        return self.static.geometry

    @cached_property
    def coarse(self) -> LinearLoads:
        """The same on linear layers: what starts are found with."""
        return LinearLoads(self.static, self.loads)

    def rows(self, at: IntArray) -> StressModel:
        """The model of some of the stations."""
        return replace(
            self,
            static=self.static.rows(at),
            loads=self.loads[at],
            columns=self.columns.rows(at),
            halves=self.halves.rows(at),
            vertical=self.vertical[at],
            horizontal=self.horizontal[at],
            pressure=self.pressure[at],
            start=self.start[at],
        )

    def deflection(self, x: Array) -> Array:
        """Deflections (n, v, K · s), m."""
        return self._deflection(x, self.settled(x)[0])

    def with_slopes(self, x: Array) -> tuple[Array, Array]:
        """Deflections, and their slopes over x (n, v, K · s, p), m: the moduli of the laws go along."""
        n, v, p = x.shape
        state, _ = self.settled(x)
        moved = (x[:, :, None, :] + _STEP * np.eye(p)).reshape(n, v * p, p)
        near = np.repeat(state, p, axis=1)
        aside = self._deflection(moved, self.settled(moved, near)[0]).reshape(n, v, p, -1)
        values = self._deflection(x, state)
        return values, np.moveaxis((aside - values[:, :, None]) / _STEP, 2, 3)

    def settled(self, x: Array, start: Array | None = None) -> tuple[Array, BoolArray]:
        """Ln of the moduli of the sublayers over the nominal ones (n, v, K, m), and which are settled (n, v).

        start: the same at the first round.
        """
        n, v, _ = x.shape
        loads, count = self.pressure.shape[1], len(self.materials)
        layers = np.repeat(self.static.layers(x), loads, axis=1)
        pressure = np.tile(self.pressure, (1, v))
        state = (np.repeat(self.start[:, None], v, axis=1) if start is None else start).reshape(n, v * loads, count)
        state, settled = self._iterate(layers, pressure, state, _ROUNDS)
        return state.reshape(n, v, loads, count), np.asarray(settled.reshape(n, v, loads).all(axis=-1))

    def _iterate(self, layers: Array, pressure: Array, state: Array, rounds: int) -> tuple[Array, BoolArray]:
        """States (n, w, m) and which are settled (n, w), of layers (n, w, L), ln Pa, under pressures (n, w), Pa."""
        out, settled = state.copy(), np.full(state.shape[:2], not self.materials)
        going = np.arange(state.shape[1])
        now, mixing = state, AndersonOfMany(_MEMORY)
        for _ in range(rounds if self.materials else 0):
            law = self._law(layers[:, going], pressure[:, going], now)
            apart = np.abs(law - now).max(axis=-1)
            out[:, going], settled[:, going] = law, apart < SETTLED
            left = np.asarray(~settled[:, going].all(axis=0))
            if not left.any():
                break
            step = mixing.next(now, law) - now
            longest = np.abs(step).max(axis=-1, keepdims=True)
            now = (now + step * np.minimum(1.0, _LONGEST / np.maximum(longest, 1e-300)))[:, left]
            mixing.keep(left)
            going = going[left]
        return out, settled

    def _law(self, layers: Array, pressure: Array, state: Array) -> Array:
        """Ln of the moduli of the law over the nominal ones (n, w, m), under the stress of a state."""
        shear = _shear(layers, state, self.half_owner, self.half_parts, self.halves.poisson)
        down, aside = self.axis.stress(self.halves, shear, self.cuts)
        down = pressure[..., None] * down + self.vertical[:, None]
        aside = pressure[..., None] * aside + self.horizontal[:, None]
        principal = np.stack([aside, aside, down])
        law = np.empty(state.shape)
        for number, material in enumerate(self.materials):
            bulk, deviator = material.invariants(principal[..., number])
            law[..., number] = np.log(material.moduli(bulk, deviator)[0] / material.nominal.modulus)
        return law

    def _deflection(self, x: Array, state: Array) -> Array:
        n, v, _ = x.shape
        loads = self.pressure.shape[1]
        layers = np.repeat(self.static.layers(x), loads, axis=1)
        shear = _shear(layers, state.reshape(n, v * loads, -1), self.owner, self.parts, self.columns.poisson)
        kernel, top = self.columns.kernel(shear)
        each = self.static.plate.settlement(kernel, top) * np.tile(self.loads, (1, v))[..., None]
        return np.asarray(each.reshape(n, v, -1))


def _shear(layers: Array, state: Array, owner: IntArray, parts: IntArray, poisson: Array) -> Array:
    """Shear moduli (n, w, layers), Pa, of layers (n, w, L), ln Pa, whose sublayers have a state (n, w, m)."""
    moduli = layers[..., owner]
    moduli[..., parts >= 0] += state[..., parts[parts >= 0]]
    return np.asarray(np.exp(moduli) / (2 * (1 + poisson[:, None, :])))


def stress_models(stations: StationLoads, unknowns: Unknowns, table: Array, drops: IntArray) -> list[StressModel]:
    """A model for each set of layers that are present and each division into sublayers.

    table: of `thicknesses`. drops: numbers of the stations to model.
    """
    first = stations.basins.rows([members[0] for members in stations.members])
    alike: dict[tuple[int, ...], list[tuple[int, StressSublayers]]] = {}
    divisions: dict[bytes, StressSublayers] = {}
    for drop in drops:
        key = table[drop].tobytes()
        if key not in divisions:
            divisions[key] = StressSublayers.of(_road(unknowns, table[drop]))
        present = np.flatnonzero(table[drop] > 0)
        alike.setdefault(tuple(present[list(divisions[key].owner)].tolist()), []).append((int(drop), divisions[key]))
    out = []
    for group in alike.values():
        at = np.array([drop for drop, _ in group])
        (static,) = models(first, unknowns, table, at)
        out.append(_model(stations, unknowns, static, [divided for _, divided in group]))
    return out


def _road(unknowns: Unknowns, thickness: Array) -> Pavement:
    """The layers that are present, with their thicknesses (L,), m."""
    layers = [
        replace(layer, thickness=float(size) if math.isfinite(size) else None)
        for layer, size in zip(unknowns.road.layers, thickness, strict=True)
        if size > 0
    ]
    return Pavement(layers, rigid_base=unknowns.depth is not None)


def _model(
    stations: StationLoads, unknowns: Unknowns, static: BasinModel, divided: Sequence[StressSublayers]
) -> StressModel:
    road, rigid = divided[0].road, divided[0].road.rigid_base
    owner, numbers = np.array(divided[0].owner), divided[0].parts
    n, count = len(divided), len(road.layers)
    sizes = np.array([[layer.thickness or math.inf for layer in entry.road.layers] for entry in divided])
    tops = np.concatenate([np.zeros((n, 1)), np.cumsum(sizes[:, :-1], axis=1)], axis=1)
    depths = np.array([entry.depths for entry in divided])
    between = springs_between(unknowns.road, np.array(static.present))
    springs = [math.inf if owner[k] == owner[k + 1] else between[owner[k]] for k in range(count - 1)]
    thickness: list[Array] = []
    half_owner: list[int] = []
    half_parts: list[int] = []
    half_springs: list[float] = []
    cuts: list[int] = []
    for layer in range(count):
        part = numbers.index(layer) if layer in numbers else -1
        ends = [sizes[:, layer]]
        if part >= 0:
            above = depths[:, part] - tops[:, layer]
            cuts.append(len(half_owner))
            ends = [above, sizes[:, layer] - above]
        thickness += [end[:, None] for end in ends]
        half_owner += [int(owner[layer])] * len(ends)
        half_parts += [part] * len(ends)
        half_springs += [math.inf] * (len(ends) - 1) + [springs[layer] if layer < count - 1 else math.inf]
    ratio = np.array([poisson_of(layer) for layer in road.layers])
    half_ratio = np.concatenate([[value] * (1 + (k in numbers)) for k, value in enumerate(ratio)])
    finite = float(np.where(np.isfinite(sizes), sizes, 0.0).sum(axis=1).max())
    axis = AxisIntegral.of(stations.basins.plate_radius, float(depths.min(initial=1.0)), max(finite, 1.0))
    drop = slice(None) if rigid else slice(-1)
    columns = Columns.of(
        static.plate.nodes, [size[:, None] for size in sizes.T[drop]], np.tile(ratio, (n, 1)), springs, rigid=rigid
    )
    halves = Columns.of(axis.nodes, thickness[drop], np.tile(half_ratio, (n, 1)), half_springs[:-1], rigid=rigid)
    loads = stations.load[static.drops]
    parts = np.array([numbers.index(k) if k in numbers else -1 for k in range(count)])
    pressure = loads / (math.pi * stations.basins.plate_radius**2)
    model = StressModel(
        replace(static, load=np.ones(n)), loads, columns, halves, axis, tuple(cuts), owner, np.array(half_owner),
        parts, np.array(half_parts),
        divided[0].materials, np.array([entry.vertical for entry in divided]),
        np.array([entry.horizontal for entry in divided]), pressure, np.zeros((*loads.shape, len(numbers))),
    )  # fmt: skip
    # States start from that of the structure.
    layers = np.repeat(np.nan_to_num(static.log_moduli, nan=math.log(3e9))[None, None], n, axis=0)
    start, _ = model._iterate(np.repeat(layers, loads.shape[1], axis=1), pressure, model.start, _FIRST)
    return replace(model, start=start)
