"""A transverse and a longitudinal crack that grow side by side: which is through first, and when the other is."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from treadload import variables
from treadload.damage.growth.options import CrackGrowth
from treadload.damage.growth.solution import Growth
from treadload.deferred import xarray as xr


def side_by_side(by_direction: Mapping[str, Growth], growth: CrackGrowth) -> Growth:
    """The growth of the crack that is through first, with the years of each direction.

    by_direction: name of the direction → growth of its crack, over the same depths. Where none is ever through, the
    first is that which comes deepest, and of these the one that is there earliest.
    """
    names = list(by_direction)
    passes = np.array([grown.dataset["reach_passes"].to_numpy() for grown in by_direction.values()])
    depth = np.isfinite(passes).sum(axis=1)
    last = passes[np.arange(len(passes)), np.maximum(depth - 1, 0)]
    first = by_direction[names[int(np.lexsort((last, -depth))[0])]]
    years = [grown.dataset["reach_years"].to_numpy() for grown in by_direction.values()]
    places = [float(grown.dataset["worst_y"]) for grown in by_direction.values()]
    fields = {
        "direction_years": (("direction", "crack_depth"), np.array(years), variables.attributes("direction_years")),
        "direction_y": (("direction",), np.array(places), variables.attributes("direction_y")),
        **{
            f"direction_{name}": (
                ("direction",),
                np.array([float(grown.dataset[name]) for grown in by_direction.values()]),
                variables.attributes(f"direction_{name}"),
            )
            for name in ("earliest_years", "earliest_y")
        },
    }
    dataset: xr.Dataset = first.dataset.assign(fields).assign_coords(direction=names)
    stats = dict(first.stats)
    for key in ("contacts", "responses", "states", "jammed", "seconds"):
        stats[key] = sum(grown.stats[key] for grown in by_direction.values())
    warnings = dict.fromkeys(text for grown in by_direction.values() for text in grown.warnings)
    return Growth(dataset, growth, stats, tuple(warnings))
