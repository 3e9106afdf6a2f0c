"""Blocks of a tread: what its grooves along and across travel leave between them, repeated by a pitch."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from treadload.errors import InputError
from treadload.kernels.sections import Block
from treadload.kernels.sections.block_mesh import Point
from treadload.tire.grooves import Groove, LateralGrooves
from treadload.tire.tread import TreadProfile

# Narrower grooves are sipes, whose walls touch under load, m.
_SIPE = 2e-3
# Pitches that differ by less are one, relative; places, m.
_SAME, _NEAR = 1e-6, 1e-9
# Blocks between which more undertread than this part of the tread's thickness is left feel each other through it.
_JOINED = 0.4
_MOST_BLOCKS = 400


@dataclass(frozen=True)
class TreadBlock:
    """A block of a tread. block: with x, y from its place. x: along travel, y: to the right of the middle, m."""

    block: Block
    x: float
    y: float

    @property
    def ends(self) -> tuple[float, float]:
        """Along travel, from the rear to the front corner, m."""
        along = [x for x, _ in self.block.corners]
        return self.x + min(along), self.x + max(along)


@dataclass(frozen=True)
class BlockPattern:
    """Blocks that repeat round the tire. period: m along the circumference. blocks: of one period."""

    period: float
    blocks: tuple[TreadBlock, ...]

    @property
    def longest(self) -> float:
        """Length of the longest block along travel, m."""
        return max(stop - start for start, stop in (block.ends for block in self.blocks))

    @property
    def narrowest(self) -> float:
        """The shortest side of a block, m."""
        corners = np.array([block.block.corners for block in self.blocks])
        return float(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2).min())

    @property
    def is_joined(self) -> bool:
        """True if undertread or a tie bar higher than 40 % of the tread joins blocks, which is left out."""
        return any(max(block.block.floors) > _JOINED * block.block.height for block in self.blocks)

    @property
    def land_ratio(self) -> float:
        """Area of the faces over that of the tread between the outermost ones."""
        corners = np.array([block.block.corners for block in self.blocks]) + np.array(
            [[(block.x, block.y)] for block in self.blocks]
        )
        x, y = corners[..., 0], corners[..., 1]
        area = 0.5 * np.abs((x * np.roll(y, -1, axis=1) - np.roll(x, -1, axis=1) * y).sum(1)).sum()
        return float(area / (self.period * (y.max() - y.min())))

    def between(self, start: float, stop: float) -> list[TreadBlock]:
        """Blocks that lie whole between two places along travel, m, from the rear to the front."""
        placed = []
        for block in self.blocks:
            low, high = block.ends
            first, last = (
                math.ceil((start - low - _NEAR) / self.period),
                math.floor((stop - high + _NEAR) / self.period),
            )
            placed += [replace(block, x=block.x + number * self.period) for number in range(first, last + 1)]
        return sorted(placed, key=lambda block: (block.x, block.y))

    def __str__(self) -> str:
        return f"{len(self.blocks)} blocks in a pitch of {self.period * 1e3:g} mm, land ratio {self.land_ratio:.0%}"


def blocks_of(profile: TreadProfile, thickness: float) -> BlockPattern:
    """The blocks of a tread of a thickness, m, from the belt to the face.

    Every rib between circumferential grooves is cut by lateral grooves from wall to wall; pitches are whole parts of
    the longest. Shoulder blocks end where the tread does. Raises InputError for ribs without lateral grooves, grooves
    that end inside a rib, sipes, grooves deeper than the tread or that cross within a rib, and pitches that do not
    fit each other.
    """
    if not profile.lateral:
        raise InputError(
            'blocks: the tread has no lateral grooves; give it lateral grooves, or take tread = "ribs" and a contact '
            "in steady rolling"
        )
    for groove in profile.grooves:
        _check_groove(groove, thickness)
    for lateral in profile.lateral:
        _check_groove(lateral, thickness)
    period = max(groove.pitch for groove in profile.lateral)
    half = 0.5 * profile.width
    grooves = sorted(profile.grooves, key=lambda groove: groove.centre)
    walls = [-half, *(edge for g in grooves for edge in (g.centre - 0.5 * g.width, g.centre + 0.5 * g.width)), half]
    blocks: list[TreadBlock] = []
    for number, (left, right) in enumerate(zip(walls[::2], walls[1::2], strict=True)):
        beside = (grooves[number - 1] if number else None, grooves[number] if number < len(grooves) else None)
        cuts = _cuts(profile.lateral, period, left, right)
        blocks += [
            _block(cuts[k], _ahead(cuts, k, period), (left, right), beside, thickness) for k in range(len(cuts))
        ]
        if len(blocks) > _MOST_BLOCKS:
            raise InputError(
                f"blocks: a pitch of {period * 1e3:g} mm has more than {_MOST_BLOCKS} blocks; give pitches of the "
                "same length"
            )
    return BlockPattern(period, tuple(blocks))


@dataclass(frozen=True)
class _Cut:
    """A lateral groove across a rib. x: of its middle line at y = 0, m."""

    groove: LateralGrooves
    x: float

    @property
    def half(self) -> float:
        """Half of its width along travel, m."""
        return 0.5 * self.groove.width / math.cos(self.groove.angle)

    def at(self, y: float) -> float:
        """Place of the middle line along travel, m."""
        return self.x + y * math.tan(self.groove.angle)


def _check_groove(groove: Groove | LateralGrooves, thickness: float) -> None:
    across = isinstance(groove, LateralGrooves)
    what = "lateral groove" if across else "groove"
    if groove.depth >= thickness:
        raise InputError(
            f"blocks: a {what} is {groove.depth * 1e3:g} mm deep and the tread {thickness * 1e3:g} mm thick; give a "
            "tread_thickness of the belt above the depth"
        )
    if groove.width < _SIPE:
        raise InputError(
            f"blocks: a {what} is {groove.width * 1e3:g} mm wide; below {_SIPE * 1e3:g} mm it is a sipe, whose walls "
            "touch under load, which is not computed: leave it out"
        )


def _cuts(lateral: tuple[LateralGrooves, ...], period: float, left: float, right: float) -> list[_Cut]:
    """Lateral grooves of a rib within a period, from the rear to the front."""
    middle = 0.5 * (left + right)
    cuts: list[_Cut] = []
    for groove in lateral:
        if groove.y_range is not None:
            low, high = groove.y_range
            if high <= left + _NEAR or low >= right - _NEAR:
                continue
            if low > left + _NEAR or high < right - _NEAR:
                raise InputError(
                    f"blocks: a lateral groove from {low * 1e3:g} to {high * 1e3:g} mm ends inside the rib from "
                    f"{left * 1e3:g} to {right * 1e3:g} mm; give it the whole width of the rib, or leave it out"
                )
        ratio = period / groove.pitch
        if abs(ratio - round(ratio)) > _SAME * ratio:
            raise InputError(
                f"blocks: a pitch of {groove.pitch * 1e3:g} mm is not a whole part of the longest, "
                f"{period * 1e3:g} mm; give {period / round(ratio) * 1e3:g} mm"
            )
        at = groove.offset + middle * math.tan(groove.angle)
        # The first whose middle lies within the period that starts at 0.
        first = groove.offset - math.floor(at / groove.pitch + _NEAR) * groove.pitch
        cuts += [_Cut(groove, first + number * groove.pitch) for number in range(round(ratio))]
    if not cuts:
        raise InputError(
            f"blocks: the rib from {left * 1e3:g} to {right * 1e3:g} mm has no lateral groove and is endless along "
            "travel; give it lateral grooves"
        )
    return sorted(cuts, key=lambda cut: cut.at(middle))


def _ahead(cuts: list[_Cut], number: int, period: float) -> _Cut:
    """The next groove to the front, of the following period after the last."""
    if number + 1 < len(cuts):
        return cuts[number + 1]
    return replace(cuts[0], x=cuts[0].x + period)


def _block(
    rear: _Cut,
    front: _Cut,
    walls: tuple[float, float],
    beside: tuple[Groove | None, Groove | None],
    thickness: float,
) -> TreadBlock:
    """The block between two lateral grooves and two walls. beside: grooves at the walls, None at a shoulder."""
    left, right = walls
    if min(front.at(y) - front.half - rear.at(y) - rear.half for y in walls) <= _NEAR:
        raise InputError(
            f"blocks: two lateral grooves meet within the rib from {left * 1e3:g} to {right * 1e3:g} mm; move one of "
            "them by its offset, or turn it by its angle"
        )
    corners = [
        (rear.at(left) + rear.half, left),
        (front.at(left) - front.half, left),
        (front.at(right) - front.half, right),
        (rear.at(right) + rear.half, right),
    ]
    x, y = (sum(values) / 4 for values in zip(*corners, strict=True))
    around: tuple[Point, Point, Point, Point] = tuple((a - x, b - y) for a, b in corners)  # type: ignore[assignment]
    grooves = (beside[0], front.groove, beside[1], rear.groove)
    floors, reach, slopes = [], [], []
    for groove in grooves:
        # A shoulder ends in a free wall from the face to the belt.
        slope = 0.0 if groove is None else math.tan(groove.wall_angle)
        depth = thickness if groove is None else _clear_depth(groove)
        floors.append(thickness - depth)
        slopes.append(slope)
        reach.append(0.0 if groove is None else max(0.5 * groove.width - slope * depth, 0.0))
    try:
        block = Block(around, thickness, _four(floors), _four(reach), _four(slopes))
    except ValueError as error:
        raise InputError(f"blocks: {error}") from None
    return TreadBlock(block, x, y)


def _clear_depth(groove: Groove | LateralGrooves) -> float:
    """Depth down to the tie bar of a circumferential groove, m, or to the floor."""
    return groove.clear_depth if isinstance(groove, Groove) else groove.depth


def _four(values: list[float]) -> tuple[float, float, float, float]:
    left, front, right, rear = values
    return left, front, right, rear
