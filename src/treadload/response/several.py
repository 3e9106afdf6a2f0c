"""Responses of many roads to many loads on the same points: what they share is computed once.

Half-bonded interfaces are the mean of two roads here, and means over a cube of road those of depths under loads
spread over as much.
"""

from __future__ import annotations

from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from treadload import variables
from treadload.deferred import xarray as xr
from treadload.errors import ConvergenceError, InputError
from treadload.kernels.arrays import Array
from treadload.kernels.layers.synthesis import READING
from treadload.materials.kinds import Solid
from treadload.pavement import Pavement
from treadload.response.fields import COMPONENTS, tensor_fields
from treadload.response.half_space import EvaluationGrid, half_space_response
from treadload.response.layered import View, layered_responses
from treadload.response.layout import Site
from treadload.response.loads import SurfaceLoad
from treadload.response.material import Windows, spread_over, windows
from treadload.response.moving import MovingFields, at_speed, moving_response
from treadload.response.parted import parted_fields
from treadload.response.superposition import merged

Side = Literal["above", "below"]
Loads = Sequence[SurfaceLoad]

_STRESS_OF = {"xx": (0, 1, 2), "yy": (0, 1, 2), "zz": (0, 1, 2), "xy": (3,), "xz": (4,), "yz": (5,)}
_ALONE = {f"stress_{name}": (k,) for k, name in enumerate(COMPONENTS)}
_PARTS = _ALONE | {f"strain_{name}": _STRESS_OF[name] for name in COMPONENTS}


@dataclass(frozen=True, eq=False)
class Question:
    """Loads, whose responses add up, on a road, as it is at the speed, at depths (nz,), m, >= 0.

    mean: weights (rows, nz) of sums over the depths, each within one layer, that are asked in their place.
    """

    loads: Loads
    road: Pavement
    depths: Array
    mean: Array | None = None


@dataclass(frozen=True, eq=False)
class Answer:
    """The fields of a question; over which parts of the road they are means, None for points."""

    fields: MovingFields
    read: Windows | None


def tensors_of_many(
    questions: Sequence[Question],
    x: Array,
    y: Array,
    *,
    needs: Iterable[str],
    speed: float | None = None,
    side: Side = "above",
    mean_over: float | None = None,
) -> list[xr.Dataset] | None:
    """Those components of stress and strain that are needed, (depth, y, x), for each question; see `solve_response`.

    Waves are taken as finely as readings need, `READING`. needs: names of variables. None where one of them is no
    component of stress or strain.
    """
    wanted = set(needs)
    components = components_of(wanted)
    if components is None:
        return None
    view = View(x, y, components=components, accuracy=READING)
    solved = answers(questions, view, side=side, speed=speed, mean_over=mean_over)
    return needed_fields(questions, solved, x, y, wanted)


def needed_fields(
    questions: Sequence[Question], solved: Sequence[Answer], x: Array, y: Array, wanted: Container[str]
) -> list[xr.Dataset]:
    """Wanted components of stress and strain, over (depth, y, x), of what was solved for each question."""
    # Coordinates are made once, and without indexes: many small fields cost less than they.
    places = {
        depths: without_indexes(np.array(depths), y, x)
        for depths in {tuple(question.depths.tolist()) for question in questions}
    }
    tensors = [tensor_fields(answer.fields.stress, answer.fields.strain) for answer in solved]
    return [
        xr.Dataset(
            # Variables, which xarray does not look at again.
            {
                name: xr.Variable(*field, variables.attributes(name), fastpath=True)
                for name, field in fields.items()
                if name in wanted
            },
            places[tuple(question.depths.tolist())],
        )
        for question, fields in zip(questions, tensors, strict=True)
    ]


def without_indexes(depths: Array, y: Array, x: Array) -> xr.Coordinates:
    """Coordinates of fields (depth, y, x), m, whose indexes would cost as much as fields of few points."""
    at = {"depth": depths, "y": y, "x": x}
    named = {name: xr.Variable((name,), values, variables.attributes(name)) for name, values in at.items()}
    return xr.Coordinates(named, indexes={})


def components_of(needs: Iterable[str]) -> list[int] | None:
    """Components of the stress, by number, that variables take; None where one is none of stress or strain."""
    wanted = set(needs)
    return sorted({part for name in wanted for part in _PARTS[name]}) if wanted <= set(_PARTS) else None


