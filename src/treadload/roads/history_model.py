"""Deflections over time that layers without inertia would show under a falling weight.

Each frequency of the force is a static problem of complex moduli, u(r, ω) = F(ω) H(r, ω). H is smooth in ln ω: it is
solved at a few frequencies of each octave, and a sum with weights that the force of each drop makes gives deflections
at the fitted times. Quasi-static: exact as ω goes to 0, and short of the travel time of waves; at 20 Hz waves of
140 m/s are 7 m long, so that sensors at 1.5 m answer late by some milliseconds, which these layers cannot show.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.polynomial.chebyshev import chebpts1, chebvander

from treadload.kernels.arrays import Array, ComplexArray, IntArray
from treadload.kernels.fft import rfft
from treadload.roads.drop_histories import DropHistories
from treadload.roads.model import BasinModel, OverBasins, models, slopes_over
from treadload.roads.unknowns import Unknowns, has_memory, modulus_of, relative_modulus

# Frequencies: octaves from the first to the last, Hz, and points of each.
_FIRST, _LAST, _POINTS = 0.25, 1024.0, 4
# The record is followed by rest, s, so that what creeps back is over before it repeats.
_REST = 8.0


@dataclass(frozen=True, eq=False)
class HistoryModel(OverBasins):
    """Deflections of drops at the fitted times, over logarithms of the unknowns x (n, v, p).

    static: the same drops and layers under 1 N. moduli: (n, L, f) of the present layers at each frequency, Pa; of
    those sought over their modulus. times: (n, nt, f), of the transfer function in the deflection at each fitted
    time, N.
    """

    static: BasinModel
    moduli: Array | ComplexArray
    times: Array | ComplexArray

    @property
    def load(self) -> Array:
        """Of the drops (n,), N."""
        return self.static.load

    @property
    def size(self) -> int:
        """Nodes of a structure."""
        return self.static.size * len(self.moduli[0, 0])

    @property
    def geometry(self) -> Array:
        """Each drop has a force of its own."""
        return np.arange(len(self.drops), dtype=float)[:, None]

    @cached_property
    def coarse(self) -> HistoryModel:
        """The same with moduli of 10 Hz and no memory: for starts."""
        if not np.iscomplexobj(self.moduli):
            return self
        felt = int(np.argmin(np.abs(_frequencies() - 10.0)))
        force = self.times.sum(axis=2).real[:, :, None]
        return replace(self, moduli=np.abs(self.moduli[:, :, felt : felt + 1]), times=force)

    def rows(self, at: IntArray) -> HistoryModel:
        """The model of some of the drops."""
        return HistoryModel(self.static.rows(at), self.moduli[at], self.times[at])

    def deflection(self, x: Array) -> Array:
        """Deflection (n, v, s times), m."""
        static = self.static
        n, v, _ = x.shape
        layers, count = len(self.present), len(self.sought)
        factor = np.ones((n, v, layers))
        factor[..., list(self.sought)] = np.exp(x[..., :count])
        poisson = static.columns.poisson[:, :, None]
        shear = factor[..., None] * (self.moduli / (2 * (1 + poisson)))[:, None]
        # (n, v, f, L): each frequency is a variant of its column.
        several = np.moveaxis(shear, 2, 3).reshape(n, -1, layers)
        columns = static.columns
        if static.seeks_depth:
            deep = np.repeat(np.exp(x[..., -1]) - static.above[:, None], self.moduli.shape[2], axis=1)
            columns = columns.with_thickness(layers - 1, deep)
        kernel, top = columns.kernel(several)
        transfer = static.plate.settlement(kernel, top).reshape(n, v, self.moduli.shape[2], -1)
        return np.asarray(np.einsum("ntf,nvfs->nvst", self.times, transfer).real.reshape(n, v, -1))

    def with_slopes(self, x: Array) -> tuple[Array, Array]:
        """Deflection, and its slopes over x (n, v, s times, p)."""
        return slopes_over(self.deflection, x)


def history_models(histories: DropHistories, unknowns: Unknowns, table: Array, drops: IntArray) -> list[HistoryModel]:
    """A model for each set of layers that are present. table: of `thicknesses`. drops: numbers to model."""
    return [_model(histories, unknowns, static) for static in models(histories.peaks, unknowns, table, drops)]


def _model(histories: DropHistories, unknowns: Unknowns, static: BasinModel) -> HistoryModel:
    layers = [unknowns.road.layers[number] for number in static.present]
    force = histories.force[static.drops]
    size = [1.0 if k in static.sought else modulus_of(layer) for k, layer in enumerate(layers)]
    if not any(has_memory(layer) for layer in layers):
        moduli = np.broadcast_to(np.array(size)[None, :, None], (len(force), len(layers), 1))
        return HistoryModel(static, moduli, force[:, histories.fitted_times, None])
    omega = 2 * math.pi * _frequencies()
    memory = np.empty((len(force), len(layers), len(omega)), complex)
    for row, drop in enumerate(static.drops):
        warmth = math.nan if histories.temperature is None else float(histories.temperature[drop])
        for k, layer in enumerate(layers):
            memory[row, k] = size[k] * relative_modulus(layer, omega, warmth)
    times = np.stack([_weights(histories.time, row, histories.fitted_times) for row in force])
    return HistoryModel(static, memory, times)


def _edges() -> Array:
    return np.concatenate([[0.0], _FIRST * 2.0 ** np.arange(round(math.log2(_LAST / _FIRST)) + 1)])


def _frequencies() -> Array:
    unit = chebpts1(_POINTS)
    return np.concatenate([0.5 * (b - a) * unit + 0.5 * (a + b) for a, b in itertools.pairwise(_edges())])


def _weights(time: Array, force: Array, at: IntArray) -> ComplexArray:
    """Of the transfer function at the frequencies (f,) in the deflection at some of the times (nt, f), N."""
    step = float(time[1] - time[0])
    count = 2 ** math.ceil(math.log2(len(time) + _REST / step))
    spectrum = np.asarray(rfft(force, count))
    steady = np.arange(len(spectrum)) / (count * step)
    share = np.full(len(spectrum), 2.0 / count)
    share[0] = 1.0 / count
    out = np.zeros((len(at), len(_frequencies())), complex)
    series = np.linalg.inv(chebvander(chebpts1(_POINTS), _POINTS - 1))
    edges = _edges()
    # What is faster than the last octave goes with its end.
    frequency = np.minimum(steady, edges[-1] * (1 - 1e-12))
    turns = 2 * math.pi * steady
    for panel, (low, high) in enumerate(itertools.pairwise(edges)):
        there = np.flatnonzero((frequency >= low) & (frequency < high))
        if not len(there):
            continue
        values = chebvander((2 * frequency[there] - low - high) / (high - low), _POINTS - 1) @ series
        wave = np.exp(1j * np.outer(at * step, turns[there])) * (spectrum[there] * share[there])
        out[:, panel * _POINTS : (panel + 1) * _POINTS] = wave @ values
    return out
