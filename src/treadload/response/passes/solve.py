"""The verb: a load rolls over a road that yields, again and again."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Unpack

import numpy as np

from treadload.errors import InputError
from treadload.materials import PassesPowerLaw
from treadload.pavement import Pavement
from treadload.response.loads import Load, gather
from treadload.response.passes.counts import by_power_law
from treadload.response.passes.fields import cautions, passes_dataset
from treadload.response.passes.problem import Zone, ZoneKeys, problem_of
from treadload.response.passes.solution import Passes
from treadload.response.passes.stepping import by_steps


def roll_passes(
    loads: Load | Sequence[Load],
    road: Pavement,
    *,
    passes: int = 10,
    speed: float | None = None,
    offsets: Sequence[float] | None = None,
    wander: float | None = None,
    tolerance: float = 1e-3,
    progress: Callable[[str], None] | None = None,
    **zone: Unpack[ZoneKeys],
) -> Passes:
    """What passes of a load leave in a road: plastic strain, residual stress and the rut.

    loads: as for `solve_response`: a contact, whose pressure and shear roll along +x, or loads of your own. road:
    with at least one layer whose material is an ElastoPlastic. passes: how many; under a PassesPowerLaw any number,
    evaluated at 1, 2, 5, 10, … of them. speed: m/s, > 0, which laws of Perzyna need, for the time under the load.
    zone: spacing=, depth= and layers= of the box in which the road may yield.
    spacing: of the cells of the box that may yield, m, or their sizes along and across travel; left out, the
    footprint's longer side over 32, and across a twelfth of the width of its ribs or blocks where that is less, but
    no less than a third of it. depth: of the box, m, from the surface; left out, it grows until it holds what yields.
    layers: rows of cells in it, graded; left out, as many as it takes where each is a little thicker than the one
    above.
    offsets: lateral places of the wheel, m, one a pass, over and over; wander: standard deviation of these, m,
    instead: evenly spread normal ones, rounded to cells. tolerance: of the plastic strain of a pass, relative.
    The pressure does not depend on the rut, as under a soft tire. On layers the stress and the rut are those of the
    layered road, and the residual stress is that of a half-space of the yielding material. Material is followed along
    straight lines, strains are small. One pass is solved at once, see `passes.steady`. All passes are solved on cells
    of twice the size too: what changes of rut_depth and peak_plastic_strain is their error, stated in the summary,
    with a warning above 10 %.
    Raises InputError for a road that cannot yield, laws of passes among others, a missing speed, and a plastic zone
    that reaches the box.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(0.4e6, kinematic=60e6))
    >>> tire, road = tl.UniformDisc(0.1, 0.3e6), tl.Pavement.half_space(yielding)
    >>> passes = tl.response.roll_passes(tire, road, passes=3, spacing=0.05, layers=4)
    >>> f"{passes.verdict}; yields from {passes.dataset.attrs['elastic_load_factor']:.1f} times this load"
    'elastic; yields from 2.2 times this load'
    """
    start = time.perf_counter()
    question = problem_of(loads, road, Zone(**zone), speed=speed, offsets=offsets, wander=wander, tell=progress)
    if isinstance(passes, bool) or not isinstance(passes, int | np.integer) or passes < 1:
        raise InputError(f"passes must be a whole number >= 1, got {passes!r}")
    if not 1e-8 <= tolerance <= 0.1:
        raise InputError(f"tolerance must lie in [1e-8, 0.1], got {tolerance:g}; 1e-3 is the default")
    laws = {type(course.material.law) for course in question.courses}
    if PassesPowerLaw in laws:
        box, records, outcome = by_power_law(question, int(passes), laws)
    else:
        box, records, outcome = by_steps(question, int(passes), tolerance)
    data = passes_dataset(road, question.courses, box, records, outcome.attrs, outcome.fields)
    seconds = time.perf_counter() - start
    stats = {"seconds": seconds, "rounds": sum(record.rounds for record in records), "box": str(box), **outcome.stats}
    warnings = (*cautions(road, question.courses, records), *outcome.warnings)
    return Passes(data, stats, warnings, gather(loads), road, speed)
