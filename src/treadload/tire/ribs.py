"""Ribs of a tread: what its grooves leave between them, as cross-sections on the belt."""

from __future__ import annotations

import math
from dataclasses import dataclass

from treadload.errors import InputError
from treadload.kernels.sections import Section
from treadload.tire.cross_section import Channel, Grooved, TreadSection
from treadload.tire.map_section import section_of_map
from treadload.tire.surface import HeightMapSurface, Surface
from treadload.tire.tread import ProfileSurface, TreadProfile

# Ribs between which more rubber than this part of the tread's thickness is left move together.
_JOINED = 0.4
# Ends of a face and of the part of it that is pressed, m to the right: left, low, high, right.
Band = tuple[float, float, float, float]
# Walls that leave less floor than this, m, meet.
_SAME = 1e-9


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


def section_of(profile: TreadProfile) -> TreadSection:
    """Cross-section of a parametric tread: its width, its grooves, and lateral ones as an obstacle."""
    channels = tuple(
        Channel(
            groove.centre - 0.5 * groove.width,
            groove.centre + 0.5 * groove.width,
            groove.depth,
            (math.tan(groove.wall_angle), math.tan(groove.wall_angle)),
            groove.tie_bar,
        )
        for groove in sorted(profile.grooves, key=lambda groove: groove.centre)
    )
    lateral = "the tread has lateral grooves; leave them out" if profile.lateral else ""
    return TreadSection(-0.5 * profile.width, 0.5 * profile.width, channels, lateral)


def cross_section_of(surface: Surface) -> TreadSection | None:
    """Cross-section of a tread's surface: of its numbers, of a scan's meridian, of a map; None where unknown."""
    if isinstance(surface, ProfileSurface):
        return section_of(surface.profile)
    if isinstance(surface, HeightMapSurface):
        return section_of_map(surface)
    return surface.cross_section if isinstance(surface, Grooved) else None


def ribs_between(section: TreadSection, thickness: float) -> tuple[RibGroup, ...]:
    """The ribs between the grooves of a tread of a thickness, m, from the belt to the face.

    Shoulder ribs end where the tread does, with a vertical wall down to the belt. Raises InputError for grooves that
    are not circumferential, that are deeper than the tread, and whose walls meet above their floor.
    """
    if section.obstacle:
        raise InputError(
            f'ribs: {section.obstacle}; tread = "ribs" takes circumferential grooves only: give tread = "layer"'
        )
    for groove in section.channels:
        if groove.depth > thickness + _SAME:
            raise InputError(
                f"ribs: the groove at y = {groove.centre * 1e3:g} mm is {groove.depth * 1e3:g} mm deep and the tread "
                f"{thickness * 1e3:g} mm thick; give the belt at least that tread_thickness, or give undertread"
            )
        width, run = groove.right - groove.left, groove.clear_depth * sum(groove.slopes)
        if run > width - _SAME:
            raise InputError(
                f"ribs: the walls of the groove at y = {groove.centre * 1e3:g} mm meet above its floor: they run "
                f"{run * 1e3:.3g} mm and the groove is {width * 1e3:.3g} mm wide; give it steeper walls (wall_angle) "
                "or less depth"
            )
    walls = [section.left, *(edge for groove in section.channels for edge in (groove.left, groove.right))]
    ribs = list(zip(walls[::2], [*walls[1::2], section.right], strict=True))
    floors = [0.0, *(max(0.0, thickness - groove.clear_depth) for groove in section.channels), 0.0]
    slopes = [0.0, *(slope for groove in section.channels for slope in groove.slopes), 0.0]
    drafts = list(zip(slopes[::2], slopes[1::2], strict=True))
    groups: list[RibGroup] = []
    first = 0
    for number in range(len(ribs)):
        if number + 1 < len(ribs) and floors[number + 1] > _JOINED * thickness:
            continue
        members = slice(first, number + 1)
        part = _Part(ribs[members], floors[first : number + 2], drafts[members], _beside(ribs, first, number))
        groups.append(_group(part, thickness))
        first = number + 1
    return tuple(groups)


@dataclass(frozen=True)
class _Part:
    """Ribs that move together, m: faces, floors beside them, slopes of walls, halves of the grooves beside them."""

    ribs: list[tuple[float, float]]
    floors: list[float]
    drafts: list[tuple[float, float]]
    beside: tuple[float, float]


def _beside(ribs: list[tuple[float, float]], first: int, last: int) -> tuple[float, float]:
    """Half of the widths of the grooves to the left and to the right of some ribs, m; 0 at a shoulder."""
    left = 0.5 * (ribs[first][0] - ribs[first - 1][1]) if first else 0.0
    right = 0.5 * (ribs[last + 1][0] - ribs[last][1]) if last + 1 < len(ribs) else 0.0
    return left, right


def _group(part: _Part, thickness: float) -> RibGroup:
    ribs, floors, drafts = part.ribs, part.floors, part.drafts
    centre = 0.5 * (ribs[0][0] + ribs[-1][1])
    around = tuple((left - centre, right - centre) for left, right in ribs)
    outer = (drafts[0][0], drafts[-1][1])
    ends = tuple(
        max(width - slope * (thickness - floor), 0.0) if floor else 0.0
        for width, floor, slope in zip(part.beside, (floors[0], floors[-1]), outer, strict=True)
    )
    alike = {slope for pair in drafts for slope in pair}
    draft = alike.pop() if len(alike) == 1 else tuple(drafts)
    try:
        section = Section(around, thickness, tuple(floors), (ends[0], ends[1]), draft)
    except ValueError as error:
        raise InputError(f"ribs: {error}; give grooves that leave ribs between them") from None
    # A shoulder's image serves the other shoulder.
    if _order(section) > _order(section.mirrored):
        return RibGroup(section.mirrored, centre, mirrored=True)
    return RibGroup(section, centre)


def _order(section: Section) -> tuple[tuple[float, ...], tuple[float, float], tuple[tuple[float, float], ...]]:
    """What differs between a section and its image, to choose one of both."""
    return section.floors, section.ends, section.drafts
