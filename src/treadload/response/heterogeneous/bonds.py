"""The faces between stones and mortar: their places, directions and stress, and what is read of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from treadload.kernels.arrays import Array, BoolArray, IntArray
from treadload.kernels.tensors import matrices

# Cells over which a stone is smoothed to see which way its surface looks.
_SMOOTH = 1.0


@dataclass(frozen=True, eq=False)
class Faces:
    """Faces of cells of stones towards mortar, (n,).

    x, y, depth: of their middles, m. stone: number. area: that of the stone's surface, m²: of the steps, less where
    they stand oblique. normal: stress across the face, Pa, tension positive. shear: along it, its size, Pa.
    """

    x: Array
    y: Array
    depth: Array
    stone: IntArray
    area: Array
    normal: Array
    shear: Array

    @property
    def pull(self) -> Array:
        """√(⟨σ⟩₊² + τ²) of each, Pa: what tears the bond; compression does not."""
        value: Array = np.hypot(np.maximum(self.normal, 0.0), self.shear)
        return value


def faces(stones: IntArray, stress: Array, x: Array, y: Array, z: Array, thickness: Array) -> Faces:
    """Faces of the stones of a window, their stress the mean of the cells on both sides.

    stones: numbers (nz, ny, nx), 0 for mortar. stress: (6, nz, ny, nx), Pa. x, y, z: centres, m. thickness: (nz,), m.
    """
    inside = stones > 0
    outwards = _outwards(inside, x, y, z)
    tensor = matrices(stress)
    places = np.stack(np.meshgrid(z, y, x, indexing="ij")[::-1], axis=-1)
    step = np.array([x[1] - x[0] if len(x) > 1 else 1.0, y[1] - y[0] if len(y) > 1 else 1.0])
    tall = np.broadcast_to(thickness[:, None, None], stones.shape)
    sizes = {2: tall * step[1], 1: tall * step[0], 0: np.broadcast_to(step[0] * step[1], stones.shape)}
    parts: list[list[Array | IntArray]] = []
    for axis, size in sizes.items():
        for inner, outer in ((slice(None, -1), slice(1, None)), (slice(1, None), slice(None, -1))):
            near_side = tuple(inner if number == axis else slice(None) for number in range(3))
            beside = tuple(outer if number == axis else slice(None) for number in range(3))
            # A stone beside another has no bond to mortar there.
            bonded: BoolArray = inside[near_side] & ~inside[beside]
            normal = outwards[near_side][bonded] + outwards[beside][bonded]
            length = np.linalg.norm(normal, axis=-1, keepdims=True)
            straight = np.zeros(3)
            straight[2 - axis] = 1.0 if inner.start is None else -1.0
            normal = np.where(length > 1e-9, normal / np.maximum(length, 1e-9), straight)
            traction = np.einsum("nij,nj->ni", 0.5 * (tensor[near_side][bonded] + tensor[beside][bonded]), normal)
            across = (traction * normal).sum(axis=-1)
            along = np.linalg.norm(traction - across[:, None] * normal, axis=-1)
            middle = 0.5 * (places[near_side][bonded] + places[beside][bonded])
            area = size[near_side][bonded] * np.abs(normal @ straight)
            parts.append([*middle.T, stones[near_side][bonded], area, across, along])
    return Faces(*(np.concatenate(several) for several in zip(*parts, strict=True)))


def share_below(values: Array, weights: Array, share: float) -> float:
    """The value below which a share of the weight lies; NaN without weight."""
    if not len(values) or weights.sum() <= 0:
        return float("nan")
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return float(values[order][min(int(np.searchsorted(total, share * total[-1])), len(values) - 1)])


def _outwards(inside: BoolArray, x: Array, y: Array, z: Array) -> Array:
    """Where a smoothed stone falls off, (nz, ny, nx, 3) in x, y, z."""
    smooth = scipy.ndimage.gaussian_filter(inside.astype(float), _SMOOTH, mode="nearest")
    slopes = np.zeros((*inside.shape, 3))
    for component, (axis, at) in enumerate(((2, x), (1, y), (0, z))):
        if len(at) > 1:
            slopes[..., component] = -np.gradient(smooth, at, axis=axis)
    return slopes
