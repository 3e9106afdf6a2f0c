"""Basins that layers would show: many drops of one plate and one kind of structure at once."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from treadload.kernels.arrays import Array, IntArray
from treadload.kernels.layers.settlement import Columns, Plate
from treadload.pavement import Bond, Pavement
from treadload.pavement.bonds import BONDED, FRICTIONLESS
from treadload.roads.basins import Basins, Measured
from treadload.roads.unknowns import Unknowns, modulus_of, poisson_of

# Of the slopes: step of ln E and ln depth. Deflections are computed to some 1e-14, so that a difference over 1e-5 has
# nine digits, and its curvature moves a slope by 1e-5 of itself.
_STEP = 1e-5
# Largest ratio of moduli for which the panel at zero is laid out.
_RATIO = 1e4


@dataclass(frozen=True, eq=False)
class BasinModel:
    """Deflections of drops with the same sensors, over logarithms of the unknowns x (n, v, p).

    drops: numbers of the drops. present: numbers of the layers that are there. sought: places among these of the
    layers whose modulus is sought. columns of x: those of `unknowns` that `chosen` names. log_moduli: of the present
    layers (L,), Pa; of those sought anything. above: depth of the top of the last layer (n,), m.
    """

    drops: IntArray
    present: tuple[int, ...]
    sought: tuple[int, ...]
    chosen: tuple[int, ...]
    seeks_depth: bool
    plate: Plate
    columns: Columns
    load: Array
    log_moduli: Array
    above: Array

    def rows(self, at: IntArray) -> BasinModel:
        """The model of some of the drops, by place."""
        return BasinModel(
            self.drops[at], self.present, self.sought, self.chosen, self.seeks_depth, self.plate,
            self.columns.rows(at), self.load[at], self.log_moduli, self.above[at],
        )  # fmt: skip

    @property
    def size(self) -> int:
        """Nodes of a structure."""
        return len(self.plate.nodes)

    @property
    def geometry(self) -> Array:
        """Numbers that drops of the same geometry share (n, ...)."""
        if not self.columns.slabs:
            return np.zeros((len(self.drops), 1))
        return np.stack([np.asarray(slab.t[4])[:, 0, self.size // 2] for slab in self.columns.slabs], axis=1)

    @property
    def coarse(self) -> BasinModel:
        """What starts are found with."""
        return self

    def deflection(self, x: Array) -> Array:
        """Deflection (n, v, s), m."""
        shear = np.exp(self.layers(x)) / (2 * (1 + self.columns.poisson[:, None, :]))
        columns = self.columns
        if self.seeks_depth:
            columns = columns.with_thickness(len(self.present) - 1, np.exp(x[..., -1]) - self.above[:, None])
        kernel, top = columns.kernel(shear)
        return np.asarray(self.plate.settlement(kernel, top) * self.load[:, None, None])

    def layers(self, x: Array) -> Array:
        """Ln of the moduli of the present layers (n, v, L), Pa."""
        moduli = np.broadcast_to(self.log_moduli, (*x.shape[:-1], len(self.present))).copy()
        moduli[..., list(self.sought)] = x[..., : len(self.sought)]
        return moduli

    def with_slopes(self, x: Array) -> tuple[Array, Array]:
        """Deflection (n, v, s), m, and its slopes over x (n, v, s, p)."""
        return slopes_over(self.deflection, x)


class OverBasins:
    """Drops, layers and unknowns of a model that is made over a `BasinModel`, its `static`."""

    static: BasinModel

    @property
    def drops(self) -> IntArray:
        """Numbers of the drops."""
        return self.static.drops

    @property
    def present(self) -> tuple[int, ...]:
        """Numbers of the layers that are there."""
        return self.static.present

    @property
    def sought(self) -> tuple[int, ...]:
        """Places among these of the layers whose modulus is sought."""
        return self.static.sought

    @property
    def chosen(self) -> tuple[int, ...]:
        """Numbers of the unknowns in the columns of x."""
        return self.static.chosen


def slopes_over(function: Callable[[Array], Array], x: Array) -> tuple[Array, Array]:
    """Values (n, v, s) of a function at x (n, v, p), and their slopes over x (n, v, s, p)."""
    n, v, p = x.shape
    moved = np.repeat(x[:, :, None, :], p + 1, axis=2)
    for number in range(p):
        moved[:, :, number + 1, number] += _STEP
    values = function(moved.reshape(n, v * (p + 1), p)).reshape(n, v, p + 1, -1)
    slopes = (values[:, :, 1:] - values[:, :, :1]) / _STEP
    return values[:, :, 0], np.moveaxis(slopes, 2, 3)


def thicknesses(basins: Measured, unknowns: Unknowns, names: tuple[str, ...]) -> Array:
    """Thickness of every layer at every drop (n, L), m; of the last one to the stiff layer, inf on a half-space."""
    count = len(basins)
    table = np.full((count, len(names)), math.inf)
    for number, layer in enumerate(unknowns.road.layers):
        if names[number] in basins.thickness:
            table[:, number] = basins.thickness[names[number]]
        elif layer.thickness is not None:
            table[:, number] = layer.thickness
    if unknowns.depth is not None and not unknowns.road.rigid_base:
        table[:, -1] = unknowns.depth - table[:, :-1].sum(axis=1)
    return table


def models(basins: Basins, unknowns: Unknowns, table: Array, drops: IntArray) -> list[BasinModel]:
    """A model for each set of layers that are present. table: of `thicknesses`. drops: numbers to model."""
    return [_model(basins, unknowns, table, *part) for part in by_layers_present(table, drops)]


def by_layers_present(table: Array, drops: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Drops that have the same layers, with the numbers of these layers. table: of `thicknesses`."""
    patterns, kind = np.unique(table[drops] > 0, axis=0, return_inverse=True)
    for number, pattern in enumerate(patterns):
        yield drops[kind.ravel() == number], np.flatnonzero(pattern)


