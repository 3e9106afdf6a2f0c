"""Depths in a stack of layers: the layer of each, how far waves matter there, and what they do to unit loads."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from treadload.kernels.arrays import Array
from treadload.kernels.layers.layered import Stack, transfer
from treadload.kernels.layers.synthesis import Accuracy, ElasticPlane
from treadload.materials import Solid
from treadload.pavement import Pavement
from treadload.pavement.stack import stack_of

# Nearer to the first interface than this part of its depth the split gains nothing and costs the closed form.
_SPLIT = 0.9


@dataclass(frozen=True, eq=False)
class Site:
    """Where in a road something is asked: an elastic road and its depths, (nz,), m, >= 0.

    mean: weights (rows, nz) of sums over the depths, each within one layer, which are asked in their place; None for
    the depths themselves.
    """

    road: Pavement
    depths: Array
    mean: Array | None = None


@dataclass(frozen=True, eq=False)
class Layout:
    """Depths in a stack: the layer of each, its side of an interface, whether the top's half-space is split off.

    fall: waves are cut where they have fallen to e^-fall, and at cut, 1/m, where a blur has faded. mean: weights
    (rows, nz) of the sums that are asked.
    """

    materials: tuple[Solid, ...]
    stack: Stack
    depths: Array
    where: list[int]
    below: bool
    split: list[bool]
    fall: float
    mean: Array
    cut: float = math.inf

    @classmethod
    def of(cls, site: Site, below: bool, accuracy: Accuracy) -> Layout:
        """With the half-space split off wherever that may gain something: nowhere where waves are blurred."""
        stack = stack_of(site.road)
        depths = stack.snapped(site.depths)
        where = [stack.layer_at(float(z), below) for z in depths]
        near = [
            layer == 0 and z < _SPLIT * stack.interfaces[0] and not accuracy.blur
            for z, layer in zip(depths, where, strict=True)
        ]
        materials = tuple(layer.elastic for layer in site.road.distinct_layers)
        mean = np.eye(len(depths)) if site.mean is None else site.mean
        return cls(materials, stack, depths, where, below, near, accuracy.fall, mean, accuracy.cut)

    @property
    def length(self) -> float:
        """Characteristic length, m: of the layers, or the deepest point."""
        contrast = (max(self.stack.moduli) / min(self.stack.moduli)) ** (1 / 3)
        return float(max(self.stack.interfaces[-1] * contrast, self.depths.max()))

    @property
    def limit(self) -> Array:
        """Largest wavenumber that matters at each depth, 1/m."""
        top = self.stack.faded(float(self.stack.interfaces[0]))
        faded = [self.stack.faded(float(z)) for z in self.depths]
        ways = [2 * top - z if near else z for z, near in zip(faded, self.split, strict=True)]
        return np.array([self.cut if way * self.cut <= self.fall else self.fall / way for way in ways])

    @property
    def rows(self) -> list[int]:
        """Depths at which the half-space is split off."""
        return [row for row, near in enumerate(self.split) if near]

    @property
    def rows_in(self) -> list[int]:
        """The layer of each sum."""
        return [self.where[int(np.flatnonzero(weights)[0])] for weights in self.mean]

    def kernels(self, k: Array) -> tuple[Array, Array]:
        """What unit loads do, (nz, 4, 2, nk) and (nz, 2, nk), without the half-space where it is split off."""
        result = transfer(k, self.stack, list(self.depths), [self.below] * len(self.depths))
        rows = self.rows
        if rows:
            alone = transfer(k, self.stack.top, list(self.depths[rows]), [False] * len(rows))
            result.plane[rows] -= alone.plane
            result.transverse[rows] -= alone.transverse
        return result.plane, result.transverse

    def plane(self, row: int) -> ElasticPlane:
        """One of its sums, with its table if that was made before."""
        columns = np.flatnonzero(self.mean[row])
        parts = tuple((float(self.mean[row, k]), float(self.depths[k]), self.split[k]) for k in columns)
        return _plane(self.stack, parts, self.where[columns[0]], self.below, (self.fall, self.cut))


@lru_cache(maxsize=256)
def _plane(
    stack: Stack, parts: tuple[tuple[float, float, bool], ...], layer: int, below: bool, ends: tuple[float, float]
) -> ElasticPlane:
    """A sum over depths in a layer. parts: weight, depth, and whether the half-space is split off; fall, cut."""
    weights, depths, split = (list(each) for each in zip(*parts, strict=True))
    layout = Layout(
        (), stack, np.array(depths), [layer] * len(parts), below, split, ends[0], np.array([weights]), ends[1]
    )

    def kernels(k: Array) -> tuple[Array, Array]:
        plane, transverse = layout.kernels(k)
        return np.tensordot(weights, plane, axes=1), np.tensordot(weights, transverse, axes=1)

    lift = None if stack.upright_of(layer) is None else stack.lift_of(layer)
    return ElasticPlane(kernels, float(stack.shear[layer]), stack.poisson[layer], float(layout.limit.max()), lift)
