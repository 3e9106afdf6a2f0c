"""Slopes that layers would show ahead of rolling wheels: many places of one kind of structure at once."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from treadload.kernels.arrays import Array, ComplexArray, IntArray
from treadload.kernels.layers.settlement import Columns
from treadload.kernels.layers.tracks import Track
from treadload.response.moving import spectrum_of
from treadload.roads.model import by_layers_present, slopes_over, sought_of, springs_between
from treadload.roads.moving_basins import MovingBasins
from treadload.roads.unknowns import Unknowns, has_memory, modulus_of, poisson_of, relative_modulus
from treadload.roads.wheel_lines import lines_of


@dataclass(frozen=True, eq=False)
class MovingModel:
    """Slopes of places with the same sensors, over logarithms of the unknowns x (n, v, p).

    drops, present, sought, chosen, seeks_depth, load: as in `BasinModel`. track: of the sensors and wheels. moduli:
    (n, L, m) of the present layers at each kx, Pa; of those sought over their modulus. thickness: (n, L), m, without
    the last on a half-space; a single row where all places share it.
    """

    drops: IntArray
    present: tuple[int, ...]
    sought: tuple[int, ...]
    chosen: tuple[int, ...]
    seeks_depth: bool
    track: Track
    moduli: Array | ComplexArray
    thickness: Array
    poisson: Array
    spring: tuple[float, ...]
    rigid: bool
    load: Array

    @property
    def size(self) -> int:
        """Nodes of a structure."""
        return max(1, len(self.track.nodes))

    @property
    def geometry(self) -> Array:
        """Numbers that places of the same geometry and memory share (n, ...)."""
        memory = np.abs(self.moduli).reshape(len(self.drops), -1)
        return np.concatenate(
            [np.broadcast_to(self.thickness, (len(self.drops), self.thickness.shape[1])), memory], 1
        )

    @property
    def has_memory(self) -> bool:
        """True if a modulus depends on the wavenumber along travel."""
        return np.iscomplexobj(self.moduli)

    @cached_property
    def coarse(self) -> MovingModel:
        """The same with the size of every modulus at the dominant wave, and no memory: for starts."""
        if not self.has_memory:
            return self
        # A wave as long as the basin, some two metres.
        felt = int(np.argmin(np.abs(self.track.along - 3.0)))
        return replace(self, track=self.track.without_memory, moduli=np.abs(self.moduli[:, :, felt : felt + 1]))

    def rows(self, at: IntArray) -> MovingModel:
        """The model of some of the places."""
        thickness = self.thickness if len(self.thickness) == 1 else self.thickness[at]
        return replace(self, drops=self.drops[at], moduli=self.moduli[at], thickness=thickness, load=self.load[at])

    @cached_property
    def _columns(self) -> Columns:
        deep = self.thickness
        return Columns.of(
            self.track.nodes, [deep[:, k : k + 1] for k in range(deep.shape[1])],
            np.tile(self.poisson, (len(deep), 1)), self.spring, rigid=self.rigid,
        )  # fmt: skip

    def deflection(self, x: Array) -> Array:
        """Slope (n, v, s)."""
        count, layers = len(self.sought), len(self.present)
        factor = np.ones((*x.shape[:-1], layers))
        factor[..., list(self.sought)] = np.exp(x[..., :count])
        shear = factor[..., None] * (self.moduli / (2 * (1 + self.poisson[:, None])))[:, None]
        columns = self._columns
        if self.seeks_depth:
            above = self.thickness[:, :-1].sum(axis=1)
            columns = columns.with_thickness(layers - 1, np.exp(x[..., -1]) - above[:, None])
        if self.has_memory:
            kernel, _ = columns.kernel(shear[..., self.track.at])
        else:
            kernel, _ = columns.kernel(shear[..., 0])
        top = (1 - self.poisson[0]) / shear[:, :, 0]
        return self.track.slope(kernel, top) * self.load[:, None, None]

    def with_slopes(self, x: Array) -> tuple[Array, Array]:
        """Slope (n, v, s), and how it changes over x (n, v, s, p)."""
        return slopes_over(self.deflection, x)


def moving_models(basins: MovingBasins, unknowns: Unknowns, table: Array, drops: IntArray) -> list[MovingModel]:
    """A model for each set of layers that are present. table: of `thicknesses`. drops: numbers to model."""
    return [_model(basins, unknowns, table, *part) for part in by_layers_present(table, drops)]


def _model(basins: MovingBasins, unknowns: Unknowns, table: Array, drops: IntArray, present: IntArray) -> MovingModel:
    road, rigid = unknowns.road, unknowns.depth is not None
    deep = table[np.ix_(drops, present)]
    thinnest = float(deep[:, 0].min()) if len(present) > 1 or rigid else math.inf
    loads = basins.unit_loads
    first, last = zip(*(load.extent_x for load in loads), strict=True)
    track = Track.of(
        [spectrum_of(load) for load in loads],
        lines_of(loads, basins.side), (min(first), max(last)), basins.offsets, basins.side, thinnest,
    )  # fmt: skip
    sought, chosen = sought_of(unknowns, present)
    moduli, track = _moduli(basins, unknowns, drops, present, sought, track)
    finite = deep[:, : len(present) - (0 if rigid else 1)]
    if (finite == finite[:1]).all():
        finite = finite[:1]
    return MovingModel(
        drops, tuple(map(int, present)), sought, chosen, unknowns.seeks_depth, track, moduli, finite,
        np.array([poisson_of(road.layers[number]) for number in present]),
        springs_between(road, present), rigid, basins.load[drops],
    )  # fmt: skip


def _moduli(
    basins: MovingBasins,
    unknowns: Unknowns,
    drops: IntArray,
    present: IntArray,
    sought: tuple[int, ...],
    track: Track,
) -> tuple[Array | ComplexArray, Track]:
    """Moduli at every kx, and the track, which has fewer nodes where nothing has a memory."""
    layers = [unknowns.road.layers[number] for number in present]
    if not any(has_memory(layer) for layer in layers):
        track = track.without_memory
        moduli = np.array([1.0 if k in sought else modulus_of(layer) for k, layer in enumerate(layers)])
        return np.broadcast_to(moduli[None, :, None], (len(drops), len(layers), 1)), track
    out = np.empty((len(drops), len(layers), len(track.along)), complex)
    # Fields go as exp(-i kx V t).
    for row, drop in enumerate(drops):
        omega = track.along * basins.speed[drop]
        warmth = math.nan if basins.temperature is None else float(basins.temperature[drop])
        for k, layer in enumerate(layers):
            size = 1.0 if k in sought else modulus_of(layer)
            out[row, k] = size * relative_modulus(layer, omega, warmth).conj()
    return out, track
