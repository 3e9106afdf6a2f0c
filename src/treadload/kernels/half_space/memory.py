"""Influence coefficients of bodies with memory: steady motion of a load along +x over a viscoelastic half-space.

In the frame that moves with the load at speed V, material flows through the point x from larger x on, and what
was done to it there fades with the retardation times T. With the instantaneous coefficients A and L = V T

    A_v(X) = A(X) + Σ fⱼ Bⱼ(X),    B(X) = ∫₀^∞ exp(-s/L)/L A(X + s) ds.

A_v is not even in X. The coefficients are those of the infinite plane, so that a convolution by padded FFT stays
exact however long the memory is.

Source: Kalker (1990), Three-Dimensional Elastic Bodies in Rolling Contact, section 5 (steady motion);
Wang & Knothe (1993), J. Appl. Mech. 60, 310-317 (viscoelastic cylinders in rolling contact).
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence

import numpy as np
import scipy

from treadload.kernels.arrays import Array

# (first, count) → A (…, count) at X = first + dx · (0, 1, …, count - 1).
Sample = Callable[[float, int], Array]

# A is smooth over a cell beyond this many cells from the load: a polynomial is good to nine digits there.
_NEAR = 6
_NODES = 7
# Slopes of A are infinite at the edges of the loaded cell: panels shrink towards them by this factor, this often.
_GRADING, _LEVELS, _NEAR_NODES = 0.35, 13, 10
# Beyond the last offset A is a power of the distance: panels grow with it until the memory has faded.
_GROWTH, _START_NODES, _FORGOTTEN = 0.5, 10, 45.0
_SHORTEST = 1e8


def fading(sample: Sample, behind: int, ahead: int, dx: float, lengths: Sequence[float]) -> Array:
    """B (terms, …, behind + 1 + ahead) at the offsets X = -behind · dx … ahead · dx, in the unit of A.

    sample: the instantaneous coefficients. behind, ahead: cells, ≥ 0. dx: cell size, m.
    lengths: L of each term, m, > 0: from L → 0, where B = A, to any multiple of the window.
    Exact recursion from the leading end, B(X) = exp(-dx/L) B(X + dx) + ∫₀^dx exp(-s/L)/L A(X + s) ds, with
    the integrals by rules that contain the exponential, good to seven digits of A or more.
    """
    # scipy.signal brings scipy.stats along, which takes as long to import as all of this package.
    from scipy.signal import lfilter

    # The near cells are treated on their own, wanted or not.
    extra, wanted = max(_NEAR - behind, 0), behind + 1 + ahead
    behind, ahead = behind + extra, max(ahead, _NEAR)
    length = np.asarray(lengths, dtype=float)
    passed = _over_cells(sample, behind, ahead, dx, length)
    first = _beyond(sample, ahead * dx, length)
    faded = np.empty((*passed.shape[:-1], passed.shape[-1] + 1))
    for term, L in enumerate(length):
        kept = np.exp(-dx / L)
        faded[term, ..., -1] = first[term]
        start = kept * first[term][..., None]
        faded[term, ..., -2::-1] = lfilter([1.0], [1.0, -kept], passed[term, ..., ::-1], axis=-1, zi=start)[0]
    return faded[..., extra : extra + wanted]


def rule(nodes: Array, start: float, end: float, lengths: Array) -> Array:
    """Weights (terms, n) with Σ w f(s) = ∫ exp(-s/L)/L f(s) ds from start to end, exact for polynomials.

    nodes: (n,) on [-1, 1], mapped to [start, end], m. lengths: L (terms,), m.
    """
    half = 0.5 * (end - start)
    # A memory this short counts as none; Bessel functions of larger arguments overflow.
    ratio = np.minimum(half / lengths, _SHORTEST)
    order = np.arange(nodes.size)
    # ∫ P_k(t) exp(-λ(1 + t)) dt over [-1, 1] is a modified spherical Bessel function.
    bessel = np.sqrt(np.pi / (2 * ratio))[:, None] * scipy.special.ive(order + 0.5, ratio[:, None])
    moments = 2 * (-1.0) ** order * bessel * (ratio * np.exp(-start / lengths))[:, None]
    legendre = np.polynomial.legendre.legvander(nodes, nodes.size - 1)
    weights: Array = np.linalg.solve(legendre.T, moments.T).T
    return weights


def _over_cells(sample: Sample, behind: int, ahead: int, dx: float, lengths: Array) -> Array:
    """∫₀^dx exp(-s/L)/L A(X + s) ds (terms, …, behind + ahead) for every offset but the last."""
    nodes = _lobatto(_NODES)
    weights = rule(nodes, 0.0, dx, lengths)
    count = behind + ahead
    # The ends of the rule are the offsets themselves, shared by neighbours.
    whole = sample(-behind * dx, count + 1)
    passed = _times(weights[:, 0], whole[..., :-1]) + _times(weights[:, -1], whole[..., 1:])
    for k in range(1, nodes.size - 1):
        passed += _times(weights[:, k], sample(-behind * dx + 0.5 * dx * (1 + nodes[k]), count))
    near = np.zeros_like(passed[..., behind - _NEAR : behind + _NEAR])
    gauss = np.polynomial.legendre.leggauss(_NEAR_NODES)[0]
    for low, high in _graded(dx):
        for node, weight in zip(gauss, rule(gauss, low, high, lengths).T, strict=True):
            s = low + 0.5 * (high - low) * (1 + node)
            near += _times(weight, sample(-_NEAR * dx + s, 2 * _NEAR))
    passed[..., behind - _NEAR : behind + _NEAR] = near
    return passed


def _graded(dx: float) -> list[tuple[float, float]]:
    """Panels of [0, dx] that shrink towards dx/2, where the edge of the loaded cell lies."""
    distance = 0.5 * dx * np.append(_GRADING ** np.arange(_LEVELS), 0.0)
    ends = np.concatenate([0.5 * dx - distance, 0.5 * dx + distance[-2::-1]])
    return list(itertools.pairwise(ends))


def _beyond(sample: Sample, x: float, lengths: Array) -> Array:
    """B (terms, …) at the offset x, m, by panels that grow with the distance from the load."""
    gauss = np.polynomial.legendre.leggauss(_START_NODES)[0]
    low, end = 0.0, _FORGOTTEN * float(lengths.max())
    total: Array | float = 0.0
    while low < end:
        high = low + _GROWTH * (x + low)
        for node, weight in zip(gauss, rule(gauss, low, high, lengths).T, strict=True):
            total = total + _times(weight, sample(x + low + 0.5 * (high - low) * (1 + node), 1)[..., 0])
        low = high
    return np.asarray(total)


def _times(weights: Array, field: Array) -> Array:
    """Outer product (terms, *field)."""
    return np.multiply.outer(weights, field)


def _lobatto(n: int) -> Array:
    """Nodes (n,) of the Gauss-Lobatto rule on [-1, 1]: the ends, and where P'ₙ₋₁ = 0."""
    inner = np.polynomial.legendre.Legendre.basis(n - 1).deriv().roots()
    return np.concatenate([[-1.0], np.sort(inner.real), [1.0]])