def answers(
    questions: Sequence[Question],
    view: View,
    *,
    side: Side,
    speed: float | None,
    mean_over: float | None,
    tell: Callable[[str], None] | None = None,
    spread: Mapping[int, Loads] | None = None,
) -> list[Answer]:
    """Stress, strain and displacement for each question in a view; arguments as in `solve_response`.

    spread: loads that are spread over the length already, by the `id` of those of a question.
    """
    at_speed_questions = [replace(question, road=at_speed(question.road, speed)) for question in questions]

    def solve(several: Sequence[Question]) -> Iterator[MovingFields]:
        limits = [question.road.bond_limits for question in several]
        single = [
            replace(question, road=road) for question, roads in zip(several, limits, strict=True) for road in roads
        ]
        solved = _solve(single, speed, view, below=side == "below", tell=tell)
        return (_mean([next(solved) for _ in roads]) for roads in limits)

    if mean_over is None:
        return [Answer(fields, None) for fields in solve(at_speed_questions)]
    return _over_windows(solve, at_speed_questions, mean_over, side, spread or {})


def all_spread(loads: Loads, length: float) -> Loads:
    """Loads whose response is the mean over squares of a length, m, of that of some loads."""
    return merged([spread_over(load, length) for load in loads])


def _over_windows(
    solve: Callable[[Sequence[Question]], Iterator[MovingFields]],
    questions: Sequence[Question],
    length: float,
    side: Side,
    spreads: Mapping[int, Loads],
) -> list[Answer]:
    """Means over windows of depth under loads spread over as much, and the points themselves where those are read."""
    spread = dict(spreads)
    parts: list[tuple[Question, Array]] = []
    reads, counts = [], []
    for posed in questions:
        read = windows(
            posed.depths, length, posed.road.interfaces, [posed.road.layer_at(float(z), side) for z in posed.depths]
        )
        reads.append(read)
        before = len(parts)
        if len(read.nodes):
            if id(posed.loads) not in spread:
                spread[id(posed.loads)] = all_spread(posed.loads, length)
            within, which = np.unique(read.mean[~read.local], axis=0, return_inverse=True)
            share = np.zeros((len(posed.depths), len(within)))
            share[~read.local] = np.eye(len(within))[which.ravel()]
            parts.append((Question(spread[id(posed.loads)], posed.road, read.nodes, within), share))
        if read.local.any():
            every = np.eye(len(posed.depths))
            parts.append((Question(posed.loads, posed.road, posed.depths[read.local]), every[:, read.local]))
        counts.append(len(parts) - before)
    solved = zip(solve([question for question, _ in parts]), (weights for _, weights in parts), strict=True)
    return [
        Answer(_weighted([next(solved) for _ in range(count)], len(question.depths)), read)
        for question, read, count in zip(questions, reads, counts, strict=True)
    ]


def _weighted(parts: Sequence[tuple[MovingFields, Array]], count: int) -> MovingFields:
    """The sum of fields at depths with weights (nz, n) of each."""
    first, weights = parts[0]
    if len(parts) == 1 and np.array_equal(weights, np.eye(count)):
        return replace(first, energy=np.zeros((count, 0)))
    stress, strain, displacement = (
        sum((_over_depths(weights, getattr(fields, name)) for fields, weights in parts), np.zeros(()))
        for name in ("stress", "strain", "displacement")
    )
    solved = [part for part, _ in parts]
    methods = " and ".join(dict.fromkeys(fields.method for fields in solved))
    warnings = tuple(dict.fromkeys(text for fields in solved for text in fields.warnings))
    return MovingFields(stress, strain, displacement, np.zeros((count, 0)), methods, warnings)


def _over_depths(weights: Array, values: Array) -> Array:
    """Sums (c, nz, ny, nx) of values (c, n, ny, nx); NaN counts where it has a weight (nz, n)."""
    gone = np.isnan(values)
    if not gone.any():
        whole: Array = np.einsum("zn,cnyx->czyx", weights, values)
        return whole
    total: Array = np.einsum("zn,cnyx->czyx", weights, np.where(gone, 0.0, values))
    total[np.einsum("zn,cnyx->czyx", weights != 0, gone)] = np.nan
    return total


