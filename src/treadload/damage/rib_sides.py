"""What an assessment of the surface lacks under a tire whose ribs have no free sides: sentences."""

from __future__ import annotations

from collections.abc import Iterable

from treadload.composing import Source
from treadload.kernels.arrays import Array
from treadload.response import Response
from treadload.response.loads import GridLoad

# Below this depth, m, free sides changed the strain by less than 5 %.
SHALLOW = 0.02
# Load repetitions at a slope of -0.2 without free sides over those with them, by the largest in-plane strain at the
# surface under a free rolling 315/80R22.5: asphalt of 5.4 GPa, and a French structure at 40 °C. The comparison is in
# docs/explanation/ribs.md.
FEWER = (9, 460)
_WHO = {
    "filled": "the tread has circumferential grooves, and this tire has them filled, as a layer or a half-space",
    "unknown": "whether the tread has circumferential ribs is not known, and this tire has none with free sides",
}


def sides_in_words(sides: Iterable[str]) -> list[str]:
    """A sentence where the ribs of a tire that loads the surface have no free sides, or may have none.

    sides: of the tires, as `Tire.rib_sides`; empty of loads that are of no tire.
    """
    for state, who in _WHO.items():
        if state in set(sides):
            return [
                f"{who}: ribs with free sides shear the surface outward. With them the largest in-plane strain at "
                f"the surface under a free rolling tire allowed {FEWER[0]} to {FEWER[1]} times fewer load "
                'repetitions, by road and temperature; give the tire a belt and tread = "ribs"'
            ]
    return []


def filled_ribs(response: Source, depths: Array) -> list[str]:
    """The sentence for an assessment at some depths, m; none where all lie deeper than free sides matter."""
    if not isinstance(response, Response) or not (depths < SHALLOW).any():
        return []
    return sides_in_words([load.rib_sides for load in response.loads if isinstance(load, GridLoad)])
