"""The verb: a load rolls over a road that yields, again and again."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from treadload import variables
from treadload.errors import InputError
from treadload.materials import PassesPowerLaw
from treadload.pavement import Pavement
from treadload.response.fields import COMPONENTS
from treadload.response.loads import Load, gather
from treadload.response.passes.asked import Asked, asked
from treadload.response.passes.box import Box
from treadload.response.passes.counts import by_power_law
from treadload.response.passes.solution import Passes
from treadload.response.passes.stepping import Record, by_steps
from treadload.response.passes.surface import surface_profile
from treadload.response.passes.verdict import CRITERION

# The program's bound of small strains.
_SMALL = 0.05


def roll_passes(
    loads: Load | Sequence[Load],
    road: Pavement,
    *,
    passes: int = 10,
    speed: float | None = None,
    spacing: float | None = None,
    depth: float | None = None,
    layers: int = 14,
    offsets: Sequence[float] | None = None,
    wander: float | None = None,
    tolerance: float = 1e-3,
    progress: Callable[[str], None] | None = None,
) -> Passes:
    """What passes of a load leave in a road: plastic strain, residual stress and the rut.

    loads: as for `solve_response`: a contact, whose pressure and shear roll along +x, or loads of your own. road:
    with at least one layer whose material is an ElastoPlastic. passes: how many; under a PassesPowerLaw any number,
    told at 1, 2, 5, 10, … of them. speed: m/s, > 0, which laws of Perzyna need, for the time under the load.
    spacing: of the cells of the box that may yield, m; left out, the footprint's longer side over 32. depth: of the
    box, m, from the surface; left out, it grows until it holds what yields. layers: rows of cells in it, graded.
    offsets: lateral places of the wheel, m, one a pass, over and over; wander: standard deviation of these, m,
    instead: evenly spread normal ones, rounded to cells. tolerance: of the plastic strain of a pass, relative.
    The pressure does not feel the rut, as under a soft tire. On layers the stress and the rut are those of the
    layered road, and the residual stress is that of a half-space of the yielding material. Material is followed along
    straight lines, strains are small. One pass is solved at once, see `passes.steady`.
    Raises InputError for a road that cannot yield, laws of passes among others, a missing speed, and a plastic zone
    that reaches the box.
    """
    start = time.perf_counter()
    question = asked(loads, road, speed, spacing, depth, layers, offsets, wander, progress)
    if isinstance(passes, bool) or not isinstance(passes, int | np.integer) or passes < 1:
        raise InputError(f"passes must be a whole number >= 1, got {passes!r}")
    if not 1e-8 <= tolerance <= 0.1:
        raise InputError(f"tolerance must lie in [1e-8, 0.1], got {tolerance:g}; 1e-3 is the default")
    laws = {type(one.material.law) for one in question.courses}
    if PassesPowerLaw in laws:
        box, records, told = by_power_law(question, int(passes), laws)
    else:
        box, records, told = by_steps(question, int(passes), tolerance)
    data = _dataset(question, box, records, told.attrs)
    seconds = time.perf_counter() - start
    stats = {"seconds": seconds, "rounds": sum(one.rounds for one in records), "box": str(box), **told.stats}
    warnings = (*_cautions(question, records, road), *told.warnings)
    return Passes(data, stats, warnings, gather(loads), road, speed)


def _dataset(question: Asked, box: Box, records: Sequence[Record], attrs: dict[str, Any]) -> Any:
    strain = np.array([one.strain for one in records])
    across = box.y0 + box.dy * np.arange(-box.ny, 2 * box.ny)
    profile = surface_profile(strain, box, question.road, across)
    dims = ("pass", "depth", "y")
    fields: dict[str, tuple[tuple[str, ...], Any]] = {
        **{f"plastic_strain_{name}": (dims, strain[:, k]) for k, name in enumerate(COMPONENTS)},
        **{
            f"residual_stress_{name}": (dims, np.array([one.residual[k] for one in records]))
            for k, name in enumerate(COMPONENTS)
        },
        "equivalent_plastic_strain": (dims, np.array([one.hardening for one in records])),
        "residual_displacement_z": (("pass", "across"), profile),
        "rut_depth": (("pass",), np.maximum(profile.max(axis=1), 0.0)),
        "heave": (("pass",), np.maximum(-profile.min(axis=1), 0.0)),
        "plastic_increment": (("pass",), np.array([one.added for one in records])),
        "plastic_left": (("pass",), np.array([one.left for one in records])),
        "wheel_offset": (("pass",), np.array([one.offset for one in records])),
    }
    places = {"pass": np.array([float(one.number) for one in records]), "depth": box.depths, "y": box.y}
    laws = ", ".join(dict.fromkeys(f"{type(one.material.law).__name__}" for one in question.courses))
    # Infinity has no place among the attributes of a file.
    told = {key: value for key, value in attrs.items() if not (isinstance(value, float) and math.isinf(value))}
    return variables.dataset(
        fields, {**places, "across": across}, criterion=CRITERION, law=f"yields by {laws}", dx=box.dx, dy=box.dy,
        row_edges=box.edges, **told,
    )  # fmt: skip


def _cautions(question: Asked, records: Sequence[Record], road: Pavement) -> Iterator[str]:
    largest = max(float(one.hardening.max()) for one in records)
    if largest > _SMALL:
        yield (
            f"the plastic strain reaches {100 * largest:.1f} %, above {100 * _SMALL:g} %: strains are taken as small "
            "here, and the rut is only a rough one"
        )
    if not road.is_homogeneous:
        yield (
            "the residual stress is that of a half-space of the yielding material; stress under the wheel and the "
            "rut are those of the layered road"
        )
    elastic = {one.material.elastic for one in question.courses}
    if len(elastic) > 1:
        yield (
            "layers of different stiffness yield: they stress each other as rows of a half-space of the geometric "
            "mean of their moduli"
        )
