"""Passes one after the other, of laws that follow the material step by step."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from treadload.errors import InputError
from treadload.kernels.arrays import Array
from treadload.kernels.plasticity.state import State
from treadload.response.passes.box import Box, over_strength, row_edges
from treadload.response.passes.grid_error import (
    HOW,
    caveats,
    change,
    cut,
    doubled,
    enough_cells,
    largest_mean,
    relative,
    rut_depths,
)
from treadload.response.passes.problem import FEW_ROWS, SEARCHED, Problem, probe
from treadload.response.passes.steady import NoSteadyPassError, Pass, Track, roll
from treadload.response.passes.verdict import at_rest, elastic_factor, judged, shakedown_factor, still_falls

# How often a box may grow that what yields has reached, and by which part of a side.
GROWTHS, GROWN = 4, 0.35
# What a pass adds at a side counts from this part of the largest plastic strain on.
REACHED = 0.01


@dataclass(frozen=True, eq=False)
class Record:
    """After one pass: its number, plastic strain (6, nz, ny), accumulated (nz, ny), and residual stress, Pa.

    added, left: largest equivalent plastic strain that it added, largest change that it left. offset: of the wheel,
    m. rounds: of the mixing. along: see `steady.Pass`, none where nothing was rolled.
    """

    number: float
    strain: Array
    hardening: Array
    residual: Array
    added: float
    left: float
    offset: float
    rounds: int
    along: Array | None = None


@dataclass(frozen=True, eq=False)
class Outcome:
    """Beside the records: attributes of the dataset, entries of stats, sentences, and fields by pass."""

    attrs: dict[str, Any]
    stats: dict[str, Any]
    warnings: tuple[str, ...]
    fields: dict[str, Array] = field(default_factory=dict)


def by_steps(question: Problem, passes: int, tolerance: float) -> tuple[Box, list[Record], Outcome]:
    """Passes of laws that are followed step by step, in a box that holds what yields."""
    box = probe(question)
    if box is None:
        return _nothing(question, passes)
    box, coarse = _coarse(question, box, passes, tolerance)
    for _ in range(GROWTHS + 1):
        records, ends, outcome = _run(question, _track(question, box), passes, tolerance)
        if not (ends > REACHED).any():
            return box, records, _with_error(question, (box, records, outcome), coarse)
        check_depth(question, ends)
        box = grown(question, box, ends, question.across)
    raise too_far(box)


def _track(question: Problem, box: Box) -> Track:
    box.check_size()
    question.tell(f"operator of {box.nx} x {box.ny} cells in {len(box.depths)} rows")
    return Track.of(box, [question.material_at(float(z)) for z in box.depths])


def _coarse(
    question: Problem, box: Box, passes: int, tolerance: float
) -> tuple[Box, tuple[Box, list[Record], Outcome]]:
    """The box, grown and cut on cells of twice the size until it just holds what yields, and the passes on these."""
    question.tell("passes on cells of twice the size, for the error of the grid")
    for last in range(GROWTHS + 1):
        wide = doubled(box, question.courses)
        if wide.too_large:
            box.check_size()
        records, ends, outcome = _run(question, _track(question, wide), passes, tolerance, seeks=False)
        if not (ends > REACHED).any() or last == GROWTHS:
            break
        check_depth(question, ends)
        box = grown(question, box, ends, question.across)
    along = np.max([record.along for record in records if record.along is not None], axis=0, initial=0.0)
    return cut(box, wide, records[-1].hardening, along, question.depth), (wide, records, outcome)


def _with_error(
    question: Problem, fine: tuple[Box, list[Record], Outcome], coarse: tuple[Box, list[Record], Outcome]
) -> Outcome:
    """The result of the passes, with the error of their grid."""
    both = [
        (
            rut_depths([record.strain for record in records], box, question.road),
            np.array([largest_mean(record.hardening, box, question.mean_over) for record in records]),
        )
        for box, records, _ in (fine, coarse)
    ]
    ruts, strains = zip(*both, strict=True)
    outcome = fine[2]
    enough = enough_cells([record.hardening for record in fine[1]])
    errors = [np.where(enough, change(*values), np.nan) for values in (ruts, strains)]
    fields = {
        "peak_plastic_strain": strains[0],
        "rut_depth_error": errors[0],
        "peak_plastic_strain_error": errors[1],
    }
    off = relative(errors[0], ruts[0]), relative(errors[1], strains[0])
    verdicts = outcome.attrs["verdict"], coarse[2].attrs["verdict"]
    attrs = outcome.attrs | {"averaging_width": question.mean_over, "error_estimate": HOW}
    warnings = (*outcome.warnings, *caveats(fine[0], off, verdicts, fine[1][-1].hardening))
    return replace(outcome, attrs=attrs, warnings=warnings, fields=fields)


def check_depth(question: Problem, ends: Array) -> None:
    """Raise InputError where the plastic zone reaches the depth that was asked for. ends: see `Pass`."""
    if ends[4] > REACHED and question.depth is not None:
        raise InputError(
            f"the plastic zone reaches the depth of the box, {question.depth:g} m: the last row takes "
            f"{100 * ends[4]:.0f} % of the largest plastic strain; raise depth, or leave it out"
        )


def grown(question: Problem, box: Box, ends: Array, cell: float) -> Box:
    """The box, larger on the sides that the plastic zone reaches. ends: see `Pass`. cell: that sets its rows, m."""
    reached = np.where(ends > REACHED, GROWN, 0.0)
    box = box.grown(*reached[:4].tolist())
    if not reached[4]:
        return box
    top = question.courses[0].top
    deeper = top + (box.edges[-1] - top) * (1 + GROWN)
    if cell == question.across:
        return replace(box, edges=question.row_edges(deeper))
    return replace(box, edges=row_edges(question.courses, 0.8 * cell, deeper, question.layers))


def too_far(box: Box) -> InputError:
    """What to raise where a box grew as often as it may."""
    return InputError(
        f"the plastic zone reaches the sides of a box of {box} and grew with it {GROWTHS} times: this load is far "
        "above what the road can carry; lower it, or give a stronger law"
    )


def _run(
    question: Problem, track: Track, passes: int, tolerance: float, *, seeks: bool = True
) -> tuple[list[Record], Array, Outcome]:
    """All passes over a track, and what of the largest strain of a pass yields at the sides of the box at most.

    seeks: whether to look for the load that would shake down where this one has no steady pass.
    """
    box = track.box
    places = [round(offset / box.dy) for offset in question.offsets]
    left, right = -min(0, *places), max(0, *places)
    # The load moved to the right stands still in a frame that moves to the left.
    y = box.y0 + box.dy * np.arange(-right, box.ny + left)
    question.tell("stress of the elastic road")
    wide = _mean_stress(question, box, y)
    duration = 0.0 if question.speed is None or not question.speed > 0 else box.dx / question.speed

    def next_pass(number: int, states: Sequence[State]) -> tuple[Pass, float]:
        place = places[(number - 1) % len(places)]
        question.tell(f"pass {number} of {passes}")
        stress = stress_at(place)
        return roll(track, stress, states, duration=duration, tolerance=tolerance), place * box.dy

    def stress_at(place: int) -> Array:
        return wide[:, :, right - place : right - place + box.ny]

    records, ends, error = follow(track, passes, next_pass, deepest=question.courses[-1].bottom)
    attrs: dict[str, Any] = {"elastic_load_factor": elastic_factor(track, wide)}
    warnings: tuple[str, ...] = ()
    if error is not None and seeks:
        question.tell("the load that would shake down")
        number = int(records[-1].number) + 1
        factor = shakedown_factor(track, stress_at(places[(number - 1) % len(places)]), duration=duration)
        attrs["shakedown_load_factor"] = factor
        warnings += (
            f"pass {number} has no steady state (its plastic strain still changed by {error.residual:.1e} of "
            f"itself): the road ratchets; it would shake down under {100 * factor:.0f} % of this load; lower the "
            "load, or give a law that hardens",
        )
    verdicts, more = verdict_of(track, records, failed=error is not None, straight=len(question.offsets) == 1)
    return records, ends, Outcome(attrs | verdicts, {"memory_mb": track.bars.bytes / 1e6}, warnings + more)


def _mean_stress(question: Problem, box: Box, y: Array) -> Array:
    """Stress (6, nz, m, nx), Pa, on the elastic road, at places y (m,), m: means over cells across.

    At their centres alone it would depend on where the edges of ribs lie in their cells.
    """
    halves = (y[:, None] + box.dy * np.array([-0.25, 0.25])).ravel()
    stress = question.stress(box.x, halves, box.depths)
    mean: Array = 0.5 * (stress[:, :, ::2] + stress[:, :, 1::2])
    return mean


def follow(
    track: Track,
    passes: int,
    pass_of: Callable[[int, Sequence[State]], tuple[Pass, float]],
    *,
    deepest: float,
    rests: bool = False,
) -> tuple[list[Record], Array, NoSteadyPassError | None]:
    """Passes over a track, one after the other, until they are done, or what yields reaches a side of the box.

    pass_of: the pass of a number over these states, and the place of the wheel, m. deepest: bottom of yielding, m.
    rests: whether to stop after a pass that adds as little as shakedown means. Returns what each left, what of the
    largest plastic strain was added at the sides of the box at most, see `Pass`, and why there is no next pass.
    """
    states, records, ends, error = track.virgin(), list[Record](), np.zeros(5), None
    strain, hardening = track.whole(states)
    closed = track.box.edges[-1] >= deepest * (1 - 1e-9)
    for number in range(1, passes + 1):
        try:
            done, offset = pass_of(number, states)
        except NoSteadyPassError as error_raised:
            error = error_raised
            break
        states, old, before = done.states, strain, hardening
        strain, hardening = track.whole(states)
        added, left_over = float((hardening - before).max()), float(np.abs(strain - old).max())
        records.append(
            Record(
                number, strain, hardening, track.residual(strain), added, left_over, offset, done.rounds, done.along
            )
        )
        reached = np.where(done.ends > 1e-3 * track.yield_strain, done.ends, 0.0)
        reached[4] *= not closed
        ends = np.maximum(ends, reached / max(float(hardening.max()), np.finfo(float).tiny))
        if (ends > REACHED).any() or (rests and at_rest(added, track.yield_strain)):
            break
    if not records:
        records.append(Record(0, strain, hardening, 0 * strain, 0.0, 0.0, 0.0, 0))
    return records, ends, error


def verdict_of(
    track: Track, records: Sequence[Record], *, failed: bool, straight: bool
) -> tuple[dict[str, object], tuple[str, ...]]:
    """Attributes with the outcome of the passes, and sentences. failed: a pass has no steady state. straight: all
    passes follow one line.
    """
    added_by, left_by = [record.added for record in records], [record.left for record in records]
    verdict = "ratchetting" if failed else judged(added_by, left_by, track.yield_strain)
    attrs: dict[str, Any] = {"yield_strain": track.yield_strain, "verdict": verdict}
    falls = still_falls(added_by)
    if verdict not in ("cyclic", "ratchetting") or falls is None or not straight:
        return attrs, ()
    return attrs | {"falls": falls}, (
        f"the plastic strain that a pass adds still falls, by {100 * falls:.0f} % in the last: more passes may "
        f"end in shakedown; the verdict is that of pass {records[-1].number:g}",
    )


def _nothing(question: Problem, passes: int) -> tuple[Box, list[Record], Outcome]:
    """A load under which nothing yields."""
    low_x, high_x, low_y, high_y = question.extent
    step = question.spacing
    nx, ny = (max(2, math.ceil((high - low) / step)) for low, high in ((low_x, high_x), (low_y, high_y)))
    top = question.courses[0].top
    deepest = top + SEARCHED * 0.5 * max(high_x - low_x, high_y - low_y)
    edges = row_edges(question.courses, 0.8 * step, question.depth or deepest, question.layers or FEW_ROWS)
    box = Box(nx, ny, step, step, low_x + step / 2, low_y + step / 2, edges)
    zeros = np.zeros((6, *box.shape))
    materials = [question.material_at(float(z)) for z in box.depths]
    stress = question.stress(box.x, box.y, box.depths)
    most, yield_strain = 0.0, math.inf
    for row, material in enumerate(materials):
        if material is None:
            continue
        most = max(most, 1 + float(over_strength(material, stress[:, row]).max()))
        yield_strain = min(yield_strain, material.yield_strain)
    records = [Record(n, zeros, zeros[0], zeros, 0.0, 0.0, 0.0, 0) for n in sorted({1, passes})]
    attrs = {
        "verdict": "elastic",
        "yield_strain": yield_strain,
        "elastic_load_factor": 1 / most if most else math.inf,
    }
    return box, records, Outcome(attrs, {}, ())
