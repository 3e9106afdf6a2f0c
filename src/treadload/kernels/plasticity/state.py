"""What a plastic material remembers, and what a return map is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from treadload.kernels.arrays import Array

# Tensors (6, ...): xx, yy, zz, xy, xz, yz; shears count twice in a double contraction.
_TWICE = np.array([1.0, 1.0, 1.0, 2.0, 2.0, 2.0])


@dataclass(frozen=True, eq=False)
class State:
    """State of a plastic material at points.

    strain: plastic strain (6, ...), tensor shears. hardening: accumulated equivalent plastic strain (...).
    back: back stress (6, ...), Pa, deviatoric.
    """

    strain: Array
    hardening: Array
    back: Array

    @classmethod
    def virgin(cls, shape: tuple[int, ...]) -> State:
        """Before anything yielded, at points of this shape."""
        return cls(np.zeros((6, *shape)), np.zeros(shape), np.zeros((6, *shape)))

    def at(self, points: object) -> State:
        """The state at some of the points, by an index of their axes."""
        index = points if isinstance(points, tuple) else (points,)
        inner = (slice(None), *index)
        return State(self.strain[inner], self.hardening[index], self.back[inner])


class ReturnMap(Protocol):
    """A law at its elastic moduli: from the trial stress of a step to the state at its end."""

    def __call__(self, trial: Array, state: State, duration: float = 0.0) -> State:
        """The state at the end of a step.

        trial: C:(strain at its end - plastic strain at its beginning), (6, ...), Pa. state: at its beginning.
        duration: of the step, s, for laws that depend on time. The stress at its end is the trial stress less
        C:(change of plastic strain).
        """

    def excess(self, stress: Array, state: State) -> Array:
        """The yield function (...), Pa: below zero inside, zero on the surface."""

    def elastic(self, strain: Array) -> Array:
        """C:strain, (6, ...), Pa."""


def deviator(tensor: Array) -> Array:
    """The tensor (6, ...) less its mean."""
    out = tensor.copy()
    out[:3] -= tensor[:3].mean(axis=0)
    return out


def size(deviatoric: Array) -> Array:
    """Von Mises' equivalent √(3/2 s:s) of a deviator (6, ...)."""
    value: Array = np.sqrt(1.5 * np.einsum("i,i...,i...->...", _TWICE, deviatoric, deviatoric))
    return value


def contracted(a: Array, b: Array) -> Array:
    """The double contraction a:b (...) of tensors (6, ...)."""
    value: Array = np.einsum("i,i...,i...->...", _TWICE, a, b)
    return value


def isotropic(strain: Array, shear: float, bulk: float) -> Array:
    """Stress (6, ...), Pa, of an isotropic elastic strain (6, ...): 2 G e + (K - 2G/3) tr e."""
    stress: Array = 2 * shear * strain
    stress[:3] += (bulk - 2 * shear / 3) * strain[:3].sum(axis=0)
    return stress
