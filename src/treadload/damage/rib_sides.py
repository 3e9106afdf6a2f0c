"""What an assessment of the surface lacks under a tire whose ribs have no free sides: sentences."""

from __future__ import annotations

from collections.abc import Iterable

from treadload.composing import Source
from treadload.kernels.arrays import Array
from treadload.response import Response
from treadload.response.loads import GridLoad

# Below this depth, m, free sides changed the strain by less than 5 %.
SHALLOW = 0.02
# Largest in-plane strain at the surface under a free rolling 315/80R22.5 with filled grooves and with free ribs,
# microstrain, on asphalt of 5.4 GPa and on a French structure at 40 °C, and how many times fewer load repetitions
# that allows at a slope of -0.2, with as many digits as cells allow. By how much at most, microstrain, the largest
# strain at places with a tensile principal stress fell, at 10 to 40 °C and driven with 10 kN as well.
# `examples/ribs/run.py` prints them, docs/notes/ribs_evidence.md shows them over temperature.
STRAINS = ((27, 45), (33, 121))
FEWER = (10, 700)
EVALUATED = 5
# That of the bus stop of `examples/top_down`, whose braking front axle does most: layer and ribs, microstrain.
BRAKED = (117, 140)
_STATES = {
    "filled": "the tread has circumferential grooves, and this tire has them filled, as a layer or a half-space",
    "unknown": "whether the tread has circumferential ribs is not known, and this tire has none with free sides",
}


def sides_in_words(sides: Iterable[str]) -> list[str]:
    """A sentence where the ribs of a tire that loads the surface have no free sides, or may have none.

    sides: of the tires, as `Tire.rib_sides`; empty of loads that are of no tire.
    """
    for state, reason in _STATES.items():
        if state in set(sides):
            (stiff, free_stiff), (hot, free_hot) = STRAINS
            return [
                f"{reason}: ribs with free sides shear the surface outward. Under a freely rolling 315/80R22.5 "
                "they raised the largest in-plane strain at the surface, compared with a layer on the same belt, "
                f"from {stiff} to {free_stiff} microstrain on asphalt of 5.4 GPa and from {hot} to {free_hot} on a "
                f"French structure at 40 °C: {FEWER[0]} to {FEWER[1]} times fewer load repetitions at a slope of "
                "-0.2, without a bound where the layer compresses the surface (25 °C). That strain lies where no "
                "principal stress is tensile. Where there is one, the strain that an assessment of tensile strain "
                f"evaluates fell by at most {EVALUATED} microstrain, rolling freely or driving with 10 kN; where a "
                f'bus brakes it rose from {BRAKED[0]} to {BRAKED[1]}; give the tire a belt and tread = "ribs"'
            ]
    return []


def filled_ribs(response: Source, depths: Array) -> list[str]:
    """The sentence for an assessment at some depths, m; none where all lie deeper than free sides matter."""
    if not isinstance(response, Response) or not (depths < SHALLOW).any():
        return []
    return sides_in_words([load.rib_sides for load in response.loads if isinstance(load, GridLoad)])
