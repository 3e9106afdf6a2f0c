"""Many passes by a power law of their number, on the stress of the elastic road."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.plasticity.state import deviator
from treadload.kernels.tensors import von_mises
from treadload.materials.plastic import ElastoPlastic, PassesPowerLaw
from treadload.response.passes.box import Box, row_edges
from treadload.response.passes.problem import FEW_ROWS, SEARCHED, Problem
from treadload.response.passes.steady import Track
from treadload.response.passes.stepping import Outcome, Record


def reported_counts(passes: int) -> Iterator[float]:
    """1, 2, 5, 10, … up to a number of passes, and that number."""
    for power in itertools.count():
        for digit in (1, 2, 5):
            if digit * 10**power >= passes:
                yield float(passes)
                return
            yield float(digit * 10**power)


def power_law_strain(
    stress: Array, materials: Sequence[ElastoPlastic | None], firsts: Sequence[int], count: int
) -> Array:
    """Plastic strain (6, nz, ny) of the first pass, on the mean over the places of the wheel.

    stress: (6, nz, wide, nx), Pa, of the load at rest. materials: of each row, None where it is elastic. firsts:
    where in it the lines begin for each place of the wheel; count: how many lines there are.
    p = factor q/E with the largest von Mises stress q of the pass, along the mean of the deviators that it goes
    through, each counted by its own von Mises stress. Wheels at several places: N passes are N/n at each of n places,
    and their strains, each with its own place, add up to what the law makes of so many passes.
    """
    result = np.zeros((6, len(materials), count))
    for row, material in enumerate(materials):
        if material is None:
            continue
        s, q = deviator(stress[:, row]), von_mises(stress[:, row])
        path = (s * q).sum(axis=-1)
        # Of a stress that keeps its direction the mean is of size one.
        path /= np.maximum((q * q).sum(axis=-1), np.finfo(float).tiny)
        once = 1.5 * _law(material).factor * q.max(axis=-1) / material.elastic.modulus * path
        result[:, row] = np.mean([once[:, first : first + count] for first in firsts], axis=0)
    return result


def _law(material: ElastoPlastic) -> PassesPowerLaw:
    law = material.law
    assert isinstance(law, PassesPowerLaw)
    return law


def by_power_law(question: Problem, passes: int, laws: set[type]) -> tuple[Box, list[Record], Outcome]:
    """Passes after a law of passes, evaluated as a whole."""
    if len(laws) > 1:
        raise InputError(
            "a PassesPowerLaw counts passes and other laws follow them one by one: all layers that yield need a "
            "PassesPowerLaw, or none"
        )
    low_x, high_x, low_y, high_y = question.extent
    step, half = question.spacing, 0.5 * max(high_x - low_x, high_y - low_y)
    places = [round(offset / step) for offset in question.offsets]
    more = math.ceil(half / step)
    nx, ny = (math.ceil((high - low) / step) + 2 * more for low, high in ((low_x, high_x), (low_y, high_y)))
    left, right = -min(0, *places), max(0, *places)
    deepest = question.courses[0].top + SEARCHED * half
    edges = row_edges(question.courses, 0.8 * step, question.depth or deepest, question.layers or FEW_ROWS)
    box = Box(
        nx, ny + left + right, step, step, low_x + (0.5 - more) * step, low_y + (0.5 - more - left) * step, edges
    )
    materials = [question.material_at(float(z)) for z in box.depths]
    question.tell("stress of the elastic road")
    wide = question.stress(box.x, box.y0 + step * np.arange(-right, box.ny + left), box.depths)
    track = Track.of(replace(box, nx=1), materials)
    by_place = power_law_strain(wide, materials, [right - place for place in places], box.ny)
    exponents = np.array([0.0 if material is None else _law(material).exponent for material in materials])[:, None]
    records, last = [], np.zeros((6, *box.shape))
    for number in reported_counts(passes):
        # Each place has had its part of the passes, and all follow the law of their number.
        strain = by_place * number**exponents
        records.append(
            Record(
                number, strain, 2 / 3 * von_mises(strain), track.residual(strain),
                float((2 / 3 * von_mises(strain - last)).max()), float(np.abs(strain - last).max()), 0.0, 0,
            )
        )  # fmt: skip
        last = strain
    strengths = [
        float(von_mises(wide[:, row]).max()) / material.elastic.modulus
        for row, material in enumerate(materials)
        if material
    ]
    return box, records, Outcome({"verdict": "ratchetting", "yield_strain": max(strengths)}, {}, ())