def _solve(
    questions: Sequence[Question],
    speed: float | None,
    view: View,
    *,
    below: bool,
    tell: Callable[[str], None] | None,
) -> Iterator[MovingFields]:
    """Fields for one question after the other, of roads with no half-bonded interface."""
    x, y, at = view.x, view.y, view.at
    for question in questions:
        if question.road.parted is not None and question.road.is_viscoelastic:
            raise InputError(
                "friction on a parted face is followed between elastic layers, and this road has a viscoelastic one; "
                "take its limit, speed=0 or speed=math.inf, or a FRICTIONLESS face"
            )
    posed = questions
    questions = [
        Question(
            question.loads,
            question.road.sticking,
            question.depths,
            None if question.road.parted is not None else question.mean,
        )
        for question in posed
    ]
    layered = [
        question for question in questions if not (question.road.is_viscoelastic or question.road.is_homogeneous)
    ]
    several = list({id(question.loads): question.loads for question in layered}.values())
    place = {id(loads): number for number, loads in enumerate(several)}
    # Loads on one road at the same depths stand on one site.
    sites: list[Site] = []
    numbers: dict[tuple[Any, ...], int] = {}
    pairs = []
    for question in layered:
        key = (
            id(question.road),
            tuple(map(float, question.depths)),
            None if question.mean is None else question.mean.tobytes(),
        )
        if key not in numbers:
            numbers[key] = len(sites)
            sites.append(Site(question.road, question.depths, question.mean))
        pairs.append((place[id(question.loads)], numbers[key]))
    solutions = layered_responses(several, sites, pairs, view, below=below)
    moves = max(view.components) > len(COMPONENTS) - 1
    for question, parted in zip(questions, posed, strict=True):
        # Whose fields at depths are to be summed after they are solved.
        apart = question.mean is None or question.road.is_viscoelastic
        if question.road.is_viscoelastic:
            assert speed is not None
            fields = moving_response(question.loads, question.road, speed, question.depths, x, y, below=below, at=at)
        else:
            if question.road.is_homogeneous:
                material = question.road.surface_material
                apart = apart or not isinstance(material, Solid)
                solved = half_space_response(
                    question.loads, material,
                    EvaluationGrid(question.depths, x, y, at, None if apart else question.mean),
                    tell=tell, moves=moves, kept=view.kept,
                )  # fmt: skip
            else:
                solved = next(solutions)
            fields = MovingFields(*solved[:3], np.zeros((len(question.depths), len(y))), solved[3])
        if parted.road.parted is not None:
            fields = _with_face(fields, parted, view, below=below)
        depths = question.depths
        if parted.mean is not None:
            depths = parted.mean @ depths
            if apart:
                fields = _weighted([(fields, parted.mean)], len(parted.mean))
        _check(fields, depths, [part for part in view.components if part < 6])
        yield fields


def _with_face(fields: MovingFields, question: Question, view: View, *, below: bool) -> MovingFields:
    """With what the sliding and opening of a parted face adds."""
    *added, cautions = parted_fields(
        question.loads, question.road, question.depths, view.x, view.y, below=below, at=view.at
    )
    stress, strain, displacement = (
        whole + part for whole, part in zip((fields.stress, fields.strain, fields.displacement), added, strict=True)
    )
    return replace(
        fields, stress=stress, strain=strain, displacement=displacement, method=f"{fields.method}+parted",
        warnings=(*fields.warnings, *cautions),
    )  # fmt: skip


def _check(fields: MovingFields, depths: Array, stresses: Sequence[int]) -> None:
    """Raise ConvergenceError where a stress that was asked for, or a strain that follows from it, is not a number."""
    normal = {0, 1, 2} <= set(stresses)
    strains = [part for part in stresses if part > 2 or normal]
    for part in (*(fields.stress[k] for k in stresses), *(fields.strain[k] for k in strains)):
        if np.isfinite(part.sum()):
            continue
        wrong = ~np.isfinite(part).all(axis=tuple(range(1, part.ndim)))
        if wrong.any():
            raise ConvergenceError(
                f"stress or strain at {depths[wrong][0]:g} m is not a number: loads, moduli and thicknesses lie too "
                "far apart for double precision; check their units"
            )


def _mean(solved: Sequence[MovingFields]) -> MovingFields:
    """Mean of the fields; one alone is not copied."""
    if len(solved) == 1:
        return solved[0]
    return MovingFields(
        np.mean([fields.stress for fields in solved], axis=0),
        np.mean([fields.strain for fields in solved], axis=0),
        np.mean([fields.displacement for fields in solved], axis=0),
        np.mean([fields.energy for fields in solved], axis=0),
        " and ".join(dict.fromkeys(fields.method for fields in solved)),
        tuple(dict.fromkeys(text for fields in solved for text in fields.warnings)),
    )
