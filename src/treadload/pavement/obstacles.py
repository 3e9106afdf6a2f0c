"""What a wheel rolls over: a step, a joint, a plate such as the frame of a manhole. Each is a `Relief`."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from treadload.errors import InputError, positive
from treadload.kernels.arrays import Array
from treadload.units import Length

# Places so near to an edge, m, lie on it.
_ON = 1e-9
# Rises and drops of a road that a wheel crosses at rest, m.
_HIGHEST = 0.2


@dataclass(frozen=True)
class RoadStep:
    """A road that changes its height at x = 0.

    rise: of the road beyond it above the road before it, m; negative where it drops. chamfer: length of the even
    slope between them, m, its middle at x = 0; 0 for an upright edge.

    >>> tl.pavement.RoadStep(0.01).rise
    0.01
    """

    rise: Length
    chamfer: Length = 0.0

    def __post_init__(self) -> None:
        _check_height(self.rise)
        _check_chamfer(self.chamfer)

    @property
    def edges(self) -> tuple[float, ...]:
        """Places along travel where the road breaks, m."""
        return (0.0,)

    @property
    def finest(self) -> float | None:
        """Shortest length along travel in it, m; None for an upright edge alone."""
        return self.chamfer or None

    def height(self, x: Array, y: Array) -> Array:
        """(ny, nx), m, at x (nx,) and y (ny,), m."""
        along, across = x[None, :], y[:, None]
        return self.rise * _rise(along, self.chamfer) + 0.0 * across

    def __str__(self) -> str:
        return f"step, {_up(self.rise)}, {_edge(self.chamfer)}"


@dataclass(frozen=True)
class RoadJoint:
    """A joint straight across the road, its middle at x = 0.

    width: at its walls, m. depth: of its floor, or of the sealant in it, below the road, m. chamfer: leg of the
    45° chamfers of its edges, m, on both sides of the width.

    >>> tl.pavement.RoadJoint(0.018, 0.03, chamfer=0.006).width
    0.018
    """

    width: Length
    depth: Length
    chamfer: Length = 0.0

    def __post_init__(self) -> None:
        positive("width of the joint", self.width, "metres", "a saw cuts 3 to 12 mm")
        if not 0 <= self.depth <= _HIGHEST:
            raise InputError(f"depth of the joint must lie between 0 and {_HIGHEST} m, got {self.depth:g}; in metres")
        _check_chamfer(self.chamfer)
        if self.chamfer > self.depth and self.depth > 0:
            raise InputError(f"a chamfer of {self.chamfer:g} m does not fit a joint of {self.depth:g} m depth")

    @property
    def edges(self) -> tuple[float, ...]:
        """Places along travel where the road breaks off, m."""
        half = 0.5 * self.width + self.chamfer
        return (-half, half)

    @property
    def finest(self) -> float | None:
        """Shortest length along travel in it, m."""
        return min(self.width, self.chamfer) if self.chamfer else self.width

    def height(self, x: Array, y: Array) -> Array:
        """(ny, nx), m, at x (nx,) and y (ny,), m."""
        along, across = x[None, :], y[:, None]
        beyond = np.abs(along) - 0.5 * self.width
        slope = np.clip(beyond - self.chamfer, -self.chamfer, 0.0) if self.depth > 0 else 0.0
        floor = 1 - _rise(beyond, 0.0)
        return np.asarray((1 - floor) * slope - floor * self.depth + 0.0 * across, dtype=np.float64)

    def __str__(self) -> str:
        return f"joint, {self.width * 1e3:g} mm wide, {self.depth * 1e3:g} mm deep, {_edge(self.chamfer)}"


@dataclass(frozen=True)
class RoadPlate:
    """A plate or frame that stands above the road or lies below it, its middle at x = y = 0.

    rise: above the road, m; negative where it is sunk. length: along travel, m. width: across, m; left out, the
    whole road, as a bump or a dip does. round: a disc of diameter `length`. chamfer: of its edge, m, an even slope
    whose middle is the edge.

    >>> tl.pavement.RoadPlate(0.01, length=0.6, width=0.6).rise
    0.01
    """

    rise: Length
    length: Length
    width: Length | None = None
    round: bool = False
    chamfer: Length = 0.0

    def __post_init__(self) -> None:
        _check_height(self.rise)
        positive("length of the plate", self.length, "metres", "a manhole has 0.6 m")
        if self.width is not None:
            positive("width of the plate", self.width, "metres", "leave it out for the whole road")
            if self.round:
                raise InputError("a round plate has its diameter, length, and no width")
        _check_chamfer(self.chamfer)
        if self.chamfer >= min(self.length, self.width or math.inf):
            raise InputError(f"a chamfer of {self.chamfer:g} m leaves nothing of a plate of {self.length:g} m")

    @property
    def edges(self) -> tuple[float, ...]:
        """Places along travel where the road breaks at y = 0, m."""
        return (-0.5 * self.length, 0.5 * self.length)

    @property
    def finest(self) -> float | None:
        """Shortest length along travel in it, m."""
        return self.chamfer or self.length

    def height(self, x: Array, y: Array) -> Array:
        """(ny, nx), m, at x (nx,) and y (ny,), m."""
        along, across = x[None, :], y[:, None]
        if self.round:
            out = np.hypot(along, across) - 0.5 * self.length
        else:
            out = np.abs(along) - 0.5 * self.length + 0.0 * across
            if self.width is not None:
                out = np.maximum(out, np.abs(across) - 0.5 * self.width)
        return np.asarray(self.rise * (1 - _rise(out, self.chamfer)), dtype=np.float64)

    def __str__(self) -> str:
        size = f"{self.length * 1e3:g} mm " + ("across, round" if self.round else "long")
        if not self.round:
            size += ", over the whole road" if self.width is None else f", {self.width * 1e3:g} mm wide"
        return f"plate, {_up(self.rise)}, {size}, {_edge(self.chamfer)}"


def _up(rise: float) -> str:
    return f"{abs(rise) * 1e3:g} mm {'down' if rise < 0 else 'up'}"


def _edge(chamfer: float) -> str:
    return f"chamfer of {chamfer * 1e3:g} mm" if chamfer else "upright edges"


def _rise(beyond: Array, chamfer: float) -> Array:
    """From 0 to 1 over a chamfer; where there is none, a half on the edge."""
    if chamfer > 0:
        return np.asarray(np.clip(beyond / chamfer + 0.5, 0.0, 1.0), dtype=np.float64)
    return np.asarray(0.5 * (1 + np.sign(np.where(np.abs(beyond) < _ON, 0.0, beyond))), dtype=np.float64)


def _check_height(height: float) -> None:
    if not (math.isfinite(height) and abs(height) <= _HIGHEST):
        raise InputError(f"rise must lie within ±{_HIGHEST} m, got {height:g}; it is in metres, 5 mm is 0.005")


def _check_chamfer(chamfer: float) -> None:
    if not (math.isfinite(chamfer) and chamfer >= 0):
        raise InputError(f"chamfer must be a length >= 0 m, got {chamfer:g}")
