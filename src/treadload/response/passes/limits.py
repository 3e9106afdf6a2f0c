"""The largest part of a load under which a road does not yield, and under which it shakes down."""

from __future__ import annotations

from dataclasses import replace

from treadload.errors import InputError
from treadload.materials import PassesPowerLaw, Perzyna
from treadload.pavement import Pavement
from treadload.response.loads import GridLoad
from treadload.response.passes.problem import Zone, first_yield, probe, problem_of
from treadload.response.passes.steady import Track
from treadload.response.passes.verdict import elastic_factor, shakedown_factor

# No load above so many times that of first yield is looked at.
_MOST = 3.0


def limit_loads(load: GridLoad, road: Pavement, *, spacing: float | None, layers: int) -> tuple[float, float, str]:
    """Factors of a load at first yield and at the limit of shakedown, and the law in words.

    spacing, layers: as of `roll_passes`. Raises InputError for laws that know no limit.
    """
    question = problem_of(load, road, Zone(spacing, None, layers), speed=1.0)
    laws = {type(course.material.law) for course in question.courses}
    if laws & {PassesPowerLaw, Perzyna}:
        names = " and ".join(sorted(law.__name__ for law in laws))
        raise InputError(
            f"{names} yields under every load and time: it has no limit of shakedown; give its law alone"
        )
    most = _MOST * first_yield(question)
    loaded = replace(question, loads=(_times(load, most),))
    box = probe(loaded)
    # Under three times the load of first yield something yields.
    assert box is not None
    track = Track.of(box, [question.material_at(float(z)) for z in box.depths])
    stress = loaded.stress(box.x, box.y, box.depths)
    words = "yields by " + ", ".join(law.__name__ for law in laws)
    return most * elastic_factor(track, stress), most * shakedown_factor(track, stress), words


def _times(load: GridLoad, factor: float) -> GridLoad:
    """A load whose pressure and shear are a multiple."""
    pressure, along, across = factor * load.array
    return replace(load, pressure=pressure, traction_x=along, traction_y=across)