def sought_of(unknowns: Unknowns, present: IntArray) -> tuple[tuple[int, ...], tuple[int, ...]]:
    """Places among the present layers whose moduli are unknown, and numbers of the unknowns that a model has."""
    chosen = [k for k, number in enumerate(unknowns.moduli) if number in present]
    sought = tuple(int(np.flatnonzero(present == unknowns.moduli[k])[0]) for k in chosen)
    return sought, (*chosen, len(unknowns.moduli)) if unknowns.seeks_depth else tuple(chosen)


def _model(basins: Basins, unknowns: Unknowns, table: Array, drops: IntArray, present: IntArray) -> BasinModel:
    road = unknowns.road
    layers = [road.layers[number] for number in present]
    rigid = unknowns.depth is not None
    deep = table[np.ix_(drops, present)]
    poisson = np.array([poisson_of(layer) for layer in layers])
    spring = springs_between(road, present)
    thinnest = float(deep[:, 0].min()) if len(present) > 1 or rigid else math.inf
    finite = deep[:, : len(present) - (0 if rigid else 1)]
    basin = max(float(finite.sum(axis=1).max(initial=0.0)), basins.plate_radius) * _RATIO ** (1 / 3)
    plate = Plate.of(basins.plate_radius, basins.offsets, thinnest, basin, rigid=basins.plate == "rigid")
    columns = Columns.of(
        plate.nodes, [deep[:, k : k + 1] for k in range(finite.shape[1])], np.tile(poisson, (len(drops), 1)), spring,
        rigid=rigid,
    )  # fmt: skip
    sought, chosen = sought_of(unknowns, present)
    log_moduli = np.log([modulus_of(layer) for layer in layers])
    above = table[np.ix_(drops, present)][:, :-1].sum(axis=1)
    return BasinModel(
        drops, tuple(map(int, present)), sought, chosen, unknowns.seeks_depth, plate, columns,
        basins.load[drops], log_moduli, above,
    )  # fmt: skip


def springs_between(road: Pavement, present: IntArray) -> tuple[float, ...]:
    """Stiffness of the interfaces between the present layers, Pa/m."""
    return tuple(_spring(road, int(present[k]), int(present[k + 1])) for k in range(len(present) - 1))


def _spring(road: Pavement, upper: int, lower: int) -> float:
    """Stiffness between two present layers, Pa/m: the weakest of the bonds between them."""
    springs = []
    for layer in road.layers[upper:lower]:
        bond = layer.bond
        springs.append(
            math.inf
            if bond == BONDED
            else 0.0
            if bond == FRICTIONLESS
            else bond.stiffness
            if isinstance(bond, Bond)
            else math.inf
        )
    return min(springs)
