"""Ribs of a tread: what its grooves leave between them, as cross-sections on the belt."""

from __future__ import annotations

import math
from dataclasses import dataclass

from treadload.errors import InputError
from treadload.kernels.sections import Section
from treadload.tire.tread import TreadProfile

# Ribs between which more rubber than this part of the tread's thickness is left move together.
_JOINED = 0.4
# Ends of a face and of the part of it that is pressed, m to the right: left, low, high, right.
Band = tuple[float, float, float, float]


@dataclass(frozen=True)
class RibGroup:
    """Ribs that stand apart from all others: one, or several joined by shallow grooves.

    section: with y from the middle of the group, or that of the image of the group, where mirrored. centre: m, to the
    right of the middle of the tread. pressed: bands of the faces whose edges are rounded; empty where all of a face
    is pressed.
    """

    section: Section
    centre: float
    mirrored: bool = False
    pressed: tuple[Band, ...] = ()

    @property
    def faces(self) -> tuple[tuple[float, float], ...]:
        """(left, right) of every rib of the group on the tread, m, from left to right."""
        section = self.section.mirrored if self.mirrored else self.section
        return tuple((left + self.centre, right + self.centre) for left, right in section.ribs)

    @property
    def bands(self) -> tuple[Band, ...]:
        """The band of every face, from left to right."""
        return self.pressed or tuple((left, left, right, right) for left, right in self.faces)


def ribs_of(profile: TreadProfile, thickness: float) -> tuple[RibGroup, ...]:
    """The ribs of a tread of a thickness, m, from the belt to the face.

    Shoulder ribs end where the tread does. Raises InputError for grooves that are not circumferential, that are
    deeper than the tread, and whose walls meet above their floor.
    """
    if profile.lateral:
        raise InputError(
            'ribs: the tread has lateral grooves, and ribs have circumferential ones only; give tread = "layer", or '
            "leave the lateral grooves out"
        )
    grooves = sorted(profile.grooves, key=lambda groove: groove.centre)
    for groove in grooves:
        if groove.depth >= thickness:
            raise InputError(
                f"ribs: the groove at y = {groove.centre * 1e3:g} mm is {groove.depth * 1e3:g} mm deep and the tread "
                f"{thickness * 1e3:g} mm thick; give a tread_thickness of the belt above the depth"
            )
    half = 0.5 * profile.width
    slopes = {math.tan(groove.wall_angle) for groove in grooves}
    if len(slopes) > 1:
        raise InputError(
            f"ribs: the walls of the grooves have {len(slopes)} different slopes; give them the same wall_angle"
        )
    slope = slopes.pop() if slopes else 0.0
    walls = [-half, *(edge for g in grooves for edge in (g.centre - 0.5 * g.width, g.centre + 0.5 * g.width)), half]
    ribs = list(zip(walls[::2], walls[1::2], strict=True))
    floors = [0.0, *(thickness - groove.depth for groove in grooves), 0.0]
    groups: list[RibGroup] = []
    first = 0
    for number in range(len(ribs)):
        if number + 1 < len(ribs) and floors[number + 1] > _JOINED * thickness:
            continue
        groups.append(
            _group(
                ribs[first : number + 1], floors[first : number + 2], thickness, slope, _beside(ribs, first, number)
            )
        )
        first = number + 1
    return tuple(groups)


def _beside(ribs: list[tuple[float, float]], first: int, last: int) -> tuple[float, float]:
    """Half of the widths of the grooves to the left and to the right of some ribs, m; 0 at a shoulder."""
    left = 0.5 * (ribs[first][0] - ribs[first - 1][1]) if first else 0.0
    right = 0.5 * (ribs[last + 1][0] - ribs[last][1]) if last + 1 < len(ribs) else 0.0
    return left, right


def _group(
    ribs: list[tuple[float, float]], floors: list[float], thickness: float, slope: float, beside: tuple[float, float]
) -> RibGroup:
    centre = 0.5 * (ribs[0][0] + ribs[-1][1])
    around = tuple((left - centre, right - centre) for left, right in ribs)
    ends = tuple(
        max(width - slope * (thickness - floor), 0.0) if floor else 0.0
        for width, floor in zip(beside, (floors[0], floors[-1]), strict=True)
    )
    try:
        section = Section(around, thickness, tuple(floors), (ends[0], ends[1]), slope)
    except ValueError as error:
        raise InputError(f"ribs: {error}; narrow the grooves' wall_angle or make them shallower") from None
    # A shoulder's image serves the other shoulder.
    if (section.floors, section.ends) > (section.mirrored.floors, section.mirrored.ends):
        return RibGroup(section.mirrored, centre, mirrored=True)
    return RibGroup(section, centre)
