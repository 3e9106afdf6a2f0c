"""Which loads come to rest on a road that yields, over the shear that they carry."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from treadload import variables
from treadload.errors import InputError
from treadload.pavement import Pavement
from treadload.response import GridLoad, UniformRectangle
from treadload.response.loads import Load, gather
from treadload.response.passes.limits import limit_loads
from treadload.results import Fields


def shakedown_map(
    load: Load,
    road: Pavement,
    frictions: Sequence[float] = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5),
    *,
    spacing: float | None = None,
    layers: int = 10,
    progress: Callable[[str], None] | None = None,
) -> Fields:
    """Largest load that yields nowhere and largest that comes to rest, for some ratios of shear to pressure.

    load: whose pressure is taken, with shear along travel of a ratio of it everywhere, as of a wheel that slides or
    brakes hard. road: with a layer that can yield step by step. frictions: the ratios, >= 0. spacing, layers: of the
    box, as in `roll_passes`. The limit of shakedown is Melan's for von Mises' law with Prager's hardening; for other
    laws it is searched by passes, to 3 % of what lies between the load of first yield and three times that. No load
    above three times is looked at.
    Returns Fields over friction: elastic_limit_load and shakedown_load, over the load at first yield without shear;
    `plots.shakedown_map` draws them. Raises InputError.

    >>> yielding = tl.materials.ElastoPlastic(tl.Elastic(600e6, 0.35), tl.materials.VonMises(0.4e6, kinematic=60e6))
    >>> patch, road = tl.UniformRectangle(0.2, 0.2, 0.3e6), tl.Pavement.half_space(yielding)
    >>> limits = tl.life.shakedown_map(patch, road, [0.0, 0.4], spacing=0.1, layers=3).dataset
    >>> [f"{load:.2f}" for load in limits.shakedown_load.values]  # over the load at first yield without shear
    ['1.68', '1.47']
    """
    ratios = np.asarray(list(frictions), float)
    if not ratios.size or not (np.isfinite(ratios) & (ratios >= 0)).all():
        raise InputError(f"frictions must be numbers >= 0, got {list(frictions)}; 0.3 is a shear of 0.3 p")
    (placed,) = gather(load)
    cells = placed.cell if isinstance(placed, UniformRectangle) else placed
    if not isinstance(cells, GridLoad):
        raise InputError("a disc carries no shear; give a contact, a GridLoad or a UniformRectangle")
    bare = replace(cells, traction_x=None, traction_y=None)
    limits = []
    for ratio in (0.0, *ratios):
        if progress is not None:
            progress(f"limit of shakedown with a shear of {ratio:g} p")
        limits.append(
            limit_loads(replace(bare, traction_x=ratio * bare.pressure), road, spacing=spacing, layers=layers)
        )
    unit, law = limits[0][0], limits[0][2]
    fields = {
        "elastic_limit_load": (("friction",), np.array([limit[0] for limit in limits[1:]]) / unit),
        "shakedown_load": (("friction",), np.array([limit[1] for limit in limits[1:]]) / unit),
    }
    return Fields(variables.dataset(fields, {"friction": ratios}, law=law))
