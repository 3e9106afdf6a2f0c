"""Functions of wavenumbers that are smooth over panels that double: known at a few nodes of each panel.

Between its nodes a function is the polynomial through them, so that its integral with any kernel is a sum of its
values with weights that depend on the kernel alone.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebpts1, chebvander

from treadload.kernels.arrays import Array
from treadload.kernels.layers.wavenumbers import gauss

# Half a turn of a Bessel function is resolved to round-off by so many Gauss points.
_GAUSS = 12


class Panel(NamedTuple):
    """One panel. nodes: (n,), 1/m. k, w: Gauss points and weights (m,), 1/m. shares: (m, n), of `interpolation`."""

    nodes: Array
    k: Array
    w: Array
    shares: Array


def panels_up_to(first: float, limit: float, count: int, reach: float) -> Iterator[Panel]:
    """Panels from 0 that end at a first wavenumber, twice that and so on, until a limit lies in the last, 1/m.

    count: nodes of a panel. reach: m, for kernels that turn like exp(i k reach).
    """
    edges = [0.0, first]
    while edges[-1] < limit:
        edges.append(2 * edges[-1])
    for low, high in itertools.pairwise(edges):
        parts = max(1, math.ceil((high - low) * reach / math.pi))
        at, share = gauss(_GAUSS)
        ends = np.linspace(low, high, parts + 1)
        k = (0.5 * np.diff(ends)[:, None] * at + 0.5 * (ends[1:] + ends[:-1])[:, None]).ravel()
        w = (0.5 * np.diff(ends)[:, None] * share).ravel()
        yield Panel(nodes_between(low, high, count), k, w, interpolation(k, low, high, count))


def nodes_between(low: float, high: float, count: int) -> Array:
    """Nodes (count,) of a panel."""
    return np.asarray(0.5 * (high - low) * chebpts1(count) + 0.5 * (high + low))


def interpolation(k: Array, low: float, high: float, count: int) -> Array:
    """Shares (n, count) of the values at a panel's nodes in the value at k (n,)."""
    return np.asarray(chebvander((2 * k - low - high) / (high - low), count - 1) @ _to_series(count))


@cache
def _to_series(count: int) -> Array:
    return np.linalg.inv(chebvander(chebpts1(count), count - 1))
